//! Reflectivity and emission of an element: the average of its texture.

use crate::math::Rgb;
use crate::scene::Scene;
use glam::Vec2;

/// Mean reflectivity and emitted exitance [lm/m²] over the cell with the given barycentric corners on triangle `t`.
pub fn over_cell(scene: &Scene, t: u32, _corners: [Vec2; 3]) -> (Rgb, Rgb) {
    let material = scene.material_of(t);
    (material.reflectivity, material.emission)
}
