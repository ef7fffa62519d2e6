"""Scenes: surfaces with materials, lights and cameras. Lengths are in metres, y is upwards, colours are linear Rec. 709."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from . import _native, meshes
from .check import Report
from .colors import Color, Floats, Integers, color
from .errors import ParameterError, UnknownFormat
from .named import NamedList
from .parts import Camera, Light, Material, Object, cameras, direction, lights, materials, objects, rgb, vector


def load(
    name: str | os.PathLike[str],
    *,
    light_units: Literal["spec", "compat", "raw"] = "spec",
    insides: Literal["hide", "keep"] = "hide",
) -> Scene:
    """Reads a scene file, or makes a built-in scene.

    Args:
        name: a file (.glb .gltf .obj .ply .stl), or a built-in scene with its parameters, such as "cornell-box" or
            "labyrinth:rho=0.9"; `isolux.names("scenes")` has all of them. A file of that name wins.
        light_units: what the intensities of a glTF file's lamps mean: "spec" is candela and lux, as glTF says; "compat" and "raw" are
            W/sr and W, as Blender's exporter may write them.
        insides: what becomes of the sides of closed two-sided surfaces that nobody can see: "hide" is that they are no surfaces,
            "keep" that both sides count, as the file says.

    Raises:
        MissingFile, FileError: the file is not there, or cannot be read.
        InvalidFile: it says something wrong; the error names the place.
        UnknownFormat, UnknownName, ParameterError: nothing reads such a file, or there is no such built-in scene or parameter.
    """
    path = os.fspath(name)
    if path.lower().endswith((".isolux", ".checkpoint")):
        raise UnknownFormat(f"{path}: this is no scene; isolux.open reads solutions (.isolux)", path)
    return Scene(_native.Scene.load(path, light_units, insides))


class Scene:
    """A scene, to be edited and solved. Solutions keep a copy of it: what is changed later does not change them.

    Make one with `isolux.load`, `Scene.from_arrays`, `Scene.from_trimesh` or `Scene.from_pyvista`.
    """

    def __init__(self, native: _native.Scene) -> None:
        self._native = native

    @classmethod
    def from_arrays(
        cls,
        vertices: npt.ArrayLike,
        triangles: npt.ArrayLike,
        *,
        objects: npt.ArrayLike | None = None,
        reflectivity: meshes.PerSurface = 0.5,
        emission: meshes.PerSurface = 0.0,
        two_sided: bool | Mapping[str, bool] = False,
        name: str = "arrays",
    ) -> Scene:
        """A scene of triangles.

        Args:
            vertices: positions [m], shape (n, 3).
            triangles: three numbers of vertices each, counter-clockwise seen from the front, shape (m, 3).
            objects: the name of the object of each triangle, shape (m,); one object called "object" if it is left out.
            reflectivity: share of the light that is reflected, below 1: a number or three for all, an array of shape (m,) or (m, 3) with
                that of each triangle, or a dict with that of each object (0.5 for those that are not in it).
            emission: exitance [lm/m²], likewise (0 for those that are not in the dict).
            two_sided: whether backs reflect and emit like fronts: for all, or a dict.
            name: what it is called.

        Raises:
            ParameterError: shapes do not fit, or a number has no meaning.
            UnknownName: a dict names an object that is not there.
            InvalidScene: a vertex is not finite, or not there.
        """
        surfaces: dict[str, Any] = {"objects": objects, "reflectivity": reflectivity, "emission": emission, "two_sided": two_sided}
        return cls(meshes.from_arrays(vertices, triangles, name=name, **surfaces))

    @classmethod
    def from_trimesh(
        cls,
        mesh: Any,
        *,
        reflectivity: meshes.PerSurface | None = None,
        emission: meshes.PerSurface = 0.0,
        two_sided: bool | Mapping[str, bool] = False,
        name: str = "trimesh",
    ) -> Scene:
        """A scene from a `trimesh.Trimesh`, or from all meshes of a `trimesh.Scene`, each an object of its own name.

        Args:
            mesh: what trimesh made; lengths are taken for metres.
            reflectivity: as in `from_arrays`; if it is left out, the colours of the faces, from sRGB, at most 0.95.
            emission, two_sided, name: as in `from_arrays`.

        Raises:
            UnreadableObject: it is nothing of the kind.
            ParameterError, UnknownName, InvalidScene: as `from_arrays`.
        """
        surfaces = {"reflectivity": reflectivity, "emission": emission, "two_sided": two_sided}
        return cls(meshes.from_trimesh(mesh, name=name, **surfaces))

    @classmethod
    def from_pyvista(
        cls,
        mesh: Any,
        *,
        reflectivity: meshes.PerSurface = 0.5,
        emission: meshes.PerSurface = 0.0,
        two_sided: bool | Mapping[str, bool] = False,
        name: str = "pyvista",
    ) -> Scene:
        """A scene from a PyVista data set (its surface), or from all blocks of a `MultiBlock`, each an object of its own name.

        Args:
            mesh: what PyVista made; lengths are taken for metres.
            reflectivity, emission, two_sided, name: as in `from_arrays`; arrays are of its triangles.

        Raises:
            UnreadableObject: it is nothing of the kind.
            ParameterError, UnknownName, InvalidScene: as `from_arrays`.
        """
        surfaces = {"reflectivity": reflectivity, "emission": emission, "two_sided": two_sided}
        return cls(meshes.from_pyvista(mesh, name=name, **surfaces))

    @property
    def name(self) -> str:
        """What it is called: the name of the file, or of the built-in scene."""
        return self._native.name

    @name.setter
    def name(self, name: str) -> None:
        self._native.name = name

    @property
    def materials(self) -> NamedList[Material]:
        """The materials, by name or number: `scene.materials["Floor"].reflectivity = 0.3`."""
        return materials(self._native)

    @property
    def objects(self) -> NamedList[Object]:
        """The objects, by name or number: `scene.objects["Desk"].material = "Oak"`."""
        return objects(self._native)

    @property
    def lights(self) -> NamedList[Light]:
        """The lights without extent, by name or number: `scene.lights["Spot"].intensity = 800`."""
        return lights(self._native)

    @property
    def cameras(self) -> NamedList[Camera]:
        """The cameras, by name or number."""
        return cameras(self._native)

    def add_material(self, name: str, reflectivity: Color = 0.5, emission: Color = 0.0, two_sided: bool = False) -> Material:
        """A new material (see `Material`), to be given to objects."""
        known = {"name": name, "reflectivity": rgb((0, 0, 0)), "emission": rgb((0, 0, 0)), "two_sided": two_sided}
        part = self._add("materials", known | {"reflectivity_texture": None, "emission_texture": None})
        material = Material(self._native, part)
        material.reflectivity, material.emission = reflectivity, emission
        return material

    def add_point_light(self, name: str, position: npt.ArrayLike, intensity: Color) -> Light:
        """A light at `position` [m] that sends `intensity` [cd] in every direction."""
        return self._add_light(name, intensity, {"Point": {"position": vector("position", position)}})

    def add_spot_light(
        self,
        name: str,
        position: npt.ArrayLike,
        target: npt.ArrayLike,
        intensity: Color,
        *,
        inner_angle: float = 0.0,
        outer_angle: float = 45.0,
    ) -> Light:
        """A light at `position` [m] that shines towards `target` [m], as glTF has it (KHR_lights_punctual).

        Args:
            name, position, target: as above.
            intensity: on its axis, and within `inner_angle` of it [cd].
            inner_angle, outer_angle: from the axis [degrees]: full intensity within the inner, none outside of the outer one.
        """
        if not 0 <= inner_angle < outer_angle <= 90:
            raise ParameterError.of("inner_angle, outer_angle", (inner_angle, outer_angle), "0 <= inner < outer <= 90 degrees")
        place = np.asarray(vector("position", position))
        axis = direction("target", np.asarray(vector("target", target)) - place)
        angles = {"inner_angle": math.radians(inner_angle), "outer_angle": math.radians(outer_angle)}
        return self._add_light(name, intensity, {"Spot": {"position": place.tolist(), "direction": axis, **angles}})

    def add_directional_light(self, name: str, towards: npt.ArrayLike, illuminance: Color) -> Light:
        """Parallel light that travels along the vector `towards`, with `illuminance` [lux] across its beam: the sun."""
        return self._add_light(name, illuminance, {"Directional": {"direction": direction("towards", towards)}})

    def _add_light(self, name: str, intensity: Color, kind: dict[str, Any]) -> Light:
        known = {"name": name, "intensity": rgb(color("intensity", intensity)), "kind": kind}
        return Light(self._native, self._add("lights", known))

    def add_camera(self, name: str, position: npt.ArrayLike, target: npt.ArrayLike, *, angle: float = 50.0) -> Camera:
        """A camera at `position` [m] that looks at `target` [m], with this vertical opening `angle` [degrees]; y is upwards."""
        if not 0 < angle < 180:
            raise ParameterError.of("angle", angle, "an opening angle above 0 and below 180 degrees")
        place = np.asarray(vector("position", position))
        forward = np.asarray(direction("target", np.asarray(vector("target", target)) - place))
        reference = (0.0, 0.0, 1.0) if abs(forward[1]) > 0.999 else (0.0, 1.0, 0.0)
        right = np.asarray(direction("target", np.cross(forward, reference)))
        known = {
            "name": name,
            "position": place.tolist(),
            "forward": forward.tolist(),
            "up": np.cross(right, forward).tolist(),
            "projection": {"Perspective": {"vertical_angle": math.radians(angle)}},
            "aspect": None,
        }
        return Camera(self._native, self._add("cameras", known))

    def _add(self, parts: str, known: dict[str, Any]) -> int:
        number = self._native.count(parts)
        self._native.set(parts, number, json.dumps(known))
        return number

    def remove(self, part: Light | Camera) -> None:
        """Takes a light or a camera out of the scene. Handles on those behind it then mean the next ones."""
        self._native.remove(part._list, part.number)

    @property
    def vertices(self) -> Floats:
        """Positions [m], a copy of shape (n, 3)."""
        return self._native.vertices()

    @property
    def triangles(self) -> Integers:
        """Three numbers of vertices each, counter-clockwise seen from the front, a copy of shape (m, 3)."""
        return self._native.triangles()

    @property
    def triangle_objects(self) -> Integers:
        """The number of the object of each triangle, a copy of shape (m,)."""
        return self._native.triangle_objects()

    @property
    def lightmap_uvs(self) -> Floats | None:
        """Coordinates in a lightmap of the three corners of each triangle (glTF `TEXCOORD_1`), a copy of shape (m, 3, 2), or `None`.
        (0, 0) is the upper left corner of the map, (1, 1) the lower right one. `isolux.unwrap` makes some.

        Assign others, or `None`, to change them; they change no solution. A vertex is split where corners that share it differ: copies,
        alike in all else, come behind the vertices there were. Wrong shapes raise `ParameterError`, numbers that are not finite
        `InvalidScene`.
        """
        corners = self._native.lightmap_uvs()
        return None if corners is None else corners.reshape(-1, 3, 2)

    @lightmap_uvs.setter
    def lightmap_uvs(self, corners: npt.ArrayLike | None) -> None:
        self._native.set_lightmap_uvs(None if corners is None else meshes.lightmap_corners(corners, len(self.triangles)))

    @property
    def bounds(self) -> Floats:
        """Least and greatest corner of the box around it [m], shape (2, 3)."""
        return np.array(self._native.bounds, dtype=np.float32)

    @property
    def remarks(self) -> list[str]:
        """What its reader assumed, ignored or dropped, a sentence each."""
        return self._native.remarks

    def check(self) -> Report:
        """Looks at everything that can be said before light is computed: flux, gaps, flipped normals, units."""
        return Report._of(json.loads(self._native.check()))

    def copy(self) -> Scene:
        """The same scene, to be changed without changing this one."""
        return Scene(self._native.copy())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it as binary glTF, in one step.

        Raises:
            UnknownFormat: the extension is not .glb.
            FileError: it cannot be written.
        """
        self._native.save(os.fspath(path))

    def __repr__(self) -> str:
        count = self._native.count
        size = self.bounds[1] - self.bounds[0]
        emitters = sum(any(material.emission) for material in self.materials)
        return (
            f"<Scene {self.name!r}: {len(self.triangles):,} triangles in {count('objects')} objects, {count('materials')} materials "
            f"({emitters} emit light), {count('lights')} lights, {count('cameras')} cameras, "
            f"{size[0]:.3g} x {size[1]:.3g} x {size[2]:.3g} m>"
        )
