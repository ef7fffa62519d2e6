//! A scene as plain data: what a file says, in world space and in units, before anything is computed.
//!
//! Positions are in metres, colours are linear Rec. 709, emission is an exitance in lm/m² (`Be = pi L` for a diffuse
//! emitter of luminance L in cd/m²). The front of a triangle is the side from which its vertices run counter-clockwise.

pub mod builtin;
mod camera;
pub mod check;
mod colors;
mod contacts;
mod image;
mod insides;
mod light;
mod light_groups;
mod lightmap_uvs;
mod material;
mod shape;
mod shells;
mod validate;

pub use camera::{Camera, Projection};
pub use contacts::{Contacts, Flat, Plane, Segment, Touched};
pub use image::{Image, Texture, Wrap};
pub use light::{Light, LightKind};
pub use light_groups::{Emitter, Grouping, LightGroup, MOST_GROUPS, Source};
pub use material::Material;
pub use shape::{Shape, octahedron};
pub use validate::Fault;

use crate::math::Rgb;
use glam::{Vec2, Vec3};

/// Everything isolux knows of a scene file.
#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Scene {
    pub name: String,
    pub vertices: Vec<Vertex>,
    pub triangles: Vec<Triangle>,
    pub objects: Vec<Object>,
    pub materials: Vec<Material>,
    pub images: Vec<Image>,
    pub lights: Vec<Light>,
    pub cameras: Vec<Camera>,
    pub shape: Shape,
    /// Which triangles have a back that nobody can see, whatever their material says; empty if none has: see [`Scene::hide_insides`].
    pub hidden_backs: Vec<bool>,
    /// Coordinates in a lightmap of every vertex (glTF `TEXCOORD_1`), (0, 0) is the upper left corner of the map; empty
    /// if the file has none, or not for all. They change no solution.
    pub lightmap_uvs: Vec<Vec2>,
    /// What the reader assumed, ignored or dropped, one sentence each, for people.
    pub remarks: Vec<String>,
}

/// A corner of triangles.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Vertex {
    /// World position [m].
    pub position: Vec3,
    /// Linear multiplier of the material's reflectivity (glTF `COLOR_0`); white if the file has none.
    pub color: Rgb,
    /// Coordinates in the reflectivity texture, texture transforms applied; (0, 0) is the image's upper left corner.
    pub uv: Vec2,
    /// Coordinates in the emission texture, likewise.
    pub emission_uv: Vec2,
}

impl Vertex {
    /// A white, untextured vertex.
    pub const fn at(position: Vec3) -> Vertex {
        Vertex { position, color: Rgb::WHITE, uv: Vec2::ZERO, emission_uv: Vec2::ZERO }
    }
}

/// A traced surface piece. Degenerate ones (no area) are dropped by the readers and counted in the remarks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Triangle {
    /// Indices into [`Scene::vertices`], counter-clockwise seen from the front.
    pub vertices: [u32; 3],
    /// Index into [`Scene::objects`].
    pub object: u32,
    /// Position of this triangle in the file, counting dropped ones: the number other programs know it by.
    pub source: u32,
}

/// A named surface with one material: a glTF primitive of one node, an OBJ group, a wall.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Object {
    pub name: String,
    /// Index into [`Scene::materials`].
    pub material: u32,
}

impl Scene {
    /// World positions [m] of the corners of triangle `t`.
    pub fn corners(&self, t: u32) -> [Vec3; 3] {
        self.triangles[t as usize].vertices.map(|v| self.vertices[v as usize].position)
    }

    pub fn material_of(&self, t: u32) -> &Material {
        let object = self.triangles[t as usize].object;
        &self.materials[self.objects[object as usize].material as usize]
    }

    /// Whether the back of triangle `t` is a surface, too, and not black.
    pub fn is_two_sided(&self, t: u32) -> bool {
        let is_hidden = self.hidden_backs.get(t as usize).is_some_and(|hidden| *hidden);
        self.material_of(t).two_sided && !is_hidden
    }

    /// Least and greatest corner of the box around all triangles [m]; both zero for a scene without triangles.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let mut corners = self.triangles.iter().flat_map(|t| t.vertices).map(|v| self.vertices[v as usize].position);
        let Some(first) = corners.next() else { return (Vec3::ZERO, Vec3::ZERO) };
        corners.fold((first, first), |(low, high), p| (low.min(p), high.max(p)))
    }

    /// Fingerprint of everything that can change a solution: geometry, materials, textures and lights, not names,
    /// cameras or remarks. Two scenes with the same hash have the same solution.
    pub fn hash(&self) -> u64 {
        hash::scene_hash(self)
    }
}

mod hash;
