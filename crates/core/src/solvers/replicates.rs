//! Independent replicates: their mean is the estimate, their spread its error bar.
//!
//! Replicates of one *round* have the same number of rays each, so their mean and variance are those of a plain sample
//! (Welford). Rounds of different sizes are averaged by their numbers of rays: `E = Σ w_k E_k`, `V = Σ w_k² V_k`.

use crate::math::Rgb;

/// Running mean and variance per element over replicates and rounds, 48 bytes an element.
#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Replicates {
    /// The round that is running: mean and sum of squared deviations.
    mean: Vec<Rgb>,
    sum_sq_dev: Vec<Rgb>,
    count: u32,
    rays: u64,
    /// The rounds before: mean and variance of the mean. Empty before the first round closes.
    earlier_mean: Vec<Rgb>,
    earlier_variance: Vec<Rgb>,
    earlier_count: u32,
    earlier_rays: u64,
}

impl Replicates {
    /// No replicate yet of `elements` values.
    pub fn new(elements: usize) -> Replicates {
        let zeros = || vec![Rgb::BLACK; elements];
        Replicates { mean: zeros(), sum_sq_dev: zeros(), ..Replicates::default() }
    }

    /// Adds one replicate that took `rays` rays, its estimates in the order of the elements.
    pub fn push(&mut self, rays: u64, values: impl Iterator<Item = Rgb>) {
        self.count += 1;
        self.rays += rays;
        let share = 1.0 / self.count as f32;
        for ((mean, sum), value) in self.mean.iter_mut().zip(&mut self.sum_sq_dev).zip(values) {
            let delta = value - *mean;
            *mean += delta * share;
            *sum += delta * (value - *mean);
        }
    }

    /// Closes the running round, so that replicates of another size can follow.
    pub fn close_round(&mut self) {
        if self.count < 2 {
            return;
        }
        let merged: (Vec<Rgb>, Vec<Rgb>) = (0..self.mean.len() as u32).map(|e| self.estimate(e)).unzip();
        (self.earlier_mean, self.earlier_variance) = merged;
        self.earlier_count += self.count;
        self.earlier_rays += self.rays;
        self.mean.fill(Rgb::BLACK);
        self.sum_sq_dev.fill(Rgb::BLACK);
        (self.count, self.rays) = (0, 0);
    }

    /// Replicates that have entered the estimate.
    pub fn count(&self) -> u32 {
        self.earlier_count + if self.usable() { self.count } else { 0 }
    }

    /// Replicates of the running round.
    pub fn count_in_round(&self) -> u32 {
        self.count
    }

    /// Mean of all replicates of element `e`, and the variance of that mean (NaN for fewer than two replicates).
    pub fn estimate(&self, e: u32) -> (Rgb, Rgb) {
        let e = e as usize;
        if !self.usable() {
            return (self.earlier_mean[e], self.earlier_variance[e]);
        }
        let variance = if self.count < 2 {
            Rgb::grey(f32::NAN)
        } else {
            self.sum_sq_dev[e] / (self.count as f32 * (self.count - 1) as f32)
        };
        if self.earlier_mean.is_empty() {
            return (self.mean[e], variance);
        }
        let now = (self.rays as f64 / (self.rays + self.earlier_rays) as f64) as f32;
        let mean = self.mean[e] * now + self.earlier_mean[e] * (1.0 - now);
        (mean, variance * (now * now) + self.earlier_variance[e] * ((1.0 - now) * (1.0 - now)))
    }

    /// Whether the running round can be used: a single replicate has no spread, so it only counts while there is nothing else.
    fn usable(&self) -> bool {
        self.count >= 2 || self.earlier_mean.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_round_gives_the_mean_and_its_standard_error() {
        let mut replicates = Replicates::new(1);
        for value in [2.0, 4.0, 9.0] {
            replicates.push(10, std::iter::once(Rgb::grey(value)));
        }
        let (mean, variance) = replicates.estimate(0);
        assert_eq!(mean, Rgb::grey(5.0));
        assert!((variance.r - 13.0 / 3.0).abs() < 1e-5);
    }

    #[test]
    fn rounds_are_weighted_by_their_rays() {
        let mut replicates = Replicates::new(1);
        replicates.push(10, std::iter::once(Rgb::grey(1.0)));
        replicates.push(10, std::iter::once(Rgb::grey(3.0)));
        replicates.close_round();
        replicates.push(30, std::iter::once(Rgb::grey(100.0)));
        assert_eq!(replicates.estimate(0).0, Rgb::grey(2.0), "a single replicate has no spread and waits");
        replicates.push(30, std::iter::once(Rgb::grey(102.0)));
        // Weights 20 : 60; variances of the two means are both 1.
        let (mean, variance) = replicates.estimate(0);
        assert!((mean.r - (0.25 * 2.0 + 0.75 * 101.0)).abs() < 1e-4);
        assert!((variance.r - (0.0625 + 0.5625)).abs() < 1e-5);
        assert_eq!(replicates.count(), 4);
    }
}
