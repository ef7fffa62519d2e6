//! The oracle: every ray against every triangle (Möller & Trumbore 1997, in double precision). Slow and obviously right.

use super::{Corners, Facet, Geometry, Hit, HitLists, NONE, Ray};
use crate::scene::Scene;
use glam::{DVec3, Vec2, Vec3};

/// Tests each triangle for each ray; for tests of other geometries.
#[derive(Clone, Debug)]
pub struct Brute {
    corners: Corners,
}

impl Brute {
    pub fn new(scene: &Scene) -> Brute {
        Brute { corners: Corners::of(scene) }
    }

    /// Every hit of `ray` in front of its origin, in the order of triangles.
    fn hits(&self, ray: &Ray) -> impl Iterator<Item = Hit> {
        let triangles = (0u32..).zip(&self.corners.triangles).filter(|(k, _)| *k != ray.from);
        triangles.filter_map(|(k, corners)| intersect(ray, k, *corners))
    }

    fn first(&self, ray: &Ray) -> Hit {
        self.hits(ray).min_by(|a, b| a.t.total_cmp(&b.t)).unwrap_or(Hit::MISS)
    }
}

impl Geometry for Brute {
    fn closest(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.first(ray);
        }
    }

    fn all(&self, rays: &[Ray], lists: &mut HitLists) {
        lists.clear();
        for ray in rays {
            self.hits(ray).for_each(|hit| lists.push(hit));
            lists.finish();
        }
    }

    fn any(&self, rays: &[Ray], reach: &[f32], blocked: &mut [bool]) {
        for ((ray, reach), blocked) in rays.iter().zip(reach).zip(blocked) {
            *blocked = self.first(ray).t < *reach;
        }
    }

    fn surface(&self, triangle: u32, uv: Vec2) -> (Vec3, Vec3) {
        self.corners.surface(triangle, uv)
    }

    fn facet(&self, triangle: u32) -> Option<Facet> {
        Some(self.corners.facet(triangle))
    }

    fn lift(&self) -> f32 {
        self.corners.lift
    }

    fn bounding_sphere(&self) -> (Vec3, f32) {
        (self.corners.center, self.corners.radius)
    }
}

/// Where `ray` meets a triangle, if it does.
fn intersect(ray: &Ray, triangle: u32, corners: [Vec3; 3]) -> Option<Hit> {
    debug_assert_ne!(triangle, NONE);
    let [a, b, c] = corners.map(|v| v.as_dvec3());
    let direction: DVec3 = ray.direction.as_dvec3();
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let s = ray.origin.as_dvec3() - a;
    let q = s.cross(ab);
    let (u, v, t) = (s.dot(p) / determinant, direction.dot(q) / determinant, ac.dot(q) / determinant);
    let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0;
    inside.then(|| Hit { t: t as f32, triangle, uv: Vec2::new(u as f32, v as f32), back: determinant < 0.0 })
}
