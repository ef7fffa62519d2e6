//! Image files to texels: PNG, JPEG, WebP and BMP, known by their first bytes, and reduced to 8-bit sRGB without alpha.

use image::{ImageFormat, ImageReader, Limits};
use isolux_core::scene::Image;
use std::io::Cursor;

const FORMATS: [ImageFormat; 4] = [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::WebP, ImageFormat::Bmp];
/// Longest edge [texels].
const MOST_TEXELS: u32 = 1 << 14;
/// A larger image must have a byte for this many of its texels, which no compression of real images beats.
const SMALL_TEXELS: u64 = 1 << 22;
const MOST_TEXELS_PER_BYTE: u64 = 10_000;
/// Memory that decoding may take [bytes]: four 8-bit channels of the largest image.
const MOST_BYTES: u64 = 4 << 28;

/// Decodes an image file; `name` is for people.
///
/// # Errors
/// A sentence for people: another format, a broken file, or more than 16384 texels along an edge.
pub fn decode(bytes: &[u8], name: &str) -> Result<Image, String> {
    let broken = |what: image::ImageError| format!("cannot decode the image: {what}");
    let format = image::guess_format(bytes).ok().filter(|format| FORMATS.contains(format));
    let format = format.ok_or("this is no PNG, JPEG, WebP or BMP image; convert it to one of these")?;
    let size = ImageReader::with_format(Cursor::new(bytes), format).into_dimensions().map_err(broken)?;
    let texels = u64::from(size.0) * u64::from(size.1);
    if texels > SMALL_TEXELS && texels / MOST_TEXELS_PER_BYTE > bytes.len() as u64 {
        return Err(format!("{} x {} texels cannot be in {} bytes", size.0, size.1, bytes.len()));
    }
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(MOST_TEXELS), Some(MOST_TEXELS));
    limits.max_alloc = Some(MOST_BYTES);
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let pixels = reader.decode().map_err(broken)?.into_rgb8();
    let (width, height) = pixels.dimensions();
    if width == 0 || height == 0 {
        return Err("the image has no texels".to_owned());
    }
    let texels = pixels.pixels().map(|pixel| pixel.0).collect();
    Ok(Image { name: name.to_owned(), width, height, texels })
}
