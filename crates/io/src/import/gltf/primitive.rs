//! The triangles of one primitive, placed in the world.

use super::Reading;
use super::accessor::Accessor;
use super::file::File;
use super::material::{Materials, Read};
use super::texture::Mapping;
use crate::Error;
use crate::import::builder::Surface;
use glam::{DMat4, DVec3, Vec2};
use gltf::json::accessor::Type;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use isolux_core::math::Rgb;
use isolux_core::scene::Vertex;

/// The second set of texture coordinates is a lightmap's, by custom, unless a texture uses it.
const LIGHTMAP_SET: u32 = 1;

/// Adds `primitive`, which stands at `place` in the file, as the object `name`; `world` takes its coordinates to the world.
///
/// # Errors
/// [`Error::Invalid`] for anything wrong with it, [`Error::File`] for an image that cannot be read.
pub fn read(
    reading: &mut Reading,
    materials: &mut Materials,
    primitive: &Primitive,
    place: &str,
    name: String,
    world: &DMat4,
) -> Result<(), Error> {
    let file = reading.file;
    let mode = match primitive.mode {
        Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => mode,
        Checked::Valid(_) => {
            reading.ignored.note("points and lines");
            return Ok(());
        }
        Checked::Invalid => return Err(file.error(place, "its mode is none that glTF knows")),
    };
    reading.ignored.note_many("morph targets", primitive.targets.as_ref().map_or(0, Vec::len));
    let attributes = Attributes { file, primitive, place };
    let Some(positions) = attributes.get(Semantic::Positions, &[Type::Vec3], None)? else {
        return Err(file.error(place, "it has no POSITION"));
    };
    let vertex_count = positions.count;
    let colors = attributes.get(Semantic::Colors(0), &[Type::Vec3, Type::Vec4], Some(vertex_count))?;
    let colors = colors.map(Accessor::normalized);
    let Read { number: material, reflectivity, emission } = materials.get(reading, primitive.material, place)?;
    let mut coordinates = |mapping: Option<Mapping>| -> Result<Option<(Accessor, Mapping)>, Error> {
        let Some(mapping) = mapping else { return Ok(None) };
        let accessor = attributes.get(Semantic::TexCoords(mapping.set), &[Type::Vec2], Some(vertex_count))?;
        if accessor.is_none() {
            reading.ignored.note("textures on surfaces without texture coordinates, of which they show one texel");
        }
        Ok(accessor.map(|accessor| (accessor, mapping)))
    };
    let (uv, emission_uv) = (coordinates(reflectivity)?, coordinates(emission)?);

    let textures = [reflectivity, emission].into_iter().flatten();
    let lightmap_uvs = match textures.map(|mapping| mapping.set).any(|set| set == LIGHTMAP_SET) {
        true => None,
        false => attributes.get(Semantic::TexCoords(LIGHTMAP_SET), &[Type::Vec2], Some(vertex_count))?,
    };

    let vertex = |i: u32| {
        let i = i as usize;
        let [x, y, z, _] = positions.get(i);
        let lightmap_uv = lightmap_uvs.as_ref().map(|uvs| uvs.get(i)).map(|[u, v, ..]| Vec2::new(u as f32, v as f32));
        let vertex = Vertex {
            position: world.transform_point3(DVec3::new(x, y, z)).as_vec3(),
            color: colors.as_ref().map_or(Rgb::WHITE, |colors| rgb(colors.get(i))),
            uv: texture_coordinates(&uv, i),
            emission_uv: texture_coordinates(&emission_uv, i),
        };
        (vertex, lightmap_uv)
    };
    let indices_place = format!("{place}/indices");
    let indices = match primitive.indices {
        Some(index) => Some(Accessor::new(file, index, &indices_place, &[Type::Scalar])?),
        None => None,
    };
    let count = indices.as_ref().map_or(vertex_count, |indices| indices.count);
    if mode == Mode::Triangles && count % 3 != 0 {
        return Err(file.error(&indices_place, format!("{count} corners make no whole number of triangles")));
    }
    let corner = |k: usize| indices.as_ref().map_or(k as u32, |indices| indices.get(k)[0] as u32);
    let mirrored = world.determinant() < 0.0;
    let triangles = (0..triangle_count(mode, count)).map(|t| {
        let [a, b, c] = corners(mode, t).map(corner);
        if mirrored { [a, c, b] } else { [a, b, c] }
    });
    reading.builder.lightmapped_surface(
        Surface { place, name, material, vertex_count, joins: false },
        triangles,
        vertex,
    )
}

fn triangle_count(mode: Mode, corners: usize) -> usize {
    if mode == Mode::Triangles { corners / 3 } else { corners.saturating_sub(2) }
}

/// Positions in the list of corners of those of triangle `t` (glTF 2.0, section 3.7.2.1).
fn corners(mode: Mode, t: usize) -> [usize; 3] {
    match mode {
        Mode::TriangleStrip => [t, t + 1 + t % 2, t + 2 - t % 2],
        Mode::TriangleFan => [t + 1, t + 2, 0],
        _ => [3 * t, 3 * t + 1, 3 * t + 2],
    }
}

fn rgb([red, green, blue, _]: [f64; 4]) -> Rgb {
    Rgb::new(red as f32, green as f32, blue as f32)
}

fn texture_coordinates(source: &Option<(Accessor, Mapping)>, i: usize) -> Vec2 {
    source.as_ref().map_or(Vec2::ZERO, |(accessor, mapping)| {
        let [u, v, ..] = accessor.get(i);
        mapping.apply(Vec2::new(u as f32, v as f32))
    })
}

struct Attributes<'a> {
    file: &'a File<'a>,
    primitive: &'a Primitive,
    place: &'a str,
}

impl<'a> Attributes<'a> {
    /// The attribute `semantic` if there is one; it must have `count` elements.
    fn get(&self, semantic: Semantic, types: &[Type], count: Option<usize>) -> Result<Option<Accessor<'a>>, Error> {
        let place = format!("{}/attributes/{}", self.place, semantic.to_string());
        let Some(&index) = self.primitive.attributes.get(&Checked::Valid(semantic)) else { return Ok(None) };
        let accessor = Accessor::new(self.file, index, &place, types)?;
        match count {
            Some(count) if accessor.count < count => {
                let what = format!("it has {} elements for {count} vertices", accessor.count);
                Err(self.file.error(&place, what))
            }
            _ => Ok(Some(accessor)),
        }
    }
}
