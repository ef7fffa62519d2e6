//! Cameras of a glTF file.

use super::file::File;
use super::nodes::forward_and_up;
use crate::Error;
use glam::{DMat4, DVec3};
use gltf::json::camera::{Camera as Json, Type};
use gltf::json::validation::Checked;
use isolux_core::scene::{Camera, Projection};
use std::f32::consts::PI;

/// The camera `json` of `file`, on a node with the matrix `world`. It looks along -z, with y upwards.
///
/// # Errors
/// [`Error::Invalid`] for an unknown type, a size or angle out of range, or a node without direction.
pub fn read(file: &File, json: &Json, name: String, world: &DMat4, place: &str) -> Result<Camera, Error> {
    let (projection, aspect) = match (json.type_, &json.perspective, &json.orthographic) {
        (Checked::Valid(Type::Perspective), Some(lens), _) => {
            if !(lens.yfov > 0.0 && lens.yfov < PI) {
                return Err(file.error(place, format!("yfov {} must lie between 0 and pi", lens.yfov)));
            }
            (Projection::Perspective { vertical_angle: lens.yfov }, lens.aspect_ratio)
        }
        (Checked::Valid(Type::Orthographic), _, Some(lens)) => {
            let (xmag, ymag) = (lens.xmag.abs(), lens.ymag.abs());
            if !(ymag > 0.0 && ymag.is_finite() && xmag > 0.0 && xmag.is_finite()) {
                return Err(file.error(place, format!("xmag {xmag} and ymag {ymag} must be positive and finite")));
            }
            (Projection::Orthographic { height: 2.0 * ymag }, Some(xmag / ymag))
        }
        _ => return Err(file.error(place, "it is neither perspective nor orthographic")),
    };
    let (forward, up) = forward_and_up(file, world, place)?;
    let position = world.transform_point3(DVec3::ZERO).as_vec3();
    if !position.is_finite() {
        return Err(file.error(place, "its node lies beyond single precision"));
    }
    let aspect = aspect.filter(|aspect| *aspect > 0.0 && aspect.is_finite());
    Ok(Camera { name, position, forward, up, projection, aspect })
}
