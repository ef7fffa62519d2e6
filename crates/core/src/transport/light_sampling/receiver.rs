//! An element as a receiver of light, and about what an emitter sends to it.

use super::emitter::Emitter;
use crate::Problem;
use crate::math::SphericalTriangle;
use crate::mesh::Cluster;
use crate::scene::Shape;
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// Share of what an emitter would send if both faced each other that a receiver is believed to get at the least, unless it is
/// certain that it gets nothing: where the estimate is wrong, no direction must become rare.
pub const FLOOR: f32 = 0.02;

/// What is known of the shape of a receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// One plane holds all of it.
    Flat,
    /// Its normals are within an angle of the mean one that has this cosine, above zero, and sine.
    Bent { cos: f32, sin: f32 },
    /// Nothing.
    Curved,
}

/// An element that receives light.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    /// Of what is flat.
    corners: [Vec3; 3],
    pub center: Vec3,
    /// Distance [m] of the farthest corner from the centre.
    pub radius: f32,
    /// The mean one if it is bent.
    pub normal: Vec3,
    /// Heights [m] above a plane that are nothing but rounding.
    tolerance: f32,
    form: Form,
}

impl Receiver {
    /// `element` of `problem`.
    pub fn new(problem: &Problem, element: u32) -> Receiver {
        let place = problem.mesh.place(element);
        if let Some(cluster) = problem.mesh.cluster(element) {
            return Receiver::of_cluster(problem, cluster, place.back);
        }
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
            form: if problem.scene.shape == Shape::Triangles { Form::Flat } else { Form::Curved },
        }
    }

    fn of_cluster(problem: &Problem, cluster: Cluster, back: bool) -> Receiver {
        let middle = |t: u32| problem.geometry.surface(t, Vec2::splat(1.0 / 3.0));
        let side = if back { -1.0 } else { 1.0 };
        let (mut center, mut vector) = (Vec3::ZERO, Vec3::ZERO);
        for piece in cluster.pieces() {
            let (position, front) = middle(piece.triangle);
            center += piece.share() * position;
            vector += piece.share() * side * front;
        }
        let normal = vector.normalize_or(Vec3::Y);
        let cos = cluster.triangles().map(|t| side * middle(t).1.dot(normal)).fold(1.0, f32::min);
        let corners = cluster.triangles().flat_map(|t| problem.scene.corners(t));
        Receiver {
            corners: [center; 3],
            center,
            radius: corners.map(|corner| corner.distance(center)).fold(0.0, f32::max),
            normal,
            tolerance: 2.0 * problem.geometry.lift(),
            form: if cos > 0.0 { Form::Bent { cos, sin: (1.0 - cos * cos).sqrt() } } else { Form::Curved },
        }
    }

    /// Share of what an emitter would send if both faced each other that this one is believed to get at the least: more than
    /// [`FLOOR`] if a part of it may face the emitter better than its mean normal tells.
    pub fn floor(&self) -> f32 {
        if let Form::Bent { sin, .. } = self.form { sin.max(FLOOR) } else { FLOOR }
    }

    /// Whether all of it is certain to see nothing of a sphere, for its horizon.
    pub fn is_above(&self, center: Vec3, radius: f32) -> bool {
        let way = center - self.center;
        let height = way.dot(self.normal);
        match self.form {
            Form::Flat => height + radius <= self.tolerance,
            Form::Bent { cos, sin } => {
                let aside = (way - height * self.normal).length();
                height * cos + aside * sin + radius + self.radius <= 0.0
            }
            Form::Curved => false,
        }
    }

    /// About the irradiance [lux] that one emitter gives, were nothing in between, from what the centre sees: Lambert's formula if
    /// all of the emitter is above the horizon, else its solid angle and the mean of the cosines to its corners. 0 only if it
    /// gives none for certain.
    pub fn irradiance(&self, emitter: &Emitter) -> f32 {
        if emitter.corners.iter().all(|&corner| self.is_above(corner, 0.0)) || self.is_behind(emitter) {
            return 0.0;
        }
        let ways = emitter.corners.map(|corner| corner - self.center);
        let way = (ways[0] + ways[1] + ways[2]) / 3.0;
        let facing = emitter.area / way.length_squared().max(self.radius * self.radius + emitter.area);
        let sent = match self.form {
            Form::Curved => facing,
            _ => self.projected(emitter, ways).max(self.floor() * facing),
        };
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

    /// Whether all of it is certain to lie where the emitter does not shine.
    fn is_behind(&self, emitter: &Emitter) -> bool {
        let height = |point: Vec3| (point - emitter.corners[0]).dot(emitter.normal);
        match self.form {
            Form::Flat => self.corners.iter().all(|&corner| height(corner) <= self.tolerance),
            Form::Bent { .. } => height(self.center) + self.radius <= self.tolerance,
            Form::Curved => false,
        }
    }
}
