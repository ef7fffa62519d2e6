"""Solutions in false colours, with a legend: in a PyVista window or notebook, or as a picture of Matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from .colors import luminance
from .errors import ParameterError, UnknownName
from .optional import is_there, needed

if TYPE_CHECKING:
    from .problem import Problem
    from .solution import Solution

Quantity: TypeAlias = Literal["irradiance", "std_error", "relative_error", "radiosity", "luminance"] | npt.ArrayLike
"""What is shown: something that the solution knows, or an array with a number for each element."""

LABELS = {
    "irradiance": "irradiance [lux]",
    "std_error": "standard error of the irradiance [lux]",
    "relative_error": "standard error over irradiance [%]",
    "radiosity": "radiosity [lm/m²]",
    "luminance": "luminance [cd/m²]",
}
BRIGHT = 0.95
"""Share of the area whose values the legend covers: lamps and the elements beside them would leave no colours for the rest."""
DECADES = 1000
"""Most that logarithmic colours span: the insides of things are as dark as one likes."""
SUPERSAMPLING = 3
"""Rays along each edge of a pixel: colours, not numbers, are averaged at the edges of things."""


def plot_solution(
    solution: Solution,
    quantity: Quantity = "irradiance",
    *,
    label: str | None = None,
    limits: tuple[float, float] | None = None,
    log: bool = False,
    colors: str = "viridis",
    camera: str | int | None = None,
    width: int = 960,
    height: int | None = None,
    backend: Literal["pyvista", "matplotlib"] | None = None,
    ax: Any = None,
) -> Any:
    """Shows a solution in false colours with a legend.

    Args:
        solution: what to show.
        quantity: "irradiance", "std_error", "relative_error", "radiosity" or "luminance", as a luxmeter sees it; or an array of shape (n,).
        label: of the legend, with the unit.
        limits: the least and the greatest number that colours tell; as 95 % of the area need it if left out. What is beyond has the
            colour of the limit.
        log: whether colours go with the logarithm.
        colors: a colour map of Matplotlib.
        camera: name or number of a camera of the scene; its first, or a view of the whole scene, if it is left out.
        width, height: of the picture in pixels.
        backend: "pyvista" can be turned round, "matplotlib" is a picture through the camera; the first of them that is
            there, or "matplotlib" if there is an `ax`.
        ax: axes of Matplotlib to draw into.

    Returns:
        A `pyvista.Plotter`, to be shown or to take a screenshot of; or a `matplotlib.figure.Figure`.

    Raises:
        MissingPackage: neither is installed, or not the one that is asked for.
        UnknownName, ParameterError: there is no such quantity or camera, or the array does not fit.
    """
    values, known = _values(solution, quantity)
    label = label or known
    low, high = limits or _limits(values, solution.areas, log)
    if backend is None:
        backend = "pyvista" if ax is None and is_there("pyvista") else "matplotlib"
    title = solution.provenance.scene
    if backend == "pyvista":
        return _pyvista(solution.problem, values, label, (low, high), log, colors, camera, (width, height))
    if backend != "matplotlib":
        raise ParameterError.of("backend", backend, "pyvista or matplotlib")
    return _matplotlib(solution.problem, values, label, (low, high), log, colors, camera, (width, height), ax, title)


def _values(solution: Solution, quantity: Quantity) -> tuple[npt.NDArray[np.float64], str]:
    """A number for each element, and what it is."""
    if not isinstance(quantity, str):
        values = np.asarray(quantity, dtype=float)
        if values.shape != (len(solution),):
            raise ParameterError.of("quantity", f"an array of shape {values.shape}", f"a number for each element, shape ({len(solution)},)")
        return values, "value"
    if quantity not in LABELS:
        raise UnknownName(f"there is no quantity called '{quantity}'; there are {', '.join(LABELS)}", "quantity", quantity, "irradiance")
    irradiance, error = luminance(solution.irradiance), luminance(solution.std_error)
    with np.errstate(divide="ignore", invalid="ignore"):
        known = {
            "irradiance": irradiance,
            "std_error": error,
            "relative_error": 100 * error / irradiance,
            "radiosity": luminance(solution.radiosity),
            "luminance": luminance(solution.radiosity) / np.pi,
        }
    return np.asarray(known[quantity], dtype=float), LABELS[quantity]


def _limits(values: npt.NDArray[np.float64], areas: npt.NDArray[Any], log: bool) -> tuple[float, float]:
    known = np.isfinite(values)
    if not known.any():
        return 0.0, 1.0
    order = np.argsort(values[known])
    sorted_values, below = values[known][order], np.cumsum(areas[known][order], dtype=float)
    share = below / below[-1]
    high = float(sorted_values[min(np.searchsorted(share, BRIGHT), len(order) - 1)])
    low = float(sorted_values[np.searchsorted(share, 1 - BRIGHT)])
    if log:
        low = max(low, high / DECADES)
        return (low, high) if 0 < low < high else (1e-3, 1.0)
    low = min(low, 0.0)
    return low, high if high > low else low + 1.0


def _matplotlib(
    problem: Problem,
    values: npt.NDArray[np.float64],
    label: str,
    limits: tuple[float, float],
    log: bool,
    colors: str,
    camera: str | int | None,
    size: tuple[int, int | None],
    ax: Any,
    title: str,
) -> Any:
    needed("matplotlib", "a plot")
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm, Normalize
    from matplotlib.figure import Figure

    norm = LogNorm(*limits, clip=True) if log else Normalize(*limits, clip=True)
    picture = _picture(problem, lambda seen: colormaps[colors](norm(seen)), values, camera, size)
    if ax is None:
        shape = picture.shape[0] / picture.shape[1]
        figure = Figure(figsize=(9, 9 * shape * 0.84 + 0.35), layout="constrained")
        ax = figure.add_subplot()
        ax.set_title(title, loc="left")
    ax.imshow(picture, interpolation="antialiased")
    ax.set_axis_off()
    seen = values[np.isfinite(values)]
    over, under = bool((seen > limits[1]).any()), bool((seen < limits[0]).any())
    extend = {(True, True): "both", (True, False): "max", (False, True): "min"}.get((over, under), "neither")
    ax.figure.colorbar(ScalarMappable(norm, colors), ax=ax, label=label, extend=extend, fraction=0.04, pad=0.02)
    return ax.figure


def _picture(
    problem: Problem, paint: Any, values: npt.NDArray[np.float64], camera: str | int | None, size: tuple[int, int | None]
) -> npt.NDArray[np.float64]:
    """Red, green and blue of every pixel; white where there is nothing."""
    width, height = size[0] * SUPERSAMPLING, None if size[1] is None else size[1] * SUPERSAMPLING
    seen = problem._native.seen(None if camera is None else str(camera), width, height)
    rows, columns = (n // SUPERSAMPLING * SUPERSAMPLING for n in seen.shape)
    seen = seen[:rows, :columns]
    colors = np.asarray(paint(values))[:, :3]
    colors[~np.isfinite(values)] = 0.75
    pixels = np.where((seen < 0)[..., None], 1.0, colors[np.maximum(seen, 0)])
    blocks = pixels.reshape(rows // SUPERSAMPLING, SUPERSAMPLING, columns // SUPERSAMPLING, SUPERSAMPLING, 3)
    return np.asarray(blocks.mean(axis=(1, 3)))


def _pyvista(
    problem: Problem,
    values: npt.NDArray[np.float64],
    label: str,
    limits: tuple[float, float],
    log: bool,
    colors: str,
    camera: str | int | None,
    size: tuple[int, int | None],
) -> Any:
    pyvista = needed("pyvista", "a plot that can be turned round")
    width, height = size
    plotter = pyvista.Plotter(window_size=(width, height or round(width * 9 / 16)))
    unit = label[label.find("[") + 1 :].rstrip("]")
    place = {"vertical": True, "position_x": 0.85, "position_y": 0.06, "width": 0.13, "height": 0.88}
    looks = {"color": "black", "fill": True, "background_color": "white", "n_labels": 6, "fmt": f"%.4g {unit.replace('%', '%%')}"}
    bar = {"title": " ", "label_font_size": 14, **place, **looks}
    mesh = to_pyvista(problem, {label: values})
    plotter.set_background("white")
    plotter.add_mesh(mesh, scalars=label, clim=limits, log_scale=log, cmap=colors, lighting=False, culling="back", scalar_bar_args=bar)
    cameras = problem.scene.cameras
    if camera is not None or len(cameras):
        chosen = cameras[0 if camera is None else camera]
        known = chosen._read()
        position, forward = np.array(known["position"]), np.array(known["forward"])
        plotter.camera_position = [position, position + forward, known["up"]]
        angle = known["projection"].get("Perspective", {}).get("vertical_angle")
        if angle is not None:
            plotter.camera.view_angle = np.degrees(angle)
        plotter.reset_camera_clipping_range()
    return plotter


def to_pyvista(problem: Problem, values: dict[str, npt.NDArray[Any]]) -> Any:
    """The elements as a `pyvista.PolyData`, with `values` of shape (n,) or (n, 3) as cell data.

    An element of many triangles has many cells.

    Raises:
        MissingPackage: PyVista is not installed.
    """
    pyvista = needed("pyvista", "a PyVista mesh")
    corners, element = problem._native.pieces()
    count = len(element)
    faces = np.column_stack([np.full(count, 3), np.arange(3 * count).reshape(-1, 3)])
    mesh = pyvista.PolyData(corners.reshape(-1, 3), faces.reshape(-1))
    mesh.cell_data["element"] = element
    for name, of_element in values.items():
        mesh.cell_data[name] = np.asarray(of_element)[element]
    return mesh
