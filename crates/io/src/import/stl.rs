//! STL, binary and ASCII: triangles and nothing else.
//!
//! The reader is our own, as common files defeat the usual ones: binary files that begin with `solid`, which only their
//! length tells apart, and ASCII files without a name after `solid`, with several solids, or in capitals.

use super::ImportOptions;
use super::builder::{SceneBuilder, Surface};
use crate::Error;
use glam::Vec3;
use isolux_core::scene::{Scene, Vertex};
use std::collections::HashMap;
use std::path::Path;

/// Bytes before the triangles of a binary file, and bytes of one.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Reads an STL file.
///
/// # Errors
/// As [`super::read_scene`].
pub fn read(path: &Path, bytes: &[u8], _: &ImportOptions) -> Result<Scene, Error> {
    let mut builder = SceneBuilder::new(path);
    let material = builder.default_material()?;
    match binary_triangles(bytes) {
        Some(triangles) => {
            let place = format!("triangles, of which there are {}", triangles.len() / TRIANGLE);
            let corners = triangles.chunks_exact(TRIANGLE).flat_map(|t| (1..4).map(|k| position(&t[12 * k..])));
            push(&mut builder, &place, "solid", material, corners)?;
        }
        None if is_ascii(bytes) => read_ascii(&mut builder, material, bytes)?,
        None => {
            let said = bytes.get(80..84).map_or(0, |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
            let what =
                format!("this is neither an ASCII file nor a binary one of {said} triangles: its length is wrong");
            return Err(builder.error("header", what));
        }
    }
    builder.remark("STL has no units: coordinates are taken as metres");
    Ok(builder.finish())
}

/// The triangles of a binary file: its length must be that of the number of them it states, or more.
fn binary_triangles(bytes: &[u8]) -> Option<&[u8]> {
    let count = u32::from_le_bytes(*bytes.get(80..)?.first_chunk()?) as usize;
    let end = HEADER.checked_add(count.checked_mul(TRIANGLE)?)?;
    bytes.get(HEADER..end).filter(|_| bytes.len() == end || !is_ascii(bytes))
}

fn is_ascii(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
}

fn position(bytes: &[u8]) -> Vec3 {
    let number = |k: usize| f32::from_le_bytes([bytes[k], bytes[k + 1], bytes[k + 2], bytes[k + 3]]);
    Vec3::new(number(0), number(4), number(8))
}

fn read_ascii(builder: &mut SceneBuilder, material: u32, bytes: &[u8]) -> Result<(), Error> {
    let text = String::from_utf8_lossy(bytes);
    let mut name = "solid".to_owned();
    let mut corners = Vec::new();
    let mut place = "line 1".to_owned();
    for (k, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or_default().to_ascii_lowercase();
        match keyword.as_str() {
            "solid" => {
                push(builder, &place, &name, material, corners.drain(..))?;
                place = format!("line {}", k + 1);
                let rest: Vec<&str> = words.collect();
                name = if rest.is_empty() { builder.default_name() } else { rest.join(" ") };
            }
            "vertex" => {
                let mut number = || words.next().and_then(|word| word.parse::<f32>().ok());
                let (Some(x), Some(y), Some(z)) = (number(), number(), number()) else {
                    return Err(builder.error(&format!("line {}", k + 1), "a vertex needs three numbers"));
                };
                corners.push(Vec3::new(x, y, z));
            }
            "endloop" if corners.len() % 3 != 0 => {
                return Err(builder.error(&format!("line {}", k + 1), "a facet must have three vertices"));
            }
            "facet" | "outer" | "endloop" | "endfacet" | "endsolid" | "" => {}
            _ => return Err(builder.error(&format!("line {}", k + 1), format!("'{keyword}' has no meaning in STL"))),
        }
    }
    push(builder, &place, &name, material, corners.drain(..))
}

/// Adds a solid; corners at the same position become one vertex.
fn push(
    builder: &mut SceneBuilder,
    place: &str,
    name: &str,
    material: u32,
    corners: impl Iterator<Item = Vec3>,
) -> Result<(), Error> {
    let mut positions = Vec::new();
    let mut numbers = HashMap::new();
    let mut indices = Vec::new();
    for corner in corners {
        indices.push(*numbers.entry(corner.to_array().map(f32::to_bits)).or_insert_with(|| {
            positions.push(corner);
            positions.len() as u32 - 1
        }));
    }
    if indices.len() % 3 != 0 {
        return Err(builder.error(place, "the file ends within a facet"));
    }
    let triangles = indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]);
    let surface = Surface { place, name: name.to_owned(), material, vertex_count: positions.len(), joins: false };
    builder.surface(surface, triangles, |i| Vertex::at(positions[i as usize]))
}
