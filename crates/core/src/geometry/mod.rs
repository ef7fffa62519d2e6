//! What a ray or a line hits.
//!
//! A [`Geometry`] answers three questions: what does this ray hit first, what does it hit at all, and where is this point of a
//! triangle? It knows triangles only; elements are found from the barycentric coordinates of a hit (see [`crate::mesh`]).

pub mod brute;
pub mod bvh;
mod lists;
pub mod raster;
pub mod sphere;

pub use brute::Brute;
pub use bvh::Bvh;
pub use lists::{Along, HitLists, Lists};
pub use sphere::Sphere;

use crate::scene::{Scene, Shape};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// "No triangle": what a ray from a lamp or a camera leaves, and what a ray into the open hits.
pub const NONE: u32 = u32::MAX;

/// A half line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Ray {
    pub origin: Vec3,
    /// Unit vector.
    pub direction: Vec3,
    /// The triangle it leaves, which it never hits, or [`NONE`].
    pub from: u32,
}

impl Ray {
    /// Radii that [`Ray::whole_line`] begins before its point.
    pub const LEAD: f32 = 1.5;

    /// The whole line through `point`, the one nearest to the centre of a sphere of `radius` [m], as a ray: it begins outside the
    /// sphere.
    pub fn whole_line(point: Vec3, direction: Vec3, radius: f32) -> Ray {
        Ray { origin: point - Ray::LEAD * radius * direction, direction, from: NONE }
    }
}

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Hit {
    /// Distance [m]; infinite if nothing was hit.
    pub t: f32,
    /// Triangle, or [`NONE`].
    pub triangle: u32,
    /// Barycentric coordinates: the point is `(1 - u - v) a + u b + v c`.
    pub uv: Vec2,
    /// Whether it was hit from behind.
    pub back: bool,
}

impl Hit {
    pub const MISS: Hit = Hit { t: f32::INFINITY, triangle: NONE, uv: Vec2::ZERO, back: false };

    pub fn is_miss(&self) -> bool {
        self.triangle == NONE
    }
}

/// A flat triangle in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// World position [m] of a corner, and the edges [m] from it.
    corner: Vec3,
    edges: [Vec3; 2],
    /// Unit normal of the front.
    pub normal: Vec3,
}

impl Facet {
    pub fn new([a, b, c]: [Vec3; 3]) -> Facet {
        let (ab, ac) = (b - a, c - a);
        let normal = ab.as_dvec3().cross(ac.as_dvec3()).normalize_or(glam::DVec3::Z).as_vec3();
        Facet { corner: a, edges: [ab, ac], normal }
    }

    /// World position [m] at barycentric coordinates `uv`.
    #[inline]
    pub fn at(&self, uv: Vec2) -> Vec3 {
        self.corner + uv.x * self.edges[0] + uv.y * self.edges[1]
    }
}

/// Surfaces that can be traced. Implementations are pure: the same ray has the same hit on every machine and thread.
pub trait Geometry: Send + Sync {
    /// First hit of every ray, `hits[k]` for `rays[k]`; both slices have the same length. Fastest if neighbouring rays have
    /// neighbouring origins.
    fn closest(&self, rays: &[Ray], hits: &mut [Hit]);

    /// All hits of every ray, into the lists of `lists`: list k for `rays[k]`, whatever was there before is gone. The nearest hit
    /// is that of [`Geometry::closest`]; a line that passes through a shared edge hits both triangles at the same distance.
    fn all(&self, rays: &[Ray], lists: &mut HitLists);

    /// Whether anything lies strictly within distance `reach[k]` [m] of the origin of `rays[k]`, into `blocked[k]`.
    fn any(&self, rays: &[Ray], reach: &[f32], blocked: &mut [bool]);

    /// World position [m] and unit normal of the front at barycentric coordinates `uv` of `triangle`.
    fn surface(&self, triangle: u32, uv: Vec2) -> (Vec3, Vec3);

    /// `triangle`, if it is flat: many points of it cost less than as many calls of [`Geometry::surface`], and are the same.
    fn facet(&self, _triangle: u32) -> Option<Facet> {
        None
    }

    /// How far [m] a ray's origin is lifted off the surface it leaves, so that rounding cannot put it behind: a few units
    /// in the last place of the largest coordinate. Coincident faces therefore do not see each other.
    fn lift(&self) -> f32;

    /// Centre and radius [m] of a sphere around everything.
    fn bounding_sphere(&self) -> (Vec3, f32);
}

/// The geometry for `scene`: the fast kernel for triangles, the exact one for a sphere.
pub fn for_scene(scene: &Scene) -> Arc<dyn Geometry> {
    match scene.shape {
        Shape::Triangles => Arc::new(Bvh::new(scene)),
        Shape::Sphere { center, radius } => Arc::new(Sphere::new(center, radius)),
    }
}

/// Corner positions, which both triangle geometries share.
#[derive(Clone, Debug)]
pub(crate) struct Corners {
    pub triangles: Vec<[Vec3; 3]>,
    pub lift: f32,
    pub center: Vec3,
    pub radius: f32,
}

impl Corners {
    pub fn of(scene: &Scene) -> Corners {
        let (low, high) = scene.bounds();
        let largest = low.abs().max(high.abs()).max_element();
        Corners {
            triangles: (0..scene.triangles.len() as u32).map(|t| scene.corners(t)).collect(),
            lift: 8.0 * f32::EPSILON * largest,
            center: 0.5 * (low + high),
            radius: 0.5 * low.distance(high) * (1.0 + 1e-6),
        }
    }

    pub fn surface(&self, triangle: u32, uv: Vec2) -> (Vec3, Vec3) {
        let facet = self.facet(triangle);
        (facet.at(uv), facet.normal)
    }

    pub fn facet(&self, triangle: u32) -> Facet {
        Facet::new(self.triangles[triangle as usize])
    }
}
