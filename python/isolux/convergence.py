"""How the error of methods falls with the number of rays, on a scene of your own."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native
from .colors import luminance
from .errors import ParameterError
from .optional import needed
from .problem import Problem, Scenelike, as_scene
from .progress import bar
from .solution import Solution
from .solving import solve

if TYPE_CHECKING:
    import pandas as pd

BETTER = 30
"""The reference has so many times the rays of the longest run."""


def convergence(
    scene: Scenelike,
    methods: Sequence[str] | Mapping[str, Mapping[str, Any]],
    rays: Sequence[float],
    *,
    elements: float = 2000,
    seeds: int = 5,
    reference: Solution | None = None,
    progress: bool = False,
) -> Convergence:
    """Measures how the error of methods falls with the number of rays.

    Each point is a whole solve. Its error is the RMS difference by area from a reference, of luminance irradiance, over its mean; what
    the reference itself is off by is taken off: `e² = |E - R|² - s_R²`.

    Args:
        scene: a `Scene`, what `isolux.load` takes, or a `Problem`.
        methods: names of `isolux.names("methods")`, or a dict of labels and what `solve` is told, such as
            `{"Halton": {"method": "random-walk", "sequence": "halton"}}`.
        rays: numbers of rays.
        elements: how finely the scene is cut, if it is no `Problem`.
        seeds: independent runs of each point.
        reference: a solution of the same `Problem`; solved with 30 times the rays of the longest run if it is left out.
        progress: whether to show a bar.

    Returns:
        The measurements, with a table, slopes and a plot.
    """
    problem = scene if isinstance(scene, Problem) else Problem(as_scene(scene), elements=elements)
    told = {name: {"method": name} for name in methods} if not isinstance(methods, Mapping) else dict(methods)
    rows: list[tuple[str, float, int, int, float]] = []
    with bar("convergence", progress) as shown:
        shown.show(0.0, "reference")
        known = reference or solve(problem, rays=BETTER * max(rays), seed=1_000_003)
        if known.problem is not problem and len(known) != len(problem):
            raise ParameterError.of("reference", repr(known), "a solution of the same Problem")
        runs = [(name, count, seed) for count in sorted(rays) for name in told for seed in range(1, seeds + 1)]
        for k, (name, count, seed) in enumerate(runs):
            solution = solve(problem, rays=count, seed=seed, **told[name])
            rows.append((name, float(count), solution.rays, seed, _error(solution, known)))
            shown.show((k + 1) / len(runs), f"{name}, {count:,.0f} rays")
    return Convergence(problem.scene.name, list(told), rows)


def _error(solution: Solution, reference: Solution) -> float:
    """The relative RMS error, without what the reference is off by; `nan` if nothing is left of it."""
    areas = np.asarray(solution.areas, dtype=float)
    exact = luminance(reference.irradiance)
    square = areas @ (luminance(solution.irradiance) - exact) ** 2 / areas.sum()
    own = areas @ np.nan_to_num(luminance(reference.std_error)) ** 2 / areas.sum()
    return float(np.sqrt(square - own) / (areas @ exact / areas.sum())) if square > own else math.nan


@dataclass(frozen=True)
class Convergence:
    """Errors of methods, for each number of rays and seed."""

    scene: str
    methods: list[str]
    rows: list[tuple[str, float, int, int, float]]
    """Method, rays that were asked for, rays that it took, seed, relative RMS error."""

    def to_dataframe(self) -> pd.DataFrame:
        """A row for each solve: scene, series (the method), rays that were asked for (`at`) and taken, seed, error.

        Raises:
            MissingPackage: pandas is not installed.
        """
        table = needed("pandas", "a table").DataFrame(self.rows, columns=["series", "at", "rays", "seed", "error"])
        table.insert(0, "scene", self.scene)
        return table  # type: ignore[no-any-return]

    def slope(self, method: str) -> tuple[float, float]:
        """The slope of the error against the rays in doubly logarithmic axes, and its 95 % margin over seeds; -0.5 with random numbers."""
        slopes = []
        for seed in sorted({row[3] for row in self.rows}):
            points = np.array([(row[2], row[4]) for row in self.rows if row[0] == method and row[3] == seed])
            known = np.isfinite(points[:, 1])
            slopes.append(np.polyfit(np.log(points[known, 0]), np.log(points[known, 1]), 1)[0])
        spread = np.std(slopes, ddof=1) / math.sqrt(len(slopes)) if len(slopes) > 1 else math.nan
        return float(np.mean(slopes)), float(spread * _native.student(0.95, len(slopes) - 1))

    def plot(self) -> Any:
        """The curves, means over seeds with their 95 % confidence intervals, as a `matplotlib.figure.Figure`.

        Raises:
            MissingPackage: Matplotlib or pandas is not installed.
        """
        return draw_curves(self.to_dataframe(), "rays", "error", "rays", "relative RMS error", "", [-0.5])


MARKERS = "osD^vPX*<>hp"
ABOVE = 1.6
"""So much higher than the highest curve straight lines begin."""


def draw_curves(table: Any, x: str, y: str, x_label: str, y_label: str, title: str, guides: Sequence[float]) -> Any:
    """A panel for each scene, a curve for each series: geometric means over seeds, with 95 % intervals by Student's t."""
    needed("matplotlib", "a plot")
    from matplotlib.figure import Figure

    scenes, series = list(dict.fromkeys(table["scene"])), list(dict.fromkeys(table["series"]))
    figure = Figure(figsize=(max(7.0, 4.6 * len(scenes)), 5.2), layout="constrained")
    panels = figure.subplots(1, len(scenes), squeeze=False, sharey=True)[0]
    for axes, scene in zip(panels, scenes, strict=True):
        for k, name in enumerate(series):
            rows = table[(table["scene"] == scene) & (table["series"] == name)]
            if len(rows):
                _draw_curve(axes, rows, x, y, name, k)
        _draw_guides(axes, guides)
        axes.set(xscale="log", yscale="log", xlabel=x_label)
        axes.set_title(scene, fontsize="medium", loc="left")
        axes.grid(which="major", alpha=0.35)
        axes.grid(which="minor", alpha=0.1)
        axes.spines[["top", "right"]].set_visible(False)
    panels[0].set_ylabel(y_label)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=min(len(labels), 3), frameon=False)
    if title:
        figure.suptitle(title, fontsize="large", x=0.01, ha="left")
    return figure


def _draw_curve(axes: Any, rows: Any, x: str, y: str, name: str, k: int) -> None:
    known = rows[(rows[x] > 0) & (rows[y] > 0)]
    points = []
    for _, group in known.groupby("at"):
        logs = np.log(group[y].to_numpy(dtype=float))
        margin = math.nan
        if len(logs) > 1:
            margin = float(logs.std(ddof=1) / math.sqrt(len(logs)) * _native.student(0.95, len(logs) - 1))
        points.append((float(np.exp(np.log(group[x]).mean())), float(np.exp(logs.mean())), margin))
    if not points:
        return
    at, mean, margins = (np.array(column) for column in zip(*points, strict=True))
    factor = np.exp(np.nan_to_num(margins))
    bars = [mean - mean / factor, mean * factor - mean]
    style = {"marker": MARKERS[k % len(MARKERS)], "markersize": 4.5, "linewidth": 1.4, "capsize": 2.5, "elinewidth": 0.9}
    axes.errorbar(at, mean, yerr=bars, color=f"C{k % 10}", linestyle="-" if k < 10 else "--", label=name, **style)


def _draw_guides(axes: Any, guides: Sequence[float]) -> None:
    """Straight lines of the given slopes, a little above the curves."""
    lines = [container.lines[0] for container in axes.containers]
    if not lines:
        return
    at = np.concatenate([line.get_xdata() for line in lines])
    first = max(line.get_ydata()[0] for line in lines)
    span = np.array([at.min(), at.max()])
    for k, slope in enumerate(guides):
        heights = ABOVE * first * (span / span[0]) ** slope
        axes.plot(span, heights, color="0.6", linewidth=0.9, linestyle=":", zorder=0)
        # The first at its start, above it; steeper ones at their ends, below: there is room.
        at, where = (0, {"ha": "left", "va": "bottom"}) if k == 0 else (1, {"ha": "right", "va": "top"})
        axes.annotate(f"slope {slope:g}", (span[at], heights[at]), color="0.45", fontsize="small", **where)
