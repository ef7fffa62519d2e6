"""What a solution says in a few numbers: where the light went, how much of it falls on each object, and where all that comes from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .estimate import Estimate


@dataclass(frozen=True)
class Balance:
    """Where the emitted light went [lm, luminance]: `emitted = absorbed + escaped + back_face + unshot`."""

    emitted: float
    """Sent out by all sources."""
    absorbed: float
    """Absorbed by surfaces."""
    escaped: float
    """Left the scene without meeting anything."""
    back_face: float
    """Lost on the backs of one-sided surfaces: gaps in the model, or flipped normals."""
    unshot: float
    """Not yet followed to its end."""
    residual: float
    """What is missing from the balance, relative to the emitted: rounding."""


@dataclass(frozen=True)
class Provenance:
    """Where a solution comes from: enough to compute it again, bit for bit."""

    scene: str
    scene_hash: str
    method: str
    parameters: dict[str, str]
    seed: int
    version: str


@dataclass(frozen=True)
class ObjectLight:
    """The light on one object; everything is luminance."""

    name: str
    side: str | None
    """"front" or "back", if the object has elements on both sides: they are two in `Solution.objects`."""
    elements: int
    area: float
    """[m²]"""
    mean: Estimate
    """Mean irradiance by area [lux], with its error bar."""
    min: float
    """The least irradiance of an element [lux]."""
    max: float
    """The greatest irradiance of an element [lux]."""
    emitted: float
    """Flux that it sends out by itself [lm]."""
    incident: float
    """Flux that falls on it [lm]."""
    reflected: float
    """Flux that it reflects [lm]."""

    def __str__(self) -> str:
        return f"{self.name}: {self.mean} lx on {self.area:.4g} m²"


def by_name(objects: list[dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """The objects of a summary by their names, with their sides if they have two; of equal names the later ones get a number."""
    found: dict[str, dict[str, Any]] = {}
    for known in objects:
        own = f"{known['name']}, {known['side']}" if known["side"] else str(known["name"])
        name, k = own, 2
        while name in found:
            name, k = f"{own} ({k})", k + 1
        found[name] = known
    return found
