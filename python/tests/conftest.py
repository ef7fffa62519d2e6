"""Solutions that several tests look at, and where things are."""

import signal
from pathlib import Path

import numpy as np
import pytest

import isolux

ROOT = Path(__file__).parents[2]
"""The folder of the project."""

# Jobs in the background of a shell ignore Ctrl-C, and so would what is tested here.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def cornell() -> isolux.Solution:
    """The Cornell box, coarse and quick."""
    return isolux.solve("cornell-box", elements=1500, rays=1e6)


@pytest.fixture
def cube() -> isolux.Scene:
    """The inside of a unit cube; its ceiling glows with 100 lm/m²."""
    return box()


def box(**surfaces: object) -> isolux.Scene:
    """The inside of a unit cube, made of arrays."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    walls = ["floor", "ceiling", "back", "front", "left", "right"]
    faces = [[0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5], [0, 2, 3, 1], [4, 5, 7, 6]]
    triangles = [half for a, b, c, d in faces for half in ([a, b, c], [a, c, d])]
    known = {"objects": np.repeat(walls, 2), "emission": {"ceiling": 100.0}} | surfaces
    return isolux.Scene.from_arrays(corners, triangles, **known)  # type: ignore[arg-type]
