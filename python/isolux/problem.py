"""A scene that is cut into elements: what solvers are given, those of isolux and your own."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _native
from .colors import Floats, Integers, luminance
from .errors import ParameterError
from .scene import Scene, load

if TYPE_CHECKING:
    from .solution import Solution

NOTHING = -1
"""In place of an element: a ray meets nothing."""
BACK = -2
"""In place of an element: a ray meets the black back of a one-sided surface."""


class Problem:
    """A scene, cut into n elements: flat pieces of its surfaces that get one value each. It never changes.

    Arrays have a row for each element and are read-only views on memory of the engine: nothing is copied.

    Args:
        scene: a `Scene`, or what `isolux.load` takes.
        elements: how many to aim at, never fewer than one for each side of a triangle; 2000 unless said otherwise.
        max_edge: instead, the longest edge of an element [m].
        contacts: whether elements are cut where others stand on them, so that no light passes below.

    Raises:
        EmptyScene, TooManyElements, ParameterError: there is nothing to cut, or no such cut.
    """

    def __init__(
        self,
        scene: Scene | str | os.PathLike[str],
        *,
        elements: float | None = None,
        max_edge: float | None = None,
        contacts: bool = False,
    ) -> None:
        check_size(elements, max_edge)
        self._native = _native.Problem(as_scene(scene)._native, whole(elements), max_edge, contacts)

    @classmethod
    def _of(cls, native: _native.Problem) -> Problem:
        problem = cls.__new__(cls)
        problem._native = native
        return problem

    def __len__(self) -> int:
        return len(self._native)

    @property
    def scene(self) -> Scene:
        """A copy of the scene."""
        return Scene(self._native.scene())

    @property
    def areas(self) -> Floats:
        """Area of each element [m²], shape (n,)."""
        return self._native.areas

    @property
    def centres(self) -> Floats:
        """Its middle [m], shape (n, 3)."""
        return self._native.centres

    @property
    def normals(self) -> Floats:
        """The unit normal of the side on which it lies, shape (n, 3)."""
        return self._native.normals

    @property
    def reflectivity(self) -> Floats:
        """Share of the light that it reflects, a mean over it, in each channel, shape (n, 3)."""
        return self._native.reflectivity

    @property
    def emission(self) -> Floats:
        """Exitance that it sends out by itself [lm/m²], shape (n, 3)."""
        return self._native.emission

    @property
    def objects(self) -> Integers:
        """The number of its object, shape (n,)."""
        return self._native.objects

    @property
    def object_names(self) -> list[str]:
        """The names of the objects, by their numbers."""
        return self._native.object_names

    @property
    def triangles(self) -> Integers:
        """The number of its triangle, shape (n,)."""
        return self._native.triangles

    @property
    def backs(self) -> npt.NDArray[np.bool_]:
        """Whether it lies on the back of its triangle, shape (n,)."""
        return self._native.backs

    def elements_of(self, name: str) -> Integers:
        """The numbers of all elements of the objects called `name`.

        Raises:
            UnknownName: there is no such object.
        """
        numbers = [k for k, known in enumerate(self.object_names) if known == name]
        if not numbers:
            self.scene.objects[name]  # says what is nearest
        return np.flatnonzero(np.isin(self.objects, numbers))

    def local_lines(self, elements: npt.ArrayLike, samples: npt.ArrayLike) -> tuple[Floats, Floats]:
        """Lines from uniform points of elements in cosine-distributed directions (Malley 1988).

        The nearest surface that such a line meets is on element j with probability F_ij, the form factor.

        Args:
            elements: where each line starts, shape (k,).
            samples: four numbers between 0 and 1 for each, random or of a low-discrepancy sequence, shape (k, 4): two choose the point,
                two the direction.

        Returns:
            Origins [m], lifted off the surface by a rounding error, and unit vectors, shape (k, 3) each.

        Raises:
            ParameterError: an element is not there, or a number is outside of 0 to 1.
        """
        return self._native.local_lines(_integers(elements), _floats(samples))

    def points(self, elements: npt.ArrayLike, samples: npt.ArrayLike) -> tuple[Floats, Floats]:
        """Uniform points of elements, from two numbers each; points [m] and unit normals there, (k, 3) each. See `local_lines`."""
        return self._native.points(_integers(elements), _floats(samples))

    def trace(self, origins: npt.ArrayLike, directions: npt.ArrayLike, *, leaving: npt.ArrayLike | None = None) -> tuple[Integers, Floats]:
        """What rays meet first. The interpreter is let go meanwhile, and all cores help.

        Args:
            origins: where each ray starts [m], shape (k, 3).
            directions: vectors of any length, shape (k, 3).
            leaving: the element that each leaves, whose triangle it never meets, shape (k,).

        Returns:
            The element (`NOTHING`, -1, if there is none; `BACK`, -2, for the black back of a one-sided surface), shape (k,), and
            the distance [m], shape (k,).

        Raises:
            ParameterError: arrays do not fit, or a direction has no length.
        """
        known = None if leaving is None else _integers(leaving)
        return self._native.trace(_floats(origins), _floats(directions), known)

    def shoot(self, elements: npt.ArrayLike, samples: npt.ArrayLike) -> Integers:
        """The element that the local line of each of `elements` meets, as in `local_lines` and `trace`, shape (k,)."""
        origins, directions = self.local_lines(elements, samples)
        return self.trace(origins, directions, leaving=elements)[0]

    def solution(self, irradiance: npt.ArrayLike, *, rays: int = 0, method: str = "own", seed: int = 0) -> Solution:
        """A solution of this problem, computed by yourself: it can be saved, rendered, compared and plotted like any other.

        Args:
            irradiance: light that falls on each element [lux], shape (n, 3); or that of r independent complete solutions, shape
                (r, n, 3), from which standard errors follow.
            rays: how many it took in all.
            method, seed: for its provenance.

        Raises:
            ParameterError: the shape does not fit.
            NotFinite: a number is not finite.
        """
        from .solution import Solution

        given = np.ascontiguousarray(irradiance, dtype=np.float32)
        stack = given[None] if given.ndim == 2 else given
        if stack.ndim != 3 or stack.shape[1:] != (len(self), 3):
            raise ParameterError.of("irradiance", f"an array of shape {given.shape}", f"shape ({len(self)}, 3) or (r, {len(self)}, 3)")
        return Solution(_native.Solution.of_independent(self._native, stack, rays, method, seed), problem=self)

    def __repr__(self) -> str:
        emitted = float(luminance(self.emission) @ self.areas)
        return f"<Problem {self._native.scene_name!r}: {len(self):,} elements, {self.areas.sum():.4g} m², {emitted:.4g} lm emitted>"


Scenelike: TypeAlias = Scene | Problem | str | os.PathLike[str]
"""What can be solved: a scene, what `isolux.load` takes, or a problem that is cut already."""


def as_scene(scene: Scene | str | os.PathLike[str]) -> Scene:
    """A scene, loaded if it is named."""
    return scene if isinstance(scene, Scene) else load(scene)


def whole(number: float | None) -> int | None:
    """A count that may have been written 1e6."""
    if number is None:
        return None
    if not (0 <= number < 2**63 and number == int(number)):
        raise ParameterError.of("count", number, "a whole number, such as 1e6 or 200_000")
    return int(number)


def check_size(elements: float | None, max_edge: float | None) -> None:
    """At most one of the two says how finely a scene is cut."""
    if elements is not None and max_edge is not None:
        raise ParameterError.of("max_edge", max_edge, "elements or max_edge, not both")


def _integers(values: npt.ArrayLike) -> npt.NDArray[np.int64]:
    array = np.asarray(values)
    if array.size and not np.issubdtype(array.dtype, np.integer):
        raise ParameterError.of("elements", f"an array of {array.dtype}", "whole numbers")
    return np.ascontiguousarray(array, dtype=np.int64)


def _floats(values: npt.ArrayLike) -> npt.NDArray[Any]:
    return np.ascontiguousarray(values, dtype=np.float32)
