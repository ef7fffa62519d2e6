//! Lightmaps as a new user would make them.

#![allow(clippy::unwrap_used)]

mod common;

use common::Folder;

/// A folder with a small solution in it.
fn solved(scene: &str) -> Folder {
    let folder = Folder::new();
    folder.prints(&["solve", scene, "--elements", "500", "--rays", "50k", "-o", "a.isolux"]);
    folder
}

#[test]
fn one_command_writes_the_model_the_map_and_what_to_know_about_them() {
    let folder = solved("cubes");
    let text = folder.prints(&["bake", "a.isolux", "-o", "room.glb", "-o", "room.png", "--size", "128"]);
    assert!(text.contains("128 x ") && text.contains("charts") && text.contains("room.json"), "{text}");
    assert_eq!(folder.names(), ["a.isolux", "room.glb", "room.json", "room.png"]);
    folder.prints(&["bake", "a.isolux", "-o", "side.glb", "--carrier", "sidecar", "--texels-per-metre", "20"]);
    let manifest: serde_json::Value = serde_json::from_slice(&folder.read("side.json")).unwrap();
    assert_eq!((manifest["files"]["exr"].as_str(), manifest["carrier"].as_str()), (Some("side.exr"), Some("sidecar")));
    assert!((manifest["texels_per_metre"].as_f64().unwrap() - 20.0).abs() < 0.1, "{manifest}");
    assert!(folder.names().contains(&"side.exr".to_owned()));
    assert_eq!(folder.prints(&["bake", "a.isolux", "-o", "q.exr", "-q", "--size", "64"]), "");
}

#[test]
fn a_solve_writes_a_lightmap_if_the_name_asks_for_one() {
    let folder = solved("cubes");
    folder.prints(&["bake", "a.isolux", "-o", "baked.glb"]);
    folder.prints(&["render", "a.isolux", "-o", "room-lightmap.glb", "-o", "room.glb"]);
    assert!(folder.read("room-lightmap.glb") == folder.read("baked.glb"));
    assert!(folder.read("room.glb") != folder.read("baked.glb"));
    folder.prints(&["solve", "cubes", "--elements", "500", "--rays", "50k", "-o", "again-lightmap.glb"]);
    assert!(folder.read("again-lightmap.glb") == folder.read("baked.glb"));
}

#[test]
fn coordinates_of_the_file_come_through_solving() {
    let folder = solved("cubes");
    folder.prints(&["bake", "a.isolux", "-o", "side.glb", "--carrier", "sidecar", "--size", "128"]);
    folder.prints(&["solve", "side.glb", "--elements", "500", "--rays", "50k", "-o", "b.isolux"]);
    let text = folder.prints(&["bake", "b.isolux", "-o", "b.glb", "--size", "128"]);
    assert!(text.contains("(TEXCOORD_1) are those of the scene's file"), "{text}");
    let text = folder.prints(&["bake", "b.isolux", "-o", "c.glb", "--size", "128", "--new-coordinates"]);
    assert!(text.contains("are new: as to those of the file, a new one was asked for"), "{text}");
}

#[test]
fn whatever_is_wrong_is_said_and_nothing_is_written() {
    let folder = solved("cubes");
    let fails = |arguments: &[&str]| folder.fails(2, &[&["bake", "a.isolux"], arguments].concat());
    assert!(fails(&["-o", "a.obj"]).contains("can be written as .glb, .exr, .png, .json"));
    assert!(fails(&["-o", "a.glb", "--carrier", "wagon"]).contains("unlit, MOZ_lightmap, sidecar"));
    assert!(fails(&["-o", "a.glb", "--texels-per-metre", "100000"]).contains("8192 are the most"));
    assert!(fails(&["-o", "a.glb", "--smooth", "much"]).contains("pictures, all, none"));
    assert!(fails(&["-o", "a.glb", "--size", "3"]).contains("16 to 8192"));
    assert!(fails(&["-o", "a.glb", "--padding", "0"]).contains("1 to 64 texels"));
    assert!(fails(&["-o", "a.glb", "--camera", "9"]).contains("camera"));
    assert!(fails(&["-o", "nowhere/a.glb"]).contains("nowhere"));
    assert!(fails(&["-o", "a.glb", "-o", "./a.glb"]).contains("named twice"));
    assert!(folder.fails(2, &["bake", "cubes", "-o", "a.glb"]).contains("isolux solve"));
    assert_eq!(folder.names(), ["a.isolux"]);
    assert!(folder.prints(&["bake", "--help"]).contains("Examples:"));
}
