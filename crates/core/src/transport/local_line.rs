//! Local lines: from a uniform point of an element in a cosine-distributed direction.
//!
//! The nearest surface such a line hits lies on element j with probability `F_ij`, the form factor (Nusselt 1928).

use super::Footprint;
use crate::Problem;
use crate::geometry::{Facet, Ray};
use crate::math::Frame;
use crate::math::warp::square_to_cosine_hemisphere;
use crate::mesh::{Cluster, Place};
use crate::sampling::Sample;
use glam::{Vec2, Vec3};

/// An element from which lines depart.
#[derive(Clone, Copy, Debug)]
pub struct Departure<'a> {
    problem: &'a Problem,
    triangle: u32,
    back: bool,
    /// Barycentric coordinates on the triangle of one corner, and the edges from it.
    corner: Vec2,
    edges: [Vec2; 2],
    /// All triangles, if there are several.
    cluster: Option<Cluster<'a>>,
    footprint: Footprint,
    /// Distance [m] by which origins are lifted off the surface.
    lift: f32,
    /// The triangle in space, and the frame about the side's normal, if they are the same for all lines.
    flat: Option<(Facet, Frame)>,
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
        let (Place { triangle, back, .. }, [corner, along, across]) = problem.mesh.place_and_edges(element);
        let cluster = problem.mesh.cluster(element);
        let facet = problem.geometry.facet(triangle).filter(|_| cluster.is_none());
        let flat = facet.map(|facet| (facet, frame(facet.normal, back)));
        let lift = problem.geometry.lift();
        Departure { problem, triangle, back, corner, edges: [along, across], cluster, footprint, lift, flat }
    }

    /// The local line that belongs to `sample`: its first two numbers choose the point, the others the direction.
    pub fn ray(&self, [x1, x2, x3, x4]: Sample) -> Ray {
        let (start, frame) = self.start_and_frame(self.footprint.point(Vec2::new(x1, x2)));
        start.ray(frame.to_world(square_to_cosine_hemisphere(Vec2::new(x3, x4))))
    }

    /// Where lines start at barycentric coordinates `uv` of the element.
    pub fn start(&self, uv: Vec2) -> Start {
        self.start_and_frame(uv).0
    }

    fn start_and_frame(&self, uv: Vec2) -> (Start, Frame) {
        let (triangle, uv) = match self.cluster {
            None => (self.triangle, self.corner + uv.x * self.edges[0] + uv.y * self.edges[1]),
            Some(cluster) => cluster.point(uv),
        };
        let (point, frame) = match self.flat {
            Some((facet, frame)) => (facet.at(uv), frame),
            None => {
                let (point, front) = self.problem.geometry.surface(triangle, uv);
                (point, frame(front, self.back))
            }
        };
        let normal = frame.z;
        (Start { origin: point + normal * self.lift, normal, triangle }, frame)
    }
}

/// The frame about the normal of a side, `front` being that of the triangle's front.
fn frame(front: Vec3, back: bool) -> Frame {
    Frame::about(if back { -front } else { front })
}
