//! Puts the built page of the viewer (`viewer/dist/viewer.html`) into the program, if it is there.

use std::path::PathBuf;

fn main() -> std::io::Result<()> {
    // Places are asked for when this runs: it may have been compiled before the sources moved elsewhere.
    let place = |name: &str| {
        std::env::var_os(name).map(PathBuf::from).ok_or_else(|| std::io::Error::other(format!("cargo sets {name}")))
    };
    let folder = place("CARGO_MANIFEST_DIR")?.join("../../viewer/dist");
    if folder.is_dir() {
        println!("cargo::rerun-if-changed={}", folder.display());
    } else {
        println!("cargo::rerun-if-changed=build.rs");
    }
    let page = std::fs::read(folder.join("viewer.html")).unwrap_or_default();
    std::fs::write(place("OUT_DIR")?.join("viewer.html"), page)
}
