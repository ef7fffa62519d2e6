//! Pictures as files: PNG for the eye, OpenEXR for further work.

use super::cannot_encode;
use crate::Error;
use ::image::codecs::png::PngEncoder;
use ::image::{ExtendedColorType, ImageEncoder};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, LayerAttributes, SmallVec, Text, WritableImage,
};
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

/// What an OpenEXR file says of itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct Label<'a> {
    /// Of the layer.
    pub name: &'a str,
    pub comment: Option<&'a str>,
}

/// Linear Rec. 709 pixels, rows from the top, as OpenEXR with 32-bit floats, losslessly compressed; and `more` pictures of that size, by the
/// name that comes before the dot of their channels.
///
/// # Errors
/// [`Error::Invalid`] if a picture has not `width * height` pixels.
pub fn encode_exr(
    width: u32,
    height: u32,
    pixels: &[Rgb],
    more: &[(&str, &[Rgb])],
    label: Label,
) -> Result<Vec<u8>, Error> {
    let mut channels = SmallVec::new();
    for (layer, pixels) in std::iter::once(("", pixels)).chain(more.iter().copied()) {
        check_size("exr", width, height, pixels.len())?;
        let dot = if layer.is_empty() { "" } else { "." };
        for (c, channel) in ["R", "G", "B"].iter().enumerate() {
            let samples = FlatSamples::F32(pixels.iter().map(|color| color.to_array()[c]).collect());
            channels.push(AnyChannel::new(format!("{layer}{dot}{channel}").as_str(), samples));
        }
    }
    let (width, height) = (width as usize, height as usize);
    let channels = AnyChannels::sort(channels);
    let mut attributes = LayerAttributes::named(label.name);
    attributes.comments = label.comment.and_then(Text::new_or_none);
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
    use exr::prelude::{ReadChannels, ReadLayers};

    #[test]
    fn pictures_read_back_exactly() {
        let pixels: Vec<[u8; 3]> = (0..6).map(|k| [k, 100 + k, 255 - k]).collect();
        let png = encode_png(3, 2, &pixels).unwrap();
        let read = ::image::load_from_memory_with_format(&png, ImageFormat::Png).unwrap().into_rgb8();
        assert_eq!((read.dimensions(), read.as_raw().as_slice()), ((3, 2), pixels.as_flattened()));

        let pixels: Vec<Rgb> = (0..6).map(|k| Rgb::new(1e-5 * k as f32, 0.1 + k as f32, 1e5)).collect();
        let errors: Vec<Rgb> = pixels.iter().map(|color| *color * 0.5).collect();
        let exr = encode_exr(3, 2, &pixels, &[("std_error", &errors)], Label::default()).unwrap();
        let read = ::image::load_from_memory_with_format(&exr, ImageFormat::OpenExr).unwrap().into_rgb32f();
        let flat: Vec<f32> = pixels.iter().flat_map(|c| c.to_array()).collect();
        assert_eq!((read.dimensions(), read.as_raw().as_slice()), ((3, 2), flat.as_slice()));

        let all = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let all = all.all_attributes().from_buffered(std::io::Cursor::new(exr)).unwrap().layer_data;
        let green = all.channel_data.list.iter().find(|c| c.name.to_string() == "std_error.G").unwrap();
        let expected: Vec<f32> = errors.iter().map(|color| color.g).collect();
        assert_eq!(green.sample_data.values_as_f32().collect::<Vec<f32>>(), expected);
    }

    #[test]
    fn wrong_sizes_are_errors() {
        assert!(encode_png(2, 2, &[[0; 3]; 3]).is_err());
        assert!(encode_exr(0, 0, &[], &[], Label::default()).is_err());
        assert!(encode_exr(1, 1, &[Rgb::BLACK], &[("std_error", &[])], Label::default()).is_err());
    }
}
