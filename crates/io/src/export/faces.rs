//! The triangles by which programs draw elements, without pinholes: what the formats for looking at share.
//!
//! An element is one triangle, or several if it is a cluster. Where vertices of its neighbours lie on an edge
//! ([`EdgePoints`]), it is a fan about its centre instead, so that both sides of the edge have the same vertices.

use glam::{Vec2, Vec3};
use isolux_core::Problem;
use isolux_core::math::Rgb;
use isolux_core::mesh::Place;
use isolux_core::view::{EdgePoints, INSIDE, VertexField};

/// The corners of an element by their weights.
const CORNERS: [Vec3; 3] = [Vec3::X, Vec3::Y, Vec3::Z];

/// Draws the elements of a problem.
pub struct Faces<'a> {
    problem: &'a Problem,
    field: &'a VertexField,
    edge_points: EdgePoints,
}

/// What a scene file says of a point on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coating {
    /// Linear multiplier of the reflectivity.
    pub tint: Rgb,
    /// Coordinates in the reflectivity texture and in the emission texture.
    pub uv: Vec2,
    pub emission_uv: Vec2,
}

impl<'a> Faces<'a> {
    /// Of elements whose vertices are those of `field`.
    pub fn new(problem: &'a Problem, field: &'a VertexField) -> Faces<'a> {
        Faces { problem, field, edge_points: field.edge_points(problem) }
    }

    /// Appends to `indices` the triangles at a place where an element lies, counter-clockwise seen from its side. `add` is asked for the
    /// number of each vertex, by the weights of the corners of the place (`VertexField::vertices_at`) and its position [m].
    pub fn draw(&self, at: Place, mut add: impl FnMut(Vec3, Vec3) -> u32, indices: &mut Vec<u32>) {
        let first = indices.len();
        let shared = self.field.vertices_at(self.problem, at);
        let corners = shared.map(|v| self.field.place(v));
        let mut outline = Vec::with_capacity(3);
        for k in 0..3 {
            let (from, to) = (CORNERS[k], CORNERS[(k + 1) % 3]);
            outline.push((from, corners[k]));
            let between = self.edge_points.between(corners[k], corners[(k + 1) % 3]);
            outline.extend(between.into_iter().map(|(t, place)| (from.lerp(to, t), place)));
        }
        let number = |(weights, place): &(Vec3, u32)| add(*weights, self.field.position_of_place(*place));
        let numbers: Vec<u32> = outline.iter().map(number).collect();
        if let [a, b, c] = numbers[..] {
            indices.extend([a, b, c]);
        } else {
            let [a, b, c] = shared.map(|v| self.field.position(v));
            let center = add(Vec3::splat(1.0 / 3.0), (a + b + c) / 3.0);
            let next = numbers.iter().cycle().skip(1);
            indices.extend(numbers.iter().zip(next).flat_map(|(&from, &to)| [from, to, center]));
        }
        if at.back {
            indices[first..].reverse();
        }
    }

    /// Whether `e` has next to no light while the other side of the same surface has: the inside of a sofa or a wall. Nobody
    /// sees it there, and leaving it out makes the file smaller.
    pub fn is_inside(&self, e: u32) -> bool {
        let mesh = &self.problem.mesh;
        let triangle = mesh.triangle(e);
        if !mesh.is_two_sided(triangle) {
            return false;
        }
        let center = mesh.corners(e).iter().sum::<Vec2>() / 3.0;
        let back = mesh.place(e).back;
        let light = |back| self.field.irradiance_at(self.problem, triangle, center, back).luminance();
        light(back) < INSIDE * light(!back)
    }

    /// What the scene file says at the given weights of the corners of a place.
    pub fn coating(&self, at: Place, weights: Vec3) -> Coating {
        let scene = &self.problem.scene;
        let on_triangle = self.problem.mesh.corners_at(at);
        let uv = on_triangle.iter().zip(weights.to_array()).map(|(c, w)| *c * w).sum::<Vec2>();
        let corners = scene.triangles[at.triangle as usize].vertices.map(|v| &scene.vertices[v as usize]);
        let of_triangle = [1.0 - uv.x - uv.y, uv.x, uv.y];
        let weighted = || corners.iter().zip(of_triangle);
        Coating {
            tint: weighted().map(|(c, w)| c.color * w).sum(),
            uv: weighted().map(|(c, w)| w * c.uv).sum(),
            emission_uv: weighted().map(|(c, w)| w * c.emission_uv).sum(),
        }
    }
}

/// The mean of the `values` of three vertices of a field, with these weights.
pub fn mean(vertices: [u32; 3], weights: Vec3, values: impl Fn(u32) -> Rgb) -> Rgb {
    vertices.into_iter().zip(weights.to_array()).map(|(v, w)| values(v) * w).sum()
}

/// Numbers of the elements of every object, in ascending order.
pub fn elements_by_object(problem: &Problem) -> Vec<Vec<u32>> {
    let mut elements = vec![Vec::new(); problem.scene.objects.len()];
    problem.mesh.elements().for_each(|e| elements[problem.object(e) as usize].push(e));
    elements
}
