//! Lights without extent (glTF KHR_lights_punctual).

use crate::math::Rgb;
use glam::Vec3;
use std::f32::consts::PI;

/// A light without surface. It is a source of direct light like any emitter, but nothing can hit it.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Light {
    pub name: String,
    /// Luminous intensity [cd] of a point or spot light, illuminance across the beam [lux] of a directional one.
    pub intensity: Rgb,
    pub kind: LightKind,
}

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum LightKind {
    /// The same intensity in every direction.
    Point { position: Vec3 },
    /// Full intensity within `inner_angle` of `direction`, none outside `outer_angle` [rad], smooth between
    /// (the square of a linear ramp in the cosine, as KHR_lights_punctual recommends).
    Spot { position: Vec3, direction: Vec3, inner_angle: f32, outer_angle: f32 },
    /// Parallel light travelling along the unit vector `direction`.
    Directional { direction: Vec3 },
}

impl Light {
    /// Emitted flux [lm] per channel. `scene_radius` [m] is that of the bounding sphere: a directional light fills its disc.
    pub fn flux(&self, scene_radius: f32) -> Rgb {
        let solid_angle = match self.kind {
            LightKind::Point { .. } => 4.0 * PI,
            LightKind::Spot { inner_angle, outer_angle, .. } => {
                // Integral of ((cos t - cos o) / (cos i - cos o))² over the ramp is a third of its solid angle.
                let (inner, outer) = (inner_angle.cos(), outer_angle.cos());
                2.0 * PI * ((1.0 - inner) + (inner - outer) / 3.0)
            }
            LightKind::Directional { .. } => PI * scene_radius * scene_radius,
        };
        self.intensity * solid_angle
    }

    /// Share of the full intensity that a spot sends at `cos_angle` from its axis.
    pub fn spot_falloff(cos_angle: f32, inner_angle: f32, outer_angle: f32) -> f32 {
        let (inner, outer) = (inner_angle.cos(), outer_angle.cos());
        let ramp = ((cos_angle - outer) / (inner - outer).max(1e-6)).clamp(0.0, 1.0);
        ramp * ramp
    }
}
