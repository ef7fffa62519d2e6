"""Tables of solutions (pandas)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .colors import luminance
from .optional import needed

if TYPE_CHECKING:
    import pandas as pd

    from .solution import Solution


def of_elements(solution: Solution) -> pd.DataFrame:
    """A row for each element, with the columns of the `.csv` file; see `Solution.to_dataframe`."""
    pandas = needed("pandas", "a table")
    problem = solution.problem
    names = problem.object_names
    known: dict[str, Any] = {
        "object": [names[k] for k in problem.objects],
        "triangle": problem.triangles,
        "side": ["back" if is_back else "front" for is_back in problem.backs],
        **_columns(problem.centres, ["x", "y", "z"]),
        **_columns(problem.normals, ["nx", "ny", "nz"]),
        "area": problem.areas,
        **_channels("reflectivity", problem.reflectivity),
        **_channels("emission", problem.emission),
        **_channels("irradiance", solution.irradiance),
        "irradiance_luminance": luminance(solution.irradiance),
        **_channels("std_error", solution.std_error),
        "std_error_luminance": luminance(solution.std_error),
        **_channels("radiosity", solution.radiosity),
    }
    table = pandas.DataFrame(known)
    for name in ("object", "side"):
        table[name] = table[name].astype("category")
    table.index.name = "element"
    return table  # type: ignore[no-any-return]


def of_objects(solution: Solution) -> pd.DataFrame:
    """A row for each object; see `Solution.to_dataframe`."""
    pandas = needed("pandas", "a table")
    rows = [
        {
            "elements": light.elements,
            "area": light.area,
            "mean": light.mean.mean,
            "std_error": light.mean.std_error,
            "margin": light.mean.margin(),
            "min": light.min,
            "max": light.max,
            "emitted": light.emitted,
            "incident": light.incident,
            "reflected": light.reflected,
        }
        for light in solution.objects.values()
    ]
    index = pandas.Index(list(solution.objects), name="object")
    return pandas.DataFrame(rows, index=index)  # type: ignore[no-any-return]


def _columns(values: Any, names: list[str]) -> dict[str, Any]:
    return {name: values[:, k] for k, name in enumerate(names)}


def _channels(name: str, values: Any) -> dict[str, Any]:
    return _columns(values, [f"{name}_{channel}" for channel in "rgb"])
