//! Direct light of all elements: rounds of independent estimates, their mean and its error.
//!
//! Each round every element sends rays (see [`crate::transport::direct_light`]) from streams scrambled anew. Which share of them are
//! cosine rays follows from the round before: of a few shares the one with the least variance,
//!
//! ```text
//! ∫ f² (d_c³ + d_l³) / (d_c² + d_l²)²  -  (∫ f w)² / n_c  -  (∫ f (1 - w))² / n_l,      w = d_c² / (d_c² + d_l²),  f = Be cos / pi
//! ```
//!
//! as its rays tell. So an element that touches a window sends cosine rays, and one lit by small lamps light rays. How many rays an
//! element sends grows with the square root of its area times the mean variance of a ray in the rounds before: that is least for the
//! area-weighted mean square error (Neyman 1934). A quarter of the rays goes to all alike, for what has not been seen yet.
//!
//! The first round is a trial and counts for nothing. Unbiased: given the earlier rounds each round is, and all others count the
//! same. Rounds are uncorrelated, so their spread is the error. Cost: one ray a sample; 25 bytes an element.

use crate::math::Rgb;
use crate::math::hash::derive;
use crate::sampling::SequenceName;
use crate::transport::direct_light::{Rays, Sight};
use crate::transport::{DirectEstimator, LightSampler};
use crate::{Error, Problem};

/// Shares of cosine rays among which every element chooses.
pub const COSINE_SHARES: [f32; 4] = [0.0625, 0.25, 0.5, 0.875];
/// The share of the first round.
const FIRST_SHARE: u8 = 1;
/// Rays of one piece, about.
const RAYS_PER_PIECE: u32 = 1 << 14;
/// Share of the rays that goes to all elements alike.
const ALIKE: f64 = 0.25;
/// Most rays of an element, as a multiple of the mean.
const MOST: f64 = 256.0;
/// Fewest rays of an element in a round: one of each kind at least, and something to choose a share by.
const FEWEST_RAYS: u32 = 4;

/// How direct light is computed.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Settings {
    /// Rays of each element in a round, on average.
    pub rays: u32,
    pub seed: u64,
    pub sequence: SequenceName,
}

/// What one round gave an element.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Received {
    /// Irradiance [lux].
    pub irradiance: Rgb,
    /// Number in [`COSINE_SHARES`] of the share that would have been best.
    pub share: u8,
    /// Variance of a ray with that share [lux²].
    pub variance: f32,
    pub rays: u32,
}

/// Running mean of the direct irradiance of every element.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct DirectLight {
    settings: Settings,
    sampler: LightSampler,
    /// Number in [`COSINE_SHARES`] of the share of each element's cosine rays.
    shares: Vec<u8>,
    /// Mean over all rounds of the variance of a ray [lux²]: the need of rays.
    variance: Vec<f32>,
    /// Rays for each unit of `sqrt(area * variance)`.
    rays_for_need: f64,
    mean: Vec<Rgb>,
    /// Of the luminance.
    sum_sq_dev: Vec<f32>,
    /// Whether the trial is over, and the finished rounds after it.
    tried: bool,
    rounds: u32,
    /// Rays of all rounds and of the trial.
    rays: u64,
}

impl DirectLight {
    /// # Errors
    /// [`Error::Parameter`] for fewer than four rays.
    pub fn new(problem: &Problem, settings: Settings) -> Result<DirectLight, Error> {
        if settings.rays < FEWEST_RAYS {
            let allowed = "each element needs at least four rays in a round";
            return Err(Error::Parameter { name: "rays", value: settings.rays.to_string(), allowed });
        }
        let elements = problem.mesh.len();
        Ok(DirectLight {
            settings,
            sampler: LightSampler::new(problem),
            shares: vec![FIRST_SHARE; elements],
            variance: vec![0.0; elements],
            rays_for_need: 0.0,
            mean: vec![Rgb::BLACK; elements],
            sum_sq_dev: vec![0.0; elements],
            tried: false,
            rounds: 0,
            rays: 0,
        })
    }

    /// Pieces of a round: ranges of neighbouring elements.
    pub fn pieces(&self) -> u64 {
        self.mean.len().div_ceil(self.elements_per_piece()) as u64
    }

    /// What the elements of `piece` receive in the running round, in their order. Pure.
    pub fn piece(&self, problem: &Problem, piece: u64) -> Vec<Received> {
        let seed = derive(self.settings.seed, self.rounds_begun());
        let sequence = (self.settings.sequence.entry().make)(seed);
        let mut light = DirectEstimator::new(problem, &self.sampler, sequence.as_ref());
        self.range(piece).map(|e| self.element(problem, &mut light, e as u32)).collect()
    }

    /// Takes in the elements of `piece`; after the last piece the round is complete. Pieces come in their order.
    pub fn absorb(&mut self, problem: &Problem, piece: u64, received: &[Received]) {
        let (share, begun) = (1.0 / (self.rounds + 1) as f32, 1.0 / (self.rounds_begun() + 1) as f32);
        for (e, received) in self.range(piece).zip(received) {
            if self.tried {
                let delta = received.irradiance - self.mean[e];
                self.mean[e] += delta * share;
                self.sum_sq_dev[e] += delta.luminance() * (received.irradiance - self.mean[e]).luminance();
            }
            self.shares[e] = received.share;
            self.variance[e] += (received.variance - self.variance[e]) * begun;
            self.rays += u64::from(received.rays);
        }
        if piece + 1 >= self.pieces() {
            self.rounds += u32::from(self.tried);
            self.tried = true;
            let need: f64 = problem.mesh.elements().map(|e| self.need(problem, e)).sum();
            let shared = (1.0 - ALIKE) * f64::from(self.settings.rays) * self.mean.len() as f64;
            self.rays_for_need = if need > 0.0 { shared / need } else { 0.0 };
        }
    }

    /// Mean direct irradiance [lux] of element `e`, and the variance of the luminance of that mean [lux²]; NaN before the second
    /// round after the trial.
    pub fn estimate(&self, e: u32) -> (Rgb, f32) {
        let rounds = self.rounds as f32;
        let variance = if self.rounds < 2 { f32::NAN } else { self.sum_sq_dev[e as usize] / (rounds * (rounds - 1.0)) };
        (self.mean[e as usize], variance)
    }

    /// Rays of element `e` in the running round.
    pub fn rays_of(&self, problem: &Problem, e: u32) -> u32 {
        let mean = f64::from(self.settings.rays);
        let alike = if self.tried { ALIKE } else { 1.0 };
        let rays = alike * mean + self.need(problem, e) * self.rays_for_need;
        (rays.min(MOST * mean) as u32).max(FEWEST_RAYS)
    }

    /// The share of cosine rays of element `e` in the running round.
    pub fn cosine_share(&self, e: u32) -> f32 {
        COSINE_SHARES[usize::from(self.shares[e as usize])]
    }

    /// Finished rounds, without the trial.
    pub fn rounds(&self) -> u32 {
        self.rounds
    }

    /// Rays traced so far, with those of the trial.
    pub fn rays(&self) -> u64 {
        self.rays
    }

    fn element(&self, problem: &Problem, light: &mut DirectEstimator, e: u32) -> Received {
        let count = self.rays_of(problem, e);
        let rays = split(count, self.cosine_share(e));
        let mut sum = Rgb::BLACK;
        let mut trials = COSINE_SHARES.map(|share| Trial::new(split(count, share)));
        let traced = light.look(e, rays, |sight| {
            let irradiance = sight.irradiance(rays);
            sum += irradiance;
            trials.iter_mut().for_each(|trial| trial.add(&sight, irradiance.luminance()));
        });
        let shadow = light.lamps(e, count, |_, irradiance| sum += irradiance);
        let variances = (0..).zip(trials.iter().map(Trial::variance));
        let best = variances.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|_| !sum.is_black());
        let (share, variance) = best.unwrap_or((self.shares[e as usize], 0.0));
        Received { irradiance: sum, share, variance: variance * count as f32, rays: (traced + shadow) as u32 }
    }

    /// What the rays of element `e` are in proportion to.
    fn need(&self, problem: &Problem, e: u32) -> f64 {
        (f64::from(problem.mesh.area(e)) * f64::from(self.variance[e as usize])).sqrt()
    }

    /// Rounds begun, the trial among them.
    fn rounds_begun(&self) -> u64 {
        u64::from(self.rounds) + u64::from(self.tried)
    }

    fn elements_per_piece(&self) -> usize {
        (RAYS_PER_PIECE / self.settings.rays).max(1) as usize
    }

    fn range(&self, piece: u64) -> std::ops::Range<usize> {
        let size = self.elements_per_piece();
        let first = (piece as usize).saturating_mul(size).min(self.mean.len());
        first..first.saturating_add(size).min(self.mean.len())
    }
}

/// `rays` with this share of cosine rays, at least one of each kind.
fn split(rays: u32, cosine_share: f32) -> Rays {
    let cosine = ((rays as f32 * cosine_share).round() as u32).clamp(1, rays - 1);
    Rays { light: rays - cosine, cosine }
}

/// What the rays of an element tell of the variance with other numbers of rays.
#[derive(Clone, Copy, Debug)]
struct Trial {
    rays: Rays,
    /// The three integrals of the variance.
    square: f32,
    by_cosine: f32,
    by_light: f32,
}

impl Trial {
    fn new(rays: Rays) -> Trial {
        Trial { rays, square: 0.0, by_cosine: 0.0, by_light: 0.0 }
    }

    /// Adds a ray that has added `irradiance` [lux].
    fn add(&mut self, sight: &Sight, irradiance: f32) {
        let value = sight.emission.luminance() * sight.cosine;
        let [cosine, light] = [self.rays.cosine as f32 * sight.cosine, self.rays.light as f32 * sight.light];
        let sum = cosine * cosine + light * light;
        self.square += irradiance * value * (cosine.powi(3) + light.powi(3)) / (sum * sum);
        self.by_cosine += irradiance * cosine * cosine / sum;
        self.by_light += irradiance * light * light / sum;
    }

    fn variance(&self) -> f32 {
        let squared = self.by_cosine.powi(2) / self.rays.cosine as f32 + self.by_light.powi(2) / self.rays.light as f32;
        (self.square - squared).max(0.0)
    }
}
