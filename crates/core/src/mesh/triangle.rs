//! Measures of triangles, in double precision: thin ones lose all their digits otherwise.

use crate::scene::{Scene, Shape};
use glam::{DVec3, Vec3};

/// Area [m²] of the surface that triangle `t` stands for.
pub fn surface_area(scene: &Scene, t: u32) -> f64 {
    match scene.shape {
        Shape::Triangles => 0.5 * cross(scene.corners(t)).length(),
        Shape::Sphere { radius, .. } => 4.0 * std::f64::consts::PI * f64::from(radius).powi(2) / 8.0,
    }
}

/// Unit normal of the front.
pub fn normal(corners: [Vec3; 3]) -> Vec3 {
    cross(corners).normalize_or(DVec3::Z).as_vec3()
}

pub fn longest_edge([a, b, c]: [Vec3; 3]) -> f64 {
    f64::from(a.distance(b).max(b.distance(c)).max(c.distance(a)))
}

pub fn shortest_edge([a, b, c]: [Vec3; 3]) -> f64 {
    f64::from(a.distance(b).min(b.distance(c)).min(c.distance(a)))
}

/// Height [m] above the longest edge.
pub fn height(corners: [Vec3; 3]) -> f64 {
    cross(corners).length() / longest_edge(corners).max(f64::MIN_POSITIVE)
}

fn cross([a, b, c]: [Vec3; 3]) -> DVec3 {
    let a = a.as_dvec3();
    (b.as_dvec3() - a).cross(c.as_dvec3() - a)
}
