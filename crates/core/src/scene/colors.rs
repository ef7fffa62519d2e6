//! What a surface reflects and emits at a point.

use super::{Scene, Texture};
use crate::math::Rgb;
use glam::Vec2;

impl Scene {
    /// Reflectivity and self-emitted exitance [lm/m²] at barycentric coordinates `uv` of `triangle`.
    pub fn colors_at(&self, triangle: u32, uv: Vec2) -> (Rgb, Rgb) {
        let material = self.material_of(triangle);
        let [a, b, c] = self.triangles[triangle as usize].vertices.map(|v| &self.vertices[v as usize]);
        let (wa, wb, wc) = (1.0 - uv.x - uv.y, uv.x, uv.y);
        let texel = |texture: Option<Texture>, at: Vec2| {
            let sample = |t: Texture| self.images[t.image as usize].sample(at, t.wrap_u, t.wrap_v);
            texture.map_or(Rgb::WHITE, sample)
        };
        let color = a.color * wa + b.color * wb + c.color * wc;
        let reflectivity = color * texel(material.reflectivity_texture, a.uv * wa + b.uv * wb + c.uv * wc);
        let emission_uv = a.emission_uv * wa + b.emission_uv * wb + c.emission_uv * wc;
        (material.reflectivity * reflectivity, material.emission * texel(material.emission_texture, emission_uv))
    }
}
