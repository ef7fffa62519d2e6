"""Form factors (view factors): the share of the light leaving one element that reaches another."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _native
from .optional import needed
from .problem import Problem, Scenelike
from .progress import bar

if TYPE_CHECKING:
    import pandas as pd


def form_factors(
    scene: Scenelike,
    *,
    by: Literal["contour", "hemicube", "local-lines", "global-lines"] = "contour",
    elements: float | None = None,
    max_edge: float | None = None,
    rays: int = 4096,
    resolution: int = 64,
    hemicubes: int = 1,
    visibility: int = 4,
    correct: Literal["none", "reciprocity", "enclosure"] = "none",
    seed: int = 1,
    threads: int | None = None,
    progress: bool = False,
) -> FormFactors:
    """Computes the form factors between all elements of a scene, as `isolux factors` does.

    Row convention: F_ij is the share of the light leaving element i that reaches element j; rows of closed scenes sum to 1.

    Args:
        scene: a `Scene`, what `isolux.load` takes, or a `Problem`.
        by: "contour" integrals, exact where nothing blocks the view (Lambert 1760; Baum, Rushmeier & Winget 1989); "hemicube"
            (Cohen & Greenberg 1985); "local-lines" (Malley 1988) or "global-lines" (Sbert 1993), which give standard errors.
        elements, max_edge: how finely it is cut, as for `Problem`; 2000 elements unless said otherwise.
        rays: lines from each element, for "local-lines" and "global-lines".
        resolution, hemicubes: pixels along the edge of a hemicube, and hemicubes along the edge of an element.
        visibility: points along the edge of an element where something blocks the view, for "contour".
        correct: the law that the matrix is made to obey: "reciprocity" A_i F_ij = A_j F_ji, or "enclosure", and rows that sum to one.
        seed: of the random numbers.
        threads: how many; one for each core unless said otherwise.
        progress: whether to show a bar.

    Raises:
        UnknownName, ParameterError: no such way, or numbers without meaning; a matrix that could have more than 100 million entries.
        MissingPackage: SciPy is not installed.
        KeyboardInterrupt: Ctrl-C ends it; half a matrix is of no use.
    """
    needed("scipy", "a sparse matrix")
    problem = scene if isinstance(scene, Problem) else Problem(scene, elements=elements, max_edge=max_edge)
    fineness = {"rays": rays, "resolution": resolution, "hemicubes": hemicubes, "visibility": visibility, "seed": seed}
    with bar("form factors", progress) as shown:

        def watch(done: int, rows: int) -> None:
            shown.show(done / rows, f"{done:,} of {rows:,} rows")

        native = _native.form_factors(problem._native, by, fineness, correct, threads, watch)
    return FormFactors(native, problem, by)


class FormFactors:
    """A sparse matrix of form factors, with what is known of it."""

    def __init__(self, native: _native.FormFactors, problem: Problem, by: str) -> None:
        self._native, self._problem, self._by = native, problem, by

    @property
    def problem(self) -> Problem:
        """The elements that its rows and columns stand for."""
        return self._problem

    @property
    def by(self) -> str:
        """How it was computed."""
        return self._by

    @property
    def areas(self) -> npt.NDArray[np.float64]:
        """Area of each element [m²], shape (n,)."""
        return self._native.areas

    @cached_property
    def matrix(self) -> Any:
        """F, a `scipy.sparse.csr_array` of shape (n, n). Its values are a read-only view on memory of the engine."""
        return self._sparse(self._native.values)

    @cached_property
    def std_error(self) -> Any:
        """The standard error of each entry of `matrix`, in the same places; `None` if the way has none."""
        errors = self._native.std_errors
        return self._sparse(errors) if len(errors) else None

    def _sparse(self, values: npt.NDArray[Any]) -> Any:
        from scipy import sparse

        n = len(self.areas)
        return sparse.csr_array((values, self._native.indices(), self._native.starts()), shape=(n, n), copy=False)

    @property
    def row_sums(self) -> npt.NDArray[np.float64]:
        """The sum of each row, shape (n,): 1 in a closed scene. What is missing has escaped, or fell on the backs of surfaces."""
        return np.asarray(self.matrix.sum(axis=1))

    @property
    def reciprocity(self) -> float:
        """RMS difference between `A_i F_ij` and `A_j F_ji`, over their RMS."""
        return self._native.reciprocity()[1]

    def by_object(self) -> pd.DataFrame:
        """Form factors between whole objects, by their names: from that of the row to that of the column.

        `F_AB = Σ_i∈A A_i Σ_j∈B F_ij / A_A`. Objects of the same name count as one.

        Raises:
            MissingPackage: pandas is not installed.
        """
        names, members = self._members()
        areas = members @ self.areas
        exchange = members @ (self.matrix * self.areas[:, None]) @ members.T
        return self._table(names, exchange.toarray() / areas[:, None])

    def by_object_std_error(self) -> pd.DataFrame | None:
        """Standard errors of `by_object`, errors of entries taken as independent; `None` if the way has none.

        Entries of a row that was sampled are a little anticorrelated, so these are rather too large.
        """
        if self.std_error is None:
            return None
        names, members = self._members()
        variance = (self.std_error * self.areas[:, None]).power(2)
        areas = members @ self.areas
        return self._table(names, np.sqrt((members @ variance @ members.T).toarray()) / areas[:, None])

    def _members(self) -> tuple[list[str], Any]:
        """Names of objects, and a matrix with a one where an element (column) is on an object (row)."""
        from scipy import sparse

        all_names = self._problem.object_names
        own = [all_names[k] for k in self._problem.objects]
        names = [name for name in dict.fromkeys(all_names) if name in set(own)]
        number = {name: k for k, name in enumerate(names)}
        rows = [number[name] for name in own]
        ones = np.ones(len(rows))
        return names, sparse.csr_array((ones, (rows, np.arange(len(rows)))), shape=(len(names), len(rows)))

    def _table(self, names: list[str], values: npt.NDArray[Any]) -> pd.DataFrame:
        pandas = needed("pandas", "a table")
        return pandas.DataFrame(values, index=pandas.Index(names, name="from"), columns=pandas.Index(names, name="to"))  # type: ignore[no-any-return]

    def __repr__(self) -> str:
        sums = self.row_sums
        spread = f"row sums {sums.min():.6f} to {sums.max():.6f}"
        return f"<FormFactors of {len(self._problem):,} elements by {self._by}: {self.matrix.nnz:,} entries, {spread}>"
