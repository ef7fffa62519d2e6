"""Scenes: loaded, made of arrays and of meshes of other packages, edited by name."""

from pathlib import Path

import numpy as np
import pytest

import isolux
from conftest import box


def test_built_in_scenes_come_by_name_and_say_what_is_in_them() -> None:
    scene = isolux.load("labyrinth:rho=0.3")
    assert scene.name == "labyrinth" and scene.check().is_fine
    assert "38 triangles in 8 objects" in repr(isolux.load("cornell-box"))
    assert isolux.load("cornell-box").check().flux == pytest.approx({"light": 0.6175}, rel=1e-3)
    for name in isolux.names("scenes"):
        assert isolux.load(name).name == name


def test_what_cannot_be_loaded_raises_the_exception_of_its_kind(tmp_path: Path) -> None:
    with pytest.raises(isolux.UnknownName, match="did you mean 'office'") as name:
        isolux.load("offise")
    assert (name.value.kind, name.value.nearest) == ("built-in scene", "office") and isinstance(name.value, KeyError)
    with pytest.raises(isolux.ParameterError, match="rho = 2"):
        isolux.load("labyrinth:rho=2")
    with pytest.raises(FileNotFoundError, match=r"none\.glb") as missing:
        isolux.load(tmp_path / "none.glb")
    assert isinstance(missing.value, isolux.MissingFile) and missing.value.filename.endswith("none.glb")
    (tmp_path / "a.glb").write_bytes(b"no glTF at all")
    with pytest.raises(isolux.InvalidFile) as invalid:
        isolux.load(tmp_path / "a.glb")
    assert invalid.value.file.endswith("a.glb") and invalid.value.place and isinstance(invalid.value, ValueError)
    (tmp_path / "a.txt").write_text("hello")
    with pytest.raises(isolux.UnknownFormat, match=r"\.glb"):
        isolux.load(tmp_path / "a.txt")
    with pytest.raises(isolux.UnknownFormat, match=r"isolux\.open"):
        isolux.load(tmp_path / "a.isolux")


def test_materials_objects_and_lights_are_edited_by_name() -> None:
    scene = isolux.load("cornell-box")
    scene.materials["white"].reflectivity = 0.25
    assert scene.materials["white"].reflectivity == (0.25, 0.25, 0.25)
    scene.materials["light"].luminance = (1, 2, 3)
    assert scene.materials["light"].emission == pytest.approx((np.pi, 2 * np.pi, 3 * np.pi), rel=1e-6)
    scene.objects["floor"].material = scene.add_material("oak", reflectivity=(0.4, 0.3, 0.2), two_sided=True)
    assert scene.objects["floor"].material.name == "oak" and scene.materials["oak"].two_sided
    scene.objects["back"].material = "red"
    assert scene.objects[3].material.number == scene.materials["red"].number
    lamp = scene.add_spot_light("spot", (0, 1, 0), (0, 0, 0), 300, outer_angle=30)
    scene.add_point_light("bulb", (0, 1, 0), (1, 2, 3))
    scene.lights["bulb"].position = (0, 2, 0)
    assert lamp.kind == "spot" and lamp.direction == (0, -1, 0) and scene.lights["bulb"].position == (0, 2, 0)
    with pytest.raises(isolux.ParameterError, match="a point light has none"):
        scene.lights["bulb"].direction = (0, 1, 0)
    scene.remove(lamp)
    assert scene.lights.names == ["bulb"]
    scene.add_camera("door", (0, 1.6, 3), (0, 1, 0))
    assert scene.cameras["door"].forward[2] < 0


def test_wrong_edits_change_nothing_and_say_why() -> None:
    scene = isolux.load("cornell-box")
    for wrong in (1.0, -0.1, (0.1, 0.2), float("nan"), "white"):
        with pytest.raises((isolux.ParameterError, ValueError)):
            scene.materials["white"].reflectivity = wrong  # type: ignore[assignment]
    assert scene.materials["white"].reflectivity[0] > 0.5
    with pytest.raises(isolux.UnknownName, match="did you mean 'white'"):
        scene.materials["whit"]
    with pytest.raises(IndexError):
        scene.objects[99]
    other = isolux.load("cornell-box")
    with pytest.raises(isolux.ParameterError, match="same scene"):
        scene.objects["floor"].material = other.materials["red"]


def test_a_copy_is_a_scene_of_its_own_and_a_file_brings_it_back(tmp_path: Path, cube: isolux.Scene) -> None:
    copy = cube.copy()
    copy.materials["floor"].reflectivity = 0.1
    assert cube.materials["floor"].reflectivity == (0.5, 0.5, 0.5)
    copy.save(tmp_path / "cube.glb")
    again = isolux.load(tmp_path / "cube.glb")
    assert again.materials["floor"].reflectivity == pytest.approx((0.1, 0.1, 0.1))
    assert again.materials["ceiling"].emission == pytest.approx((100, 100, 100), rel=1e-6)
    with pytest.raises(isolux.UnknownFormat):
        copy.save(tmp_path / "cube.obj")


def test_arrays_make_scenes_with_colours_by_all_by_triangle_and_by_object() -> None:
    scene = box(reflectivity={"floor": (0.1, 0.2, 0.3)})
    assert scene.check().flux == pytest.approx({"ceiling": 100.0})
    assert scene.materials["floor"].reflectivity == pytest.approx((0.1, 0.2, 0.3))
    assert scene.objects.names == ["floor", "ceiling", "back", "front", "left", "right"]
    assert scene.vertices.shape == (8, 3) and scene.triangles.shape == (12, 3) and scene.bounds.tolist() == [[0, 0, 0], [1, 1, 1]]
    shares = np.linspace(0.1, 0.6, 12)
    assert box(reflectivity=shares).objects.names[:2] == ["floor 1", "floor 2"]
    by_triangle = box(reflectivity=np.repeat(shares[::2], 2), emission=0.0)
    assert by_triangle.materials["back"].reflectivity[0] == pytest.approx(shares[4])
    assert by_triangle.objects.names == scene.objects.names


def test_arrays_that_make_no_sense_are_refused_with_the_reason() -> None:
    corners, triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
    make = isolux.Scene.from_arrays
    for wrong, reason in [
        (lambda: make(corners, [[0, 1, 3]]), "numbers of vertices, 0 to 2"),
        (lambda: make(corners, [[0, 1]]), "shape"),
        (lambda: make(corners, [[0.5, 1, 2]]), "whole numbers"),
        (lambda: make([[0, 0, np.nan], *corners[1:]], triangle), "not a finite number"),
        (lambda: make(corners, triangle, objects=["a", "b"]), "a name for each of the 1 triangles"),
        (lambda: make(corners, triangle, reflectivity=np.zeros((2, 3))), "one for each triangle"),
        (lambda: make(corners, triangle, reflectivity={"wall": 0.1}), "no object called 'wall'"),
        (lambda: make(corners, triangle, emission=-1), "none below 0"),
    ]:
        with pytest.raises(isolux.Error, match=reason):
            wrong()
    flat = make([*corners, [2, 0, 0]], [[0, 1, 2], [0, 1, 3]])
    assert len(flat.triangles) == 1 and "1 triangles without area" in flat.remarks[0]
    with pytest.raises(isolux.EmptyScene):
        isolux.solve(make(np.empty((0, 3)), np.empty((0, 3), dtype=int)))


def test_a_trimesh_becomes_a_scene() -> None:
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.5)
    ball.visual.face_colors = [188, 0, 255, 255]
    scene = isolux.Scene.from_trimesh(ball, emission=2.0)
    assert scene.check().flux == pytest.approx({"trimesh": 2 * ball.area}, rel=1e-5)
    assert scene.materials[0].reflectivity == pytest.approx((0.5, 0, 0.95), abs=0.01)
    two = trimesh.Scene()
    two.add_geometry(ball, node_name="one")
    two.add_geometry(ball, node_name="other", transform=trimesh.transformations.translation_matrix([3, 0, 0]))
    scene = isolux.Scene.from_trimesh(two, reflectivity={"one": 0.1})
    assert sorted(scene.objects.names) == ["one", "other"] and scene.bounds[1, 0] == pytest.approx(3.5, abs=0.01)
    with pytest.raises(isolux.UnreadableObject, match="ndarray"):
        isolux.Scene.from_trimesh(np.zeros(3))


def test_pyvista_data_sets_become_scenes() -> None:
    pyvista = pytest.importorskip("pyvista")
    scene = isolux.Scene.from_pyvista(pyvista.Cube(x_length=2), emission=1.0)
    assert scene.check().area == pytest.approx(10.0) and len(scene.triangles) == 12
    blocks = pyvista.MultiBlock({"a": pyvista.Plane(), "b": pyvista.Cube().cast_to_unstructured_grid()})
    scene = isolux.Scene.from_pyvista(blocks, emission={"a": 5.0})
    assert scene.objects.names == ["a", "b"] and scene.check().flux == pytest.approx({"a": 5.0}, rel=1e-4)
    with pytest.raises(isolux.UnreadableObject, match="list"):
        isolux.Scene.from_pyvista([1, 2])
