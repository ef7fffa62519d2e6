//! glTF 2.0, `.glb` and `.gltf` (Khronos, ISO/IEC 12113:2022).
//!
//! The schema is that of the `gltf` crate. Everything that the JSON says about bytes and numbers is checked here, on
//! use and by us, so that every error names its place (`meshes/3/primitives/0`) and no content can make us panic.
//! The way: [`container`] splits the file, [`file`] holds it and looks things up, [`nodes`] walks the tree,
//! [`primitive`] reads triangles through an [`accessor`], [`material`] and [`light`] say what things look like.

mod accessor;
mod camera;
mod container;
mod file;
mod ignored;
mod light;
mod material;
mod nodes;
mod primitive;
mod texture;

use super::ImportOptions;
use super::builder::SceneBuilder;
use crate::Error;
use file::File;
use ignored::Ignored;
use isolux_core::scene::Scene;
use std::path::Path;

/// A file being read, the scene being built from it, and what is left out on the way.
struct Reading<'a, 'b> {
    file: &'a File<'a>,
    builder: &'a mut SceneBuilder<'b>,
    ignored: Ignored,
}

/// Reads a glTF file.
///
/// # Errors
/// As [`super::read_scene`].
pub fn read(path: &Path, bytes: &[u8], options: &ImportOptions) -> Result<Scene, Error> {
    let (json, binary) = container::split(path, bytes)?;
    let root = container::parse(path, json)?;
    let file = File::new(path, root, binary)?;
    let mut builder = SceneBuilder::new(path);
    let reading = Reading { file: &file, builder: &mut builder, ignored: Ignored::default() };
    nodes::Walk::new(reading, options).run()?;
    Ok(builder.finish())
}
