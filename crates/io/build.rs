//! Puts the built page of the viewer (`viewer/dist/viewer.html`) into the program, if it is there.

use std::path::{Path, PathBuf};

fn main() -> std::io::Result<()> {
    // Asked for when it runs: the program that this is may have been compiled before the sources moved elsewhere.
    let here =
        std::env::var_os("CARGO_MANIFEST_DIR").ok_or_else(|| std::io::Error::other("cargo sets CARGO_MANIFEST_DIR"))?;
    let folder = PathBuf::from(here).join("../../viewer/dist");
    if folder.is_dir() {
        println!("cargo::rerun-if-changed={}", folder.display());
    } else {
        println!("cargo::rerun-if-changed=build.rs");
    }
    let page = std::fs::read(folder.join("viewer.html")).unwrap_or_default();
    let out = std::env::var_os("OUT_DIR").ok_or_else(|| std::io::Error::other("cargo sets OUT_DIR"))?;
    std::fs::write(Path::new(&out).join("viewer.html"), page)
}
