//! PLY (Stanford polygon format), ASCII and binary: polygons, and vertex colours as reflectivity.

use super::builder::{SceneBuilder, Surface};
use super::{ImportOptions, polygon};
use crate::Error;
use glam::{DVec3, Vec3};
use isolux_core::math::{Rgb, color::srgb_to_linear};
use isolux_core::scene::{Material, Scene, Vertex};
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult};
use ply_rs_bw::ply::{PropertyType, ScalarType};
use std::path::Path;

/// Reads a PLY file.
///
/// # Errors
/// As [`super::read_scene`].
pub fn read(path: &Path, bytes: &[u8], _: &ImportOptions) -> Result<Scene, Error> {
    let mut builder = SceneBuilder::new(path);
    let broken = |error: ParseError| {
        let place = error.line().map_or("content".to_owned(), |line| format!("line {line}"));
        let what = error.to_string();
        Error::invalid(
            path,
            place,
            what.split(['\n', '\t']).filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" "),
        )
    };
    let parser = Parser::<Row>::new();
    let mut reader = Reader::new(bytes);
    let header = parser.read_header(&mut reader).map_err(broken)?;
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for (name, element) in &header.elements {
        check_count(&builder, &header, element, reader.get_ref().len())?;
        let rows = parser.read_payload_for_element(&mut reader, element, &header).map_err(broken)?;
        match name.as_str() {
            "vertex" => vertices = rows,
            "face" => faces = rows,
            _ => builder.remark(format!("the elements '{name}' were ignored: only vertices and faces are read")),
        }
    }
    if faces.is_empty() {
        return Err(builder.error("header", "it has no faces: isolux lights surfaces, not points"));
    }
    let has_colors = vertices.iter().any(|row| row.color.is_some());
    let material = if has_colors {
        builder
            .remark("vertex colours are taken as reflectivity, integers as sRGB and floats as linear, on both sides");
        builder.material(Material { two_sided: true, ..Material::diffuse("colours", Rgb::WHITE) }, "vertex")?
    } else {
        builder.default_material()?
    };
    builder.remark("PLY has no units: coordinates are taken as metres");
    let position = |index: u32| vertices.get(index as usize).map_or(Vec3::NAN, |row| row.position.as_vec3());
    let triangles = faces.iter().flat_map(|face| {
        let corners: Vec<Vec3> = face.corners.iter().map(|&index| position(index)).collect();
        polygon::triangulate(&corners).into_iter().map(|t| t.map(|k| face.corners[k]))
    });
    let name = path.file_stem().map_or("object 1".into(), |stem| stem.to_string_lossy().into_owned());
    let surface = Surface { place: "face", name, material, vertex_count: vertices.len(), joins: false };
    builder.surface(surface, triangles, |i| {
        let row = &vertices[i as usize];
        Vertex { color: row.color.map_or(Rgb::WHITE, Rgb::from), ..Vertex::at(row.position.as_vec3()) }
    })?;
    Ok(builder.finish())
}

/// Holds the number of rows that the header states against the bytes that are left, before anything is made of it.
fn check_count(builder: &SceneBuilder, header: &Header, element: &ElementDef, left: usize) -> Result<(), Error> {
    let size = |kind: &ScalarType| match kind {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    };
    let least: usize = match header.encoding {
        // A digit and a blank for each number.
        Encoding::Ascii => 2 * element.properties.len(),
        _ => element
            .properties
            .values()
            .map(|property| match &property.data_type {
                PropertyType::Scalar(kind) | PropertyType::List(kind, _) => size(kind),
            })
            .sum(),
    };
    // The last line may lack its end.
    if element.count > (left + 1) / least.max(1) || (least == 0 && element.count > 0) {
        let what = format!("{} of them do not fit into the {left} bytes that are left", element.count);
        return Err(builder.error(&format!("element {}", element.name), what));
    }
    Ok(())
}

/// A vertex or a face.
struct Row {
    position: DVec3,
    /// Linear.
    color: Option<[f32; 3]>,
    corners: Vec<u32>,
}

impl PropertyAccess for Row {
    fn new() -> Row {
        Row { position: DVec3::ZERO, color: None, corners: Vec::new() }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let known = match name {
            "x" | "y" | "z" => number(&property).map(|value| match name {
                "x" => self.position.x = value,
                "y" => self.position.y = value,
                _ => self.position.z = value,
            }),
            "red" | "green" | "blue" => linear(&property).map(|value| {
                let channel = ["red", "green", "blue"].iter().position(|channel| *channel == name).unwrap_or_default();
                self.color.get_or_insert([1.0; 3])[channel] = value;
            }),
            "vertex_indices" | "vertex_index" => indices(property).map(|corners| self.corners = corners),
            _ => return PropertyAccessResult::Ignored,
        };
        if known.is_some() { PropertyAccessResult::Set } else { PropertyAccessResult::UnsupportedType }
    }
}

fn number(property: &Property) -> Option<f64> {
    Some(match *property {
        Property::Char(v) => f64::from(v),
        Property::UChar(v) => f64::from(v),
        Property::Short(v) => f64::from(v),
        Property::UShort(v) => f64::from(v),
        Property::Int(v) => f64::from(v),
        Property::UInt(v) => f64::from(v),
        Property::Float(v) => f64::from(v),
        Property::Double(v) => v,
        _ => return None,
    })
}

/// A colour channel, linear.
fn linear(property: &Property) -> Option<f32> {
    Some(match *property {
        Property::UChar(v) => srgb_to_linear(f32::from(v) / 255.0),
        Property::UShort(v) => srgb_to_linear(f32::from(v) / 65535.0),
        Property::Float(v) => v,
        Property::Double(v) => v as f32,
        _ => return None,
    })
}

/// Vertex numbers; a negative one becomes a number that no vertex has.
fn indices(property: Property) -> Option<Vec<u32>> {
    fn all<T: TryInto<u32>>(list: Vec<T>) -> Vec<u32> {
        list.into_iter().map(|index| index.try_into().unwrap_or(u32::MAX)).collect()
    }
    Some(match property {
        Property::ListChar(list) => all(list),
        Property::ListUChar(list) => all(list),
        Property::ListShort(list) => all(list),
        Property::ListUShort(list) => all(list),
        Property::ListInt(list) => all(list),
        Property::ListUInt(list) => list,
        _ => return None,
    })
}
