"""An estimate with its error bar."""

from __future__ import annotations

import math
from dataclasses import dataclass

from . import _native


@dataclass(frozen=True)
class Estimate:
    """A mean that independent solutions have told. `float(estimate)` is the mean; `print` shows it with its error bar."""

    mean: float
    std_error: float
    """Standard error; `nan` if it is not known."""
    freedom: float
    """How many degrees of freedom the standard error has."""

    def margin(self, confidence: float = 0.95) -> float:
        """The true value is within so much of the mean with this confidence, by Student's t; `nan` if it is not known."""
        return self.std_error * _native.student(confidence, self.freedom)

    def __float__(self) -> float:
        return self.mean

    def __str__(self) -> str:
        margin = self.margin()
        if not math.isfinite(margin):
            return f"{self.mean:.6g}"
        decimals = max(0, 1 - math.floor(math.log10(margin))) if margin > 0 else 6
        return f"{self.mean:.{decimals}f} ± {margin:.{decimals}f} (95 %)"
