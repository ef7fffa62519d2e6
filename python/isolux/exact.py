"""Scenes whose light is known exactly, for tests of solvers."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _native
from .problem import Problem
from .scene import Scene

Case: TypeAlias = tuple[str, Problem, npt.NDArray[np.float64]]
"""A name, a problem, and the irradiance [lux] of its elements, shape (n, 3), which is known exactly."""


def furnace() -> Case:
    """A closed cube in which every wall has `Be + rho = 1`, each with another rho: then B = 1 and E = 1 everywhere."""
    shares = [[0.1, 0.5, 0.9], [0.9, 0.3, 0.2], [0.6, 0.6, 0.6], [0.2, 0.8, 0.4], [0.5, 0.1, 0.7], [0.8, 0.7, 0.3]]
    walls = {name: np.array(share) for name, share in zip(WALLS, shares, strict=True)}
    problem = Problem(inside_of_a_cube(walls, {name: 1 - share for name, share in walls.items()}), elements=300)
    return "furnace", problem, np.ones((len(problem), 3))


def sphere() -> Case:
    """The inside of a sphere: all points see each other alike, so `E = Σ A Be / (Σ A - Σ A rho)`, the same everywhere."""
    problem = Problem("sphere", elements=200)
    areas, rho, emission = (np.asarray(values, dtype=float) for values in (problem.areas, problem.reflectivity, problem.emission))
    exact = (areas @ emission) / (areas.sum() - areas @ rho)
    return "sphere", problem, np.tile(exact, (len(problem), 1))


def cube() -> Case:
    """A black cube with a floor that glows: irradiances are form factors, by contour integrals."""
    glow = {"floor": np.array([3.0, 2.0, 1.0])}
    problem = Problem(inside_of_a_cube(dict.fromkeys(WALLS, np.zeros(3)), glow), elements=300)
    return "black cube", problem, _by_form_factors(problem)


def lamp_in_a_room() -> Case:
    """A cube of several colours with a ceiling that glows: the radiosity system, solved by elimination."""
    walls = dict.fromkeys(WALLS, np.full(3, 0.7)) | {"left": np.array([0.8, 0.1, 0.1]), "right": np.array([0.1, 0.7, 0.2])}
    problem = Problem(inside_of_a_cube(walls, {"ceiling": np.array([100.0, 90.0, 70.0])}), elements=300)
    return "lamp in a room", problem, _by_form_factors(problem)


WALLS = ("floor", "ceiling", "back", "front", "left", "right")


def inside_of_a_cube(reflectivity: dict[str, npt.NDArray[Any]], emission: dict[str, npt.NDArray[Any]]) -> Scene:
    """The inside of a cube with edges of 2 m."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (0, 2) for z in (-1, 1)], dtype=float)
    faces = [[0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5], [0, 2, 3, 1], [4, 5, 7, 6]]
    triangles = np.array([half for a, b, c, d in faces for half in ([a, b, c], [a, c, d])])
    return Scene.from_arrays(corners, triangles, objects=np.repeat(WALLS, 2), reflectivity=reflectivity, emission=emission, name="cube")


def _by_form_factors(problem: Problem) -> npt.NDArray[np.float64]:
    """`E = F B, B = Be + rho E`, with the form factors of a scene in which nothing blocks the view."""
    fineness = {"rays": 1, "resolution": 64, "hemicubes": 1, "visibility": 4, "seed": 1}
    factors = _native.form_factors(problem._native, "contour", fineness, "none", None, lambda done, rows: None)
    n, starts = len(problem), factors.starts()
    matrix = np.zeros((n, n))
    matrix[np.repeat(np.arange(n), np.diff(starts)), factors.indices()] = factors.values
    rho, emission = np.asarray(problem.reflectivity, dtype=float), np.asarray(problem.emission, dtype=float)
    solve = np.linalg.solve
    return np.stack([solve(np.eye(n) - matrix * rho[:, c], matrix @ emission[:, c]) for c in range(3)], axis=1)
