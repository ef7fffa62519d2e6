//! The map as an image: OpenEXR for those who compute with it, PNG for the web.

use super::BakedScene;
use crate::Error;
use crate::export::image::{Label, encode_exr, encode_png};
use isolux_core::math::Rgb;
use isolux_core::view::tone;

/// Irradiance in lux.
pub fn write_exr(baked: &BakedScene) -> Result<Vec<u8>, Error> {
    let atlas = &baked.lightmap.atlas;
    let comment = format!(
        "Irradiance E in lux (lm/m^2), linear Rec. 709, without the reflectivity of surfaces: \
         luminance = reflectivity * E / pi cd/m^2. \
         Illuminance = 0.2126 R + 0.7152 G + 0.0722 B. Rows from the top, glTF texture coordinates; exposed by 2^{:.3}.",
        baked.exposure.stops
    );
    let label = Label { name: "lightmap", comment: Some(&comment) };
    encode_exr(atlas.width, atlas.height, &baked.lightmap.irradiance, &[], label)
}

/// sRGB-encoded irradiance over [`BakedScene::lux_at_white`].
pub fn write_png(baked: &BakedScene) -> Result<Vec<u8>, Error> {
    encode(baked, &baked.lightmap.irradiance, 1.0 / baked.lux_at_white, tone::to_srgb8)
}

/// Irradiance over [`BakedScene::lux_at_white`], in equal steps.
pub fn linear_png(baked: &BakedScene) -> Result<Vec<u8>, Error> {
    encode(baked, &baked.lightmap.irradiance, 1.0 / baked.lux_at_white, tone::to_linear8)
}

/// What the surfaces look like, given their `radiosity` [lm/m²]: exposed, tone-mapped, sRGB.
pub fn lit_png(baked: &BakedScene, radiosity: &[Rgb]) -> Result<Vec<u8>, Error> {
    let shown: Vec<Rgb> = radiosity.iter().map(|b| baked.exposure.display(*b * std::f32::consts::FRAC_1_PI)).collect();
    encode(baked, &shown, 1.0, tone::to_srgb8)
}

fn encode(
    baked: &BakedScene,
    values: &[Rgb],
    factor: f32,
    to_8_bits: fn(Rgb, u32, u32) -> [u8; 3],
) -> Result<Vec<u8>, Error> {
    let (width, height) = (baked.lightmap.atlas.width, baked.lightmap.atlas.height);
    let pixel = |(k, value): (u32, &Rgb)| to_8_bits(*value * factor, k % width, k / width);
    let pixels: Vec<[u8; 3]> = (0u32..).zip(values).map(pixel).collect();
    encode_png(width, height, &pixels)
}
