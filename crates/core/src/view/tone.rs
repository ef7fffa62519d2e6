//! From luminance to a screen: exposure, a filmic curve, and 8-bit sRGB without banding.
//!
//! Exposure is given in stops `s`: luminance L [cd/m²] enters the curve as `x = L 2^s`. A camera set to EV100 renders
//! `x = L / (1.2 * 2^EV100)` (ISO 12232, saturation based), so `EV100 = -s - 0.26`: a stop more is twice as bright. The
//! curve is Hable's (Filmic Tonemapping Operators, 2010), which rolls highlights off like film and, unlike the fits to ACES,
//! leaves the light in the shadows to be seen.

use crate::math::Rgb;
use crate::math::color::linear_to_srgb;

/// How bright a picture is made.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Exposure {
    /// Stops: luminance is multiplied by `2^stops`.
    pub stops: f32,
}

/// Where the metered luminance is put before the curve: 18 % grey is what a camera takes an average scene for.
const MIDDLE_GREY: f32 = 0.18;
/// The brightest of what is metered is put no higher than this before the curve; the curve takes it to 0.94.
const BRIGHTEST: f32 = 3.0;
/// Hable's curve darkens; with this factor before it middle grey stays middle grey.
const CURVE_EXPOSURE: f32 = 3.0;
/// What becomes white, after that factor: Hable's linear white point.
const WHITE_POINT: f32 = 11.2;
/// How far bright saturated colours keep their hue; the rest of the way each channel saturates by itself, as film does.
const HUE_KEPT: f32 = 0.5;

impl Exposure {
    /// The factor on luminance.
    pub fn scale(self) -> f32 {
        self.stops.exp2()
    }

    /// The setting of a camera that takes the same picture: EV at ISO 100.
    pub fn ev100(self) -> f32 {
        -self.stops - 1.2f32.log2()
    }

    /// Exposure for surfaces with these luminances [cd/m²]; lamps and background do not belong among them. The
    /// logarithmic mean without the darkest tenth and the brightest twentieth becomes middle grey, unless that would burn out the
    /// brightest fiftieth. Zero stops if everything is dark.
    pub fn metered(mut luminances: Vec<f32>) -> Exposure {
        luminances.retain(|l| *l > 0.0 && l.is_finite());
        luminances.sort_by(f32::total_cmp);
        let at = |share: f32| (share * luminances.len() as f32) as usize;
        let Some(middle) = luminances.get(at(0.10)..at(0.95)).filter(|middle| !middle.is_empty()) else {
            return Exposure { stops: luminances.last().map_or(0.0, |l| (MIDDLE_GREY / l).log2()) };
        };
        let mean = middle.iter().map(|l| f64::from(l.log2())).sum::<f64>() / middle.len() as f64;
        let brightest = luminances[at(0.98).min(luminances.len() - 1)];
        let stops = MIDDLE_GREY.log2() - mean as f32;
        Exposure { stops: stops.min((BRIGHTEST / brightest).log2()) }
    }

    /// Linear display colour in [0, 1] of luminance `l` [cd/m²].
    pub fn display(self, l: Rgb) -> Rgb {
        filmic(l * self.scale())
    }
}

/// The filmic curve, linear in and out: each channel by itself mixed with the curve of the luminance alone, which keeps hue.
fn filmic(x: Rgb) -> Rgb {
    let by_channel = x.map(curve);
    let luminance = x.luminance();
    if luminance <= 0.0 {
        return by_channel.map(|v| v.clamp(0.0, 1.0));
    }
    let target = curve(luminance);
    let hue_kept = toward_white(x * (target / luminance), target);
    (by_channel * (1.0 - HUE_KEPT) + hue_kept * HUE_KEPT).map(|v| v.clamp(0.0, 1.0))
}

/// Fades a colour of luminance `y` towards grey just until no channel exceeds 1.
fn toward_white(color: Rgb, y: f32) -> Rgb {
    let most = color.max_channel();
    if most <= 1.0 {
        return color;
    }
    let keep = ((1.0 - y) / (most - y)).clamp(0.0, 1.0);
    Rgb::grey(y) + (color - Rgb::grey(y)) * keep
}

/// Hable 2010, normalised to his white point.
fn curve(x: f32) -> f32 {
    // Shoulder strength, linear strength and angle, toe strength, numerator and denominator.
    const A: f32 = 0.15;
    const B: f32 = 0.50;
    const C: f32 = 0.10;
    const D: f32 = 0.20;
    const E: f32 = 0.02;
    const F: f32 = 0.30;
    // His quotient less E / F, over one denominator: black is exactly black.
    let hable = |x: f32| x * (A * (F - E) * x + B * (C * F - E)) / (F * (x * (A * x + B) + D * F));
    (hable((CURVE_EXPOSURE * x).clamp(0.0, WHITE_POINT)) / hable(WHITE_POINT)).clamp(0.0, 1.0)
}

/// 8-bit sRGB of a linear display colour for the pixel (x, y), with half a step of ordered noise against banding
/// (interleaved gradient noise, Jimenez 2014).
pub fn to_srgb8(color: Rgb, x: u32, y: u32) -> [u8; 3] {
    to_linear8(color.map(|v| linear_to_srgb(v.clamp(0.0, 1.0))), x, y)
}

/// As [`to_srgb8`], without the encoding: 0 to 255 are equal steps of light.
pub fn to_linear8(color: Rgb, x: u32, y: u32) -> [u8; 3] {
    let noise = (52.982_918 * (0.067_110_56 * x as f32 + 0.005_837_15 * y as f32).fract()).fract();
    // Exact black and white stay without noise.
    color.to_array().map(|v| (v.clamp(0.0, 1.0) * 255.0 + 0.25 + 0.5 * noise) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_rises_from_black_to_white_in_every_hue() {
        for hue in [Rgb::WHITE, Rgb::new(1.0, 0.2, 0.1), Rgb::new(0.0, 0.1, 1.0)] {
            let at = |k: i32| filmic(hue * (0.25 * k as f32).exp2());
            for k in -60..60 {
                assert!(at(k).luminance() <= at(k + 1).luminance() + 1e-6, "{hue:?} {k}");
                assert!(at(k).to_array().iter().all(|v| (0.0..=1.0).contains(v)));
            }
        }
        assert_eq!(filmic(Rgb::BLACK), Rgb::BLACK);
        assert!(filmic(Rgb::grey(1e3)).luminance() > 0.999);
    }

    #[test]
    fn metering_follows_the_light() {
        let one: Vec<f32> = (1..=1000).map(|k| 0.3 * k as f32).collect();
        let two: Vec<f32> = one.iter().map(|l| 2.0 * l).collect();
        let difference = Exposure::metered(one).stops - Exposure::metered(two).stops;
        assert!((difference - 1.0).abs() < 1e-5);
        assert_eq!(Exposure::metered(vec![0.0, f32::NAN]).stops, 0.0);
    }

    #[test]
    fn dithering_keeps_black_white_and_the_mean() {
        let (mut sum, value) = (0.0, Rgb::grey(0.215));
        for k in 0..10_000 {
            sum += f64::from(to_srgb8(value, k % 100, k / 100)[0]) / 10_000.0;
            assert_eq!(to_srgb8(Rgb::BLACK, k % 100, k / 100), [0; 3]);
            assert_eq!(to_srgb8(Rgb::WHITE, k % 100, k / 100), [255; 3]);
        }
        assert!((sum - f64::from(linear_to_srgb(0.215) * 255.0)).abs() < 0.6);
    }
}
