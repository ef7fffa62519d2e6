"""Studies: the published experiments with Monte Carlo radiosity, each reproduced by one call."""

from __future__ import annotations

import io
import json
import os
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _native
from .errors import MissingFile, UnknownName
from .optional import needed
from .progress import bar

if TYPE_CHECKING:
    import pandas as pd


def study(
    name: str | os.PathLike[str],
    *,
    quick: bool = False,
    seeds: int | None = None,
    folder: str | os.PathLike[str] | None = None,
    scenes: str | os.PathLike[str] | None = None,
    threads: int | None = None,
    progress: bool = False,
) -> Study:
    """Runs a study, as `isolux study` does.

    Args:
        name: one of `isolux.names("studies")`, or the path of a `study.toml` of your own.
        quick: fewer scenes, samples and seeds: under two minutes.
        seeds: runs of each point; what the study says unless said otherwise.
        folder: keeps every measurement there as soon as it is known, so that the same call goes on after Ctrl-C; without it they are kept
            nowhere but in what is returned.
        scenes: folder of the scenes that are no part of isolux; without them a study does with the others.
        threads: how many; one for each core unless said otherwise.
        progress: whether to show a bar.

    Raises:
        UnknownName: there is no such study.
        InvalidStudy: its file says something wrong.
        OtherRun: the folder holds something else than the first part of this study.
        KeyboardInterrupt: Ctrl-C; what was measured is in the folder, if there is one.
    """
    text = None
    name = os.fspath(name)
    if name.lower().endswith(".toml"):
        if not Path(name).is_file():
            raise MissingFile(f"{name}: there is no such file", name, "read")
        text, name = Path(name).read_text(encoding="utf-8"), Path(name).parent.name or Path(name).stem
    with tempfile.TemporaryDirectory(prefix="isolux-study-") as temporary, bar(f"study {name}", progress) as shown:
        place = Path(os.fspath(folder) if folder is not None else temporary)

        def watch(what: str, done: int, points: int, share: float) -> None:
            shown.show(share, f"{done} of {points}, {what}")

        asked = {"name": name, "text": text, "quick": quick, "seeds": seeds, "folder": place, "scenes": scenes}
        found = _native.study(asked, threads, watch)
        if found is None:
            raise KeyboardInterrupt
        return Study._of(name, json.loads(found), (place / "result.csv").read_text(encoding="utf-8"))


@dataclass(frozen=True)
class Slope:
    """The slope of a curve in a doubly logarithmic plot, with its confidence interval of 95 % over seeds."""

    plot: str
    scene: str
    series: str
    slope: float
    low: float | None
    high: float | None


@dataclass(frozen=True)
class Verdict:
    """What was claimed, and whether it shows here."""

    claim: str
    scene: str
    holds: bool
    found: str
    """The numbers."""
    robust: bool
    """Whether it should hold on any machine, with any seed."""


@dataclass(frozen=True)
class Study:
    """The results of a study."""

    name: str
    title: str
    question: str
    slopes: list[Slope]
    verdicts: list[Verdict]
    plots: list[dict[str, Any]]
    csv: str
    """The table of all measurements, as text."""

    @classmethod
    def _of(cls, name: str, known: dict[str, Any], csv: str) -> Study:
        slopes = [Slope(**slope) for slope in known["fits"]]
        verdicts = [Verdict(**verdict) for verdict in known["verdicts"]]
        return cls(name, known["title"], known["question"], slopes, verdicts, known["plots"], csv)

    def to_dataframe(self) -> pd.DataFrame:
        """A row for each measurement: scene, series, place on the curve (`at`), seed, and what was measured.

        Raises:
            MissingPackage: pandas is not installed.
        """
        return needed("pandas", "a table").read_csv(io.StringIO(self.csv))  # type: ignore[no-any-return]

    def plot(self, plot: str | None = None, scene: str | None = None) -> Any:
        """Convergence curves in doubly logarithmic axes, means over seeds with their 95 % confidence intervals.

        Args:
            plot: the name of one of `plots`; the first if it is left out.
            scene: only this one; all of them side by side if it is left out.

        Returns:
            A `matplotlib.figure.Figure`.

        Raises:
            MissingPackage: Matplotlib or pandas is not installed.
            UnknownName: the study has no such plot.
        """
        from .convergence import draw_curves

        known = {one["file"]: one for one in self.plots}
        if plot is not None and plot not in known:
            raise UnknownName(f"there is no plot called '{plot}'; there are {', '.join(known)}", "plot", plot, next(iter(known), ""))
        spec = self.plots[0] if plot is None else known[plot]
        table = self.to_dataframe()
        if scene is not None:
            table = table[table["scene"] == scene]
        if spec["series"]:
            table = table[table["series"].isin(spec["series"])]
        return draw_curves(table, spec["x"], spec["y"], spec["x_label"], spec["y_label"], self.title, spec["guides"])

    def __iter__(self) -> Iterator[Verdict]:
        return iter(self.verdicts)

    def __str__(self) -> str:
        lines = [self.title]
        lines += [f"{'yes' if one.holds else 'no '}  {one.scene}: {one.claim} ({one.found})" for one in self.verdicts]
        return "\n".join(lines)
