//! Pictures as files: PNG for the eye, OpenEXR for further work.

use super::cannot_encode;
use crate::Error;
use ::image::codecs::png::PngEncoder;
use ::image::{ExtendedColorType, ImageEncoder};
use exr::prelude::{Encoding, Image, LayerAttributes, SpecificChannels, Text, WritableImage};
use isolux_core::math::Rgb;

/// sRGB pixels, rows from the top, as PNG.
///
/// # Errors
/// [`Error::Invalid`] if `pixels` are not `width * height`.
pub fn encode_png(width: u32, height: u32, pixels: &[[u8; 3]]) -> Result<Vec<u8>, Error> {
    check_size("png", width, height, pixels.len())?;
    let mut file = Vec::new();
    PngEncoder::new(&mut file)
        .write_image(pixels.as_flattened(), width, height, ExtendedColorType::Rgb8)
        .map_err(cannot_encode("png"))?;
    Ok(file)
}

/// Linear Rec. 709 pixels, rows from the top, as OpenEXR with 32-bit floats, losslessly compressed.
///
/// # Errors
/// [`Error::Invalid`] if `pixels` are not `width * height`.
pub fn encode_exr(width: u32, height: u32, pixels: &[Rgb]) -> Result<Vec<u8>, Error> {
    encode_exr_layer(width, height, pixels, "picture", None)
}

/// As [`encode_exr`], with the name of the layer, and a comment in the header.
///
/// # Errors
/// [`Error::Invalid`] if `pixels` are not `width * height`.
pub fn encode_exr_layer(
    width: u32,
    height: u32,
    pixels: &[Rgb],
    name: &str,
    comment: Option<&str>,
) -> Result<Vec<u8>, Error> {
    check_size("exr", width, height, pixels.len())?;
    let (width, height) = (width as usize, height as usize);
    let channels = SpecificChannels::rgb(|at: exr::math::Vec2<usize>| {
        let color = pixels[at.y() * width + at.x()];
        (color.r, color.g, color.b)
    });
    let mut attributes = LayerAttributes::named(name);
    attributes.comments = comment.and_then(Text::new_or_none);
    attributes.software_name = Text::new_or_none(format!("isolux {}", isolux_core::VERSION));
    let layer = exr::image::Layer::new((width, height), attributes, Encoding::SMALL_LOSSLESS, channels);
    let mut file = std::io::Cursor::new(Vec::new());
    Image::from_layer(layer).write().non_parallel().to_buffered(&mut file).map_err(cannot_encode("exr"))?;
    Ok(file.into_inner())
}

fn check_size(format: &'static str, width: u32, height: u32, pixels: usize) -> Result<(), Error> {
    if pixels == 0 || pixels as u64 != u64::from(width) * u64::from(height) {
        return Err(cannot_encode(format)(format!("{pixels} pixels do not make a picture of {width} x {height}")));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::ImageFormat;

    #[test]
    fn pictures_read_back_exactly() {
        let pixels: Vec<[u8; 3]> = (0..6).map(|k| [k, 100 + k, 255 - k]).collect();
        let png = encode_png(3, 2, &pixels).unwrap();
        let read = ::image::load_from_memory_with_format(&png, ImageFormat::Png).unwrap().into_rgb8();
        assert_eq!((read.dimensions(), read.as_raw().as_slice()), ((3, 2), pixels.as_flattened()));

        let pixels: Vec<Rgb> = (0..6).map(|k| Rgb::new(1e-5 * k as f32, 0.1 + k as f32, 1e5)).collect();
        let exr = encode_exr(3, 2, &pixels).unwrap();
        let read = ::image::load_from_memory_with_format(&exr, ImageFormat::OpenExr).unwrap().into_rgb32f();
        let flat: Vec<f32> = pixels.iter().flat_map(|c| c.to_array()).collect();
        assert_eq!((read.dimensions(), read.as_raw().as_slice()), ((3, 2), flat.as_slice()));
    }

    #[test]
    fn wrong_sizes_are_errors() {
        assert!(encode_png(2, 2, &[[0; 3]; 3]).is_err());
        assert!(encode_exr(0, 0, &[]).is_err());
    }
}
