//! What to know about a lightmap, for people and scripts: `name.json` beside the other files.

use super::BakedScene;
use crate::Error;
use isolux_core::lightmap::Origin;
use serde_json::{Value, json};
use std::f32::consts::PI;

/// The bytes of the file.
pub fn write(baked: &BakedScene) -> Result<Vec<u8>, Error> {
    let text = serde_json::to_string_pretty(&manifest(baked)).map_err(crate::export::cannot_encode("json"))?;
    Ok(format!("{text}\n").into_bytes())
}

fn manifest(baked: &BakedScene) -> Value {
    let BakedScene { problem, solution, lightmap, .. } = baked;
    let atlas = &lightmap.atlas;
    let shown = lightmap.texels.list.iter().flatten().count();
    let inside = lightmap.texels.list.iter().flatten().filter(|texel| texel.inside).count();
    let of_all = |count: usize| count as f64 / lightmap.texels.list.len() as f64;
    let (made_by, why_not_file) = match &atlas.origin {
        Origin::File => ("the file", None),
        Origin::Made { why_not_file } => ("uvunwrap", why_not_file.as_ref()),
    };
    json!({
        "version": isolux_core::VERSION,
        "scene": problem.scene.name,
        "files": { "glb": baked.file("glb"), "exr": baked.file("exr"), "png": baked.file("png") },
        "carrier": baked.file("glb").map(|_| baked.carrier.name()),
        "light": solution.provenance.parameter("light").unwrap_or("all"),
        "width": atlas.width,
        "height": atlas.height,
        "padding": atlas.padding,
        "texels_per_metre": atlas.texels_per_metre,
        "texture_coordinates": {
            "set": "TEXCOORD_1",
            "made_by": made_by,
            "file_has_others": why_not_file,
            "origin": "upper left corner of the map, as in glTF",
        },
        "quantity": "irradiance E in lux (lm/m^2), linear Rec. 709, without the reflectivity of surfaces",
        "exr": "E = texel",
        "png": "E = lux_at_white * srgb_to_linear(texel / 255)",
        "MOZ_lightmap": "E = lux_at_white * texel / 255",
        "lux_at_white": baked.lux_at_white,
        "clipped_in_8_bits": baked.clipped(),
        "exposure_stops": baked.exposure.stops,
        "ev100": baked.exposure.ev100(),
        "engines": engines(baked),
        "charts": atlas.chart_count,
        "texels_on_surfaces": of_all(inside),
        "texels_read": of_all(shown),
        "texels_covered": lightmap.covered,
        "objects": baked.objects,
    })
}

/// What makes the map as bright as the picture of `isolux render`, before its tone curve.
fn engines(baked: &BakedScene) -> Value {
    let exposed = baked.exposure.scale();
    let white = baked.lux_at_white;
    json!({
        "three.js": {
            "what": "material.lightMap holds E: the renderer multiplies with color / pi",
            "lightMapIntensity_of_exr": exposed,
            "lightMapIntensity_of_png": exposed * white,
            "png_colorSpace": "srgb",
        },
        "godot_unity_blender": {
            "what": "shaders that multiply the map with the base colour, without a division by pi",
            "factor_of_exr": exposed / PI,
            "factor_of_png": exposed * white / PI,
        },
    })
}
