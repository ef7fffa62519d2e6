//! Direct light of all elements: rounds of independent estimates, their mean and its error.
//!
//! Each round every element sends as many rays (see [`crate::transport::direct_light`]), from streams scrambled anew. Which share of
//! them are cosine rays follows from the round before: of a few shares the one with the least second moment
//!
//! ```text
//! ∫ f² / (share p_c + (1 - share) p_l)  ≈  1/n Σ_k f_k² / (p_k(share) p_k),      f = Be cos / pi
//! ```
//!
//! as its rays tell. So a room lit by a large window it stands in sends cosine rays, and one lit by small lamps light rays. Unbiased:
//! given the earlier rounds each round is, and all rounds count the same. Rounds are uncorrelated, so their spread is the error,
//! though it shrinks as shares become better. Cost: one ray a sample; 29 bytes an element.

use crate::math::Rgb;
use crate::math::hash::derive;
use crate::sampling::SequenceName;
use crate::transport::LightSampler;
use crate::transport::direct_light::{self, Rays, Sight};
use crate::{Error, Problem};

/// Shares of cosine rays among which every element chooses.
pub const COSINE_SHARES: [f32; 4] = [0.0625, 0.25, 0.5, 0.875];
/// The share of the first round.
const FIRST_SHARE: u8 = 1;
/// Rays of one piece, about.
const RAYS_PER_PIECE: u32 = 1 << 14;
/// Fewest rays of an element in a round: one of each kind at least, and something to choose a share by.
const FEWEST_RAYS: u32 = 4;

/// How direct light is computed.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Settings {
    /// Rays of each element in a round.
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
    pub rays: u32,
}

/// Running mean of the direct irradiance of every element.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct DirectLight {
    settings: Settings,
    sampler: LightSampler,
    /// Number in [`COSINE_SHARES`] of the share of each element's cosine rays.
    shares: Vec<u8>,
    mean: Vec<Rgb>,
    sum_sq_dev: Vec<Rgb>,
    /// Finished rounds, and rays of all of them and the running one.
    rounds: u32,
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
            mean: vec![Rgb::BLACK; elements],
            sum_sq_dev: vec![Rgb::BLACK; elements],
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
        let seed = derive(self.settings.seed, u64::from(self.rounds));
        let sequence = (self.settings.sequence.entry().make)(seed);
        let mut light = direct_light::DirectLight::new(problem, &self.sampler, sequence.as_ref());
        self.range(piece).map(|e| self.element(&mut light, e as u32)).collect()
    }

    /// Takes in the elements of `piece`; after the last piece the round is complete. Pieces come in their order.
    pub fn absorb(&mut self, piece: u64, received: &[Received]) {
        let share = 1.0 / (self.rounds + 1) as f32;
        for (e, received) in self.range(piece).zip(received) {
            let delta = received.irradiance - self.mean[e];
            self.mean[e] += delta * share;
            self.sum_sq_dev[e] += delta * (received.irradiance - self.mean[e]);
            self.shares[e] = received.share;
            self.rays += u64::from(received.rays);
        }
        if piece + 1 >= self.pieces() {
            self.rounds += 1;
        }
    }

    /// Mean direct irradiance [lux] of element `e`, and the variance of that mean [lux²]; NaN before the second round.
    pub fn estimate(&self, e: u32) -> (Rgb, Rgb) {
        let rounds = self.rounds as f32;
        let variance = match self.rounds {
            0 | 1 => Rgb::grey(f32::NAN),
            _ => self.sum_sq_dev[e as usize] / (rounds * (rounds - 1.0)),
        };
        (self.mean[e as usize], variance)
    }

    /// The share of cosine rays of element `e` in the running round.
    pub fn cosine_share(&self, e: u32) -> f32 {
        COSINE_SHARES[usize::from(self.shares[e as usize])]
    }

    /// Finished rounds.
    pub fn rounds(&self) -> u32 {
        self.rounds
    }

    /// Rays traced so far.
    pub fn rays(&self) -> u64 {
        self.rays
    }

    fn element(&self, light: &mut direct_light::DirectLight, e: u32) -> Received {
        let rays = split(self.settings.rays, self.cosine_share(e));
        let mut sum = Rgb::BLACK;
        let mut moments = [0.0; COSINE_SHARES.len()];
        let traced = light.look(e, rays, |sight| {
            let irradiance = sight.irradiance(rays);
            sum += irradiance;
            moments
                .iter_mut()
                .zip(COSINE_SHARES)
                .for_each(|(sum, share)| *sum += second_moment(&sight, irradiance, share));
        });
        let shadow = light.lamps(e, self.settings.rays, |_, irradiance| sum += irradiance);
        let known = moments.iter().any(|&moment| moment > 0.0);
        let best = (0..).zip(moments).min_by(|a, b| a.1.total_cmp(&b.1)).map_or(FIRST_SHARE, |(share, _)| share);
        let share = if known { best } else { self.shares[e as usize] };
        Received { irradiance: sum, share, rays: (traced + shadow) as u32 }
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

/// What a ray that adds `irradiance` tells of the second moment under another share, but for a common factor.
fn second_moment(sight: &Sight, irradiance: Rgb, cosine_share: f32) -> f32 {
    let value = sight.emission.luminance() * sight.cosine;
    irradiance.luminance() * value / (cosine_share * sight.cosine + (1.0 - cosine_share) * sight.light)
}
