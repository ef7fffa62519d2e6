//! A diffuse (Lambertian) material.

use super::Texture;
use crate::math::Rgb;

/// What a surface reflects and emits. Everything else a file may say (gloss, metal, normal maps) is not diffuse and is
/// ignored by the readers with a remark.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Material {
    pub name: String,
    /// Reflectivity (albedo) in [0, 1), multiplied by the texture and the vertex colour.
    pub reflectivity: Rgb,
    pub reflectivity_texture: Option<Texture>,
    /// Emitted exitance [lm/m²], `pi` times the luminance in cd/m²; multiplied by the texture.
    pub emission: Rgb,
    pub emission_texture: Option<Texture>,
    /// Whether the back reflects and emits like the front. The back of a one-sided surface is black and blocks light.
    pub two_sided: bool,
}

impl Material {
    /// A one-sided material that reflects `reflectivity` and emits nothing.
    pub fn diffuse(name: &str, reflectivity: Rgb) -> Material {
        Material {
            name: name.to_owned(),
            reflectivity,
            reflectivity_texture: None,
            emission: Rgb::BLACK,
            emission_texture: None,
            two_sided: false,
        }
    }

    pub fn is_emitter(&self) -> bool {
        !self.emission.is_black()
    }
}
