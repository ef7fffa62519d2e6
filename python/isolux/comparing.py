"""Several solutions of one problem: merged into a better one, or compared."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass

from . import _native
from .light import by_name
from .solution import Solution


def merge(solutions: Sequence[Solution]) -> Solution:
    """One better solution of several of the same problem and method with different seeds, weighted by what they are worth.

    Raises:
        NotMergeable: they are of different problems or methods, of equal seeds, or have no error bars.
    """
    problem = solutions[0].problem if solutions else None
    return Solution(_native.Solution.merge([solution._native for solution in solutions]), problem=problem)


@dataclass(frozen=True)
class Comparison:
    """How two solutions of the same scene differ, and whether their error bars explain it."""

    rms: float
    """RMS difference of the irradiance by area, relative to the mean of both."""
    expected_rms: float
    """What the standard errors of independent solutions let expect of it; `nan` if they are not known, or the elements are others."""
    power: tuple[float, float]
    """Flux that leaves all surfaces [lm], in each of them."""
    z: dict[str, float]
    """Difference of the mean irradiances over its standard deviation, of each of `Solution.objects`; "scene" is the whole."""
    beyond_3: float
    """Share of the elements that differ by more than three standard deviations; 0.0027 if the differences are normal."""

    def __str__(self) -> str:
        worst = max(self.z, key=lambda name: abs(self.z[name]), default=None)
        means = "" if worst is None else f"; of all means that on '{worst}' differs most, by {self.z[worst]:.2f} standard deviations"
        expected = "" if math.isnan(self.expected_rms) else f", {100 * self.expected_rms:.3g} % is to be expected"
        return f"RMS difference {100 * self.rms:.3g} %{expected}{means}"


def compare(a: Solution, b: Solution) -> Comparison:
    """How two solutions of the same scene differ.

    If it is cut into other elements, `b` is averaged on those of `a`, and only means have scores.

    Raises:
        NotComparable: they are of different scenes.
    """
    known = json.loads(a._native.compare(b._native))
    means = {name: one["z"] for name, one in by_name(known["objects"]).items()}
    if known["mean"] is not None:
        means = {"scene": known["mean"]["z"]} | means
    scores = known["z"] or {}
    number = {key: math.nan if known[key] is None else float(known[key]) for key in ("rms", "expected_rms")}
    power = (float(known["power"][0]), float(known["power"][1]))
    return Comparison(**number, power=power, z=means, beyond_3=float(scores.get("beyond_3", math.nan)))
