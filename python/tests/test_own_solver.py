"""Solvers in Python: the example passes every test of `check_solver`, and planted faults are caught."""

import importlib.util
import signal
import threading
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import isolux
from conftest import ROOT, box
from isolux.testing import check_solver


def load_example() -> Any:
    spec = importlib.util.spec_from_file_location("own_solver", ROOT / "examples" / "06_own_solver.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


Jacobi: Any = load_example().Jacobi


class ReflectsTwice(Jacobi):  # type: ignore[misc]
    """Multiplies by the reflectivity once too often."""

    def solution(self, problem: isolux.Problem) -> npt.ArrayLike:
        return super().solution(problem) * problem.reflectivity  # type: ignore[no-any-return]


class ForgetsTheCosine(Jacobi):  # type: ignore[misc]
    """Shoots evenly over the hemisphere instead of with the cosine."""

    def part(self, problem: isolux.Problem, piece: int) -> npt.NDArray[Any]:
        random = np.random.default_rng([self.seed, self.sweep, piece])
        power, count = self.unshot.sum(axis=1), self.rays_of_sweep // 4
        source = random.choice(len(power), size=count, p=power / power.sum())
        origins, normals = problem.points(source, random.random((count, 2)))
        directions = random.normal(size=(count, 3))
        directions *= np.sign((directions * normals).sum(axis=1))[:, None]
        hit, _ = problem.trace(origins, directions, leaving=source)
        light = self.unshot[source] * (power.sum() / power[source] / count / 4)[:, None]
        return np.stack([np.bincount(hit[hit >= 0], light[hit >= 0, c], minlength=len(power)) for c in range(3)], axis=1)


class LosesSomeLight(Jacobi):  # type: ignore[misc]
    """Drops three hundredths of what lands."""

    def absorb(self, problem: isolux.Problem, part: npt.NDArray[Any]) -> None:
        super().absorb(problem, 0.97 * part)


class DrawsWhileItComputes(Jacobi):  # type: ignore[misc]
    """Numbers depend on how often parts were computed: not pure."""

    calls = 0

    def part(self, problem: isolux.Problem, piece: int) -> npt.NDArray[Any]:
        self.calls += 1
        return super().part(problem, 1000 * self.calls)  # type: ignore[no-any-return]


def test_the_example_is_a_solver_as_it_should_be() -> None:
    report = check_solver(Jacobi)
    assert report.passed and not report.faults and len(report.findings) == 12
    smallest = [finding.smallest_fault for finding in report.findings if finding.smallest_fault is not None]
    assert all(0 < fault < 0.05 for fault in smallest), str(report)
    assert isinstance(Jacobi(isolux.Problem("box", elements=12), 1), isolux.Solver)


@pytest.mark.parametrize(
    ("mutant", "seen_by"),
    [
        (ReflectsTwice, "furnace"),
        (ForgetsTheCosine, "black cube"),
        (LosesSomeLight, "energy balance"),
        (DrawsWhileItComputes, "any order and number of threads"),
    ],
)
def test_planted_faults_are_caught(mutant: Any, seen_by: str) -> None:
    with pytest.raises(isolux.SolverFault) as fault:
        check_solver(mutant)
    assert any(seen_by in sentence for sentence in fault.value.faults), str(fault.value)


def test_the_exact_answers_are_those_of_the_engine() -> None:
    """The engine's own solver, in the clothes of one in Python, agrees with what solvers are held against."""
    for name, problem, exact in (isolux.testing.furnace(), isolux.testing.sphere(), isolux.testing.lamp_in_a_room()):
        solution = isolux.solve(problem, rays=2e6, method="stochastic-jacobi", leaving="whole-element")
        error = np.sqrt(problem.areas @ ((solution.irradiance - exact) ** 2).sum(axis=1) / (problem.areas @ (exact**2).sum(axis=1)))
        assert error < 0.03, name
        mean = problem.areas @ isolux.luminance(exact) / problem.areas.sum()
        assert abs(solution.mean.mean - mean) < 8 * solution.mean.std_error + 1e-4 * mean, name


def test_lines_go_where_form_factors_say() -> None:
    problem = isolux.Problem(box(), elements=12)
    samples = np.random.default_rng(1).random((200_000, 4))
    floor = problem.elements_of("floor")
    source = np.repeat(floor, 100_000)[:200_000]
    hit = problem.shoot(source, samples)
    ceiling = np.isin(hit, problem.elements_of("ceiling")).mean()
    # Opposite faces of a cube: 0.199825 (Howell's catalogue, C-11); four standard deviations are 0.0036.
    assert ceiling == pytest.approx(0.199825, abs=0.005)
    origins, directions = problem.local_lines(source, samples)
    assert np.linalg.norm(directions, axis=1) == pytest.approx(1, abs=1e-5) and (directions[:, 1] > 0).all()
    assert abs(origins[:, 1]).max() < 1e-5
    _, normals = problem.points(floor, np.full((len(floor), 2), 0.5))
    assert normals == pytest.approx(np.tile([0.0, 1.0, 0.0], (len(floor), 1)))
    element, distance = problem.trace([[0.5, 0.5, 0.5], [0.5, 0.5, 0.5], [0.5, 5, 0.5]], [[0, 9, 0], [0, -1, 0], [0, 1, 0]])
    assert distance[:2] == pytest.approx(0.5) and np.isinf(distance[2]) and element[2] == -1 and element[0] != element[1]
    assert problem.trace([[0.5, 2, 0.5]], [[0, -1, 0]])[0][0] == -2, "the back of the ceiling is black"
    for wrong in (
        lambda: problem.shoot([99], [[0, 0, 0, 0]]),
        lambda: problem.shoot([0], [[0, 0, 0, 2]]),
        lambda: problem.trace([[0, 0, 0]], [[0, 0, 0]]),
        lambda: problem.shoot([0.5], [[0, 0, 0, 0]]),
    ):
        with pytest.raises(isolux.ParameterError):
            wrong()


def test_a_run_gives_a_solution_like_any_other() -> None:
    problem = isolux.Problem("cornell-box", elements=100)
    solution = isolux.run(Jacobi(problem, 3), problem, threads=2)
    assert solution.provenance.method == "Jacobi" and solution.provenance.seed == 3 and solution.rays > 0
    assert np.isnan(solution.std_error).all() and solution.balance.emitted == pytest.approx(0.6175, rel=1e-3)
    several = problem.solution(np.stack([isolux.run(Jacobi(problem, seed), problem).irradiance for seed in range(4)]))
    assert several.replicates == 4 and np.isfinite(several.std_error).all() and several.objects["floor"].mean.freedom == 3
    assert isolux.run(Jacobi(problem, 3), problem, callback=lambda solver: True).ended == "stopped"
    with pytest.raises(isolux.ParameterError, match="shape"):
        problem.solution(np.zeros((3, 3)))
    with pytest.raises(isolux.NotFinite) as error:
        problem.solution(np.full((len(problem), 3), np.nan))
    assert error.value.element == 0 and isinstance(error.value, ArithmeticError)


def test_ctrl_c_ends_a_run_between_two_parts() -> None:
    problem = isolux.Problem("cornell-box", elements=100)
    endless = Jacobi(problem, 1, least=-1)
    timer = threading.Timer(0.5, signal.raise_signal, [signal.SIGINT])
    timer.start()
    with pytest.warns(isolux.errors.InterruptedWarning):
        solution = isolux.run(endless, problem)
    assert solution.interrupted and solution.irradiance.any() and endless.next_piece < 4
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
