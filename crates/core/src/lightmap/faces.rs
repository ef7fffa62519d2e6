//! What a lightmap shows: the sides of triangles that get light.

use crate::Problem;
use crate::math::Rgb;
use crate::mesh::cells;
use crate::scene::Shape;
use crate::view::{INSIDE, VertexField};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// A flat piece of one side of a surface: a triangle, or a part of it where the surface is curved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    pub triangle: u32,
    /// Whether it is the back of the triangle.
    pub back: bool,
    /// Barycentric coordinates on the triangle of the corners, in the orientation of its front.
    pub corners: [Vec2; 3],
}

/// A whole triangle.
const WHOLE: [Vec2; 3] = [Vec2::ZERO, Vec2::X, Vec2::Y];
/// Along each edge of the octahedron whose faces become a sphere.
const SPHERE_DIVISIONS: u16 = 32;
/// Along each edge, when the light on the sides of a triangle is compared.
const LOOKS: u16 = 4;

impl Face {
    /// Barycentric coordinates on the triangle of the point at the barycentric coordinates `at` of the face.
    pub fn on_triangle(&self, at: Vec2) -> Vec2 {
        let [a, b, c] = self.corners;
        a + at.x * (b - a) + at.y * (c - a)
    }

    /// World position [m] at the barycentric coordinates `at` of the face, and the unit normal of its side.
    pub fn surface(&self, problem: &Problem, at: Vec2) -> (Vec3, Vec3) {
        let (position, front) = problem.geometry.surface(self.triangle, self.on_triangle(at));
        (position, if self.back { -front } else { front })
    }

    /// World positions [m] of the corners, in the orientation of the triangle's front.
    pub fn positions(&self, problem: &Problem) -> [Vec3; 3] {
        self.corners.map(|uv| problem.geometry.surface(self.triangle, uv).0)
    }

    /// Irradiance [lux] at the barycentric coordinates `at` of the face.
    pub fn irradiance(&self, problem: &Problem, field: &VertexField, at: Vec2) -> Rgb {
        field.irradiance_at(problem, self.triangle, self.on_triangle(at), self.back)
    }

    /// Number of the object it belongs to.
    pub fn object(&self, problem: &Problem) -> u32 {
        problem.scene.triangles[self.triangle as usize].object
    }
}

/// The faces that get texels of their own, object by object, fronts before backs. Both sides of a two-sided surface are
/// there, but for the dark insides of things.
pub fn lit_faces(problem: &Problem, field: &VertexField) -> Vec<Face> {
    let sides = |triangle: u32| {
        let light = side_light(problem, field, triangle);
        let emits = problem.scene.material_of(triangle).is_emitter();
        [false, true].into_iter().filter(move |&back| {
            let (own, other) = if back { (light[1], light[0]) } else { (light[0], light[1]) };
            // Where both are dark, the front is shown.
            let is_lit = if back { own > INSIDE * other } else { own >= INSIDE * other };
            (!back || problem.mesh.is_two_sided(triangle)) && (is_lit || emits)
        })
    };
    let triangles = 0..problem.scene.triangles.len() as u32;
    let sides: Vec<(u32, bool)> =
        triangles.into_par_iter().flat_map_iter(|t| sides(t).map(move |back| (t, back))).collect();
    in_order(problem, sides)
}

/// One face for each triangle, for maps in which both sides of a surface share their texels: the brighter side.
pub fn brighter_faces(problem: &Problem, field: &VertexField) -> Vec<Face> {
    let side = |triangle: u32| {
        let [front, back] = side_light(problem, field, triangle);
        (triangle, back > front)
    };
    in_order(problem, (0..problem.scene.triangles.len() as u32).into_par_iter().map(side).collect())
}

/// The front of every triangle.
pub fn fronts(problem: &Problem) -> Vec<Face> {
    in_order(problem, (0..problem.scene.triangles.len() as u32).map(|t| (t, false)).collect())
}

/// Mean illuminance [lux] on front and back.
fn side_light(problem: &Problem, field: &VertexField, triangle: u32) -> [f32; 2] {
    if !problem.mesh.is_two_sided(triangle) {
        return [1.0, 0.0];
    }
    let middles = (0..cells::count(LOOKS)).map(|cell| cells::corners(cell, LOOKS).iter().sum::<Vec2>() / 3.0);
    [false, true].map(|back| {
        let light = |uv| field.irradiance_at(problem, triangle, uv, back).luminance();
        middles.clone().map(light).sum::<f32>() / cells::count(LOOKS) as f32
    })
}

fn in_order(problem: &Problem, mut sides: Vec<(u32, bool)>) -> Vec<Face> {
    sides.sort_by_key(|&(t, back)| (problem.scene.triangles[t as usize].object, back, t));
    let pieces = |(triangle, back): (u32, bool)| {
        let divisions = if problem.scene.shape == Shape::Triangles { 1 } else { SPHERE_DIVISIONS };
        (0..cells::count(divisions)).map(move |cell| {
            let corners = if divisions == 1 { WHOLE } else { cells::corners(cell, divisions) };
            Face { triangle, back, corners }
        })
    };
    sides.into_iter().flat_map(pieces).collect()
}
