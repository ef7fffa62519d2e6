//! KHR_lights_punctual: point, spot and directional lights, in candela and lux whatever the exporter wrote.

use super::file::File;
use super::nodes::forward_and_up;
use crate::Error;
use crate::import::LightUnits;
use glam::{DMat4, DVec3};
use gltf::json::extensions::scene::khr_lights_punctual::{Light as Json, Type};
use gltf::json::validation::Checked;
use isolux_core::math::Rgb;
use isolux_core::scene::{Light, LightKind};
use std::f32::consts::{FRAC_PI_2, PI};

/// Luminous efficacy that exporters convert with [lm/W]: that of green light, 555 nm, from the definition of the candela.
const LUMENS_PER_WATT: f32 = 683.0;

/// The light `json` of `file`, on a node with the matrix `world`. It shines along -z; scale does not touch its intensity.
///
/// # Errors
/// [`Error::Invalid`] for an unknown type, an intensity or angle out of range, or a node without direction.
pub fn read(
    file: &File,
    json: &Json,
    name: String,
    world: &DMat4,
    units: LightUnits,
    place: &str,
) -> Result<Light, Error> {
    let position = world.transform_point3(DVec3::ZERO).as_vec3();
    if !position.is_finite() {
        return Err(file.error(place, "its node lies beyond single precision"));
    }
    let kind = match json.type_ {
        Checked::Valid(Type::Point) => LightKind::Point { position },
        Checked::Valid(Type::Directional) => {
            LightKind::Directional { direction: forward_and_up(file, world, place)?.0 }
        }
        Checked::Valid(Type::Spot) => {
            let Some(spot) = &json.spot else { return Err(file.error(place, "it is a spot without its angles")) };
            let (inner_angle, outer_angle) = (spot.inner_cone_angle, spot.outer_cone_angle);
            if !(0.0 <= inner_angle
                && inner_angle <= outer_angle
                && 0.0 < outer_angle
                && outer_angle <= FRAC_PI_2 + 1e-5)
            {
                let what = format!("cone angles {inner_angle} and {outer_angle} must rise from 0 to at most pi/2");
                return Err(file.error(&format!("{place}/spot"), what));
            }
            LightKind::Spot { position, direction: forward_and_up(file, world, place)?.0, inner_angle, outer_angle }
        }
        Checked::Invalid => return Err(file.error(place, "its type is none of point, spot and directional")),
    };
    let intensity = Rgb::from(json.color) * json.intensity * factor(units, &kind);
    if intensity.to_array().into_iter().any(|v| !v.is_finite() || v < 0.0) {
        return Err(
            file.error(place, format!("intensity {:?} must not be negative and must be finite", intensity.to_array()))
        );
    }
    Ok(Light { name, intensity, kind })
}

/// What an intensity of the file is to be multiplied with to be in candela or lux.
fn factor(units: LightUnits, kind: &LightKind) -> f32 {
    match (units, kind) {
        (LightUnits::Spec, _) => 1.0,
        (LightUnits::Compat, _) | (LightUnits::Raw, LightKind::Directional { .. }) => LUMENS_PER_WATT,
        (LightUnits::Raw, _) => LUMENS_PER_WATT / (4.0 * PI),
    }
}

/// The sentence that says how intensities were taken.
pub fn assumption(units: LightUnits) -> &'static str {
    match units {
        LightUnits::Spec => "punctual lights are taken in candela and lux, as glTF says (light units spec)",
        LightUnits::Compat => "punctual lights are taken in W/sr and W/m², at 683 lm/W (light units compat)",
        LightUnits::Raw => "punctual lights are taken in W and W/m², at 683 lm/W (light units raw)",
    }
}
