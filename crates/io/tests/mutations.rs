//! Broken files: every one is an error with its place, and never a panic, a hang or a flood of memory.

#![allow(clippy::unwrap_used)]

mod common;

use common::{folder, glb, png, quad, write};
use isolux_io::import::{ImportOptions, read_scene};
use serde_json::{Value, json};
use std::path::Path;
use std::time::{Duration, Instant};

/// A generator of its own (SplitMix64, Steele et al. 2014), so that the mutations never change.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

/// Numbers that programs trip over.
const NUMBERS: [&str; 12] = [
    "0",
    "-1",
    "1",
    "3",
    "255",
    "65536",
    "2147483648",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "1e39",
    "0.5",
];

/// Changes one to three things in `bytes`.
fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..1 + random.below(3) {
        let at = random.below(bytes.len());
        match random.below(6) {
            0 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
            1 if !bytes.is_empty() => bytes[at] = [0, 0xff, 0x7f, 0x80, b'-', b'/'][random.below(6)],
            2 => bytes.truncate(at),
            3 => {
                let end = (at + random.below(40)).min(bytes.len());
                let piece: Vec<u8> = bytes[at..end].to_vec();
                let target = random.below(bytes.len());
                bytes.splice(target..target, piece);
            }
            4 => drop(bytes.drain(at..(at + random.below(20)).min(bytes.len()))),
            _ => {
                // Another number in place of one: in JSON or text this is what breaks counts, offsets and indices.
                let digits = (at..bytes.len()).find(|&k| bytes[k].is_ascii_digit());
                let Some(start) = digits else { continue };
                let length = bytes[start..].iter().take_while(|b| b.is_ascii_digit() || **b == b'.').count();
                let number = NUMBERS[random.below(NUMBERS.len())];
                bytes.splice(start..start + length, number.bytes());
            }
        }
    }
}

/// Repairs the lengths in a GLB after its JSON changed, so that mutations get past the header.
fn with_json(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let mut bytes = glb(&Value::Null, binary);
    let mut json = json.to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    bytes.splice(12..24, [(json.len() as u32).to_le_bytes().to_vec(), b"JSON".to_vec(), json].concat());
    let length = bytes.len() as u32;
    bytes.splice(8..12, length.to_le_bytes());
    bytes
}

/// A document that uses most of what is read.
fn rich() -> (Value, Vec<u8>) {
    let (mut document, binary) = quad();
    document["samplers"] = json!([{"wrapS": 33071}]);
    document["textures"][0]["sampler"] = json!(0);
    document["materials"][0]["emissiveFactor"] = json!([1, 1, 1]);
    document["materials"][0]["emissiveTexture"] =
        json!({"index": 0, "extensions": {"KHR_texture_transform": {"rotation": 1}}});
    document["nodes"][0]["children"] = json!([1, 2]);
    document["nodes"].as_array_mut().unwrap().extend([
        json!({"camera": 0, "mesh": 0, "scale": [1, 2, -3]}),
        json!({"extensions": {"KHR_lights_punctual": {"light": 0}}, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}),
    ]);
    document["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]);
    document["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 5, "spot": {}}]}});
    document["accessors"][1]["sparse"] = json!({"count": 1, "indices": {"bufferView": 0, "componentType": 5123},
        "values": {"bufferView": 1}});
    (document, binary)
}

const OBJ: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 0.5 0\nv 0 1 0 1 0 0\nvt 0 0\nvt 1 1\no a\nusemtl w\nf 1/1 2/2 3/1 4/2 5/1\nf -1 -2 -3\n";
const MTL: &str = "newmtl w\nKd 0.5 0.5 0.5\nKe 1 2 3\nmap_Kd -clamp on t.png\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty double z\nproperty uchar red\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 255\n1 0 0 9\n0 1 0 0\n3 0 1 2\n";
const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";

fn binary_ply() -> Vec<u8> {
    let mut bytes = PLY.split("0 0 0 255").next().unwrap().replace("ascii", "binary_little_endian").into_bytes();
    for [x, y] in [[0_f32, 0.0], [1.0, 0.0], [0.0, 1.0]] {
        bytes.extend([x.to_le_bytes().to_vec(), y.to_le_bytes().to_vec(), vec![0; 9]].concat());
    }
    bytes.extend([3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]);
    bytes
}

fn binary_stl() -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(2_u32.to_le_bytes());
    for _ in 0..2 {
        bytes.extend(common::floats(&[0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0.]));
        bytes.extend([0, 0]);
    }
    bytes
}

#[test]
fn two_thousand_mutations_are_read_or_refused() {
    let folder = folder();
    let (document, binary) = rich();
    let json = document.to_string().into_bytes();
    write(folder.path(), "m.mtl", MTL.as_bytes());
    let texture = png(2, &[[9; 3]; 4]);
    write(folder.path(), "t.png", &texture);
    let sources: Vec<(&str, Vec<u8>)> = vec![
        ("a.glb", glb(&document, &binary)),
        ("json", json),
        ("json", document.to_string().into_bytes()),
        ("binary", binary.clone()),
        ("a.obj", OBJ.as_bytes().to_vec()),
        ("m.mtl", MTL.as_bytes().to_vec()),
        ("t.png", texture),
        ("a.ply", PLY.as_bytes().to_vec()),
        ("a.ply", binary_ply()),
        ("a.stl", STL.as_bytes().to_vec()),
        ("a.stl", binary_stl()),
    ];
    let mut random = Random(1);
    let (mut read, mut refused) = (0, 0);
    for k in 0..2200 {
        let (name, source) = &sources[k % sources.len()];
        let mut bytes = source.clone();
        if k >= sources.len() {
            mutate(&mut bytes, &mut random);
        }
        let path = match *name {
            "json" => write(folder.path(), "a.glb", &with_json(&bytes, &binary)),
            "binary" => write(folder.path(), "a.glb", &glb(&document, &bytes)),
            "m.mtl" | "t.png" => {
                write(folder.path(), name, &bytes);
                write(folder.path(), "a.obj", OBJ.as_bytes())
            }
            _ => write(folder.path(), name, &bytes),
        };
        let start = Instant::now();
        match read_scene(&path, &ImportOptions::default()) {
            Ok(_) => read += 1,
            Err(error) if k < sources.len() => panic!("{name} should be read as it is: {error}"),
            Err(_) => refused += 1,
        }
        assert!(start.elapsed() < Duration::from_secs(5), "mutation {k} of {name} takes too long");
        if ["m.mtl", "t.png"].contains(name) {
            write(folder.path(), "m.mtl", MTL.as_bytes());
            write(folder.path(), "t.png", &sources[6].1);
        }
    }
    // Neither is everything refused nor nothing.
    assert!(read > 300 && refused > 300, "{read} read, {refused} refused");
}

/// Memory the process ever had, in MiB, where the system tells.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<u64>().ok()? / 1024)
}

fn refusal(folder: &Path, bytes: &[u8]) -> String {
    let path = write(folder, "bad.glb", bytes);
    read_scene(&path, &ImportOptions::default()).expect_err("this should be refused").to_string()
}

#[test]
fn bad_gltf_files_are_refused_with_their_place() {
    type Edit = fn(&mut Value);
    const CASES: &[(&str, Edit)] = &[
        ("asset/version: glTF 1.0", |d| d["asset"]["version"] = json!("1.0")),
        ("missing field `asset`", |d| drop(d.as_object_mut().unwrap().remove("asset"))),
        ("extensionsRequired/0: the file cannot be read without KHR_draco_mesh_compression", |d| {
            d["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
        }),
        ("extensionsRequired/1: the file cannot be read without EXT_mesh_gpu_instancing", |d| {
            d["extensionsRequired"] = json!(["KHR_mesh_quantization", "EXT_mesh_gpu_instancing"]);
        }),
        ("scene: it refers to scenes/7", |d| d["scene"] = json!(7)),
        ("scenes/0: it refers to nodes/9", |d| d["scenes"][0]["nodes"] = json!([9])),
        ("nodes/0: it is reached a second time, from nodes/0", |d| d["nodes"][0]["children"] = json!([0])),
        ("nodes/0: it is reached a second time, from scenes/0", |d| d["scenes"][0]["nodes"] = json!([0, 0])),
        ("nodes/0: its matrix is not finite", |d| d["nodes"][0]["scale"] = json!([1e39, 1, 1])),
        ("nodes/0: it refers to meshes/3", |d| d["nodes"][0]["mesh"] = json!(3)),
        ("meshes/0/primitives/0: it has no POSITION", |d| d["meshes"][0]["primitives"][0]["attributes"] = json!({})),
        ("meshes/0/primitives/0: its mode", |d| d["meshes"][0]["primitives"][0]["mode"] = json!(99)),
        ("meshes/0/primitives/0: it refers to materials/5", |d| d["meshes"][0]["primitives"][0]["material"] = json!(5)),
        ("meshes/0/primitives/0/indices: it refers to accessors/44", |d| {
            d["meshes"][0]["primitives"][0]["indices"] = json!(44);
        }),
        ("meshes/0/primitives/0/indices: accessors/1: elements of type Vec3", |d| {
            d["meshes"][0]["primitives"][0]["indices"] = json!(1);
        }),
        ("meshes/0/primitives/0/indices: 5 corners", |d| d["accessors"][0]["count"] = json!(5)),
        ("meshes/0/primitives/0/attributes/POSITION: 5 elements of 12 bytes", |d| {
            d["accessors"][1]["count"] = json!(5)
        }),
        ("meshes/0/primitives/0/attributes/POSITION: 18446744073709551615 elements", |d| {
            d["accessors"][1]["count"] = json!(u64::MAX);
        }),
        ("meshes/0/primitives/0/attributes/POSITION: accessors/1: 4294967295 elements without", |d| {
            d["accessors"][1] = json!({"componentType": 5126, "count": u32::MAX, "type": "VEC3"});
        }),
        ("meshes/0/primitives/0/attributes/POSITION: accessors/1: its type", |d| {
            d["accessors"][1]["componentType"] = json!(5124);
        }),
        ("meshes/0/primitives/0/attributes/POSITION/sparse: its indices must rise", |d| {
            d["accessors"][1]["sparse"] = json!({"count": 3, "indices": {"bufferView": 0, "byteOffset": 6, "componentType": 5121},
                "values": {"bufferView": 1}});
        }),
        ("meshes/0/primitives/0/attributes/TEXCOORD_0: it has 3 elements for 4 vertices", |d| {
            d["accessors"][2]["count"] = json!(3);
        }),
        ("bufferViews/1: 48 bytes from 18446744073709551615", |d| d["bufferViews"][1]["byteOffset"] = json!(u64::MAX)),
        ("bufferViews/1: it refers to buffers/2", |d| d["bufferViews"][1]["buffer"] = json!(2)),
        ("buffers/0: it should have 99999 bytes", |d| d["buffers"][0]["byteLength"] = json!(99_999)),
        ("buffers/0: its data URI is broken", |d| d["buffers"][0]["uri"] = json!("data:;base64,####")),
        ("buffers/0: https://example.org/a.bin", |d| d["buffers"][0]["uri"] = json!("https://example.org/a.bin")),
        ("textures/0: it refers to images/8", |d| d["textures"][0]["source"] = json!(8)),
        ("materials/0/baseColorTexture: it refers to textures/6", |d| {
            d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = json!(6);
        }),
        ("images/0: it has neither", |d| d["images"][0] = json!({})),
        ("images/0: this is no PNG", |d| d["images"][0]["bufferView"] = json!(1)),
        ("samplers/0/wrapT", |d| {
            d["samplers"] = json!([{"wrapT": 5}]);
            d["textures"][0]["sampler"] = json!(0);
        }),
        ("materials/0: reflectivity [-0.5", |d| {
            d["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([-0.5, 0.5, 0.5, 1]);
        }),
        ("materials/0: emission [inf", |d| d["materials"][0]["emissiveFactor"] = json!([1e39, 0, 0])),
        ("materials/0/pbrMetallicRoughness/baseColorFactor", |d| {
            d["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!("red");
        }),
        ("cameras/0: yfov 4", |d| {
            d["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 4, "znear": 1}}]);
            d["nodes"][0]["camera"] = json!(0);
        }),
        ("extensions/KHR_lights_punctual/lights/0: intensity", |d| {
            d["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": -1}]}});
            d["nodes"][0]["extensions"] = json!({"KHR_lights_punctual": {"light": 0}});
        }),
        ("nodes/0: it refers to extensions/KHR_lights_punctual/lights/1", |d| {
            d["nodes"][0]["extensions"] = json!({"KHR_lights_punctual": {"light": 1}});
        }),
    ];
    let folder = folder();
    for (expected, edit) in CASES {
        let (mut document, binary) = quad();
        edit(&mut document);
        let error = refusal(folder.path(), &glb(&document, &binary));
        assert!(error.contains("bad.glb: ") && error.contains(expected), "'{expected}' is not in: {error}");
    }
}

#[test]
fn bad_bytes_are_refused_with_their_place() {
    let folder = folder();
    let (document, binary) = quad();
    let whole = glb(&document, &binary);
    for (expected, bytes) in [
        ("header: it says", whole[..whole.len() - 4].to_vec()),
        ("header: the file ends", whole[..6].to_vec()),
        ("header: version 1", [b"glTF\x01\0\0\0", &whole[8..]].concat()),
        ("chunks: there is no JSON", [&whole[..8], &12_u32.to_le_bytes()].concat()),
        ("asset: ", b"{\"asset\": ".to_vec()),
        ("JSON: ", Vec::new()),
    ] {
        let error = refusal(folder.path(), &bytes);
        assert!(error.contains(expected), "'{expected}' is not in: {error}");
    }
    let mut with_index = binary.clone();
    with_index[0] = 200;
    let error = refusal(folder.path(), &glb(&document, &with_index));
    assert!(error.contains("meshes/0/primitives/0: a triangle uses vertex 200, but there are only 4"), "{error}");
    for bad in [f32::NAN, f32::INFINITY] {
        let mut with_bad = binary.clone();
        with_bad[12..16].copy_from_slice(&bad.to_le_bytes());
        let error = refusal(folder.path(), &glb(&document, &with_bad));
        assert!(error.contains("meshes/0/primitives/0: vertex 0: position"), "{error}");
    }
}

#[test]
fn deep_trees_and_great_claims_take_neither_stack_nor_memory() {
    let folder = folder();
    let (mut document, binary) = quad();
    let count = 100_000;
    document["nodes"] =
        (0..count).map(|k| if k + 1 < count { json!({"children": [k + 1]}) } else { json!({"mesh": 0}) }).collect();
    let path = write(folder.path(), "deep.glb", &glb(&document, &binary));
    assert_eq!(read_scene(&path, &ImportOptions::default()).unwrap().triangles.len(), 2);
    // Headers that promise four thousand million elements.
    for (name, bytes) in [
        ("a.ply", PLY.replace("vertex 3", "vertex 4000000000").into_bytes()),
        ("b.ply", PLY.replace("ascii", "binary_little_endian").replace("face 1", "face 4000000000").into_bytes()),
        ("c.ply", b"ply\nformat binary_little_endian 1.0\nelement face 4000000000\nend_header\n".to_vec()),
        ("d.stl", [&[b' '; 80][..], &u32::MAX.to_le_bytes()].concat()),
    ] {
        let path = write(folder.path(), name, &bytes);
        assert!(read_scene(&path, &ImportOptions::default()).is_err(), "{name}");
    }
    assert!(peak_memory().is_none_or(|mib| mib < 1500), "{:?} MiB", peak_memory());
}
