//! What a point of a surface sends out: textures at full resolution over interpolated irradiance.

use super::VertexField;
use crate::Problem;
use crate::math::Rgb;
use glam::Vec2;
use std::f32::consts::FRAC_1_PI;

/// Luminance [cd/m²] of a point, the same in all directions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seen {
    pub emitted: Rgb,
    pub reflected: Rgb,
    /// Of what is reflected; zero if it is not known.
    pub std_error: Rgb,
}

impl Seen {
    pub fn luminance(self) -> Rgb {
        self.emitted + self.reflected
    }
}

/// `L = (Be + rho E) / pi` at barycentric coordinates `uv` of `triangle`, seen from its front or its back.
pub fn seen(problem: &Problem, field: &VertexField, triangle: u32, uv: Vec2, back: bool) -> Seen {
    let (reflectivity, emission) = problem.scene.colors_at(triangle, uv);
    let irradiance = field.irradiance_at(problem, triangle, uv, back);
    let std_error = match field.is_error_known() {
        true => field.std_error_at(problem, triangle, uv, back),
        false => Rgb::BLACK,
    };
    let shown = |irradiance: Rgb| reflectivity * irradiance * FRAC_1_PI;
    Seen { emitted: emission * FRAC_1_PI, reflected: shown(irradiance), std_error: shown(std_error) }
}
