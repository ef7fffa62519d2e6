//! Linear Rec. 709 colour, its luminance, and the sRGB transfer function (IEC 61966-2-1).

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// Three linear channels with Rec. 709 primaries. The quantity (reflectivity, lux, cd, ...) is said where one is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[repr(C)]
pub struct Rgb {
    pub r: f32,
    pub g: f32,
    pub b: f32,
}

impl Rgb {
    pub const BLACK: Rgb = Rgb::grey(0.0);
    pub const WHITE: Rgb = Rgb::grey(1.0);

    pub const fn new(r: f32, g: f32, b: f32) -> Rgb {
        Rgb { r, g, b }
    }

    /// The same value in all three channels.
    pub const fn grey(value: f32) -> Rgb {
        Rgb::new(value, value, value)
    }

    pub const fn to_array(self) -> [f32; 3] {
        [self.r, self.g, self.b]
    }

    /// Luminance (Y) of linear Rec. 709: the weight of each channel in lumens, lux and candela.
    pub fn luminance(self) -> f32 {
        self.luminance_f64() as f32
    }

    /// Luminance in double precision, for sums that must add up: in single, the three weights do not even add up to one.
    pub fn luminance_f64(self) -> f64 {
        0.2126 * f64::from(self.r) + 0.7152 * f64::from(self.g) + 0.0722 * f64::from(self.b)
    }

    pub fn max_channel(self) -> f32 {
        self.r.max(self.g).max(self.b)
    }

    pub fn is_finite(self) -> bool {
        self.r.is_finite() && self.g.is_finite() && self.b.is_finite()
    }

    pub fn is_black(self) -> bool {
        self == Rgb::BLACK
    }

    /// Applies `f` to every channel.
    pub fn map(self, f: impl Fn(f32) -> f32) -> Rgb {
        Rgb::new(f(self.r), f(self.g), f(self.b))
    }

    /// Linear value of an 8-bit sRGB triple.
    pub fn from_srgb8(srgb: [u8; 3]) -> Rgb {
        let linear = |v: u8| srgb_to_linear(f32::from(v) / 255.0);
        Rgb::new(linear(srgb[0]), linear(srgb[1]), linear(srgb[2]))
    }

    /// The nearest 8-bit sRGB triple; values outside [0, 1] are clamped.
    pub fn to_srgb8(self) -> [u8; 3] {
        self.to_array().map(|v| (linear_to_srgb(v.clamp(0.0, 1.0)) * 255.0 + 0.5) as u8)
    }
}

/// sRGB transfer function, encoded to linear; both in [0, 1].
pub fn srgb_to_linear(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// sRGB transfer function, linear to encoded; both in [0, 1].
pub fn linear_to_srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

impl From<[f32; 3]> for Rgb {
    fn from([r, g, b]: [f32; 3]) -> Rgb {
        Rgb::new(r, g, b)
    }
}

impl Add for Rgb {
    type Output = Rgb;
    fn add(self, other: Rgb) -> Rgb {
        Rgb::new(self.r + other.r, self.g + other.g, self.b + other.b)
    }
}

impl AddAssign for Rgb {
    fn add_assign(&mut self, other: Rgb) {
        *self = *self + other;
    }
}

impl Sub for Rgb {
    type Output = Rgb;
    fn sub(self, other: Rgb) -> Rgb {
        Rgb::new(self.r - other.r, self.g - other.g, self.b - other.b)
    }
}

impl Neg for Rgb {
    type Output = Rgb;
    fn neg(self) -> Rgb {
        self.map(|v| -v)
    }
}

/// Channel by channel.
impl Mul for Rgb {
    type Output = Rgb;
    fn mul(self, other: Rgb) -> Rgb {
        Rgb::new(self.r * other.r, self.g * other.g, self.b * other.b)
    }
}

impl Mul<f32> for Rgb {
    type Output = Rgb;
    fn mul(self, k: f32) -> Rgb {
        self.map(|v| v * k)
    }
}

impl Div<f32> for Rgb {
    type Output = Rgb;
    fn div(self, k: f32) -> Rgb {
        self.map(|v| v / k)
    }
}

impl std::iter::Sum for Rgb {
    fn sum<I: Iterator<Item = Rgb>>(items: I) -> Rgb {
        items.fold(Rgb::BLACK, Rgb::add)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_8_bit_code_survives_the_round_trip() {
        for code in 0..=255 {
            assert_eq!(Rgb::from_srgb8([code; 3]).to_srgb8(), [code; 3]);
        }
    }

    #[test]
    fn white_has_luminance_one() {
        assert!((Rgb::WHITE.luminance() - 1.0).abs() < 1e-6);
    }
}
