"""Progress bars: tqdm's if it is installed, in terminals and notebooks; otherwise a line on stderr."""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Protocol

from .optional import is_there

EVERY = 0.2
"""Seconds between two lines on stderr."""


@dataclass(frozen=True)
class SolveProgress:
    """How far a solve is."""

    stage: str
    """What the solver is doing, in a few words."""
    rays: int
    """Rays so far."""
    rays_in_all: int | None
    """Rays that the whole solve will take, if it is known."""
    error: float | None
    """The expected RMS error over the mean irradiance, if it is known yet."""
    excess: float | None
    """How many times as large the error is as the one that is asked for, if one is."""
    seconds: float
    """Time since the solve began [s]."""

    def share(self, error: float | None = None, time: float | None = None) -> float:
        """About how much of the work is done, between 0 and 1, if this error and this time [s] were asked for."""
        shares = [0.0]
        if error is None and self.rays_in_all:
            shares.append(self.rays / self.rays_in_all)
        if self.excess:
            # Half the error takes four times the rays.
            shares.append(self.excess**-2)
        if time is not None:
            shares.append(self.seconds / time)
        return min(max(shares), 1.0)

    def __str__(self) -> str:
        rays = f"{self.rays / 1e6:.3g}M rays" if self.rays >= 1e6 else f"{self.rays / 1e3:.0f}k rays"
        return rays if self.error is None else f"{rays}, error {100 * self.error:.2g} %"


class Bar(Protocol):
    """Somebody who shows how far something is."""

    def show(self, share: float, text: str) -> None:
        """So much of it is done, between 0 and 1."""

    def __enter__(self) -> Bar: ...

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None: ...


class NoBar:
    """Shows nothing."""

    def show(self, share: float, text: str) -> None:
        """Nothing."""

    def __enter__(self) -> NoBar:
        return self

    def __exit__(self, *_: object) -> None:
        pass


class Line(NoBar):
    """A line on stderr that is written again and again."""

    def __init__(self, title: str) -> None:
        self._title, self._next, self._width = title, 0.0, 0

    def show(self, share: float, text: str) -> None:
        """Writes the line, unless it was written just now."""
        if time.monotonic() >= self._next:
            self._next = time.monotonic() + EVERY
            self._write(f"{self._title}: {100 * share:3.0f} % {text}")

    def _write(self, line: str) -> None:
        sys.stderr.write("\r" + line.ljust(self._width))
        sys.stderr.flush()
        self._width = len(line)

    def __exit__(self, *_: object) -> None:
        self._write("")
        sys.stderr.write("\r")


class Tqdm(NoBar):
    """A bar of tqdm."""

    def __init__(self, title: str) -> None:
        from tqdm.auto import tqdm

        self._bar: Any = tqdm(total=100, desc=title, leave=False, bar_format="{l_bar}{bar}| {elapsed}<{remaining}{postfix}")

    def show(self, share: float, text: str) -> None:
        """Moves the bar; it never goes back."""
        self._bar.set_postfix_str(text, refresh=False)
        self._bar.update(max(100 * share - self._bar.n, 0))

    def __exit__(self, *_: object) -> None:
        self._bar.close()


def bar(title: str, is_wanted: bool) -> Bar:
    """A progress bar, if one is wanted."""
    if not is_wanted:
        return NoBar()
    return Tqdm(title) if is_there("tqdm") else Line(title)
