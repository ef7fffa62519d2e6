//! Planted faults: what a test must see to be worth running. Each wraps or rebuilds a [`Problem`].

use glam::{Vec2, Vec3};
use isolux_core::Problem;
use isolux_core::geometry::{Geometry, Hit, HitLists, NONE, Ray};
use isolux_core::math::hash::{mix, unit_f64};
use std::sync::Arc;

/// A fault of the lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// Directions are uniform over the hemisphere: the cosine is forgotten.
    NoCosine,
    /// The lobe is narrower than the cosine's: tangents are multiplied by this.
    NarrowLobe(f32),
    /// This share of the rays passes through what it hits.
    Leaks(f64),
    /// This share of the hits is on the triangle after the next instead: on another face of a box.
    WrongTriangle(f64),
}

/// `problem` with faulty lines.
pub fn with_fault(problem: Problem, fault: Fault) -> Problem {
    let triangles = problem.scene.triangles.len() as u32;
    Problem { geometry: Arc::new(Faulty { sound: problem.geometry, triangles, fault }), ..problem }
}

struct Faulty {
    sound: Arc<dyn Geometry>,
    triangles: u32,
    fault: Fault,
}

impl Faulty {
    /// The ray with its fault; rays of lamps are left alone. The normal is that of a flat triangle, or of a sphere about the origin.
    fn distort(&self, ray: &Ray) -> Ray {
        if ray.from == NONE {
            return *ray;
        }
        let (center, normal) = self.sound.surface(ray.from, Vec2::splat(1.0 / 3.0));
        let curved = (ray.origin - center).dot(normal).abs() > 1e-3 * ray.origin.distance(center);
        let front = if curved { -ray.origin.normalize() } else { normal };
        let normal = if ray.direction.dot(front) < 0.0 { -front } else { front };
        let cos = ray.direction.dot(normal);
        let tangent = ray.direction - normal * cos;
        let direction = match self.fault {
            // The square of a cosine-distributed cosine is uniform, as the cosine of uniform directions is.
            Fault::NoCosine => {
                let cos = (cos * cos).max(1e-4);
                normal * cos + tangent.normalize_or_zero() * (1.0 - cos * cos).sqrt()
            }
            Fault::NarrowLobe(scale) => (normal * cos + tangent * scale).normalize(),
            Fault::Leaks(_) | Fault::WrongTriangle(_) => ray.direction,
        };
        Ray { direction, ..*ray }
    }

    fn spoil(&self, ray: &Ray, hit: &mut Hit) {
        let bits = |v: Vec3| v.to_array().into_iter().fold(0, |key, x| mix(key ^ u64::from(x.to_bits())));
        let draw = unit_f64(mix(bits(ray.direction) ^ bits(ray.origin)));
        match self.fault {
            Fault::Leaks(share) if draw < share => *hit = Hit::MISS,
            Fault::WrongTriangle(share) if draw < share => hit.triangle = (hit.triangle + 2) % self.triangles,
            _ => {}
        }
    }
}

impl Geometry for Faulty {
    fn closest(&self, rays: &[Ray], hits: &mut [Hit]) {
        let distorted: Vec<Ray> = rays.iter().map(|ray| self.distort(ray)).collect();
        self.sound.closest(&distorted, hits);
        distorted.iter().zip(hits).filter(|(_, hit)| !hit.is_miss()).for_each(|(ray, hit)| self.spoil(ray, hit));
    }

    /// Global lines leave no surface: they are left alone.
    fn all(&self, rays: &[Ray], lists: &mut HitLists) {
        self.sound.all(rays, lists);
    }

    fn any(&self, rays: &[Ray], reach: &[f32], blocked: &mut [bool]) {
        self.sound.any(rays, reach, blocked);
    }

    fn surface(&self, triangle: u32, uv: Vec2) -> (Vec3, Vec3) {
        self.sound.surface(triangle, uv)
    }

    fn lift(&self) -> f32 {
        self.sound.lift()
    }

    fn bounding_sphere(&self) -> (Vec3, f32) {
        self.sound.bounding_sphere()
    }
}
