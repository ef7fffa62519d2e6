"""The parts of a scene: handles through which it is edited."""

from __future__ import annotations

import json
import math
from typing import Any, Literal

import numpy as np

from . import _native
from .colors import Color, color, reflectivity
from .errors import ParameterError
from .named import NamedList

Vector = tuple[float, float, float]


def rgb(channels: Vector) -> dict[str, float]:
    """A colour as the core writes it."""
    return dict(zip("rgb", channels, strict=True))


def channels_of(known: dict[str, float]) -> Vector:
    """A colour that the core wrote."""
    return known["r"], known["g"], known["b"]


def vector(name: str, value: Any) -> Vector:
    """Three finite numbers."""
    numbers = np.asarray(value, dtype=float)
    if numbers.shape != (3,) or not np.isfinite(numbers).all():
        raise ParameterError.of(name, value, "three finite numbers x, y, z")
    return float(numbers[0]), float(numbers[1]), float(numbers[2])


def direction(name: str, value: Any) -> Vector:
    """A unit vector along three numbers."""
    numbers = np.asarray(vector(name, value))
    length = float(np.linalg.norm(numbers))
    if length == 0:
        raise ParameterError.of(name, value, "a direction has a length")
    return vector(name, numbers / length)


class Part:
    """A handle on one part of a scene."""

    _list: str

    def __init__(self, scene: _native.Scene, number: int) -> None:
        self._scene, self._number = scene, number

    def _read(self) -> dict[str, Any]:
        known: dict[str, Any] = json.loads(self._scene.get(self._list, self._number))
        return known

    def _write(self, **changes: Any) -> None:
        self._scene.set(self._list, self._number, json.dumps(self._read() | changes))

    @property
    def number(self) -> int:
        """Its number in the scene, from 0."""
        return self._number

    @property
    def name(self) -> str:
        """Its name."""
        return str(self._read()["name"])

    @name.setter
    def name(self, name: str) -> None:
        self._write(name=str(name))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Part) and (self._list, self._scene, self._number) == (other._list, other._scene, other._number)

    def __hash__(self) -> int:
        return hash((self._list, id(self._scene), self._number))


class Material(Part):
    """A diffuse (Lambertian) material. Objects that share it all change with it."""

    _list = "materials"

    @property
    def reflectivity(self) -> Vector:
        """Share of the light that is reflected, red, green and blue, in [0, 1). A texture multiplies it, if there is one."""
        return channels_of(self._read()["reflectivity"])

    @reflectivity.setter
    def reflectivity(self, value: Color) -> None:
        self._write(reflectivity=rgb(reflectivity("reflectivity", value)))

    @property
    def emission(self) -> Vector:
        """Exitance [lm/m²]: the light that each square metre sends out by itself, in each channel. A texture multiplies it."""
        return channels_of(self._read()["emission"])

    @emission.setter
    def emission(self, value: Color) -> None:
        self._write(emission=rgb(color("emission", value)))

    @property
    def luminance(self) -> Vector:
        """Luminance [cd/m²] of the light that it sends out by itself: the emission over pi."""
        red, green, blue = self.emission
        return red / math.pi, green / math.pi, blue / math.pi

    @luminance.setter
    def luminance(self, value: Color) -> None:
        red, green, blue = color("luminance", value)
        self.emission = (red * math.pi, green * math.pi, blue * math.pi)

    @property
    def two_sided(self) -> bool:
        """Whether the back reflects and emits like the front. The back of a one-sided surface is black."""
        return bool(self._read()["two_sided"])

    @two_sided.setter
    def two_sided(self, value: bool) -> None:
        self._write(two_sided=bool(value))

    @property
    def has_texture(self) -> bool:
        """Whether an image multiplies reflectivity or emission."""
        known = self._read()
        return known["reflectivity_texture"] is not None or known["emission_texture"] is not None

    def remove_textures(self) -> None:
        """Lets reflectivity and emission be the same everywhere on it."""
        self._write(reflectivity_texture=None, emission_texture=None)

    def __repr__(self) -> str:
        emits = f", emission={_short(self.emission)} lm/m²" if any(self.emission) else ""
        textured = ", textured" if self.has_texture else ""
        return f"Material({self.name!r}, reflectivity={_short(self.reflectivity)}{emits}{textured})"


class Object(Part):
    """A named surface with one material."""

    _list = "objects"

    @property
    def material(self) -> Material:
        """Its material. Assign another one, or its name, to change it."""
        return Material(self._scene, int(self._read()["material"]))

    @material.setter
    def material(self, material: Material | str) -> None:
        if isinstance(material, str):
            material = materials(self._scene)[material]
        if material._scene is not self._scene:
            raise ParameterError.of("material", material.name, "a material of the same scene")
        self._write(material=material.number)

    def __repr__(self) -> str:
        return f"Object({self.name!r}, material={self.material.name!r})"


class Light(Part):
    """A light without extent: a point, a spot, or parallel light."""

    _list = "lights"

    def _kind(self) -> tuple[str, dict[str, Any]]:
        ((kind, known),) = self._read()["kind"].items()
        return kind, known

    def _write_kind(self, **changes: Any) -> None:
        kind, known = self._kind()
        missing = next((name for name in changes if name not in known), None)
        if missing is not None:
            raise ParameterError.of(missing, changes[missing], f"a {self.kind} light has none")
        self._write(kind={kind: known | changes})

    @property
    def kind(self) -> Literal["point", "spot", "directional"]:
        """Which of the three it is."""
        kinds: dict[str, Literal["point", "spot", "directional"]] = {"Point": "point", "Spot": "spot"}
        return kinds.get(self._kind()[0], "directional")

    @property
    def intensity(self) -> Vector:
        """Luminous intensity [cd] in each channel; of a directional light the illuminance [lux] across its beam."""
        return channels_of(self._read()["intensity"])

    @intensity.setter
    def intensity(self, value: Color) -> None:
        self._write(intensity=rgb(color("intensity", value)))

    @property
    def position(self) -> Vector | None:
        """Where it is [m]; `None` for a directional light."""
        position = self._kind()[1].get("position")
        return None if position is None else vector("position", position)

    @position.setter
    def position(self, value: Any) -> None:
        self._write_kind(position=vector("position", value))

    @property
    def direction(self) -> Vector | None:
        """The unit vector along which its light travels; `None` for a point light."""
        found = self._kind()[1].get("direction")
        return None if found is None else vector("direction", found)

    @direction.setter
    def direction(self, value: Any) -> None:
        self._write_kind(direction=direction("direction", value))

    def __repr__(self) -> str:
        unit = "lux" if self.kind == "directional" else "cd"
        return f"Light({self.name!r}, {self.kind}, intensity={_short(self.intensity)} {unit})"


class Camera(Part):
    """Where a picture is taken from."""

    _list = "cameras"

    @property
    def position(self) -> Vector:
        """Where it stands [m]."""
        return vector("position", self._read()["position"])

    @property
    def forward(self) -> Vector:
        """The unit vector along which it looks."""
        return vector("forward", self._read()["forward"])

    def __repr__(self) -> str:
        return f"Camera({self.name!r}, position={_short(self.position)})"


def materials(scene: _native.Scene) -> NamedList[Material]:
    """All materials of a scene."""
    return _list("material", Material, scene)


def _list(kind: str, part: type[Any], scene: _native.Scene) -> NamedList[Any]:
    def names() -> list[str]:
        return [part(scene, k).name for k in range(scene.count(part._list))]

    return NamedList(kind, names, lambda k: part(scene, k))


def objects(scene: _native.Scene) -> NamedList[Object]:
    """All objects of a scene."""
    return _list("object", Object, scene)


def lights(scene: _native.Scene) -> NamedList[Light]:
    """All lights without extent of a scene."""
    return _list("light", Light, scene)


def cameras(scene: _native.Scene) -> NamedList[Camera]:
    """All cameras of a scene."""
    return _list("camera", Camera, scene)


def _short(numbers: Vector) -> str:
    return "(" + ", ".join(f"{number:.4g}" for number in numbers) + ")"
