//! Independent replicates: their mean is the estimate, their spread its error bar.
//!
//! Replicates of one *round* have the same number of rays each, so their mean and variance are those of a plain sample
//! (Welford). Rounds of different sizes are averaged with weights: `E = Σ w_k E_k`, `V = Σ w_k² V_k`, by what they are worth
//! ([`precision`]). Where there are few elements the weights are the numbers of rays.

use crate::math::Rgb;
use crate::precision::{Known, precision};

/// Running mean and variance per element over replicates and rounds, 48 bytes an element.
#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Replicates {
    /// The round that is running: mean and sum of squared deviations.
    mean: Vec<Rgb>,
    sum_sq_dev: Vec<Rgb>,
    count: u32,
    rays: u64,
    /// Weight of the running round.
    precision: f64,
    /// The rounds before: mean and variance of the mean. Empty before the first round closes.
    earlier_mean: Vec<Rgb>,
    earlier_variance: Vec<Rgb>,
    earlier_count: u32,
    earlier_precision: f64,
}

impl Replicates {
    /// No replicate yet of `elements` values.
    pub fn new(elements: usize) -> Replicates {
        let zeros = || vec![Rgb::BLACK; elements];
        Replicates { mean: zeros(), sum_sq_dev: zeros(), ..Replicates::default() }
    }

    /// Whether they are of so many elements.
    pub fn fits(&self, elements: usize) -> bool {
        [self.mean.len(), self.sum_sq_dev.len()] == [elements; 2]
            && [0, elements].contains(&self.earlier_mean.len())
            && self.earlier_mean.len() == self.earlier_variance.len()
    }

    /// Adds one replicate that took `rays` rays, its estimates in the order of the elements, whose areas are `area(e)` [m²].
    ///
    /// The area-weighted mean square of its distance from the mean of those before, of luminance, times `(n - 1) / n`: an
    /// estimate of a replicate's variance, independent of those before. None for the first of a round.
    pub fn push(&mut self, rays: u64, values: impl Iterator<Item = Rgb>, area: impl Fn(u32) -> f32) -> Option<f64> {
        self.count += 1;
        self.rays += rays;
        let share = 1.0 / self.count as f32;
        let (mut square, mut total_area) = (0.0, 0.0);
        for (e, ((mean, sum), value)) in (0..).zip(self.mean.iter_mut().zip(&mut self.sum_sq_dev).zip(values)) {
            let delta = value - *mean;
            *mean += delta * share;
            *sum += delta * (value - *mean);
            let area = f64::from(area(e));
            square += area * delta.luminance_f64().powi(2);
            total_area += area;
        }
        self.precision = self.measure_precision(area);
        (self.count > 1).then_some(square / total_area * (1.0 - f64::from(share)))
    }

    /// What the running round is worth.
    fn measure_precision(&self, area: impl Fn(u32) -> f32) -> f64 {
        let freedom = f64::from(self.count) * f64::from(self.count.saturating_sub(1));
        let known = |(e, (mean, sum)): (u32, (&Rgb, &Rgb))| Known {
            area: f64::from(area(e)),
            mean: mean.luminance_f64(),
            variance: sum.luminance_f64() / freedom,
        };
        let all = (0..self.mean.len() as u32).zip(self.mean.iter().zip(&self.sum_sq_dev)).map(known);
        match precision(all) {
            None => self.rays as f64,
            _ if self.count < 2 => self.rays as f64,
            Some(precision) if precision.is_finite() => precision,
            // Rounds without any noise, as in the dark, weigh the same.
            Some(_) => f64::from(self.count),
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
        self.earlier_precision += self.precision;
        self.mean.fill(Rgb::BLACK);
        self.sum_sq_dev.fill(Rgb::BLACK);
        (self.count, self.rays) = (0, 0);
    }

    /// Weight of the running round in the estimate.
    pub fn weight(&self) -> f64 {
        self.precision / (self.precision + self.earlier_precision)
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
        let now = self.weight() as f32;
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

    fn push(replicates: &mut Replicates, rays: u64, values: &[f32]) {
        replicates.push(rays, values.iter().map(|&value| Rgb::grey(value)), |_| 1.0);
    }

    #[test]
    fn one_round_gives_the_mean_and_its_standard_error() {
        let mut replicates = Replicates::new(1);
        for value in [2.0, 4.0, 9.0] {
            push(&mut replicates, 10, &[value]);
        }
        let (mean, variance) = replicates.estimate(0);
        assert_eq!(mean, Rgb::grey(5.0));
        assert!((variance.r - 13.0 / 3.0).abs() < 1e-5);
    }

    #[test]
    fn rounds_of_few_elements_are_weighted_by_their_rays() {
        let mut replicates = Replicates::new(1);
        push(&mut replicates, 10, &[1.0]);
        push(&mut replicates, 10, &[3.0]);
        replicates.close_round();
        push(&mut replicates, 30, &[100.0]);
        assert_eq!(replicates.estimate(0).0, Rgb::grey(2.0), "a single replicate has no spread and waits");
        push(&mut replicates, 30, &[102.0]);
        // Weights 20 : 60; variances of the two means are both 1.
        let (mean, variance) = replicates.estimate(0);
        assert!((mean.r - (0.25 * 2.0 + 0.75 * 101.0)).abs() < 1e-4);
        assert!((variance.r - (0.0625 + 0.5625)).abs() < 1e-5);
        assert_eq!(replicates.count(), 4);
    }

    #[test]
    fn rounds_of_many_elements_are_weighted_by_their_variances() {
        // Values 10 ± d: variances of the means d² / 7, with d = 2 and then 1, whatever the rays.
        let mut replicates = Replicates::new(100);
        for (rays, d) in [(1000, 2.0), (10, 1.0)] {
            for k in 0..8 {
                let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
                let shift = if rays == 10 { 1.0 } else { 0.0 };
                push(&mut replicates, rays, &[10.0 + shift + sign * d; 100]);
            }
            if rays == 1000 {
                replicates.close_round();
            }
        }
        // Relative to twice the mean: (2 / 20)² against (1 / 22)².
        let (first, second) = (1.0 / (4.0 / 400.0), 1.0 / (1.0 / 484.0));
        let weight = second / (first + second);
        let (mean, variance) = replicates.estimate(0);
        assert!((f64::from(mean.r) - (10.0 + weight)).abs() < 1e-4, "{mean:?}");
        let expected = (1.0 - weight).powi(2) * 4.0 / 7.0 + weight.powi(2) / 7.0;
        assert!((f64::from(variance.r) - expected).abs() < 1e-4, "{variance:?} {expected}");
    }
}
