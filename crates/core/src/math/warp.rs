//! Area-preserving maps from the unit square that keep its strata: to the disc (Shirley & Chiu 1997), to the
//! cosine-weighted hemisphere (Malley 1988: disc lifted to the hemisphere), to the triangle (Heitz 2019).

use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

/// Unit square to unit disc, concentric and area preserving.
pub fn square_to_disc(u: Vec2) -> Vec2 {
    let s = 2.0 * u - Vec2::ONE;
    if s.x == 0.0 && s.y == 0.0 {
        return Vec2::ZERO;
    }
    let (radius, angle) =
        if s.x.abs() > s.y.abs() { (s.x, FRAC_PI_4 * (s.y / s.x)) } else { (s.y, FRAC_PI_2 - FRAC_PI_4 * (s.x / s.y)) };
    let (sin, cos) = angle.sin_cos();
    radius * Vec2::new(cos, sin)
}

/// Unit square to the hemisphere about +z with density cos(theta) / pi. The result is a unit vector with z > 0.
pub fn square_to_cosine_hemisphere(u: Vec2) -> Vec3 {
    let d = square_to_disc(u);
    // A point on the rim would graze its own surface for ever; half a unit in the last place keeps it above.
    let z = (1.0 - d.length_squared()).max(1e-8).sqrt();
    Vec3::new(d.x, d.y, z)
}

/// Unit square to the barycentric coordinates (u, v) of a triangle, u, v >= 0, u + v <= 1, area preserving.
///
/// Heitz, A Low-Distortion Map Between Triangle and Square, 2019: no fold, so strata stay compact.
pub fn square_to_triangle(s: Vec2) -> Vec2 {
    if s.y > s.x {
        let u = 0.5 * s.x;
        Vec2::new(u, s.y - u)
    } else {
        let v = 0.5 * s.y;
        Vec2::new(s.x - v, v)
    }
}

/// The inverse of [`square_to_triangle`].
pub fn triangle_to_square(uv: Vec2) -> Vec2 {
    let sum = uv.x + uv.y;
    if uv.y > uv.x { Vec2::new(2.0 * uv.x, sum) } else { Vec2::new(sum, 2.0 * uv.y) }
}

/// Unit square to the unit sphere, uniform (Archimedes' hat-box map).
pub fn square_to_sphere(u: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * u.x;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = (std::f32::consts::TAU * u.y).sin_cos();
    Vec3::new(r * cos, r * sin, z)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Midpoints of an n x n grid: integrates smooth functions to O(1/n²).
    fn grid(n: u32) -> impl Iterator<Item = Vec2> {
        (0..n * n).map(move |k| Vec2::new((k % n) as f32 + 0.5, (k / n) as f32 + 0.5) / n as f32)
    }

    fn mean(n: u32, f: impl Fn(Vec2) -> f64) -> f64 {
        grid(n).map(f).sum::<f64>() / f64::from(n * n)
    }

    #[test]
    fn disc_map_has_the_moments_of_the_uniform_disc() {
        assert!((mean(400, |u| f64::from(square_to_disc(u).length_squared())) - 0.5).abs() < 1e-4);
        assert!(mean(400, |u| f64::from(square_to_disc(u).x)).abs() < 1e-4);
    }

    #[test]
    fn hemisphere_map_has_the_moments_of_the_cosine_density() {
        let z = |u| f64::from(square_to_cosine_hemisphere(u).z);
        assert!((mean(400, z) - 2.0 / 3.0).abs() < 1e-4);
        assert!((mean(400, |u| z(u).powi(2)) - 0.5).abs() < 1e-4);
    }

    #[test]
    fn triangle_map_has_the_moments_of_the_uniform_triangle() {
        let b = |u| square_to_triangle(u);
        assert!((mean(400, |u| f64::from(b(u).x)) - 1.0 / 3.0).abs() < 1e-4);
        assert!((mean(400, |u| f64::from(b(u).x * b(u).y)) - 1.0 / 12.0).abs() < 1e-4);
        assert!(grid(100).all(|u| b(u).x >= 0.0 && b(u).y >= 0.0 && b(u).x + b(u).y <= 1.0));
    }

    #[test]
    fn triangle_maps_are_inverse_to_each_other() {
        assert!(grid(100).all(|s| triangle_to_square(square_to_triangle(s)).distance(s) < 1e-6));
    }

    #[test]
    fn sphere_map_has_the_moments_of_the_uniform_sphere() {
        assert!((mean(400, |u| f64::from(square_to_sphere(u).z).powi(2)) - 1.0 / 3.0).abs() < 1e-4);
    }
}
