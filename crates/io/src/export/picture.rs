//! A picture of the solution: tone-mapped as PNG, linear in cd/m² as OpenEXR.

use super::image::{Label, encode_exr, encode_png};
use super::{ExportOptions, LitScene};
use crate::Error;
use isolux_core::view::{self, Exposure, ViewOptions};

pub fn write_png(lit: &LitScene, options: &ExportOptions) -> Result<Vec<u8>, Error> {
    let picture = view::render_field(lit.problem, lit.field(), &view_options(options))?;
    encode_png(picture.width, picture.height, &picture.to_srgb8())
}

pub fn write_exr(lit: &LitScene, options: &ExportOptions) -> Result<Vec<u8>, Error> {
    let picture = view::render_field(lit.problem, lit.field(), &view_options(options))?;
    let std_error = picture.std_error.as_deref().map(|errors| ("std_error", errors));
    let label = Label { name: "picture", comment: Some("luminance in cd/m^2, linear Rec. 709") };
    encode_exr(picture.width, picture.height, &picture.luminance, std_error.as_slice(), label)
}

/// What of the options concerns a picture.
pub fn view_options(options: &ExportOptions) -> ViewOptions {
    ViewOptions {
        camera: options.camera.clone(),
        width: options.width,
        height: options.height,
        samples: options.samples,
        exposure: options.exposure.map(|stops| Exposure { stops }),
    }
}
