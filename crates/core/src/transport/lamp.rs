//! Rays of lights without extent (glTF KHR_lights_punctual); every ray of a light carries the same flux.

use crate::geometry::{NONE, Ray};
use crate::math::Frame;
use crate::math::warp::{square_to_disc, square_to_sphere};
use crate::sampling::Sample;
use crate::scene::{Light, LightKind};
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// The ray of `light` that belongs to `sample`. A directional light shines through the disc of the scene's bounding
/// sphere (`center`, `radius`) across its direction; rays that miss the scene are light that escapes.
pub fn ray(light: &Light, [x1, x2, x3, x4]: Sample, (center, radius): (Vec3, f32)) -> Ray {
    let (origin, direction) = match light.kind {
        LightKind::Point { position } => (position, square_to_sphere(Vec2::new(x3, x4))),
        LightKind::Spot { position, direction, inner_angle, outer_angle } => {
            let cos = spot_cosine(x3, inner_angle.cos(), outer_angle.cos());
            let sin = (1.0 - cos * cos).max(0.0).sqrt();
            let (sin_phi, cos_phi) = (TAU * x4).sin_cos();
            (position, Frame::about(direction).to_world(Vec3::new(sin * cos_phi, sin * sin_phi, cos)))
        }
        LightKind::Directional { direction } => {
            let frame = Frame::about(direction);
            let disc = square_to_disc(Vec2::new(x1, x2)) * radius;
            (center + frame.x * disc.x + frame.y * disc.y - frame.z * radius, direction)
        }
    };
    Ray { origin, direction: direction.normalize(), from: NONE }
}

/// Cosine of the angle to the axis with a density proportional to the intensity: 1 above `inner`, the square of a
/// linear ramp down to 0 at `outer`. Inverse of the distribution function, from the rim inwards.
fn spot_cosine(x: f32, inner: f32, outer: f32) -> f32 {
    let (ramp, cone) = ((inner - outer) / 3.0, 1.0 - inner);
    let share = x * (ramp + cone);
    if share < ramp { outer + (inner - outer) * (share / ramp).cbrt() } else { inner + share - ramp }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;

    fn samples() -> impl Iterator<Item = Sample> {
        (0..10_000).map(|k| [0.5, 0.5, (k % 100) as f32 / 100.0 + 0.005, (k / 100) as f32 / 100.0 + 0.005])
    }

    #[test]
    fn spot_rays_have_the_density_of_the_intensity() {
        let (inner, outer) = (0.3f32, 0.8f32);
        let kind = LightKind::Spot { position: Vec3::ZERO, direction: Vec3::Z, inner_angle: inner, outer_angle: outer };
        let light = Light { name: String::new(), intensity: Rgb::WHITE, kind };
        // Mean cosine over the rays against the quotient of the integrals of I cos and I, by the midpoint rule.
        let mean = samples().map(|s| ray(&light, s, (Vec3::ZERO, 1.0)).direction.z).sum::<f32>() / 10_000.0;
        let steps = 10_000;
        let (mut weighted, mut flux) = (0.0f64, 0.0f64);
        for k in 0..steps {
            let cos = outer.cos() + (1.0 - outer.cos()) * (k as f32 + 0.5) / steps as f32;
            let intensity = f64::from(Light::spot_falloff(cos, inner, outer));
            weighted += intensity * f64::from(cos);
            flux += intensity;
        }
        assert!((f64::from(mean) - weighted / flux).abs() < 1e-4);
        let expected = flux / steps as f64 * f64::from(1.0 - outer.cos()) * std::f64::consts::TAU;
        assert!((f64::from(light.flux(1.0).g) / expected - 1.0).abs() < 1e-3);
    }

    #[test]
    fn point_rays_are_uniform() {
        let light =
            Light { name: String::new(), intensity: Rgb::WHITE, kind: LightKind::Point { position: Vec3::ZERO } };
        let sum: Vec3 = samples().map(|s| ray(&light, s, (Vec3::ZERO, 1.0)).direction).sum();
        assert!((sum / 10_000.0).length() < 1e-3);
    }
}
