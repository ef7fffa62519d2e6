"""What every radiosity solver must do, and whether one does: for solvers that are written in Python (`isolux.Solver`).

Exact answers and invariants, judged by error bars: the furnace, the inside of a sphere, form factors of a cube, energy balance, the same
bits on any number of threads, scenes without light. Statistics are of functionals, not of elements: a small fault everywhere hides in
each element and shines in a sum. All tests of one call together raise a false alarm once in a million calls.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from . import _native
from .colors import LUMINANCE, luminance
from .driver import Solver, run, solution_of
from .errors import ParameterError, SolverFault
from .exact import WALLS, Case, cube, furnace, inside_of_a_cube, lamp_in_a_room, sphere
from .problem import Problem
from .scene import Scene

MakeSolver: TypeAlias = Callable[[Problem, int], Solver]
"""Makes a solver for a problem, with this seed."""

FALSE_ALARM = 1e-6
"""Probability that a solver without a fault is called faulty."""
STATISTICS = 90
"""No check has more numbers to judge than this, all scenes together; each gets its part of the false alarms."""
PROJECTIONS = 4
"""Random sums with signs for each scene."""
ROUNDING = 2e-5
"""What is lost in 32-bit arithmetic, relative to the mean irradiance: no solver can be better than that."""


@dataclass(frozen=True)
class Finding:
    """What one test found out."""

    test: str
    """Which test."""
    passed: bool
    what: str
    """What was found, with numbers."""
    smallest_fault: float | None
    """The relative error that it would have seen, one time in two; `None` where the test is exact."""

    def __str__(self) -> str:
        sees = "" if self.smallest_fault is None else f" (sees faults from {100 * self.smallest_fault:.2g} %)"
        return f"{'passed' if self.passed else 'FAILED'}  {self.test}: {self.what}{sees}"


@dataclass
class SolverReport:
    """The findings of `check_solver`; `print` it to read them."""

    findings: list[Finding] = field(default_factory=list)

    @property
    def passed(self) -> bool:
        """Whether no test found a fault."""
        return all(finding.passed for finding in self.findings)

    @property
    def faults(self) -> list[str]:
        """One sentence for each test that found one."""
        return [f"{finding.test}: {finding.what}" for finding in self.findings if not finding.passed]

    def __str__(self) -> str:
        return "\n".join(str(finding) for finding in self.findings)


def check_solver(make_solver: MakeSolver, *, seeds: int = 12, seed: int = 1, raises: bool = True) -> SolverReport:
    """Tests a solver that is written in Python.

    Args:
        make_solver: called with a `Problem` and a seed, gives a solver of it; solvers with different seeds are independent, those with
            the same seed the same. Let it take so few rays that a scene of some hundred elements takes about a second: error bars follow
            from the spread over seeds.
        seeds: independent runs on each scene, at least 4: faults show the better the more there are.
        seed: the first of them.
        raises: whether to raise an error for a fault, as in tests; otherwise look at `report.passed`.

    Returns:
        A report that says of each test what it found, and the smallest fault it would have seen.

    Raises:
        SolverFault: a test failed; `faults` has a sentence for each, and the message the whole report.
    """
    if seeds < 4:
        raise ParameterError.of("seeds", seeds, "at least 4: fewer tell no error bars")
    report = SolverReport()
    for name, problem, exact in (furnace(), sphere(), cube(), lamp_in_a_room()):
        values = np.array([_irradiance(make_solver(problem, seed + k), problem) for k in range(seeds)])
        report.findings += _against(name, problem, values, exact)
    report.findings += [
        _threads(make_solver, seed),
        _seeds(make_solver, seed),
        _dark(make_solver, seed),
        _alone(make_solver, seed),
    ]
    if raises and not report.passed:
        raise SolverFault(f"the solver does not do what every solver must\n{report}", report.faults)
    return report


def _irradiance(solver: Solver, problem: Problem) -> npt.NDArray[np.float64]:
    return np.asarray(run(solver, problem).irradiance, dtype=float)


def _against(name: str, problem: Problem, values: npt.NDArray[np.float64], exact: npt.NDArray[np.float64]) -> list[Finding]:
    """Holds irradiances of several seeds, shape (seeds, n, 3), against exact ones: means over objects, all channels of all light, and
    random sums with signs."""
    areas = np.asarray(problem.areas, dtype=float)
    names = problem.object_names
    functionals: dict[str, npt.NDArray[np.float64]] = {}
    for k, channel in enumerate(("red", "green", "blue")):
        functionals[f"{channel} light on all surfaces"] = areas[:, None] * np.eye(3)[k] / areas.sum()
    own = [names[k] for k in problem.objects]
    for found in dict.fromkeys(own):
        is_here = np.array([one == found for one in own])
        functionals[f"light on '{found}'"] = (areas * is_here)[:, None] * LUMINANCE / (areas @ is_here)
    signs = np.random.default_rng(7)
    for k in range(PROJECTIONS):
        sign = signs.choice([-1.0, 1.0], size=(len(areas), 3))
        functionals[f"random sum {k + 1}"] = sign * areas[:, None] / areas.sum()
    scale = float(areas @ luminance(exact) / areas.sum())
    keeps = [_judge(what, np.einsum("kec,ec->k", values, f), float((exact * f).sum()), scale) for what, f in functionals.items()]
    kept = areas[:, None] * (1 - np.asarray(problem.reflectivity, dtype=float))
    absorbed = luminance(np.einsum("kec,ec->kc", values, kept))
    emitted = float(luminance(areas @ np.asarray(problem.emission, dtype=float)))
    balance = _judge("absorbed over emitted light", absorbed / emitted, 1.0, 1.0)
    return [_finding(name, keeps), _finding(f"{name}, energy balance", [balance])]


@dataclass(frozen=True)
class _Judgement:
    """One number against its exact value."""

    what: str
    mean: float
    exact: float
    deviations: float
    """The difference over its standard error."""
    bound: float
    """The most that it may be."""
    smallest_fault: float


def _judge(what: str, values: npt.NDArray[np.float64], exact: float, scale: float) -> _Judgement:
    freedom = len(values) - 1
    std_error = math.hypot(float(values.std(ddof=1)) / math.sqrt(len(values)), ROUNDING * scale)
    bound = _native.student(1 - FALSE_ALARM / STATISTICS, freedom)
    mean = float(values.mean())
    return _Judgement(what, mean, exact, abs(mean - exact) / std_error, bound, bound * std_error / scale)


def _finding(test: str, judged: list[_Judgement]) -> Finding:
    worst = max(judged, key=lambda one: one.deviations if math.isfinite(one.deviations) else math.inf)
    passed = all(one.deviations <= one.bound for one in judged)
    what = f"{worst.what} is {worst.mean:.6g}, exactly {worst.exact:.6g}: {worst.deviations:.1f} standard errors, {worst.bound:.1f} may be"
    return Finding(test, passed, what, min(one.smallest_fault for one in judged))


def _small() -> Problem:
    return Problem(inside_of_a_cube(dict.fromkeys(WALLS, np.full(3, 0.5)), {"ceiling": np.full(3, 10.0)}), elements=60)


def _threads(make_solver: MakeSolver, seed: int) -> Finding:
    """Parts are pure: computed twice, backwards, and on several threads, they give the same bits."""
    problem = _small()
    alone = np.asarray(run(make_solver(problem, seed), problem).irradiance)
    several = np.asarray(run(make_solver(problem, seed), problem, threads=3).irradiance)
    backwards = make_solver(problem, seed)
    while (pieces := backwards.step()) is not None:
        parts = {piece: backwards.part(problem, piece) for piece in reversed(pieces)}
        parts |= {piece: backwards.part(problem, piece) for piece in pieces[:1]}
        for piece in pieces:
            backwards.absorb(problem, parts[piece])
    last = np.asarray(solution_of(backwards, problem).irradiance)
    same = bool((alone == several).all() and (alone == last).all())
    what = "the same bits" if same else f"irradiances differ by up to {max(abs(alone - several).max(), abs(alone - last).max()):.3g} lx"
    return Finding("any order and number of threads", same, what, None)


def _seeds(make_solver: MakeSolver, seed: int) -> Finding:
    """The same seed gives the same bits; another one others, unless nothing is random."""
    problem = _small()
    first, again, other = (np.asarray(run(make_solver(problem, s), problem).irradiance) for s in (seed, seed, seed + 1))
    same = bool((first == again).all())
    what = "the same bits" if same else "two runs with the same seed differ"
    return Finding("same seed", same, what + ("; no random numbers" if (first == other).all() else ""), None)


def _dark(make_solver: MakeSolver, seed: int) -> Finding:
    """Without any emitter everything is black."""
    problem = Problem(inside_of_a_cube(dict.fromkeys(WALLS, np.full(3, 0.5)), {}), elements=60)
    brightest = float(np.abs(_irradiance(make_solver(problem, seed), problem)).max())
    return Finding("no emitter", brightest == 0, f"the brightest element has {brightest:.3g} lx, and nothing emits light", None)


def _alone(make_solver: MakeSolver, seed: int) -> Finding:
    """One element that shines into the open: no light falls on it."""
    corners, triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
    problem = Problem(Scene.from_arrays(corners, triangle, emission=1.0), elements=1)
    found = float(np.abs(_irradiance(make_solver(problem, seed), problem)).max())
    return Finding("one element", found == 0, f"it receives {found:.3g} lx, and there is nothing else", None)


__all__ = ["Case", "Finding", "MakeSolver", "SolverReport", "check_solver", "cube", "furnace", "lamp_in_a_room", "sphere"]
