//! Wavefront OBJ: polygons in groups, with the materials of MTL files beside it.
//!
//! The reader is our own: the usual crate panics on material files that are right (`Kd 0.5`), mixes up texture
//! coordinates when some corners have none, and cannot say in which line something is wrong.
//! OBJ has neither units nor sides. Lengths are taken as metres, and as the winding of faces is often arbitrary,
//! every surface reflects and emits on both sides.

mod mtl;

use super::builder::{SceneBuilder, Surface};
use super::{ImportOptions, polygon};
use crate::Error;
use glam::{Vec2, Vec3};
use isolux_core::math::Rgb;
use isolux_core::scene::{Scene, Vertex};
use std::collections::HashMap;
use std::path::Path;

/// Reads an OBJ file and the MTL files and images it refers to.
///
/// # Errors
/// As [`super::read_scene`]; a material file that cannot be found is a remark, not an error.
pub fn read(path: &Path, bytes: &[u8], _: &ImportOptions) -> Result<Scene, Error> {
    let mut builder = SceneBuilder::new(path);
    let text = String::from_utf8_lossy(bytes).replace("\\\r\n", " ").replace("\\\n", " ");
    let mut obj = Obj::default();
    for (k, line) in text.lines().enumerate() {
        obj.line(line, k + 1).map_err(|what| builder.error(&format!("line {}", k + 1), what))?;
    }
    let mut materials = mtl::Library::default();
    for name in &obj.libraries {
        materials.read(&mut builder, name)?;
    }
    for part in &obj.parts {
        let material = materials.number(&mut builder, &part.material)?;
        let name = if part.name.is_empty() { builder.default_name() } else { part.name.clone() };
        let place = format!("faces from line {}", part.line);
        let surface = Surface { place: &place, name, material, vertex_count: obj.corners.len(), joins: true };
        builder.surface(surface, part.triangles.iter().copied(), |i| obj.vertex(i))?;
    }
    if obj.skipped > 0 {
        builder.remark(format!("{} points, lines and curves were ignored", obj.skipped));
    }
    if obj.colors.iter().any(|&color| color != Rgb::WHITE) {
        builder.remark("vertex colours multiply the reflectivity and are taken as linear");
    }
    builder.remark("OBJ has no units: coordinates are taken as metres");
    builder.remark("OBJ has no sides: every surface reflects and emits on both");
    Ok(builder.finish())
}

/// What the lines so far say.
#[derive(Default)]
struct Obj {
    positions: Vec<Vec3>,
    colors: Vec<Rgb>,
    uvs: Vec<Vec2>,
    /// Pairs of position and texture coordinates that faces use, and the number of each pair.
    corners: Vec<[u32; 2]>,
    numbers: HashMap<[u32; 2], u32>,
    parts: Vec<Part>,
    libraries: Vec<String>,
    name: String,
    material: String,
    skipped: usize,
}

/// Faces that follow each other in one group, with one material.
struct Part {
    line: usize,
    name: String,
    material: String,
    triangles: Vec<[u32; 3]>,
}

/// Stands for missing texture coordinates.
const NONE: u32 = u32::MAX;

impl Obj {
    fn line(&mut self, line: &str, number: usize) -> Result<(), String> {
        let line = line.trim();
        let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        // Names may contain the sign of comments, numbers cannot.
        let rest = if ["v", "vt", "f"].contains(&keyword) { rest.split('#').next().unwrap_or_default() } else { rest };
        match keyword {
            "v" => match numbers(rest)?[..] {
                [x, y, z] | [x, y, z, _] => self.push_position(Vec3::new(x, y, z), Rgb::WHITE),
                [x, y, z, r, g, b] | [x, y, z, _, r, g, b] => self.push_position(Vec3::new(x, y, z), Rgb::new(r, g, b)),
                _ => return Err("a vertex needs three numbers, and may have a weight or a colour".to_owned()),
            },
            "vt" => match numbers(rest)?[..] {
                // Rows of images run downwards, v runs upwards.
                [u, v] | [u, v, _] => self.uvs.push(Vec2::new(u, 1.0 - v)),
                [u] => self.uvs.push(Vec2::new(u, 1.0)),
                _ => return Err("texture coordinates need one to three numbers".to_owned()),
            },
            "f" => self.face(rest, number)?,
            "o" | "g" => self.name = rest.trim().to_owned(),
            "usemtl" => self.material = rest.trim().to_owned(),
            "mtllib" => self.libraries.push(rest.trim().to_owned()),
            "p" | "l" | "curv" | "curv2" | "surf" => self.skipped += 1,
            _ => {}
        }
        Ok(())
    }

    fn push_position(&mut self, position: Vec3, color: Rgb) {
        self.positions.push(position);
        self.colors.push(color);
    }

    fn face(&mut self, rest: &str, line: usize) -> Result<(), String> {
        let mut pairs = Vec::new();
        for corner in rest.split_whitespace() {
            let mut parts = corner.split('/');
            let position = index(parts.next().unwrap_or_default(), self.positions.len(), "vertex")?;
            let uv = match parts.next() {
                None | Some("") => NONE,
                Some(word) => index(word, self.uvs.len(), "texture coordinate")?,
            };
            pairs.push([position, uv]);
        }
        if pairs.len() < 3 {
            return Err(format!("a face needs three corners, this has {}", pairs.len()));
        }
        if self.parts.last().is_none_or(|part| part.name != self.name || part.material != self.material) {
            let (name, material) = (self.name.clone(), self.material.clone());
            self.parts.push(Part { line, name, material, triangles: Vec::new() });
        }
        let points: Vec<Vec3> = pairs.iter().map(|pair| self.positions[pair[0] as usize]).collect();
        let corners: Vec<u32> = pairs.into_iter().map(|pair| self.corner(pair)).collect();
        let triangles = polygon::triangulate(&points).into_iter().map(|t| t.map(|k| corners[k]));
        self.parts.last_mut().into_iter().for_each(|part| part.triangles.extend(triangles.clone()));
        Ok(())
    }

    fn corner(&mut self, pair: [u32; 2]) -> u32 {
        *self.numbers.entry(pair).or_insert_with(|| {
            self.corners.push(pair);
            self.corners.len() as u32 - 1
        })
    }

    fn vertex(&self, corner: u32) -> Vertex {
        let [position, uv] = self.corners[corner as usize].map(|k| k as usize);
        let uv = self.uvs.get(uv).copied().unwrap_or_default();
        Vertex { position: self.positions[position], color: self.colors[position], uv, emission_uv: uv }
    }
}

fn numbers(text: &str) -> Result<Vec<f32>, String> {
    text.split_whitespace().map(|word| word.parse().map_err(|_| format!("'{word}' is no number"))).collect()
}

/// The position in a list of `count` of what a face calls `word`: from 1 upwards, or from -1 back from the end.
fn index(word: &str, count: usize, what: &str) -> Result<u32, String> {
    let number: i64 = word.parse().map_err(|_| format!("'{word}' is no number of a {what}"))?;
    let place = if number < 0 { number.saturating_add(count as i64) } else { number - 1 };
    match u32::try_from(place) {
        Ok(place) if (place as usize) < count => Ok(place),
        _ => Err(format!("{what} {word} does not exist, there are {count} so far")),
    }
}
