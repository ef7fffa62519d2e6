//! What a point of a surface sends out: textures at full resolution over interpolated irradiance.

use super::VertexField;
use crate::Problem;
use crate::math::Rgb;
use crate::scene::{Scene, Texture};
use glam::Vec2;
use std::f32::consts::FRAC_1_PI;

/// Luminance [cd/m²] of a point, the same in all directions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seen {
    pub emitted: Rgb,
    pub reflected: Rgb,
}

impl Seen {
    pub fn luminance(self) -> Rgb {
        self.emitted + self.reflected
    }
}

/// `L = (Be + rho E) / pi` at barycentric coordinates `uv` of `triangle`, seen from its front or its back.
pub fn seen(problem: &Problem, field: &VertexField, triangle: u32, uv: Vec2, back: bool) -> Seen {
    let (reflectivity, emission) = colors(&problem.scene, triangle, uv);
    let irradiance = field.irradiance_at(problem, triangle, uv, back);
    Seen { emitted: emission * FRAC_1_PI, reflected: reflectivity * irradiance * FRAC_1_PI }
}

/// Reflectivity and self-emitted exitance [lm/m²] at a point of a triangle.
pub fn colors(scene: &Scene, triangle: u32, uv: Vec2) -> (Rgb, Rgb) {
    let material = scene.material_of(triangle);
    let [a, b, c] = scene.triangles[triangle as usize].vertices.map(|v| &scene.vertices[v as usize]);
    let (wa, wb, wc) = (1.0 - uv.x - uv.y, uv.x, uv.y);
    let texel = |texture: Option<Texture>, at: Vec2| {
        let sample = |t: Texture| scene.images[t.image as usize].sample(at, t.wrap_u, t.wrap_v);
        texture.map_or(Rgb::WHITE, sample)
    };
    let color = a.color * wa + b.color * wb + c.color * wc;
    let reflectivity = color * texel(material.reflectivity_texture, a.uv * wa + b.uv * wb + c.uv * wc);
    let emission_uv = a.emission_uv * wa + b.emission_uv * wb + c.emission_uv * wc;
    (material.reflectivity * reflectivity, material.emission * texel(material.emission_texture, emission_uv))
}
