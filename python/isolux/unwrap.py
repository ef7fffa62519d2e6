"""Charts for lightmaps, made by xatlas.

xatlas is by Jonathan Young (https://github.com/jpcy/xatlas), after thekla_atlas by Ignacio Castaño; the package that brings it to Python is
by Markus Worchel. It grows charts along surfaces, flattens them by least squares conformal maps (Lévy et al. 2002) and packs them by their
shapes. What is ours: it is given surfaces that are cut already where light jumps, so that charts end there, and the density that fills
the map is looked for. Cost: that of xatlas, a few times.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .colors import Floats, Integers
from .errors import LightmapError, ParameterError
from .optional import needed
from .scene import Scene

MOST_SIZE = 8192
"""Most texels across a map: as many as graphics cards take."""
MOST_PADDING = 64

EXTENT = 1024.0
"""About as large are scenes when xatlas sees them: it leaves out triangles whose area is below 1.2e-7."""
HAIR = 2.0**-14
"""So far apart, of `EXTENT`, are vertices that are no longer the same to xatlas: it asks for equal positions."""
TRIES = 12
FULL = 0.985
"""A map is full when its charts take this share of its width."""


@dataclass(frozen=True)
class Charts:
    """What was made of the surfaces of a scene."""

    count: int
    """How many charts there are."""
    size: int
    """Texels across the map that they are packed for: bake it so large (`isolux bake --size`)."""
    texels_per_metre: float
    """The mean over the area (root of the mean square). xatlas stretches charts to whole texels, so small ones have more."""
    left_out: int
    """Triangles with so little area that they have no place of their own in the map: each has the one point of the nearest corner that
    has a place, and so its light."""


def unwrap(scene: Scene, *, size: int | None = None, texels_per_metre: float | None = None, padding: int = 4) -> Charts:
    """Gives a scene coordinates in a lightmap: charts of the package xatlas, as `scene.lightmap_uvs`.

    `isolux bake` keeps them. Charts end with objects, at edges sharper than 36°, and where something stands on the whole edge of a
    triangle, unless both sides of such an edge hang together elsewhere. Both sides of a two-sided surface share their texels. The same
    scene gets the same bits each time.

    Args:
        scene: is changed: vertices are split where charts meet.
        size: texels across the map, and down; surfaces get as many as fit. 1024 unless said otherwise.
        texels_per_metre: instead, so many texels for each metre of surface; the map is as large as that takes.
        padding: texels around each chart that continue its light; neighbouring charts are twice as far apart.

    Raises:
        MissingPackage: xatlas is not installed.
        ParameterError: a number has no meaning, or there are both a size and a density.
        LightmapError: charts do not fit into one map, or the scene is a sphere, which is not made of triangles.
        EmptyScene: there is no surface.
    """
    xatlas = needed("xatlas", "isolux.unwrap")
    _check(size, texels_per_metre, padding)
    positions, triangles = scene._native.pieces()
    place, scale = _set_apart(positions)
    atlas = xatlas.Atlas()
    # All in one mesh: where there are several, xatlas 0.0.11 may move a list that its threads still read.
    atlas.add_mesh(place, triangles)
    surface = _area(positions.astype(float), triangles)

    def pack(density: float) -> int:
        """Packs charts with so many texels for a metre; gives how many the longer side of them all takes, padding included."""
        options = xatlas.PackOptions()
        options.texels_per_unit, options.padding = density / scale, padding
        atlas.generate(pack_options=options)
        return int(max(atlas.width, atlas.height)) + 2 * padding

    if texels_per_metre is None:
        size = 1024 if size is None else size
        if not _fill(pack, size, size * math.sqrt(0.6 / surface)):
            raise LightmapError.of(
                f"{atlas.chart_count} charts with {padding} texels of padding around each do not fit into one map of this size; "
                "ask for a larger size, or less padding"
            )
    else:
        size = _large_enough(pack, texels_per_metre, surface)
    corners, left_out = _corners(atlas, place, triangles)
    texels = corners * (atlas.width, atlas.height) + padding
    scene.lightmap_uvs = texels / size
    density = math.sqrt(_area(texels, np.arange(texels.size // 2).reshape(-1, 3)) / surface)
    return Charts(int(atlas.chart_count), size, density, left_out)


def _check(size: int | None, texels_per_metre: float | None, padding: int) -> None:
    if size is not None and texels_per_metre is not None:
        raise ParameterError.of("texels_per_metre", texels_per_metre, "either a size or a density")
    if size is not None and not 16 <= size <= MOST_SIZE:
        raise ParameterError.of("size", size, f"16 to {MOST_SIZE} texels")
    if texels_per_metre is not None and not 0 < texels_per_metre < math.inf:
        raise ParameterError.of("texels_per_metre", texels_per_metre, "a positive number")
    if not 1 <= padding <= MOST_PADDING:
        raise ParameterError.of("padding", padding, f"1 to {MOST_PADDING} texels")


def _set_apart(positions: Floats) -> tuple[Floats, float]:
    """Positions about the middle of the scene, enlarged by a power of two, and that. Vertices of pieces that touch are a hair apart, or
    xatlas would join them: for it, vertices in the same place are one."""
    low, high = positions.min(axis=0).astype(float), positions.max(axis=0).astype(float)
    scale = 2.0 ** math.floor(math.log2(EXTENT / (high - low).max()))
    place = ((positions - (low + high) / 2) * scale).astype(np.float32)
    _, number, count = np.unique(place, axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(number.reshape(-1), kind="stable")
    first = np.repeat(np.cumsum(count) - count, count)
    place[order, 0] += (np.arange(len(place)) - first) * np.float32(HAIR)
    return place, scale


def _fill(pack: Callable[[float], int], size: int, density: float) -> bool:
    """Packs as densely as fits into `size` texels, by bisection; `density` is a first guess. Whether anything fits."""
    fits, too_dense = 0.0, math.inf
    for _ in range(TRIES):
        wide = pack(density)
        if FULL * size <= wide <= size:
            return True
        fits, too_dense = (density, too_dense) if wide <= size else (fits, density)
        density = min((fits + too_dense) / 2, 1.5 * density)
    return fits > 0 and pack(fits) <= size


def _large_enough(pack: Callable[[float], int], density: float, surface: float) -> int:
    """Packs with this density; gives the size that it takes."""
    least = math.sqrt(surface) * density
    taken = least if least > MOST_SIZE else pack(density)
    if taken > MOST_SIZE:
        fits = density * MOST_SIZE / taken
        raise LightmapError.of(
            f"at {density} texels per metre it would be at least {taken:.0f} texels across, and {MOST_SIZE} are the most; try {fits:.3g}"
        )
    return max(-(-int(taken) // 4) * 4, 16)


def _corners(atlas: Any, place: Floats, triangles: Integers) -> tuple[npt.NDArray[np.float64], int]:
    """Coordinates of the corners of every triangle in the atlas, and how many of the triangles xatlas leaves out."""
    _, own, uvs = atlas.get_mesh(0)
    charts = atlas.get_mesh_vertex_assignment(0)[1].astype(np.int32)
    corners = uvs[own].astype(float)
    is_mapped = charts[own].min(axis=1) >= 0
    known, at = place[triangles[is_mapped]].reshape(-1, 3), corners[is_mapped].reshape(-1, 2)
    for t in np.flatnonzero(~is_mapped):
        away = ((known - place[triangles[t, 0]]) ** 2).sum(axis=1)
        corners[t] = at[np.argmin(away)] if len(at) else 0
    return corners, int((~is_mapped).sum())


def _area(points: npt.NDArray[Any], triangles: npt.NDArray[Any]) -> float:
    """Area of triangles in the plane or in space, each with its corners' numbers."""
    a, b, c = np.moveaxis(points.reshape(-1, points.shape[-1])[triangles], 1, 0)
    along, across = b - a, c - a
    squares = (along**2).sum(axis=1) * (across**2).sum(axis=1) - (along * across).sum(axis=1) ** 2
    return float(0.5 * np.sqrt(np.maximum(squares, 0)).sum())
