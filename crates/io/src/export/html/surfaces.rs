//! The surfaces of a page: which triangles are drawn, where, with what on them. They do not change while the light does.

use super::batch::{Batch, add_images, batches};
use super::part::Part;
use crate::Error;
use crate::export::faces::{Coating, Faces, elements_by_object, mean};
use flate2::Compression;
use glam::{Vec2, Vec3};
use isolux_core::Problem;
use isolux_core::math::Rgb;
use isolux_core::scene::{Camera, Projection};
use isolux_core::solution::GroupLight;
use isolux_core::view::{VertexField, default_camera};
use serde_json::{Value, json};
use std::collections::HashMap;

/// The name of the camera that every page has.
const OVERVIEW: &str = "Overview";

/// Triangles by batches, with shared vertices.
pub struct Surfaces {
    vertices: Vec<Vertex>,
    /// Three vertices each.
    indices: Vec<u32>,
    /// Of every triangle.
    elements: Vec<u32>,
    batches: Vec<Batch>,
    /// Number of triangles up to the end of every batch.
    ends: Vec<usize>,
}

struct Vertex {
    /// Vertices of the field, and their weights.
    shared: [u32; 3],
    weights: Vec3,
    position: Vec3,
    coating: Coating,
}

/// A vertex of the field with what is on it there, bit by bit.
type Key = (u32, [u32; 7]);

impl Surfaces {
    /// Those of `problem`, on the vertices of `field`; lamps are at the factors 1 of the `groups`. The dark insides of things are left out unless
    /// `all` is asked for, as in a draft, where much is dark by chance.
    pub fn new(problem: &Problem, field: &VertexField, groups: &[GroupLight], all: bool) -> Surfaces {
        let faces = Faces::new(problem, field);
        let elements_of = elements_by_object(problem);
        let batches = batches(problem, groups);
        let mut surfaces = Surfaces {
            vertices: Vec::new(),
            indices: Vec::new(),
            elements: Vec::new(),
            batches: Vec::new(),
            ends: Vec::new(),
        };
        for batch in &batches {
            let mut known = HashMap::new();
            let elements = batch.objects.iter().flat_map(|&object| &elements_of[object as usize]);
            for &e in elements.filter(|&&e| all || !faces.is_inside(e)) {
                surfaces.add_element(problem, field, &faces, batch, e, &mut known);
            }
            surfaces.ends.push(surfaces.elements.len());
        }
        Surfaces { batches, ..surfaces }
    }

    fn add_element(
        &mut self,
        problem: &Problem,
        field: &VertexField,
        faces: &Faces,
        batch: &Batch,
        e: u32,
        known: &mut HashMap<Key, u32>,
    ) {
        for at in problem.mesh.pieces(e) {
            let shared = field.vertices_at(problem, at);
            let vertices = &mut self.vertices;
            let add = |weights: Vec3, position| {
                let mut coating = faces.coating(at, weights);
                coating.uv = if batch.has_uv { coating.uv } else { Vec2::ZERO };
                coating.emission_uv = if batch.has_emission_uv { coating.emission_uv } else { Vec2::ZERO };
                let next = vertices.len() as u32;
                // Corners are shared with neighbours; points on edges are not.
                let corner = (0..3).find(|&k| weights[k] == 1.0);
                let number = corner.map_or(next, |k| *known.entry((shared[k], bits(coating))).or_insert(next));
                if number == next {
                    vertices.push(Vertex { shared, weights, position, coating });
                }
                number
            };
            faces.draw(at, add, &mut self.indices);
            self.elements.resize(self.indices.len() / 3, e);
        }
    }

    /// The part of a page with the surfaces, packed.
    ///
    /// # Errors
    /// Those of the encoders of images.
    pub fn part(&self, problem: &Problem) -> Result<Vec<u8>, Error> {
        let (scene, mesh) = (&problem.scene, &problem.mesh);
        let mut part = Part::default();
        let (center, radius) = problem.geometry.bounding_sphere();
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        let batch_json = |((batch, first), end): ((&Batch, usize), &usize)| {
            let mut look = batch.look.clone();
            (look["first"], look["count"]) = (json!(first), json!(end - first));
            look
        };
        part.set("name", json!(scene.name));
        part.set("elements", json!(mesh.len()));
        part.set("vertices", json!(self.vertices.len()));
        part.set("triangles", json!(self.elements.len()));
        part.set("bounds", json!({ "center": center.to_array(), "radius": radius }));
        part.set("objects", scene.objects.iter().map(|object| json!(object.name)).collect());
        part.set("batches", self.batches.iter().zip(starts).zip(&self.ends).map(batch_json).collect());
        let overview = Camera { name: OVERVIEW.to_owned(), ..default_camera(problem) };
        part.set("cameras", scene.cameras.iter().chain([&overview]).map(camera).collect());

        part.add_f32("position", self.vertices.iter().map(|v| v.position.to_array()));
        if self.batches.iter().any(|batch| batch.has_uv) {
            part.add_f32("uv", self.vertices.iter().map(|v| v.coating.uv.to_array()));
        }
        if self.batches.iter().any(|batch| batch.has_emission_uv) {
            part.add_f32("emission_uv", self.vertices.iter().map(|v| v.coating.emission_uv.to_array()));
        }
        if self.vertices.iter().any(|v| v.coating.tint != Rgb::WHITE) {
            part.add_f32("tint", self.vertices.iter().map(|v| v.coating.tint.to_array()));
        }
        part.add_u32("index", self.indices.iter().copied());
        part.add_u32("triangle_element", self.elements.iter().copied());
        part.add_f32("area", mesh.elements().map(|e| [mesh.area(e)]));
        part.add_u32("face", mesh.elements().map(|e| problem.face(e)));
        let reflectivities: Vec<[f32; 3]> = mesh.elements().map(|e| mesh.reflectivity(e).to_array()).collect();
        part.add_f16("reflectivity", &reflectivities);
        add_images(&mut part, &self.batches, &scene.images)?;
        part.finish(Compression::default())
    }

    /// Irradiance [lux] of `field` at the vertices. It must have the vertices of the field these surfaces were made with.
    pub fn irradiance(&self, field: &VertexField) -> Vec<[f32; 3]> {
        self.vertices.iter().map(|v| mean(v.shared, v.weights, |v| field.irradiance(v)).to_array()).collect()
    }
}

fn bits(Coating { tint, uv, emission_uv }: Coating) -> [u32; 7] {
    [tint.r, tint.g, tint.b, uv.x, uv.y, emission_uv.x, emission_uv.y].map(f32::to_bits)
}

fn camera(camera: &Camera) -> Value {
    let (angle, height) = match camera.projection {
        Projection::Perspective { vertical_angle } => (Some(vertical_angle), None),
        Projection::Orthographic { height } => (None, Some(height)),
    };
    json!({
        "name": camera.name,
        "position": camera.position.to_array(),
        "forward": camera.forward.to_array(),
        "up": camera.up.to_array(),
        "vertical_angle": angle,
        "height": height,
        "aspect": camera.aspect,
    })
}
