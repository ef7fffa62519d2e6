//! Which share of cosine rays would have been best, told by rays with another.
//!
//! With n_c cosine rays and n_l light rays, combined by the power heuristic, the variance of an element's irradiance is
//!
//! ```text
//! ∫ f² (d_c³ + d_l³) / (d_c² + d_l²)²  -  (∫ f w)² / n_c  -  (∫ f (1 - w))² / n_l,      w = d_c² / (d_c² + d_l²),  f = Be cos / pi
//! ```
//!
//! and each ray that was sent, whatever its kind, is a sample of the three integrals.

use crate::transport::direct_light::{Rays, Sight};

/// Number of rays for which shares are compared: of these all shares are whole numbers.
const RAYS: u32 = 16;

/// `rays` with this share of cosine rays, at least one of each kind.
pub fn split(rays: u32, cosine_share: f32) -> Rays {
    let cosine = ((rays as f32 * cosine_share).round() as u32).clamp(1, rays - 1);
    Rays { light: rays - cosine, cosine }
}

/// What the rays of an element tell of the variance with other numbers of rays.
#[derive(Clone, Copy, Debug)]
pub struct Comparison {
    rays: Rays,
    /// Rays that were sent.
    sent: u32,
    /// The first integral of the variance.
    square: f32,
    /// The other two, by the parts that both kinds of rays add to the mean: their sums and sums of squares.
    by_cosine: [f32; 2],
    by_light: [f32; 2],
}

impl Comparison {
    /// For that share of cosine rays, by `sent` rays that were sent.
    pub fn new(share: f32, sent: u32) -> Comparison {
        let rays = split(RAYS, share);
        Comparison { rays, sent, square: 0.0, by_cosine: [0.0; 2], by_light: [0.0; 2] }
    }

    /// Adds a ray that has added `irradiance` [lux].
    pub fn add(&mut self, sight: &Sight, irradiance: f32) {
        let value = sight.emission.luminance() * sight.cosine;
        let [cosine, light] = [self.rays.cosine as f32 * sight.cosine, self.rays.light as f32 * sight.light];
        let sum = cosine * cosine + light * light;
        self.square += irradiance * value * (cosine.powi(3) + light.powi(3)) / (sum * sum);
        for ([first, second], d) in [(&mut self.by_cosine, cosine), (&mut self.by_light, light)] {
            let part = irradiance * d * d / sum;
            *first += part;
            *second += part * part;
        }
    }

    /// Variance of a ray [lux²]. Unbiased, so it may be negative: products of two different rays stand for the squares of means.
    pub fn variance(&self) -> f32 {
        let sent = self.sent as f32;
        let squared = |[sum, sum_sq]: [f32; 2]| (sum * sum - sum_sq) * sent / (sent - 1.0);
        let subtracted =
            squared(self.by_cosine) / self.rays.cosine as f32 + squared(self.by_light) / self.rays.light as f32;
        (self.square - subtracted) * RAYS as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;
    use crate::transport::Spot;

    /// Variances with few and with many cosine rays, told by ten rays of each kind: `seen` of them, whether they are light rays, and the
    /// densities of their directions among light rays and cosine rays.
    fn variances(seen: &[(usize, bool, f32, f32)]) -> [f32; 2] {
        let sent = Rays { light: 10, cosine: 10 };
        [0.0625, 0.875].map(|share| {
            let mut comparison = Comparison::new(share, 20);
            for &(times, aimed, light, cosine) in seen {
                let sight = Sight { spot: Spot::default(), emission: Rgb::grey(1.0), light, cosine, aimed };
                (0..times).for_each(|_| comparison.add(&sight, sight.irradiance(sent).luminance()));
            }
            comparison.variance()
        })
    }

    #[test]
    fn where_all_emits_alike_cosine_rays_are_best() {
        // Two halves of the hemisphere; nine of ten light rays go to one of them.
        let [few, many] =
            variances(&[(5, false, 0.9, 0.5), (5, false, 0.1, 0.5), (9, true, 0.9, 0.5), (1, true, 0.1, 0.5)]);
        assert!(many < 0.5 * few, "{few} {many}");
    }

    #[test]
    fn where_there_is_one_lamp_light_rays_are_best() {
        let [few, many] = variances(&[(10, true, 1.0, 0.01)]);
        assert!(few < many, "{few} {many}");
    }
}
