//! Texture images and how they repeat.

use crate::math::Rgb;
use glam::Vec2;
use std::sync::LazyLock;

/// An 8-bit sRGB image, rows from the top.
#[derive(Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Image {
    pub name: String,
    pub width: u32,
    pub height: u32,
    /// `width * height` sRGB-encoded texels.
    pub texels: Vec<[u8; 3]>,
}

/// A use of an image by a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Texture {
    /// Index into [`super::Scene::images`].
    pub image: u32,
    pub wrap_u: Wrap,
    pub wrap_v: Wrap,
}

/// What lies outside [0, 1] (glTF sampler wrap modes).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Wrap {
    #[default]
    Repeat,
    MirroredRepeat,
    ClampToEdge,
}

static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| crate::math::color::srgb_to_linear(code as f32 / 255.0)));

impl Image {
    /// Linear colour of one texel.
    pub fn texel(&self, x: u32, y: u32) -> Rgb {
        let [r, g, b] = self.texels[(y * self.width + x) as usize].map(|code| LINEAR[usize::from(code)]);
        Rgb::new(r, g, b)
    }

    /// Greatest linear value of each channel over all texels; black for an image without texels.
    pub fn brightest(&self) -> Rgb {
        let codes =
            self.texels.iter().fold([0; 3], |most: [u8; 3], texel| std::array::from_fn(|c| most[c].max(texel[c])));
        Rgb::from_srgb8(codes)
    }

    /// Linear colour at `uv` by bilinear interpolation; (0, 0) is the upper left corner of the image.
    pub fn sample(&self, uv: Vec2, wrap_u: Wrap, wrap_v: Wrap) -> Rgb {
        let (x0, x1, fx) = wrap_u.neighbours(uv.x, self.width);
        let (y0, y1, fy) = wrap_v.neighbours(uv.y, self.height);
        let top = self.texel(x0, y0) * (1.0 - fx) + self.texel(x1, y0) * fx;
        let bottom = self.texel(x0, y1) * (1.0 - fx) + self.texel(x1, y1) * fx;
        top * (1.0 - fy) + bottom * fy
    }
}

impl Wrap {
    /// The two texels around coordinate `u` on an axis of `size` texels, and the weight of the second.
    fn neighbours(self, u: f32, size: u32) -> (u32, u32, f32) {
        // Bring u into one or two periods first, so that large coordinates keep their fraction.
        let folded = match self {
            Wrap::Repeat => u - u.floor(),
            Wrap::MirroredRepeat => u - 2.0 * (0.5 * u).floor(),
            Wrap::ClampToEdge => u.clamp(0.0, 1.0),
        };
        let x = folded * size as f32 - 0.5;
        let floor = x.floor();
        (self.texel_index(floor as i64, size), self.texel_index(floor as i64 + 1, size), x - floor)
    }

    /// The texel that stands at `index`, which may lie outside `0..size`.
    pub fn texel_index(self, index: i64, size: u32) -> u32 {
        let size = i64::from(size);
        let wrapped = match self {
            Wrap::Repeat => index.rem_euclid(size),
            Wrap::MirroredRepeat => {
                let k = index.rem_euclid(2 * size);
                k.min(2 * size - 1 - k)
            }
            Wrap::ClampToEdge => index.clamp(0, size - 1),
        };
        wrapped as u32
    }
}

impl std::fmt::Debug for Image {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Image({}, {} x {})", self.name, self.width, self.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One row: black, white.
    fn image() -> Image {
        Image { name: String::new(), width: 2, height: 1, texels: vec![[0; 3], [255; 3]] }
    }

    fn value(u: f32, wrap: Wrap) -> f32 {
        image().sample(Vec2::new(u, 0.5), wrap, Wrap::Repeat).g
    }

    #[test]
    fn texel_centres_have_the_texels_colour_in_every_wrap_mode() {
        for wrap in [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge] {
            assert_eq!((value(0.25, wrap), value(0.75, wrap)), (0.0, 1.0), "{wrap:?}");
        }
    }

    #[test]
    fn wrap_modes_differ_outside_the_image() {
        assert_eq!((value(1.25, Wrap::Repeat), value(-0.25, Wrap::Repeat)), (0.0, 1.0));
        assert_eq!((value(1.25, Wrap::MirroredRepeat), value(-0.25, Wrap::MirroredRepeat)), (1.0, 0.0));
        assert_eq!((value(1.25, Wrap::ClampToEdge), value(-0.25, Wrap::ClampToEdge)), (1.0, 0.0));
        assert_eq!((value(1.0, Wrap::Repeat), value(1.0, Wrap::MirroredRepeat)), (0.5, 1.0));
    }
}
