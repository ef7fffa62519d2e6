"""Scenes from triangles: NumPy arrays, trimesh, PyVista."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _native
from .colors import Color, color, from_srgb
from .colors import reflectivity as below_one
from .errors import ParameterError, UnknownName, UnreadableObject
from .parts import rgb

PerSurface: TypeAlias = Color | npt.ArrayLike | Mapping[str, Color]
"""A colour of all surfaces, an array with that of each triangle, or a dict with that of each object."""

BRIGHTEST = 0.95
"""Colours for screens say white; surfaces are not as white as that."""


def from_arrays(
    vertices: npt.ArrayLike,
    triangles: npt.ArrayLike,
    *,
    objects: npt.ArrayLike | None,
    reflectivity: PerSurface,
    emission: PerSurface,
    two_sided: bool | Mapping[str, bool],
    name: str,
) -> _native.Scene:
    """See `Scene.from_arrays`. An object with several colours becomes several objects, with numbers behind its name."""
    points = _array("vertices", vertices, np.float32)
    corners = _array("triangles", triangles, np.int64)
    if corners.size and not 0 <= corners.min() <= corners.max() < len(points):
        wrong = int(corners.min() if corners.min() < 0 else corners.max())
        raise ParameterError.of("triangles", wrong, f"numbers of vertices, 0 to {len(points) - 1}")
    names, object_of = _names(objects, len(corners))
    shares = _per_triangle("reflectivity", reflectivity, 0.5, names, object_of, below_one)
    exitances = _per_triangle("emission", emission, 0.0, names, object_of, color)
    sides = _sides(two_sided, names)[object_of]

    surfaces = np.column_stack([object_of, shares, exitances, sides])
    kinds, kind_of = np.unique(surfaces, axis=0, return_inverse=True)
    owners = kinds[:, 0].astype(int)
    kind_names = [_kind_name(names[owner], k - int(np.searchsorted(owners, owner)), owners == owner) for k, owner in enumerate(owners)]
    materials = [_material(kind_name, kind) for kind_name, kind in zip(kind_names, kinds, strict=True)]
    return _native.Scene.from_arrays(name, points, corners.astype(np.uint32), kind_of.reshape(-1).astype(np.uint32), kind_names, materials)


def _array(name: str, values: npt.ArrayLike, kind: Any) -> npt.NDArray[Any]:
    array = np.asarray(values)
    if array.size == 0:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ParameterError.of(name, f"an array of shape {array.shape}", "shape (n, 3)")
    if kind is np.int64 and not np.issubdtype(array.dtype, np.integer) and array.size:
        raise ParameterError.of(name, f"an array of {array.dtype}", "whole numbers")
    return np.ascontiguousarray(array, dtype=kind)


def lightmap_corners(corners: npt.ArrayLike, triangles: int) -> npt.NDArray[np.float32]:
    """Coordinates in a lightmap, those of the three corners of a triangle in each row. That they are finite the engine sees."""
    array = np.asarray(corners, dtype=float)
    if array.shape != (triangles, 3, 2):
        raise ParameterError.of("lightmap_uvs", f"an array of shape {array.shape}", f"a pair for each corner, shape ({triangles}, 3, 2)")
    return np.ascontiguousarray(array.reshape(-1, 6), dtype=np.float32)


def _names(objects: npt.ArrayLike | None, count: int) -> tuple[list[str], npt.NDArray[np.int64]]:
    """Names in the order in which they appear, and the number of that of each triangle."""
    if objects is None:
        return ["object"], np.zeros(count, dtype=np.int64)
    given = np.asarray(objects).astype(str)
    if given.shape != (count,):
        raise ParameterError.of("objects", f"an array of shape {given.shape}", f"a name for each of the {count} triangles")
    found, first, number = np.unique(given, return_index=True, return_inverse=True)
    order = np.argsort(first)
    return [str(found[k]) for k in order], np.argsort(order)[number]


def _per_triangle(
    name: str,
    given: PerSurface,
    default: float,
    names: list[str],
    object_of: npt.NDArray[np.int64],
    check: Callable[[str, Color], tuple[float, float, float]],
) -> npt.NDArray[np.float64]:
    if isinstance(given, Mapping):
        _check_names(name, given, names)
        return np.array([check(f"{name} of {n}", given.get(n, default)) for n in names]).reshape(-1, 3)[object_of]
    values = np.asarray(given, dtype=float)
    if values.shape in ((), (3,)):
        return np.tile(check(name, values), (len(object_of), 1))
    if values.shape == (len(object_of),):
        values = np.repeat(values[:, None], 3, axis=1)
    if values.shape != (len(object_of), 3):
        raise ParameterError.of(name, f"an array of shape {values.shape}", "a colour, one for each triangle, or a dict by object")
    kinds, kind_of = np.unique(values, axis=0, return_inverse=True)
    checked = np.array([check(name, kind) for kind in kinds], dtype=float)
    return np.asarray(checked.reshape(-1, 3)[kind_of.reshape(-1)])


def _sides(two_sided: bool | Mapping[str, bool], names: list[str]) -> npt.NDArray[np.bool_]:
    if isinstance(two_sided, Mapping):
        _check_names("two_sided", two_sided, names)
        return np.array([bool(two_sided.get(name, False)) for name in names])
    return np.full(len(names), bool(two_sided))


def _check_names(parameter: str, given: Mapping[str, Any], names: list[str]) -> None:
    for name in given:
        if name not in names:
            raise UnknownName(f"{parameter}: there is no object called '{name}'; there are {', '.join(names)}", "object", name, names[0])


def _kind_name(name: str, k: int, same: npt.NDArray[np.bool_]) -> str:
    return name if same.sum() == 1 else f"{name} {k + 1}"


def _material(name: str, kind: npt.NDArray[np.float64]) -> str:
    known = {"name": name, "reflectivity": rgb(tuple(kind[1:4])), "emission": rgb(tuple(kind[4:7])), "two_sided": bool(kind[7])}
    return json.dumps(known | {"reflectivity_texture": None, "emission_texture": None})


def _joined(parts: Iterator[tuple[str, npt.NDArray[Any], npt.NDArray[Any]]]) -> dict[str, Any]:
    """Named meshes as the arrays of one."""
    vertices: list[npt.NDArray[Any]] = [np.empty((0, 3))]
    triangles: list[npt.NDArray[Any]] = [np.empty((0, 3), dtype=np.int64)]
    objects: list[npt.NDArray[Any]] = [np.empty(0, dtype=str)]
    count = 0
    for name, points, corners in parts:
        vertices.append(np.asarray(points, dtype=float))
        triangles.append(np.asarray(corners, dtype=np.int64) + count)
        objects.append(np.full(len(corners), name))
        count += len(points)
    return {"vertices": np.concatenate(vertices), "triangles": np.concatenate(triangles), "objects": np.concatenate(objects)}


def from_trimesh(mesh: Any, *, reflectivity: PerSurface | None, name: str, **surfaces: Any) -> _native.Scene:
    """See `Scene.from_trimesh`."""
    meshes = list(_trimeshes(mesh, name))
    if reflectivity is None:
        reflectivity = np.concatenate([np.empty((0, 3)), *(_face_colors(one) for _, one, _ in meshes)])
    arrays = _joined((own, points, one.faces) for own, one, points in meshes)
    return from_arrays(**arrays, reflectivity=reflectivity, name=name, **surfaces)


def _trimeshes(mesh: Any, name: str) -> Iterator[tuple[str, Any, npt.NDArray[Any]]]:
    """Name, mesh and positions in the world of each mesh with faces."""
    if hasattr(mesh, "geometry") and hasattr(mesh, "graph"):
        for node in mesh.graph.nodes_geometry:
            transform, geometry = mesh.graph[node]
            part = mesh.geometry[geometry]
            if hasattr(part, "faces"):
                yield str(node), part, np.asarray(part.vertices) @ transform[:3, :3].T + transform[:3, 3]
    elif hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        yield name, mesh, np.asarray(mesh.vertices)
    else:
        raise UnreadableObject(f"a {type(mesh).__name__} is no trimesh.Trimesh and no trimesh.Scene: it has no vertices and faces")


def _face_colors(mesh: Any) -> npt.NDArray[np.float64]:
    visual = getattr(mesh, "visual", None)
    kind = getattr(visual, "kind", None)
    if visual is None or kind is None:
        return np.full((len(mesh.faces), 3), 0.5)
    colors = visual.to_color() if kind == "texture" else visual
    return np.minimum(from_srgb(np.asarray(colors.face_colors)[:, :3] / 255), BRIGHTEST)


def from_pyvista(mesh: Any, *, name: str, **surfaces: Any) -> _native.Scene:
    """See `Scene.from_pyvista`."""
    return from_arrays(**_joined(_polydata(mesh, name)), name=name, **surfaces)


def _polydata(mesh: Any, name: str) -> Iterator[tuple[str, npt.NDArray[Any], npt.NDArray[Any]]]:
    """Name, points and triangles of each data set."""
    if hasattr(mesh, "n_blocks") and hasattr(mesh, "keys"):
        for k, key in enumerate(mesh.keys()):
            if mesh[k] is not None:
                yield from _polydata(mesh[k], str(key))
    elif hasattr(mesh, "points") and hasattr(mesh, "extract_surface"):
        surface = mesh if hasattr(mesh, "strips") else mesh.extract_surface()
        triangles = surface.triangulate()
        yield name, np.asarray(triangles.points), np.asarray(triangles.faces).reshape(-1, 4)[:, 1:]
    else:
        raise UnreadableObject(f"a {type(mesh).__name__} is no PyVista data set and no MultiBlock: it has no points and no surface")
