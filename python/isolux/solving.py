"""`isolux.solve`: how much light falls on every surface of a scene, with an error bar."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, TypeAlias

from . import _native
from .errors import AccuracyWarning, Interrupted, InterruptedWarning, ParameterError
from .problem import Problem, Scenelike, as_scene, check_size, whole
from .progress import SolveProgress, bar
from .solution import Solution

LightGroups: TypeAlias = Literal["objects", "materials"] | Mapping[str, str | Sequence[str]]
"""Which lamps are dimmed together: each emitting object by its name, each material, or named groups of names ("Window*" is a pattern)."""


def solve(
    scene: Scenelike,
    *,
    elements: float | None = None,
    max_edge: float | None = None,
    mesh: Literal["adaptive", "uniform"] | None = None,
    contacts: bool | None = None,
    error: float | None = None,
    confidence: float = 0.95,
    error_of: str = "rms",
    rays: float | None = None,
    time: float | None = None,
    method: str | None = None,
    seed: int = 1,
    light: Literal["all", "indirect"] | None = None,
    light_groups: LightGroups | None = None,
    threads: int | None = None,
    progress: bool = False,
    callback: Callable[[SolveProgress], bool | None] | None = None,
    on_interrupt: Literal["keep", "raise"] = "keep",
    **options: Any,
) -> Solution:
    """Computes the light on every surface of a scene, as `isolux solve` does, to the same bits.

    The interpreter is let go meanwhile: other threads of the program run on. Ctrl-C ends the solve and keeps the best result so far:
    the call returns it, `solution.interrupted` is true, and an `InterruptedWarning` says so.

    Args:
        scene: a `Scene`, what `isolux.load` takes, or a `Problem`, which is cut into elements already.
        elements: pieces of surface that get one value each, about so many; 400,000 unless said otherwise (2000 for deterministic methods).
            Small triangles of smooth surfaces are put together.
        max_edge: instead, the longest edge of an element [m].
        mesh: "adaptive" elements are small where the light changes, as they are unless said otherwise; "uniform" ones are equal, as they
            are for little time, with `max_edge` and for deterministic methods.
        contacts: whether elements are cut where others stand on them, so that no light passes below; they are unless said otherwise.
        error: goes on until the error is at most this share of the mean irradiance: 0.02 is two hundredths. `rays` and `time` limit it;
            if they are too little an `AccuracyWarning` says so.
        confidence: how sure that shall be: the share of all solves that keep it.
        error_of: which error: "rms" over all elements by area, "max" of the worst element, "mean" of the scene's mean, or
            "object:NAME" of the mean on that object.
        rays: how many. Without error, rays and time it follows from the elements, and is enough for a first look.
        time: at most so long [s].
        method: by its name in the literature, one of `isolux.names("methods")`; "auto" unless said otherwise.
        seed: of the random numbers. The same seed gives the same bits for any number of threads (but not with `time`).
        light: "indirect" keeps what was reflected at least once.
        light_groups: lamps that are solved apart, all at once, so that `solution.mix` can dim them.
        threads: how many; one for each core unless said otherwise.
        progress: whether to show a bar (in notebooks, too, with tqdm).
        callback: called several times a second with a `SolveProgress`; the solve ends if it returns true.
        on_interrupt: "raise" raises `Interrupted`, with the result in it, instead of returning it.
        **options: what differs from the method: `sequence`, `order`, `lines`, `walk`, `address`, `estimator`, `direction`, `survival`,
            `first_shot`, `replicates`, `leaving`; for deterministic methods `factors`, `unshot`, `ambient`, `link_power`.
            `isolux solve --help` explains each.

    Returns:
        A `Solution`: irradiance [lux] of every element, with standard errors.

    Raises:
        UnknownName, Meaningless, UnusedOption: no such method, a combination without meaning, or an option that would be ignored.
        ParameterError, EmptyScene, TooManyElements: a number without meaning, or nothing to light.
        Interrupted: Ctrl-C, with on_interrupt="raise".
    """
    if on_interrupt not in ("keep", "raise"):
        raise ParameterError.of("on_interrupt", on_interrupt, "keep or raise")
    request = _request(method=method, seed=seed, light=light, **options)
    limits = {"error": error, "confidence": confidence, "error_of": error_of, "rays": whole(rays), "time": time}
    cut = {"elements": whole(elements), "max_edge": max_edge, "mesh": mesh, "contacts": contacts}
    problem, limits = _problem(scene, request, cut, limits, threads)

    with bar("solving", progress) as shown:

        def watch(*now: Any) -> bool:
            known = SolveProgress(*now)
            shown.show(known.share(error, time), str(known))
            return bool(callback(known)) if callback else False

        native, ended, bias = _native.solve(problem._native, request, limits, _groups(light_groups), threads, watch)

    solution = Solution(native, problem=problem, ended=ended, bias=bias)
    if solution.interrupted:
        if on_interrupt == "raise":
            raise Interrupted(solution)
        warnings.warn("interrupted: this is the best result so far, less than was asked for", InterruptedWarning, stacklevel=2)
    elif error is not None and ended != "stopped" and solution.balance.emitted > 0:
        reached = solution.error_bound(confidence, error_of)
        if not reached <= error:
            what = f"the error is at most {100 * reached:.3g} %, not {100 * error:.3g} % as was asked for"
            warnings.warn(what, AccuracyWarning, stacklevel=2)
    return solution


KNOWN_OPTIONS = (
    *("sequence", "order", "lines", "walk", "address", "estimator", "direction", "survival", "first_shot"),
    *("replicates", "leaving", "factors", "unshot", "ambient", "link_power"),
)
"""What a method may be told besides its name."""


def _request(**options: Any) -> _native.Request:
    unknown = next((name for name in options if name not in (*KNOWN_OPTIONS, "method", "seed", "light")), None)
    if unknown is not None:
        raise TypeError(f"solve() got an unexpected argument '{unknown}'; a method may be told {', '.join(KNOWN_OPTIONS)}")
    given = {name: value for name, value in options.items() if value is not None}
    return _native.Request({"method": None} | given)


def _problem(
    scene: Scenelike, request: _native.Request, cut: dict[str, Any], limits: dict[str, Any], threads: int | None
) -> tuple[Problem, dict[str, Any]]:
    """The scene, cut into elements, and the limits that are left: to find adaptive ones takes some of the rays and of the time."""
    check_size(cut["elements"], cut["max_edge"])
    if not isinstance(scene, Problem):
        native, left = request.problem(as_scene(scene)._native, cut, limits, threads)
        return Problem._of(native), left
    if any(value is not None for value in cut.values()):
        raise ParameterError.of("elements", cut["elements"], "a Problem is cut into elements already: say so when it is made")
    return scene, limits


def _groups(groups: LightGroups | None) -> str | list[tuple[str, list[str]]] | None:
    if groups is None or isinstance(groups, str):
        return groups
    return [(name, [members] if isinstance(members, str) else list(members)) for name, members in groups.items()]
