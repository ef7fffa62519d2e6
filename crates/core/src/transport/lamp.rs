//! Lights without extent (glTF KHR_lights_punctual): their rays, each of which carries the same flux, and what they give a point.

use crate::geometry::{NONE, Ray};
use crate::math::warp::{square_to_disc, square_to_sphere};
use crate::math::{Frame, Rgb};
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

/// What a light gives a point, were nothing in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shine {
    /// Irradiance [lux].
    pub irradiance: Rgb,
    /// Unit vector from the point to the light.
    pub direction: Vec3,
    /// Distance of the light [m]; infinite if it has none.
    pub distance: f32,
}

/// What `light` gives the surface at `point` with `normal`: `I cos / r²`, or for a directional light `E cos`. `None` if nothing.
pub fn shine(light: &Light, point: Vec3, normal: Vec3) -> Option<Shine> {
    let (direction, distance, share) = match light.kind {
        LightKind::Point { position } => (position - point, position.distance(point), 1.0),
        LightKind::Spot { position, direction, inner_angle, outer_angle } => {
            let cos = (point - position).normalize_or_zero().dot(direction.normalize_or_zero());
            (position - point, position.distance(point), Light::spot_falloff(cos, inner_angle, outer_angle))
        }
        LightKind::Directional { direction } => (-direction, f32::INFINITY, 1.0),
    };
    let direction = direction.normalize_or_zero();
    let over_square = if distance.is_finite() { 1.0 / (distance * distance) } else { 1.0 };
    let factor = share * direction.dot(normal) * over_square;
    let shines = factor > 0.0 && factor.is_finite();
    shines.then(|| Shine { irradiance: light.intensity * factor, direction, distance })
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

    /// Flux is irradiance times area: what shines on a sphere around a lamp is what it emits.
    #[test]
    fn what_shines_on_a_sphere_is_the_flux() {
        let position = Vec3::new(1.0, 2.0, 3.0);
        let direction = Vec3::new(0.6, 0.0, 0.8);
        let kinds = [
            LightKind::Point { position },
            LightKind::Spot { position, direction, inner_angle: 0.4, outer_angle: 1.1 },
        ];
        for kind in kinds {
            let light = Light { name: String::new(), intensity: Rgb::WHITE, kind };
            let on = |s: Sample| {
                let outward = square_to_sphere(Vec2::new(s[2], s[3]));
                shine(&light, position + 2.0 * outward, -outward).map_or(0.0, |shine| shine.irradiance.g)
            };
            let flux = samples().map(on).sum::<f32>() / 10_000.0 * 16.0 * std::f32::consts::PI;
            assert!((flux / light.flux(1.0).g - 1.0).abs() < 1e-3, "{kind:?}: {flux}");
        }
        let sun = Light { name: String::new(), intensity: Rgb::WHITE, kind: LightKind::Directional { direction } };
        assert_eq!(shine(&sun, position, Vec3::NEG_Z).map(|shine| shine.irradiance.g), Some(0.8));
        assert_eq!(shine(&sun, position, Vec3::Z), None);
    }
}
