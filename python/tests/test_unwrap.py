"""Coordinates in lightmaps: set by hand, made by xatlas, kept by `isolux bake`."""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import isolux
from conftest import box

ALL_KEPT = "Lightmap coordinates (TEXCOORD_1) are those of the scene's file"


def apart(scene: isolux.Scene) -> np.ndarray:
    """Coordinates that differ at every corner."""
    count = len(scene.triangles)
    corners = np.array([[0, 0], [0.5, 0], [0, 0.5]]) / count
    return (corners + np.arange(count)[:, None, None] / count).astype(np.float32)


def test_vertices_are_split_where_corners_differ_and_solutions_stay_the_same() -> None:
    before, scene = isolux.load("cornell-box"), isolux.load("cornell-box")
    assert scene.lightmap_uvs is None
    by_vertex = scene.vertices[:, :2][scene.triangles]
    scene.lightmap_uvs = by_vertex
    assert (scene.lightmap_uvs == by_vertex).all() and (scene.triangles == before.triangles).all()
    scene.lightmap_uvs = apart(scene)
    assert scene.lightmap_uvs.tobytes() == apart(scene).tobytes() and len(scene.vertices) == 3 * len(scene.triangles)
    assert (scene.vertices[scene.triangles] == before.vertices[before.triangles]).all()
    assert (scene.triangle_objects == before.triangle_objects).all() and scene.objects.names == before.objects.names
    solved = [isolux.solve(one, elements=500, rays=1e5).irradiance.tobytes() for one in (before, scene)]
    assert solved[0] == solved[1]
    scene.lightmap_uvs = None
    assert scene.lightmap_uvs is None


def test_coordinates_that_make_no_sense_are_refused_and_nothing_changes(cube: isolux.Scene) -> None:
    for wrong in (np.zeros((12, 3)), np.zeros((11, 3, 2)), np.zeros((8, 2)), 0.5):
        with pytest.raises(isolux.ParameterError, match=r"lightmap_uvs = an array of shape .* shape \(12, 3, 2\)"):
            cube.lightmap_uvs = wrong
    bad = apart(cube)
    bad[7, 1, 0] = np.nan
    with pytest.raises(isolux.InvalidScene, match="not all of them finite") as fault:
        cube.lightmap_uvs = bad
    assert fault.value.place == "lightmap_uvs/7" and cube.lightmap_uvs is None and len(cube.vertices) == 8


def test_a_file_keeps_every_bit_and_a_scene_with_coordinates_is_edited_like_any_other(tmp_path: Path) -> None:
    room = box()
    vertices, triangles = np.concatenate([room.vertices, 0.3 + 0.3 * room.vertices]), np.concatenate([room.triangles, room.triangles + 8])
    scene = isolux.Scene.from_arrays(vertices, triangles, objects=["room"] * 12 + ["thing"] * 12, two_sided={"thing": True})
    scene.lightmap_uvs = apart(scene)
    scene.save(tmp_path / "a.glb")
    again = isolux.load(tmp_path / "a.glb", insides="keep")
    assert again.lightmap_uvs is not None and again.lightmap_uvs.tobytes() == apart(scene).tobytes()
    again = isolux.load(tmp_path / "a.glb")
    assert "only the side that can be seen counts" in again.remarks[0]
    again.materials["thing"].reflectivity = 0.25
    again.objects["room"].name = "hall"
    assert again.objects.names == ["hall", "thing"] and again.materials["thing"].reflectivity == (0.25, 0.25, 0.25)


def strip(bends: list[float], **surfaces: Any) -> isolux.Scene:
    """Squares of 1 m in a row along x; at each of the edges between them the strip bends by so many degrees."""
    angles = np.radians(np.cumsum([0.0, *bends]))
    along = np.concatenate([[[0.0, 0.0]], np.cumsum(np.column_stack([np.cos(angles), np.sin(angles)]), axis=0)])
    vertices = [[x, y, z] for x, y in along for z in (0.0, 1.0)]
    first = 2 * np.arange(len(angles))
    squares = np.stack([first, first + 1, first + 2, first + 2, first + 1, first + 3], axis=1)
    return isolux.Scene.from_arrays(vertices, squares.reshape(-1, 3), **surfaces)


def test_charts_end_with_objects_at_sharp_edges_and_where_something_stands() -> None:
    pytest.importorskip("xatlas")
    assert isolux.unwrap(strip([0, 0, 20])).count == 1
    assert isolux.unwrap(strip([0, 20], objects=["a", "a", "b", "b", "b", "b"])).count == 2
    assert isolux.unwrap(strip([40, 40, 20])).count == 3
    with_wall = strip([0])
    wall = [[1, 0, 0], [1, 0, 1], [1, 1, 1], [1, 1, 0]]
    vertices = np.concatenate([with_wall.vertices, wall])
    triangles = np.concatenate([with_wall.triangles, [[6, 7, 8], [6, 8, 9]]])
    names = ["floor"] * 4 + ["wall"] * 2
    stood_on = isolux.Scene.from_arrays(vertices, triangles, objects=names, two_sided=True)
    assert isolux.unwrap(stood_on).count == 3


def covered_by(uvs: np.ndarray, size: int) -> np.ndarray:
    """Number of the triangle that has the centre of each texel inside, shape (size, size); -1 for none. No two may have one."""
    owner = np.full((size, size), -1)
    for t, (a, b, c) in enumerate(uvs.astype(float) * size):
        low, high = np.floor(np.min([a, b, c], axis=0)).astype(int), np.ceil(np.max([a, b, c], axis=0)).astype(int)
        y, x = np.mgrid[low[1] : high[1], low[0] : high[0]]
        p = np.stack([x + 0.5, y + 0.5], axis=-1)
        cross = [(v - u)[0] * (p - u)[..., 1] - (v - u)[1] * (p - u)[..., 0] for u, v in ((a, b), (b, c), (c, a))]
        inside = np.all(np.sign(np.sum(cross, axis=0)) * np.array(cross) > 1e-3, axis=0)
        assert (owner[y[inside], x[inside]] == -1).all()
        owner[y[inside], x[inside]] = t
    return owner


def test_charts_fill_the_map_do_not_overlap_and_are_twice_the_padding_apart() -> None:
    pytest.importorskip("xatlas")
    for padding, size in ((1, 96), (3, 160)):
        scene = isolux.load("cubes")
        charts = isolux.unwrap(scene, size=size, padding=padding)
        uvs = scene.lightmap_uvs
        assert uvs is not None and charts.size == size and charts.left_out == 0
        owner = covered_by(uvs, size)
        assert (owner >= 0).mean() > 0.3
        # Triangles that share a corner of the map are on one chart.
        chart = np.arange(len(uvs))
        for _ in range(len(uvs)):
            _, corner = np.unique(uvs.reshape(-1, 2), axis=0, return_inverse=True)
            least = np.full(corner.max() + 1, len(uvs))
            np.minimum.at(least, corner.reshape(-1), np.repeat(chart, 3))
            chart = least[corner.reshape(-1, 3)].min(axis=1)
        assert len(np.unique(chart)) == charts.count
        of_texel = np.where(owner >= 0, chart[owner], -1)
        for dy in range(2 * padding):
            for dx in range(1 - 2 * padding, 2 * padding):
                one, other = of_texel, np.roll(of_texel, (dy, dx), axis=(0, 1))
                assert ((one < 0) | (other < 0) | (one == other)).all()


def test_maps_of_every_size_have_their_padding_all_around() -> None:
    pytest.importorskip("xatlas")
    for size in (64, 100, 128, 256, 500, 512, 1000, 1024):
        scene = isolux.load("cubes")
        isolux.unwrap(scene, size=size, padding=2)
        uvs = scene.lightmap_uvs
        assert uvs is not None and uvs.min() > 2 / size and 0.93 < uvs.max() < 1 - 2 / size, size


@pytest.mark.parametrize(("name", "size"), [("cornell-box", 256), ("cubes", 256), ("office", 2048)])
def test_bake_keeps_the_charts_and_finds_the_same_light_as_on_its_own(
    name: str, size: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("xatlas")
    monkeypatch.chdir(tmp_path)
    scene, again = isolux.load(name), isolux.load(name)
    charts = isolux.unwrap(scene, size=size)
    assert isolux.unwrap(again, size=size) == charts
    assert scene.lightmap_uvs is not None and again.lightmap_uvs is not None
    assert scene.lightmap_uvs.tobytes() == again.lightmap_uvs.tobytes()
    isolux.solve(scene, elements=20_000, rays=1e6).save("lit.isolux")
    assert ALL_KEPT in baked("kept", "--size", str(size))
    assert ALL_KEPT not in baked("own", "--size", str(size), "--new-coordinates")
    kept, own = (json.loads(Path(f"{file}.json").read_text()) for file in ("kept", "own"))
    assert kept["texels_per_metre"] == pytest.approx(charts.texels_per_metre, rel=1e-3)
    assert kept["texels_per_metre"] > 0.75 * own["texels_per_metre"]
    # Where own charts show both sides, those of a file show the brighter one: there is nothing to compare.
    pairs = [
        pair for pair in zip(kept["objects"], own["objects"], strict=True) if pair[0]["area"] == pytest.approx(pair[1]["area"], rel=1e-3)
    ]
    assert len(pairs) > 0.9 * len(own["objects"])
    means = np.array([[one["mean"] * one["area"] for one in pair] for pair in pairs])
    assert np.median(np.abs(means[:, 0] / means[:, 1] - 1)) < 1e-3
    assert means[:, 0].sum() == pytest.approx(means[:, 1].sum(), rel=0.01)


def baked(file: str, *options: str) -> str:
    """What `isolux bake` says when it bakes lit.isolux into a .png and a .glb of this name."""
    command = [sys.executable, "-m", "isolux.command_line", "bake", "lit.isolux", "-o", f"{file}.glb", "-o", f"{file}.png"]
    ran = subprocess.run([*command, "--carrier", "sidecar", *options], capture_output=True, text=True, check=True)
    return ran.stdout


def test_both_maps_have_the_same_light_at_the_same_points(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("xatlas")
    image = pytest.importorskip("matplotlib.image")
    monkeypatch.chdir(tmp_path)
    scene = isolux.load("cornell-box")
    isolux.unwrap(scene, size=256)
    isolux.solve(scene, elements=5000, rays=1e6).save("lit.isolux")
    light = []
    for file, options in (("kept", ["--size", "256"]), ("own", ["--size", "256", "--new-coordinates"])):
        baked(file, *options)
        read, display = isolux.load(f"{file}.glb"), image.imread(f"{file}.png")[:, :, 1]
        assert read.lightmap_uvs is not None
        assert (read.vertices[read.triangles] == scene.vertices[scene.triangles]).all()
        linear = np.where(display <= 0.04045, display / 12.92, ((display + 0.055) / 1.055) ** 2.4)
        texel = read.lightmap_uvs.mean(axis=1) * display.shape[::-1] - 0.5
        (column, row), (x, y) = texel.astype(int).T, (texel % 1).T
        beside = [(linear[row + j, column + i], (x if i else 1 - x) * (y if j else 1 - y)) for i in (0, 1) for j in (0, 1)]
        light.append(sum(value * weight for value, weight in beside) * json.loads(Path(f"{file}.json").read_text())["lux_at_white"])
    assert len(light[0]) == 38 and np.abs(light[0] - light[1]).max() < 0.04 * light[1].max()


def test_triangles_that_xatlas_leaves_out_have_the_light_of_the_nearest_corner(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("xatlas")
    monkeypatch.chdir(tmp_path)
    room = box(emission={"ceiling": 100.0})
    corner = room.vertices[7]
    vertices = np.concatenate([room.vertices, [corner - [1e-6, 0, 0], corner - [0, 0, 1e-6]]])
    triangles = np.concatenate([room.triangles, [[7, 8, 9]]])
    names = [room.objects.names[k] for k in room.triangle_objects]
    scene = isolux.Scene.from_arrays(vertices, triangles, objects=[*names, "ceiling"], emission={"ceiling": 100.0})
    before = len(scene.triangles)
    charts = isolux.unwrap(scene, size=64)
    uvs = scene.lightmap_uvs
    assert uvs is not None and charts.left_out == 1 and len(scene.triangles) == before == 13
    at_corner = uvs[:12][(scene.vertices[scene.triangles[:12]] == corner).all(axis=2)]
    assert (uvs[12] == uvs[12, 0]).all() and (at_corner == uvs[12, 0]).all(axis=1).any()
    isolux.solve(scene, elements=500, rays=1e5).save("lit.isolux")
    assert ALL_KEPT in baked("kept", "--size", "64")


def test_a_density_gives_the_size_that_it_takes() -> None:
    pytest.importorskip("xatlas")
    scene = isolux.load("cubes")
    charts = isolux.unwrap(scene, texels_per_metre=20, padding=2)
    assert scene.lightmap_uvs is not None and charts.size % 4 == 0
    assert charts.texels_per_metre == pytest.approx(20, rel=0.05)
    assert scene.lightmap_uvs.min() > 2 / charts.size and 1 - scene.lightmap_uvs.max() > 2 / charts.size


def test_what_cannot_be_unwrapped_is_said_and_the_scene_stays_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("xatlas")
    scene = isolux.load("labyrinth")
    wrong: list[tuple[Callable[[], object], type[isolux.Error], str]] = [
        (lambda: isolux.unwrap(scene, size=3), isolux.ParameterError, "16 to 8192 texels"),
        (lambda: isolux.unwrap(scene, padding=0), isolux.ParameterError, "1 to 64 texels"),
        (lambda: isolux.unwrap(scene, size=64, texels_per_metre=5), isolux.ParameterError, "either a size or a density"),
        (lambda: isolux.unwrap(scene, texels_per_metre=float("nan")), isolux.ParameterError, "positive number"),
        (lambda: isolux.unwrap(scene, texels_per_metre=1e4), isolux.LightmapError, "8192 are the most"),
        (lambda: isolux.unwrap(scene, size=64), isolux.LightmapError, "772 charts with 4 texels of padding"),
        (lambda: isolux.unwrap(isolux.load("sphere")), isolux.LightmapError, "a sphere has no lightmap coordinates"),
        (lambda: isolux.unwrap(isolux.Scene.from_arrays([], [])), isolux.EmptyScene, "surface"),
    ]
    for call, error, words in wrong:
        with pytest.raises(error, match=words):
            call()
    monkeypatch.setitem(sys.modules, "xatlas", None)
    with pytest.raises(isolux.MissingPackage, match="pip install xatlas"):
        isolux.unwrap(scene)
    assert scene.lightmap_uvs is None
