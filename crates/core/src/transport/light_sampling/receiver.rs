//! An element as a receiver of light, and about what an emitter sends to it.

use super::emitter::Emitter;
use crate::Problem;
use crate::math::SphericalTriangle;
use crate::scene::Shape;
use glam::Vec3;
use std::f32::consts::PI;

/// Share of what an emitter would send if both faced each other that a receiver is believed to get at the least, unless it is
/// certain that it gets nothing: where the estimate is wrong, no direction must become rare.
pub const FLOOR: f32 = 0.02;

/// An element that receives light.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    pub corners: [Vec3; 3],
    pub center: Vec3,
    /// Distance [m] of the farthest corner from the centre.
    pub radius: f32,
    pub normal: Vec3,
    /// Heights [m] above a plane that are nothing but rounding.
    pub tolerance: f32,
    /// Whether one plane holds all of it.
    pub flat: bool,
}

impl Receiver {
    /// `element` of `problem`.
    pub fn new(problem: &Problem, element: u32) -> Receiver {
        let place = problem.mesh.place(element);
        let corners = problem.mesh.corners(element);
        let at = |uv| problem.geometry.surface(place.triangle, uv);
        let (center, front) = at((corners[0] + corners[1] + corners[2]) / 3.0);
        let corners = corners.map(|uv| at(uv).0);
        Receiver {
            corners,
            center,
            radius: corners.iter().map(|c| c.distance(center)).fold(0.0, f32::max),
            normal: if place.back { -front } else { front },
            tolerance: 2.0 * problem.geometry.lift(),
            flat: problem.scene.shape == Shape::Triangles,
        }
    }

    /// About the irradiance [lux] that one emitter gives, were nothing in between, from what the centre sees: Lambert's formula if
    /// all of the emitter is above the horizon, else its solid angle and the mean of the cosines to its corners. 0 only if it
    /// gives none for certain.
    pub fn irradiance(&self, emitter: &Emitter) -> f32 {
        if self.flat && (self.is_above_none(emitter.corners) || is_behind(emitter, self.corners, self.tolerance)) {
            return 0.0;
        }
        let ways = emitter.corners.map(|corner| corner - self.center);
        let way = (ways[0] + ways[1] + ways[2]) / 3.0;
        let facing = emitter.area / way.length_squared().max(self.radius * self.radius + emitter.area);
        let sent = if self.flat { self.projected(emitter, ways).max(FLOOR * facing) } else { facing };
        emitter.emission.luminance() * sent / PI
    }

    /// About the solid angle of `emitter`, weighted by the cosine; `ways` lead to its corners.
    fn projected(&self, emitter: &Emitter, ways: [Vec3; 3]) -> f32 {
        let Some(seen) = SphericalTriangle::new(emitter.corners, self.center) else { return 0.0 };
        if ways.iter().all(|way| way.dot(self.normal) >= -self.tolerance) {
            return seen.projected(self.normal) as f32;
        }
        let cosines = ways.map(|way| way.normalize_or_zero().dot(self.normal).max(0.0));
        seen.solid_angle() as f32 * cosines.iter().sum::<f32>() / 3.0
    }

    fn is_above_none(&self, corners: [Vec3; 3]) -> bool {
        corners.iter().all(|&corner| (corner - self.center).dot(self.normal) <= self.tolerance)
    }
}

/// Whether all `points` lie where the emitter does not shine.
fn is_behind(emitter: &Emitter, points: [Vec3; 3], tolerance: f32) -> bool {
    points.iter().all(|&point| (point - emitter.corners[0]).dot(emitter.normal) <= tolerance)
}
