//! Reading scenes: exact answers on tiny files, and the real rooms.

mod common;

use isolux_core::scene::Scene;
use isolux_io::import::{ImportOptions, read_scene};
use std::path::Path;

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
fn the_living_room_is_read_whole() {
    let Some(scene) = room("living-room.glb") else { return };
    for o in scene.remarks.iter() {
        eprintln!("{o}");
    }
    assert_eq!(scene.triangles.last().map(|t| t.source + 1), Some(143_171));
    assert_eq!(scene.triangles.len(), 143_171 - 190);
}

#[test]
fn the_classroom_is_read_whole() {
    let Some(scene) = room("classroom.glb") else { return };
    for o in scene.remarks.iter() {
        eprintln!("{o}");
    }
    assert_eq!(scene.triangles.last().map(|t| t.source + 1), Some(103_838));
}
