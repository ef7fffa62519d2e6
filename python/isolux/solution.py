"""Solutions: numbers with error bars, tables, files and pictures."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy.typing as npt

from . import _native, plot, tables
from .colors import Color, Floats, color, luminance
from .errors import ParameterError, UnknownName
from .estimate import Estimate
from .light import Balance, ObjectLight, Provenance, by_name
from .problem import Problem

if TYPE_CHECKING:
    import pandas as pd

Smooth = Literal["pictures", "all", "none"]


class Solution:
    """How much light falls on every element of a scene, how sure that is, and where all the light went.

    Arrays have a row for each of the n elements and a column for each channel (red, green, blue; `isolux.luminance` makes one of
    three), and are read-only views on memory of the engine: nothing is copied.

    Irradiance `E` [lux = lm/m²] is the light that falls on a surface. It does not contain its colour; what leaves is the radiosity
    `B = Be + rho E`, and what is seen the luminance `B / pi` [cd/m²].
    """

    def __init__(
        self, native: _native.Solution, *, problem: Problem | None = None, ended: str = "complete", bias: str | None = None
    ) -> None:
        self._native, self._ended, self._bias = native, ended, bias
        self._problem = problem or Problem._of(native.problem)

    @property
    def problem(self) -> Problem:
        """The scene as it was cut: areas, centres, normals, reflectivities and objects of the elements."""
        return self._problem

    @property
    def irradiance(self) -> Floats:
        """Light that falls on each element [lux], shape (n, 3)."""
        return self._native.irradiance

    @property
    def std_error(self) -> Floats:
        """Standard error of the irradiance [lux], shape (n, 3); `nan` with fewer than two independent solutions.

        It does not contain what elements of finite size cost. Errors of neighbours are correlated: `objects` has the error bars of means.
        """
        return self._native.std_error

    @property
    def radiosity(self) -> Floats:
        """Light that leaves each element, `B = Be + rho E` [lm/m²], shape (n, 3)."""
        return self._native.radiosity

    @property
    def areas(self) -> Floats:
        """Area of each element [m²], shape (n,)."""
        return self._problem.areas

    def __len__(self) -> int:
        return len(self._problem)

    @cached_property
    def _summary(self) -> dict[str, Any]:
        known: dict[str, Any] = json.loads(self._native.summary())
        return known

    @cached_property
    def objects(self) -> dict[str, ObjectLight]:
        """The light on each object with elements, by its name, in the order of the scene; of equal names the later ones get a number.

        An object with elements on both sides is there twice, as "Wall, front" and "Wall, back".
        """
        found: dict[str, ObjectLight] = {}
        for name, known in by_name(self._summary["objects"]).items():
            mean = _estimate(known["mean"], known["mean_error"])
            numbers = {key: known[key] for key in ("side", "elements", "area", "min", "max", "emitted", "incident", "reflected")}
            found[name] = ObjectLight(name=name, mean=mean, **numbers)
        return found

    @property
    def mean(self) -> Estimate:
        """Mean irradiance of the scene by area [lux, luminance], with its error bar."""
        if self._summary["mean"] is not None:
            return _estimate(self._summary["mean"], self._summary["mean_error"])
        return Estimate(float(luminance(self.irradiance) @ self.areas / self.areas.sum()), math.nan, 0.0)

    @property
    def error(self) -> float:
        """The expected RMS error of the irradiance over all elements by area, relative to its mean; `nan` if it is not known."""
        return self._native.rms_error

    def error_bound(self, confidence: float = 0.95, of: str = "rms") -> float:
        """What the irradiance is off by at most with this confidence, relative to its mean; `nan` if it is not known.

        Args:
            confidence: the share of all solves that keep it.
            of: "rms" over all elements (Fisher's F), "max" of the worst element (Student's t with Bonferroni's correction), "mean" of
                the scene, or "object:NAME" of the mean on that object (Student's t).

        Raises:
            UnknownName: there is no such error, or no such object.
        """
        return self._native.error_bound(confidence, of)

    @property
    def balance(self) -> Balance:
        """Where the emitted light went [lm]."""
        return Balance(**self._summary["balance"])

    @property
    def provenance(self) -> Provenance:
        """Scene, method, parameters and seed."""
        known = self._summary
        scene = known["scene"]
        return Provenance(scene["name"], scene["hash"], known["method"], known["parameters"], known["seed"], known["version"])

    @property
    def rays(self) -> int:
        """Rays that it took."""
        return int(self._summary["rays"])

    @property
    def replicates(self) -> int:
        """Independent solutions from which the standard errors come."""
        return int(self._summary["replicates"])

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C ended the solve: then it is the best result until then."""
        return self._ended == "interrupted"

    @property
    def ended(self) -> str:
        """Why the solve came to its end: "complete", "time", "interrupted", or "stopped" by the callback."""
        return self._ended

    @property
    def bias(self) -> str | None:
        """Why the method is biased, if it is: no error bar tells of that. Not known of solutions that were read from files."""
        return self._bias

    def to_dataframe(self, by: Literal["element", "object"] = "element") -> pd.DataFrame:
        """A table (pandas).

        Args:
            by: "element" has a row for each element, with the columns of the `.csv` file; "object" one for each object:
                area [m²], mean irradiance with standard error and 95 % margin, min, max [lux], and flux [lm].

        Raises:
            MissingPackage: pandas is not installed.
        """
        if by not in ("element", "object"):
            raise ParameterError.of("by", by, "element or object")
        return tables.of_elements(self) if by == "element" else tables.of_objects(self)

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        camera: str | int | None = None,
        width: int = 1280,
        height: int | None = None,
        samples: int = 16,
        exposure: float | None = None,
        smooth: Smooth = "pictures",
    ) -> None:
        """Writes a file, in one step, in the format of its extension.

        `.isolux` is the whole solution, for `isolux.open`; `.glb` the lit scene; `.png` and `.exr` are pictures; `.csv`, `.npz`, `.vtu` and
        `.ply` tables of all elements; `.json` a summary. docs/file-formats.md says what each holds.

        Args:
            path: the file.
            camera, width, height, samples, exposure: of pictures, see `render`.
            smooth: where noise is taken out, as far as the error bars allow: in "pictures", in "all" files but .isolux, or in "none".

        Raises:
            UnknownFormat: nothing writes such a file.
            FileError, MissingFile: it cannot be written, or its folder is not there; an older file stays as it was.
        """
        self._native.save(os.fspath(path), _picture(camera, width, height, samples, exposure, smooth))

    def render(
        self,
        *,
        camera: str | int | None = None,
        width: int = 1280,
        height: int | None = None,
        samples: int = 16,
        exposure: float | None = None,
        smooth: Smooth = "pictures",
        linear: bool = False,
    ) -> npt.NDArray[Any]:
        """A picture.

        Args:
            camera: its name or number; the scene's first, or a view of the whole scene, if it is left out.
            width, height: in pixels; without a height as the camera's shape has it.
            samples: rays a pixel, against jagged edges.
            exposure: in stops: luminances are multiplied by 2^exposure; metered if it is left out.
            smooth: "none" leaves the noise in.
            linear: whether to give luminance [cd/m²] instead of what a screen shows.

        Returns:
            uint8 sRGB of shape (h, w, 3), rows from the top; or float32 [cd/m²] if `linear`.

        Raises:
            UnknownName, ParameterError: there is no such camera, or no such picture.
        """
        display, linear_light, _ = self._native.render(_picture(camera, width, height, samples, exposure, smooth))
        return linear_light if linear else display

    def plot(self, quantity: plot.Quantity = "irradiance", **options: Any) -> Any:
        """False colours with a legend: see `isolux.plot_solution`, which has the options."""
        return plot.plot_solution(self, quantity, **options)

    @property
    def light_groups(self) -> dict[str, tuple[float, float, float]]:
        """The factor of each light group, red, green and blue, by its name; empty if all light was solved together."""
        return dict(zip(self._native.groups, ((r, g, b) for r, g, b in self._native.factors), strict=True))

    def mix(self, factors: Mapping[str, Color]) -> Solution:
        """The same with lamps dimmed and coloured, without solving again; error bars are right for any factors.

        Args:
            factors: how many times as much as when it was solved a light group emits: a number, or three. Groups that are not named
                stay as they are.

        Raises:
            UnknownName: there is no such group: solve with `light_groups`.
        """
        known = self.light_groups
        for name in factors:
            if name not in known:
                there = f"there are {', '.join(known)}" if known else "solve with light_groups='objects' to have some"
                raise UnknownName(f"there is no light group called '{name}'; {there}", "light group", name, next(iter(known), ""))
        mixed = known | {name: color(f"factor of {name}", factor) for name, factor in factors.items()}
        return Solution(self._native.mix(list(mixed.values())), ended=self._ended, bias=self._bias)

    def alone(self, group: str) -> Solution:
        """The light of one light group, at its factor.

        Raises:
            UnknownName: there is no such group.
        """
        names = list(self.light_groups)
        if group not in names:
            raise UnknownName(f"there is no light group called '{group}'; there are {', '.join(names)}", "light group", group, "")
        return Solution(self._native.alone(names.index(group)), problem=self._problem, ended=self._ended, bias=self._bias)

    def __repr__(self) -> str:
        error = f", error at most {100 * self.error_bound():.3g} % (RMS, 95 %)" if not math.isnan(self.error) else ""
        how = f"{self.provenance.method}, {self.rays / 1e6:.3g}M rays"
        return f"<Solution of {self.provenance.scene!r}: {len(self):,} elements, {how}, mean {self.mean} lx{error}>"


def _estimate(mean: float, error: dict[str, float] | None) -> Estimate:
    known = error or {}
    std_error = known.get("std_error")
    return Estimate(mean, math.nan if std_error is None else std_error, known.get("freedom") or 0.0)


def _picture(
    camera: str | int | None, width: int, height: int | None, samples: int, exposure: float | None, smooth: Smooth
) -> dict[str, Any]:
    for what, number in {"width": width, "height": height, "samples": samples}.items():
        if number is not None and not 0 < number < 2**31:
            raise ParameterError.of(what, number, "a number above 0")
    if exposure is not None and not abs(exposure) <= 100:
        raise ParameterError.of("exposure", exposure, "stops between -100 and 100")
    name = None if camera is None else str(camera)
    return {"camera": name, "width": width, "height": height, "samples": samples, "exposure": exposure, "smooth": smooth}


def open(path: str | os.PathLike[str]) -> Solution:
    """Reads a solution that `Solution.save` or `isolux solve` has written (`.isolux`).

    Raises:
        MissingFile, FileError: it is not there, or cannot be read.
        InvalidFile: it is no such file, or damaged.
    """
    return Solution(_native.Solution.open(os.fspath(path)))
