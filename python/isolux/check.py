"""What is in a scene, and what is wrong with it: everything that can be said before light is computed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal


@dataclass(frozen=True)
class Finding:
    """Something to know of a scene, or to mend."""

    severity: Literal["error", "warning", "note"]
    """Whether the result would be meaningless, may not be what is meant, or is only good to know."""
    what: str
    """What it is, and what to do about it."""
    place: str
    """Where: objects, materials, positions."""


@dataclass(frozen=True)
class Report:
    """What is in a scene, and what is wrong with it. `print` it to read it."""

    triangles: int
    area: float
    """Area of all surfaces [m²]; a two-sided surface counts twice."""
    size: tuple[float, float, float]
    """Edges of the box around it [m]."""
    flux: dict[str, float]
    """What each emitting object and light sends out [lm]."""
    findings: list[Finding]
    """What is noteworthy, gravest first."""

    @property
    def is_fine(self) -> bool:
        """Whether there is neither an error nor a warning."""
        return all(finding.severity == "note" for finding in self.findings)

    @classmethod
    def _of(cls, known: dict[str, Any]) -> Report:
        weights = {"r": 0.2126, "g": 0.7152, "b": 0.0722}
        flux: dict[str, float] = {}
        for emitter in known["emitters"]:
            lumens = sum(weights[channel] * value for channel, value in emitter["flux"].items())
            flux[emitter["name"]] = flux.get(emitter["name"], 0.0) + lumens
        findings = [Finding(f["severity"].lower(), f["what"], f["place"]) for f in known["findings"]]
        width, height, depth = known["size"]
        return cls(known["triangles"], known["area"], (width, height, depth), flux, findings)

    def __str__(self) -> str:
        lines = [f"{self.triangles:,} triangles, {self.area:.4g} m²"]
        lines += [f"{name} emits {lumens:.4g} lm" for name, lumens in self.flux.items()]
        lines += [f"{finding.severity}: {finding.what} ({finding.place})" for finding in self.findings]
        return "\n".join(lines)
