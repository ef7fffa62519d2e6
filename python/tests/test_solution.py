"""Solutions: tables, files, pictures, plots, light groups, merging and comparing."""

import math
from pathlib import Path

import numpy as np
import pytest

import isolux
from isolux.light import by_name


def test_means_are_those_of_the_arrays(cornell: isolux.Solution) -> None:
    lux = isolux.luminance(cornell.irradiance)
    assert cornell.mean.mean == pytest.approx(lux @ cornell.areas / cornell.areas.sum(), rel=1e-5)
    here = cornell.problem.elements_of("floor")
    floor = cornell.objects["floor"]
    assert floor.mean.mean == pytest.approx(lux[here] @ cornell.areas[here] / cornell.areas[here].sum(), rel=1e-5)
    assert floor.elements == len(here) and floor.area == pytest.approx(cornell.areas[here].sum(), rel=1e-5)
    assert floor.incident == pytest.approx(floor.mean.mean * floor.area, rel=1e-5)
    assert "± " in str(floor.mean) and float(floor.mean) == floor.mean.mean and floor.mean.margin(0.99) > floor.mean.margin(0.9)
    assert cornell.balance.emitted == pytest.approx(0.6175, rel=1e-3)
    assert 0 < cornell.error < cornell.error_bound(0.95) < cornell.error_bound(0.99) < cornell.error_bound(0.99, "max")


def test_tables_have_a_row_for_each_element_or_object(cornell: isolux.Solution) -> None:
    pytest.importorskip("pandas")
    elements, objects = cornell.to_dataframe(), cornell.to_dataframe(by="object")
    assert len(elements) == len(cornell) and list(objects.index) == list(cornell.objects)
    for name, row in objects.iterrows():
        here = elements[elements["object"] == name]
        assert np.average(here["irradiance_luminance"], weights=here["area"]) == pytest.approx(row["mean"], rel=1e-4)
    with pytest.raises(isolux.ParameterError):
        cornell.to_dataframe(by="wall")  # type: ignore[arg-type]


def test_every_format_is_written_and_a_solution_comes_back(cornell: isolux.Solution, tmp_path: Path) -> None:
    for extension in isolux.names("writers"):
        file = tmp_path / f"a.{extension}"
        cornell.save(file, width=32)
        assert file.stat().st_size > 0
    again = isolux.open(tmp_path / "a.isolux")
    assert (again.irradiance == cornell.irradiance).all() and again.objects.keys() == cornell.objects.keys()
    pandas = pytest.importorskip("pandas")
    table = pandas.read_csv(tmp_path / "a.csv")
    ours = cornell.to_dataframe()
    lux = next(name for name in table.columns if name.startswith("irradiance_luminance"))
    assert list(table["side"]) == list(ours["side"])
    assert table[lux].to_numpy() == pytest.approx(ours["irradiance_luminance"].to_numpy(), rel=1e-4)
    with pytest.raises(isolux.UnknownFormat, match=r"\.npz"):
        cornell.save(tmp_path / "a.docx")
    with pytest.raises(isolux.MissingFile, match="make it first"):
        cornell.save(tmp_path / "none" / "a.csv")
    (tmp_path / "b.isolux").write_bytes(b"rubbish")
    with pytest.raises(isolux.InvalidFile):
        isolux.open(tmp_path / "b.isolux")


def test_pictures_are_arrays(cornell: isolux.Solution) -> None:
    display, linear = cornell.render(width=48, samples=4), cornell.render(width=48, samples=4, linear=True)
    assert display.shape == linear.shape == (48, 48, 3) and display.dtype == np.uint8 and linear.dtype == np.float32
    lamp = np.max(cornell.problem.emission) / np.pi
    assert lamp <= linear.max() <= 1.5 * lamp
    with pytest.raises(isolux.UnknownName):
        cornell.render(camera="door")
    with pytest.raises(isolux.ParameterError):
        cornell.render(width=0)


def test_a_plot_shows_values_where_they_are(cornell: isolux.Solution) -> None:
    pytest.importorskip("matplotlib")
    figure = cornell.plot(backend="matplotlib", width=60)
    picture = figure.axes[0].images[0].get_array()
    assert picture.shape == (60, 60, 3) and figure.axes[1].get_ylabel() == "irradiance [lux]"
    # Elements of the left half are 0, of the right half 1: the picture, seen from the front, has one colour on each side.
    sides = (cornell.problem.centres[:, 0] > 0.278).astype(float)
    picture = cornell.plot(sides, backend="matplotlib", width=60, limits=(0, 1), colors="gray").axes[0].images[0].get_array()
    assert picture[30, 8].mean() != pytest.approx(picture[30, 51].mean())
    assert {round(float(picture[30, 8].mean())), round(float(picture[30, 51].mean()))} == {0, 1}
    for wrong in ("lux", np.zeros(3)):
        with pytest.raises(isolux.Error):
            cornell.plot(wrong, backend="matplotlib")
    assert cornell.plot("luminance", log=True, backend="matplotlib", width=40) is not None


def test_pyvista_gets_a_mesh_with_the_right_area(cornell: isolux.Solution) -> None:
    pytest.importorskip("pyvista")
    mesh = isolux.to_pyvista(cornell.problem, {"lux": isolux.luminance(cornell.irradiance)})
    sizes = mesh.compute_cell_sizes(length=False, volume=False).cell_data["Area"]
    assert sizes.sum() == pytest.approx(cornell.areas.sum(), rel=1e-4)
    assert (sizes @ mesh.cell_data["lux"]) == pytest.approx(isolux.luminance(cornell.irradiance) @ cornell.areas, rel=1e-4)
    plotter = cornell.plot(backend="pyvista")
    assert plotter.scalar_bars.keys() and plotter.camera.position == pytest.approx(cornell.problem.scene.cameras[0].position, rel=1e-5)
    plotter.close()


def test_lamps_are_mixed_without_solving_again() -> None:
    groups = {"lamps": "pendant*", "windows": "window*"}
    solution = isolux.solve("office", elements=3000, rays=1e6, light_groups=groups)
    assert list(solution.light_groups)[:2] == ["lamps", "windows"]
    dark = solution.mix(dict.fromkeys(solution.light_groups, 0))
    assert not dark.irradiance.any() and dark.balance.emitted == 0
    half = solution.mix({"lamps": 0.5})
    expected = solution.irradiance - 0.5 * solution.alone("lamps").irradiance
    assert half.irradiance == pytest.approx(expected, rel=1e-3, abs=1e-3)
    with pytest.raises(isolux.UnknownName, match="there are lamps, windows"):
        solution.mix({"lamp": 1})


def test_seeds_are_merged_and_compared(cornell: isolux.Solution) -> None:
    problem = isolux.Problem("cornell-box", elements=400)
    one, two = (isolux.solve(problem, rays=4e5, seed=seed) for seed in (1, 2))
    both = isolux.merge([one, two])
    assert both.rays == one.rays + two.rays and both.error < max(one.error, two.error)
    difference = isolux.compare(one, two)
    assert difference.rms == pytest.approx(difference.expected_rms, rel=0.5) and abs(difference.z["scene"]) < 12
    assert "standard deviations" in str(difference)
    assert list(difference.z) == ["scene", *one.objects]
    with pytest.raises(isolux.NotMergeable):
        isolux.merge([one, one])
    with pytest.raises(isolux.NotMergeable):
        isolux.merge([])
    other = isolux.compare(one, cornell)
    assert math.isnan(other.expected_rms) and 0.0 < other.rms < 1.0 and abs(other.z["scene"]) < 12 and "nan" not in str(other)
    with pytest.raises(isolux.NotComparable):
        isolux.compare(one, isolux.solve("cubes", elements=400, rays=1e4))


def test_objects_of_equal_names_are_all_kept() -> None:
    objects = [{"name": "chair", "side": side, "number": k} for k, side in enumerate([None, None, "front", "back", "front"])]
    numbers = {name: known["number"] for name, known in by_name(objects).items()}
    assert numbers == {"chair": 0, "chair (2)": 1, "chair, front": 2, "chair, back": 3, "chair, front (2)": 4}


def test_elements_know_their_side() -> None:
    scene = isolux.Scene.from_arrays([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], two_sided=True)
    problem = isolux.Problem(scene, elements=8)
    assert 0 < problem.backs.sum() == len(problem) / 2
    assert (problem.normals[problem.backs] == -problem.normals[~problem.backs][0]).all()
