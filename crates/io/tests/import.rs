//! Reading scenes: exact answers on tiny files, and the real rooms.

#![allow(clippy::unwrap_used, clippy::print_stderr)]

mod common;

use common::{floats, folder, glb, png, quad, write};
use glam::{Vec2, Vec3};
use isolux_core::math::Rgb;
use isolux_core::mesh::{ElementMesh, Resolution};
use isolux_core::scene::{LightKind, Projection, Scene, Wrap};
use isolux_io::import::{ImportOptions, Insides, LightUnits, read_scene};
use serde_json::{Value, json};
use std::f32::consts::PI;
use std::path::Path;

fn read_as(name: &str, bytes: &[u8], light_units: LightUnits) -> Result<Scene, String> {
    let folder = folder();
    let path = write(folder.path(), name, bytes);
    let options = ImportOptions { light_units, ..ImportOptions::default() };
    read_scene(&path, &options).map_err(|error| error.to_string())
}

fn read(name: &str, bytes: &[u8]) -> Scene {
    read_as(name, bytes, LightUnits::Spec).unwrap()
}

fn read_glb(document: &Value, binary: &[u8]) -> Scene {
    read("scene.glb", &glb(document, binary))
}

/// Twice the area of triangle `t`, along its normal.
fn cross(scene: &Scene, t: u32) -> Vec3 {
    let [a, b, c] = scene.corners(t);
    (b - a).cross(c - a)
}

fn has_remark(scene: &Scene, part: &str) -> bool {
    scene.remarks.iter().any(|remark| remark.contains(part))
}

/// One of the real rooms, if a folder `shared/scenes` is beside the workspace or above it.
fn room(name: &str) -> Option<Scene> {
    let folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().skip(2);
    let Some(path) = folders.map(|f| f.join("shared/scenes").join(name)).find(|path| path.exists()) else {
        eprintln!("shared/scenes/{name} is not there: skipped");
        return None;
    };
    Some(read_scene(&path, &ImportOptions::default()).unwrap())
}

#[test]
fn closed_things_have_no_inside_unless_it_is_kept() {
    // Two tetrahedra, one in the other.
    let corners = |size: f32| {
        [[-size, -size, -size], [3.0 * size, -size, -size], [-size, 3.0 * size, -size], [-size, -size, 3.0 * size]]
    };
    let vertex = |p: &[f32; 3]| format!("v {} {} {}\n", p[0], p[1], p[2]);
    let faces = |first: u32| {
        let face = |[a, b, c]: [u32; 3]| format!("f {} {} {}\n", first + a, first + b, first + c);
        [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(face).concat()
    };
    let all = |size: f32| corners(size).iter().map(vertex).collect::<String>();
    let file = format!("{}o room\n{}{}o thing\n{}", all(2.0), faces(1), all(0.5), faces(5));
    let folder = folder();
    let path = write(folder.path(), "two.obj", file.as_bytes());
    let read = |insides| read_scene(&path, &ImportOptions { insides, ..ImportOptions::default() }).unwrap();
    let (hidden, kept) = (read(Insides::Hide), read(Insides::Keep));
    let sides = |scene: &Scene| ElementMesh::new(scene, Resolution::MaxEdge(100.0)).unwrap().len();
    assert_eq!((sides(&hidden), sides(&kept)), (8, 16));
    assert!(has_remark(&hidden, "'room', 'thing': only the side") && !has_remark(&kept, "only the side"));
}

#[test]
fn the_living_room_is_read_whole() {
    let Some(scene) = room("living-room.glb") else { return };
    assert_eq!(scene.triangles.last().map(|t| t.source + 1), Some(143_171));
    assert_eq!(scene.triangles.len(), 143_171 - 190);
    assert_eq!((scene.images.len(), scene.materials.iter().filter(|m| m.is_emitter()).count()), (3, 1));
    assert!(ElementMesh::new(&scene, Resolution::default()).is_ok());
}

#[test]
fn the_classroom_is_read_whole() {
    let Some(scene) = room("classroom.glb") else { return };
    assert_eq!(scene.triangles.last().map(|t| t.source + 1), Some(103_838));
}

#[test]
fn a_textured_square_has_names_numbers_and_linear_colours() {
    let (document, binary) = quad();
    let scene = read_glb(&document, &binary);
    assert_eq!((scene.vertices.len(), scene.triangles.len(), scene.objects[0].name.as_str()), (4, 2, "wall"));
    assert_eq!((cross(&scene, 0), scene.triangles[1].source), (Vec3::Z, 1));
    assert_eq!((scene.vertices[0].uv, scene.name.as_str()), (Vec2::new(0.0, 1.0), "scene"));
    assert_eq!(scene.images[0].texels, [[0, 0, 0], [255, 255, 255], [255, 0, 0], [0, 255, 0]]);
    assert_eq!(scene.materials[0].reflectivity, Rgb::grey(0.5));
    let mesh = ElementMesh::new(&scene, Resolution::Elements(2)).unwrap();
    let mean = (mesh.reflectivity(0) + mesh.reflectivity(1)) * 0.5;
    assert!((mean - Rgb::new(0.25, 0.25, 0.125)).map(f32::abs).max_channel() < 1e-6);
    assert!(scene.remarks.is_empty(), "{:?}", scene.remarks);
}

#[test]
fn nodes_place_instances_and_mirrors_keep_fronts_in_front() {
    let (mut document, binary) = quad();
    document["scenes"][0]["nodes"] = json!([1, 3]);
    document["nodes"] = json!([
        {"mesh": 0},
        {"children": [2, 0], "translation": [0, 0, 5]},
        {"mesh": 0, "name": "turned", "rotation": [0, 0, 0.70710677, 0.70710677], "scale": [2, 1, 1]},
        {"mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
    ]);
    let scene = read_glb(&document, &binary);
    let names: Vec<&str> = scene.objects.iter().map(|o| o.name.as_str()).collect();
    assert_eq!(names, ["turned", "object 2", "object 3"]);
    assert!(scene.corners(0)[1].distance(Vec3::new(0.0, 2.0, 5.0)) < 1e-6);
    // The mirror keeps the front where a mirrored normal points: towards +z.
    assert_eq!((cross(&scene, 4), scene.corners(4)[0]), (Vec3::Z, Vec3::ZERO));
    assert_eq!(scene.triangles.iter().map(|t| t.source).collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5]);
}

#[test]
fn strips_fans_and_lists_without_indices_have_the_same_fronts() {
    for (mode, order) in [(5, vec![0_u8, 1, 3, 2]), (6, vec![0, 1, 2, 3]), (4, vec![0, 1, 2, 0, 2, 3])] {
        let (mut document, mut binary) = quad();
        binary.splice(0..order.len(), order.iter().copied());
        document["accessors"][0] =
            json!({"bufferView": 0, "componentType": 5121, "count": order.len(), "type": "SCALAR"});
        document["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        let scene = read_glb(&document, &binary);
        assert_eq!((cross(&scene, 0), cross(&scene, 1)), (Vec3::Z, Vec3::Z), "mode {mode}");
    }
    let (mut document, binary) = quad();
    document["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("indices");
    document["meshes"][0]["primitives"][0]["mode"] = json!(6);
    assert_eq!(read_glb(&document, &binary).triangles.len(), 2);
    document["meshes"][0]["primitives"][0]["mode"] = json!(1);
    let scene = read_glb(&document, &binary);
    assert!(scene.triangles.is_empty() && has_remark(&scene, "points and lines"));
}

#[test]
fn texture_transforms_and_wrap_modes_are_kept() {
    let (mut document, binary) = quad();
    document["samplers"] = json!([{"wrapS": 33071, "wrapT": 33648}]);
    document["textures"][0]["sampler"] = json!(0);
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 0, "texCoord": 7,
        "extensions": {"KHR_texture_transform":
            {"offset": [0.25, 0.5], "rotation": PI / 2.0, "scale": [2.0, 4.0], "texCoord": 0}}});
    let scene = read_glb(&document, &binary);
    let texture = scene.materials[0].reflectivity_texture.unwrap();
    assert_eq!((texture.wrap_u, texture.wrap_v), (Wrap::ClampToEdge, Wrap::MirroredRepeat));
    // Scaled to (2 u, 4 v), then (1, 0) turns to (0, -1) and (0, 1) to (1, 0).
    let expected =
        [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)].map(|(u, v)| Vec2::new(0.25 + 4.0 * v, 0.5 - 2.0 * u));
    for (vertex, expected) in scene.vertices.iter().zip(expected) {
        assert!(vertex.uv.distance(expected) < 1e-5, "{} is not {expected}", vertex.uv);
    }
}

#[test]
fn quantised_sparse_and_interleaved_attributes_are_read() {
    let (mut document, mut binary) = quad();
    let start = binary.len();
    // Interleaved: three i8 normalised positions and a gap, two u16 normalised texture coordinates, three u8 colours and a gap.
    for (x, y) in [(0_i8, 0_i8), (127, 0), (127, 127), (0, -128)] {
        binary.extend([x.cast_unsigned(), y.cast_unsigned(), 0, 0]);
        binary.extend([u16::MAX, 0].map(u16::to_le_bytes).concat());
        binary.extend([255, 51, 0, 0]);
    }
    let sparse = binary.len();
    binary.extend([3, 0, 0, 0]);
    binary.extend([0, 127, 0, 0]);
    let views = document["bufferViews"].as_array_mut().unwrap();
    views.push(json!({"buffer": 0, "byteOffset": start, "byteLength": 48, "byteStride": 12}));
    views.push(json!({"buffer": 0, "byteOffset": sparse, "byteLength": 8}));
    document["accessors"].as_array_mut().unwrap().extend([
        json!({"bufferView": 4, "componentType": 5120, "normalized": true, "count": 4, "type": "VEC3", "sparse": {
            "count": 1, "indices": {"bufferView": 5, "componentType": 5121}, "values": {"bufferView": 5, "byteOffset": 4}}}),
        json!({"bufferView": 4, "byteOffset": 4, "componentType": 5123, "normalized": true, "count": 4, "type": "VEC2"}),
        json!({"bufferView": 4, "byteOffset": 8, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC3"}),
    ]);
    document["meshes"][0]["primitives"][0]["attributes"] = json!({"POSITION": 3, "TEXCOORD_0": 4, "COLOR_0": 5});
    document["buffers"][0]["byteLength"] = json!(binary.len());
    document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let scene = read_glb(&document, &binary);
    assert_eq!(scene.vertices[3].position, Vec3::Y);
    assert_eq!((scene.vertices[2].uv, scene.vertices[2].color), (Vec2::X, Rgb::new(1.0, 0.2, 0.0)));
    assert_eq!(cross(&scene, 1), Vec3::Z);
}

#[test]
fn emission_is_pi_times_luminance() {
    let (mut document, binary) = quad();
    document["materials"][0]["emissiveFactor"] = json!([1.0, 0.5, 0.0]);
    document["materials"][0]["emissiveTexture"] = json!({"index": 0});
    document["materials"][0]["extensions"] = json!({"KHR_materials_emissive_strength": {"emissiveStrength": 1000.0}});
    document["materials"][0]["doubleSided"] = json!(true);
    let scene = read_glb(&document, &binary);
    assert_eq!(scene.materials[0].emission, Rgb::new(1.0, 0.5, 0.0) * 1000.0 * PI);
    assert!(scene.materials[0].two_sided && scene.images.len() == 1);
    let mesh = ElementMesh::new(&scene, Resolution::Elements(4)).unwrap();
    let flux = mesh.total_emitted_flux();
    // Half the texels are red, half green; both sides of one square metre shine.
    assert!((flux[0] / (1000.0 * std::f64::consts::PI) - 1.0).abs() < 1e-5 && flux[2] == 0.0, "{flux:?}");
}

#[test]
fn lights_and_cameras_are_placed_and_in_units() {
    let (mut document, binary) = quad();
    document["scenes"][0]["nodes"] = json!([0, 1, 2, 3, 4, 5]);
    let light = |k: u32| json!({"KHR_lights_punctual": {"light": k}});
    document["nodes"].as_array_mut().unwrap().extend([
        json!({"name": "bulb", "translation": [1, 2, 3], "scale": [9, 9, 9], "extensions": light(0)}),
        json!({"rotation": [-0.70710677, 0, 0, 0.70710677], "extensions": light(1)}),
        json!({"extensions": light(2)}),
        json!({"camera": 0, "translation": [0, 1, 0]}),
        json!({"camera": 1}),
    ]);
    document["cameras"] = json!([
        {"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1, "aspectRatio": 1.5}},
        {"type": "orthographic", "name": "plan", "orthographic": {"xmag": 4, "ymag": 2, "znear": 0, "zfar": 9}}]);
    document["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "intensity": 100.0, "color": [1, 0.5, 0]},
        {"type": "spot", "intensity": 10.0, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.3}},
        {"type": "directional", "intensity": 2.0}]}});
    for (units, candela, lux, word) in [
        (LightUnits::Spec, 1.0, 1.0, "spec"),
        (LightUnits::Compat, 683.0, 683.0, "compat"),
        (LightUnits::Raw, 683.0 / (4.0 * PI), 683.0, "raw"),
    ] {
        let scene = read_as("scene.glb", &glb(&document, &binary), units).unwrap();
        let [bulb, spot, sun] = &scene.lights[..] else { panic!("{:?}", scene.lights) };
        assert_eq!((bulb.name.as_str(), bulb.kind), ("bulb", LightKind::Point { position: Vec3::new(1., 2., 3.) }));
        assert_eq!(bulb.intensity, Rgb::new(100.0, 50.0, 0.0) * candela);
        assert_eq!(sun.intensity, Rgb::grey(2.0) * lux);
        let LightKind::Spot { direction, inner_angle, outer_angle, .. } = spot.kind else { panic!("{spot:?}") };
        assert!(direction.distance(Vec3::NEG_Y) < 1e-6 && (inner_angle, outer_angle) == (0.1, 0.3));
        assert_eq!(sun.kind, LightKind::Directional { direction: Vec3::NEG_Z });
        assert!(has_remark(&scene, word), "{:?}", scene.remarks);
        let [view, plan] = &scene.cameras[..] else { panic!("{:?}", scene.cameras) };
        assert_eq!(view.projection, Projection::Perspective { vertical_angle: 0.8 });
        assert_eq!((view.position, view.forward, view.up, view.aspect), (Vec3::Y, Vec3::NEG_Z, Vec3::Y, Some(1.5)));
        assert_eq!((plan.projection, plan.name.as_str()), (Projection::Orthographic { height: 4.0 }, "plan"));
    }
}

#[test]
fn external_and_embedded_buffers_and_images_are_found() {
    let (mut document, binary) = quad();
    let folder = folder();
    let from_chunk = read_glb(&document, &binary);
    write(folder.path(), "my buffer.bin", &binary);
    write(folder.path(), "tiles.png", &png(2, &[[0, 0, 0], [255, 255, 255], [255, 0, 0], [0, 255, 0]]));
    document["buffers"][0]["uri"] = json!("my%20buffer.bin");
    document["images"][0] = json!({"uri": "tiles.png"});
    let path = write(folder.path(), "room.gltf", document.to_string().as_bytes());
    let external = read_scene(&path, &ImportOptions::default()).unwrap();
    let encoded = base64::Engine::encode(&base64::engine::general_purpose::STANDARD, &binary);
    document["buffers"][0]["uri"] = json!(format!("data:application/octet-stream;base64,{encoded}"));
    let embedded =
        read_scene(&write(folder.path(), "a.gltf", document.to_string().as_bytes()), &ImportOptions::default());
    assert_eq!([external.hash(), embedded.unwrap().hash()], [from_chunk.hash(); 2]);
    std::fs::remove_file(folder.path().join("tiles.png")).unwrap();
    let error = read_scene(&path, &ImportOptions::default()).unwrap_err().to_string();
    assert!(error.contains("tiles.png") && error.contains("cannot read"), "{error}");
}

#[test]
fn what_is_not_diffuse_is_said_in_one_sentence() {
    let (mut document, binary) = quad();
    let material = &mut document["materials"][0];
    material["pbrMetallicRoughness"]["metallicFactor"] = json!(1.0);
    material["normalTexture"] = json!({"index": 0});
    material["alphaMode"] = json!("BLEND");
    document["animations"] = json!([]);
    document["extensionsUsed"] = json!(["ACME_glitter", "KHR_materials_clearcoat", "KHR_materials_unlit"]);
    let scene = read_glb(&document, &binary);
    assert_eq!(scene.remarks.len(), 2, "{:?}", scene.remarks);
    assert!(has_remark(&scene, "1 of 1 materials are metallic"));
    assert!(has_remark(
        &scene,
        "extension ACME_glitter (1), extension KHR_materials_clearcoat (1), normal maps (1), transparent materials"
    ));
}

#[test]
fn unlit_materials_reflect_their_colour_and_say_so() {
    let (mut document, binary) = quad();
    document["materials"][0]["extensions"] = json!({"KHR_materials_unlit": {}});
    let scene = read_glb(&document, &binary);
    assert_eq!((scene.materials[0].reflectivity, scene.materials[0].is_emitter()), (Rgb::grey(0.5), false));
    assert!(has_remark(&scene, "1 of 1 materials are unlit"));
}

#[test]
fn specular_glossiness_gives_its_diffuse_colour() {
    let (mut document, binary) = quad();
    document["materials"][0] =
        json!({"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.1, 0.2, 0.3, 1]}}});
    assert_eq!(read_glb(&document, &binary).materials[0].reflectivity, Rgb::new(0.1, 0.2, 0.3));
}

#[test]
fn degenerate_triangles_are_dropped_and_still_counted() {
    let (document, mut binary) = quad();
    binary[2..4].copy_from_slice(&0_u16.to_le_bytes());
    let scene = read_glb(&document, &binary);
    assert_eq!((scene.triangles.len(), scene.triangles[0].source), (1, 1));
    assert!(has_remark(&scene, "1 of 2 triangles have no area"));
}

#[test]
fn obj_files_have_groups_polygons_and_materials() {
    let folder = folder();
    write(folder.path(), "wood.png", &png(1, &[[255, 0, 0], [0, 0, 255]]));
    let mtl = "# two\nnewmtl wood\nKd 0.5 0.5 0.5\nmap_Kd -s 1 1 1 wood.png\nnewmtl lamp\nKd 0.2\nKe 10 20 30\n";
    write(folder.path(), "room.mtl", mtl.as_bytes());
    let obj = "mtllib room.mtl\nmtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0.5 0 # right\nvt 0 0\nvt 1 1\n\
        o wall\nusemtl wood\nf 1/1 2/1 3/2 4/2\no lamp\nusemtl lamp\nf -4//1 5 -3\no wall\nusemtl wood\nf 1/1 3/2 2/1\n";
    let path = write(folder.path(), "room.obj", obj.as_bytes());
    let scene = read_scene(&path, &ImportOptions::default()).unwrap();
    let names: Vec<&str> = scene.objects.iter().map(|o| o.name.as_str()).collect();
    assert_eq!(names, ["wall", "lamp"]);
    assert_eq!(
        scene.triangles.iter().map(|t| (t.object, t.source)).collect::<Vec<_>>(),
        [(0, 0), (0, 1), (1, 2), (0, 3)]
    );
    assert_eq!(scene.materials[1].emission, Rgb::new(10., 20., 30.) * PI);
    assert_eq!(scene.materials[1].reflectivity, Rgb::grey(0.2));
    let texture = scene.materials[0].reflectivity_texture.unwrap();
    // v = 0 is the lower edge of the image.
    let lower = scene.images[0].sample(scene.vertices[0].uv - Vec2::new(0.0, 0.25), texture.wrap_u, texture.wrap_v);
    assert_eq!(lower, Rgb::new(0.0, 0.0, 1.0));
    assert!(scene.materials.iter().all(|m| m.two_sided));
    for part in ["lost.mtl", "metres", "both", "cd/m²"] {
        assert!(has_remark(&scene, part), "{part}: {:?}", scene.remarks);
    }
    assert!(read_as("a.obj", b"v 0 0 0\nf 1 2 3\n", LightUnits::Spec).unwrap_err().contains("line 2"));
}

const PLY: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\n\
    property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
    property list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 255 0 0\n1 1 0 255 0 0\n0 1 0 0 0 0\n4 0 1 2 3\n";

#[test]
fn ply_files_have_polygons_and_colours() {
    let scene = read("square.ply", PLY.as_bytes());
    assert_eq!((scene.triangles.len(), cross(&scene, 1), scene.objects[0].name.as_str()), (2, Vec3::Z, "square"));
    assert_eq!((scene.vertices[0].color, scene.vertices[3].color), (Rgb::new(1., 0., 0.), Rgb::BLACK));
    for (format, big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let header = PLY.split("end_header").next().unwrap().replace("ascii", format);
        let mut bytes = format!("{header}end_header\n").into_bytes();
        for [x, y] in [[0_f32, 0.], [1., 0.], [1., 1.], [0., 1.]] {
            [x, y, 0.0].iter().for_each(|v| bytes.extend(if big { v.to_be_bytes() } else { v.to_le_bytes() }));
            bytes.extend([255, 255, 255]);
        }
        bytes.push(4);
        (0..4_i32).for_each(|v| bytes.extend(if big { v.to_be_bytes() } else { v.to_le_bytes() }));
        assert_eq!(cross(&read("square.ply", &bytes), 0), Vec3::Z, "{format}");
    }
}

#[test]
fn stl_files_are_told_apart_by_what_is_in_them() {
    let ascii = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n\
        solid second part\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 1\nVERTEX 1 0 1\nVERTEX 0 1 1\nENDLOOP\nENDFACET\n";
    let scene = read("part.stl", ascii.as_bytes());
    let names: Vec<&str> = scene.objects.iter().map(|o| o.name.as_str()).collect();
    assert_eq!((names, cross(&scene, 1)), (vec!["object 1", "second part"], Vec3::Z));
    let mut binary = b"solid, says the header of a binary file".to_vec();
    binary.resize(80, b' ');
    binary.extend(1_u32.to_le_bytes());
    binary.extend(floats(&[0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0.]));
    binary.extend([0, 0]);
    assert_eq!(cross(&read("part.stl", &binary), 0), Vec3::Z);
    assert!(read_as("part.stl", &binary[..100], LightUnits::Spec).is_err());
}

#[test]
fn an_unknown_extension_lists_the_known_ones() {
    let error = read_as("scene.blend", b"", LightUnits::Spec).unwrap_err();
    for part in ["scene.blend", ".glb", ".obj", ".ply", ".stl", "export"] {
        assert!(error.contains(part), "{error}");
    }
}
