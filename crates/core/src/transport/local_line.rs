//! Local lines: from a uniform point of an element in a cosine-distributed direction.
//!
//! The nearest surface such a line hits lies on element j with probability `F_ij`, the form factor (Nusselt 1928).

use super::Footprint;
use crate::Problem;
use crate::geometry::Ray;
use crate::math::Frame;
use crate::math::warp::square_to_cosine_hemisphere;
use crate::sampling::Sample;
use glam::{Vec2, Vec3};

/// An element from which lines depart.
#[derive(Clone, Copy, Debug)]
pub struct Departure<'a> {
    problem: &'a Problem,
    triangle: u32,
    back: bool,
    /// Barycentric coordinates of one corner, and the edges from it.
    corner: Vec2,
    edges: [Vec2; 2],
    footprint: Footprint,
}

/// A point of an element, lifted off it.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// World position [m].
    pub origin: Vec3,
    pub normal: Vec3,
    triangle: u32,
}

impl Start {
    /// The line into the unit vector `direction`.
    pub fn ray(&self, direction: Vec3) -> Ray {
        Ray { origin: self.origin, direction, from: self.triangle }
    }
}

impl<'a> Departure<'a> {
    /// Lines from the part of `element` that `footprint` covers.
    pub fn new(problem: &'a Problem, element: u32, footprint: Footprint) -> Departure<'a> {
        let place = problem.mesh.place(element);
        let [a, b, c] = problem.mesh.corners(element);
        Departure { problem, triangle: place.triangle, back: place.back, corner: a, edges: [b - a, c - a], footprint }
    }

    /// The local line that belongs to `sample`: its first two numbers choose the point, the others the direction.
    pub fn ray(&self, [x1, x2, x3, x4]: Sample) -> Ray {
        let start = self.start(self.footprint.point(Vec2::new(x1, x2)));
        let direction = Frame::about(start.normal).to_world(square_to_cosine_hemisphere(Vec2::new(x3, x4)));
        start.ray(direction)
    }

    /// Where lines start at barycentric coordinates `uv` of the element.
    pub fn start(&self, uv: Vec2) -> Start {
        let uv = self.corner + uv.x * self.edges[0] + uv.y * self.edges[1];
        let (point, front) = self.problem.geometry.surface(self.triangle, uv);
        let normal = if self.back { -front } else { front };
        Start { origin: point + normal * self.problem.geometry.lift(), normal, triangle: self.triangle }
    }
}
