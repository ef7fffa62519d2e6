"""A solver of your own: progressive Jacobi Monte Carlo, tested by `isolux.testing.check_solver`."""

import numpy as np

import isolux

PIECES = 4


class Jacobi:
    """Shoots the unshot power of all elements at once, again and again, until hardly any is left (Shirley 1991)."""

    def __init__(self, problem: isolux.Problem, seed: int, rays: int = 8000, least: float = 1e-4) -> None:
        self.seed, self.rays_of_sweep, self.least = seed, rays, least
        self.rays, self.sweep, self.next_piece = 0, 0, 0
        self.unshot = (problem.areas[:, None] * problem.emission).astype(float)
        self.emitted = self.unshot.sum()
        self.incident, self.landed = np.zeros_like(self.unshot), np.zeros_like(self.unshot)

    def step(self) -> range | None:
        return range(self.next_piece, PIECES) if self.unshot.sum() > self.least * self.emitted else None

    def part(self, problem: isolux.Problem, piece: int) -> np.ndarray:
        random = np.random.default_rng([self.seed, self.sweep, piece])
        power, count = self.unshot.sum(axis=1), self.rays_of_sweep // PIECES
        source = random.choice(len(power), size=count, p=power / power.sum())
        hit = problem.shoot(source, random.random((count, 4)))
        light = self.unshot[source] * (power.sum() / power[source] / count / PIECES)[:, None]
        hits = hit >= 0
        return np.stack([np.bincount(hit[hits], light[hits, c], minlength=len(power)) for c in range(3)], axis=1)

    def absorb(self, problem: isolux.Problem, part: np.ndarray) -> None:
        self.landed += part
        self.next_piece += 1
        if self.next_piece == PIECES:
            self.incident += self.landed
            self.unshot = problem.reflectivity * self.landed
            self.landed = np.zeros_like(self.landed)
            self.rays, self.sweep, self.next_piece = self.rays + self.rays_of_sweep, self.sweep + 1, 0

    def solution(self, problem: isolux.Problem) -> np.ndarray:
        return self.incident / problem.areas[:, None]


if __name__ == "__main__":
    print(isolux.testing.check_solver(Jacobi))

    problem = isolux.Problem("cornell-box", elements=1000)
    own = isolux.run(Jacobi(problem, seed=1, rays=100_000), problem, threads=2)
    engine = isolux.solve(problem, rays=2e6)
    print(f"own solver {own.mean} lx, engine {engine.mean} lx")
