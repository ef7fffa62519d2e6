"""Solvers in Python: four methods, and who drives them."""

from __future__ import annotations

import time as clock
import warnings
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from typing import Any, Literal, Protocol, runtime_checkable

import numpy.typing as npt

from .errors import Interrupted, InterruptedWarning, ParameterError
from .interrupt import deferred
from .problem import Problem
from .progress import bar
from .solution import Solution

PIECES_PER_THREAD = 4
"""Pieces in flight for each thread: enough that nobody waits for the last of them."""


@runtime_checkable
class Solver(Protocol):
    """A radiosity algorithm as a sequence of steps, each made of independent pieces: the four methods of the engine's own solvers.

    `run` calls `step`, computes the parts of all pieces in any order, on any threads, and absorbs them in the order of their pieces.
    So `part` must be pure: the same state and piece give the same bits. Then the result is the same for any number of threads.
    `isolux.testing.check_solver` finds out whether a solver does what it should. It may have a `name`, a `seed`, and a number of
    `rays` as attributes.
    """

    def step(self) -> range | None:
        """The pieces of the running step that are not absorbed yet, or `None` when the work is done."""

    def part(self, problem: Problem, piece: int) -> Any:
        """Computes one piece. Pure."""

    def absorb(self, problem: Problem, part: Any) -> None:
        """Takes in the part of the next piece in order."""

    def solution(self, problem: Problem) -> npt.ArrayLike:
        """The irradiance [lux] of every element, shape (n, 3), as good as it is by now; or that of r independent complete solutions,
        shape (r, n, 3), from which isolux makes mean and standard errors."""


def run(
    solver: Solver,
    problem: Problem,
    *,
    threads: int = 1,
    time: float | None = None,
    progress: bool = False,
    callback: Callable[[Solver], bool | None] | None = None,
    on_interrupt: Literal["keep", "raise"] = "keep",
) -> Solution:
    """Runs a solver that is written in Python, to its end or until somebody ends it.

    Args:
        solver: it has the four methods of `Solver`.
        problem: what it solves.
        threads: how many compute parts at once. They help as far as NumPy and the engine let the interpreter go.
        time: at most so long [s].
        progress: whether to show a bar, for each step anew.
        callback: called with the solver between pieces; the run ends if it returns true.
        on_interrupt: what Ctrl-C does, as in `isolux.solve`: "keep" returns the best result so far.

    Returns:
        A `Solution` like any other.

    Raises:
        ParameterError, NotFinite: the solver gave an array that does not fit, or a number that is not finite.
        Interrupted: Ctrl-C, with on_interrupt="raise".
    """
    if threads < 1:
        raise ParameterError.of("threads", threads, "at least one thread")
    ended, start = "complete", clock.monotonic()
    with bar("solving", progress) as shown, _pool(threads) as pool, deferred() as interrupt:
        while ended == "complete" and (pieces := solver.step()) is not None:
            window = pieces[: PIECES_PER_THREAD * threads] if threads > 1 else pieces[:1]
            for part in _parts(solver, problem, window, pool):
                solver.absorb(problem, part)
            shown.show(min(window.stop / pieces.stop, 1.0), f"piece {window.stop:,} of {pieces.stop:,}")
            if interrupt.is_set:
                ended = "interrupted"
            elif time is not None and clock.monotonic() - start >= time:
                ended = "time"
            elif callback is not None and callback(solver):
                ended = "stopped"
    solution = solution_of(solver, problem, ended)
    if ended == "interrupted":
        if on_interrupt == "raise":
            raise Interrupted(solution)
        warnings.warn("interrupted: this is the best result so far, less than was asked for", InterruptedWarning, stacklevel=2)
    return solution


def solution_of(solver: Solver, problem: Problem, ended: str = "complete") -> Solution:
    """The solution that a solver has now."""
    name = str(getattr(solver, "name", type(solver).__name__))
    rays, seed = int(getattr(solver, "rays", 0)), int(getattr(solver, "seed", 0))
    known = problem.solution(solver.solution(problem), rays=rays, method=name, seed=seed)
    return Solution(known._native, problem=problem, ended=ended)


def _pool(threads: int) -> Any:
    return ThreadPoolExecutor(threads) if threads > 1 else nullcontext()


def _parts(solver: Solver, problem: Problem, pieces: range, pool: ThreadPoolExecutor | None) -> Iterable[Any]:
    """The parts of all pieces, in their order; all of them are computed before the first is absorbed."""
    if pool is None:
        return [solver.part(problem, piece) for piece in pieces]
    return list(pool.map(lambda piece: solver.part(problem, piece), pieces))
