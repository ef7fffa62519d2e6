//! Direct light of all elements in independent rounds, and what is learned from them about where rays are best spent.
//!
//! Each round elements send rays (see [`crate::transport::direct_light`]) from streams scrambled anew. A single element sends too few to
//! know how good they are, so neighbours put together what theirs tell: 64 elements that follow each other in the mesh.
//!
//! - Which share of the rays are cosine rays ([`comparison`]): elements that touch a window send cosine rays, and those lit by small lamps
//!   light rays.
//! - The weight against light that was shot with Φ lumens a ray, whose variance is `V_s = E Φ / A`: `V_s / (V_s + v / n)`, with the
//!   variance v of a ray.
//! - How many rays an element sends ([`neighbours`]): where nothing is seen, or shooting does better, none.
//!
//! A trial before the first round shows something of all neighbours. Unbiased: weights and numbers of rays follow from earlier rounds.
//! Cost: one ray a sample, which takes twice as long as one of shooting; 1 byte an element.

mod comparison;
mod neighbours;

pub use self::neighbours::Neighbours;

use self::comparison::{Comparison, split};
use crate::Problem;
use crate::math::Rgb;
use crate::math::hash::derive;
use crate::sampling::SequenceName;
use crate::solvers::allocation::SAMPLE;
use crate::transport::{DirectEstimator, LightSampler};
use std::ops::Range;

/// Shares of cosine rays among which neighbours choose.
pub const COSINE_SHARES: [f32; 4] = [0.0625, 0.25, 0.5, 0.875];
/// One of so many elements takes part in the trial.
const TRIAL_OF: usize = 4;
/// Rays of one piece, about.
const RAYS_PER_PIECE: usize = 1 << 14;
/// Most rays of an element, as a multiple of the mean.
const MOST: f64 = 256.0;
/// Fewest rays of an element that sends any; there are two kinds of them.
const FEWEST_RAYS: u32 = 3;
/// Who wants fewer sends none, if others have shot.
const LEAST_WANTED: f64 = 1.5;
/// Rays of an element in the trial.
const RAYS_OF_TRIAL: u32 = 4;

/// What one round gave an element.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Received {
    /// Irradiance [lux].
    pub irradiance: Rgb,
    /// Variance of a ray with each of the [`COSINE_SHARES`] [lux²].
    pub variances: [f32; COSINE_SHARES.len()],
    /// Its rays; those that would have left below its horizon were not traced, but count.
    pub rays: u32,
    /// Rays that were traced, with those towards lights without extent.
    pub traced: u32,
}

/// Rounds of direct light.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct DirectLight {
    seed: u64,
    sequence: SequenceName,
    sampler: LightSampler,
    neighbours: Neighbours,
    elements: usize,
    /// Rounds begun; the trial is the first.
    rounds: u32,
    /// Rays of an element in the running round, on average.
    rays: f64,
    /// Rays for each unit of need.
    rays_for_need: f64,
    /// Flux [lm] of the rays that have shot the light with which the round is merged.
    ray_flux: f64,
}

impl DirectLight {
    /// Nothing learned yet.
    pub fn new(problem: &Problem, seed: u64, sequence: SequenceName) -> DirectLight {
        let elements = problem.mesh.len();
        DirectLight {
            seed,
            sequence,
            sampler: LightSampler::new(problem),
            neighbours: Neighbours::new(elements),
            elements,
            rounds: 0,
            rays: 0.0,
            rays_for_need: 0.0,
            ray_flux: f64::INFINITY,
        }
    }

    /// Whether a loaded state is of the elements of `problem`.
    pub fn fits(&self, problem: &Problem) -> bool {
        self.elements == problem.mesh.len() && self.neighbours.fits(self.elements)
    }

    /// Begins the trial.
    pub fn begin_trial(&mut self) {
        (self.rounds, self.rays) = (0, f64::from(RAYS_OF_TRIAL) / TRIAL_OF as f64);
    }

    /// Begins a round of about `rays` rays in all, to be merged with light that was shot with so much flux [lm] a ray (infinite if there
    /// is none).
    pub fn begin_round(&mut self, problem: &Problem, rays: f64, ray_flux: f64) {
        self.end_round();
        self.rounds += 1;
        (self.rays, self.ray_flux) = (rays / self.elements as f64, ray_flux);
        let every = self.elements.div_ceil(SAMPLE);
        let sample = problem.mesh.elements().step_by(every);
        self.rays_for_need = self.neighbours.rays_for_need(&problem.mesh, sample, rays / every as f64, ray_flux);
    }

    /// What the running round or trial has taught holds from now on.
    pub fn end_round(&mut self) {
        self.neighbours.end_round();
    }

    /// Pieces of a round: ranges of neighbouring elements.
    pub fn pieces(&self) -> u64 {
        self.elements.div_ceil(self.elements_per_piece()) as u64
    }

    /// What the elements of `piece` receive in the running round, in their order. Pure.
    pub fn piece(&self, problem: &Problem, piece: u64) -> Vec<Received> {
        let sequence = (self.sequence.entry().make)(derive(self.seed, self.rounds.into()));
        let mut light = DirectEstimator::new(problem, &self.sampler, sequence.as_ref());
        self.range(piece).map(|e| self.element(problem, &mut light, e as u32)).collect()
    }

    /// Hands element, irradiance [lux] and weight of what was `received` in `piece` to `merge`, but not in the trial.
    pub fn merge(&self, problem: &Problem, piece: u64, received: &[Received], mut merge: impl FnMut(u32, Rgb, f32)) {
        if self.rounds > 0 {
            for (e, received) in self.range(piece).zip(received).filter(|(_, received)| received.rays > 0) {
                merge(e as u32, received.irradiance, self.weight(problem, e as u32, received.rays));
            }
        }
    }

    /// Learns from what was `received` in `piece`, for the next round.
    pub fn learn(&mut self, piece: u64, received: &[Received]) {
        for (e, received) in self.range(piece).zip(received) {
            self.neighbours.learn(e as u32, received.rays, received.irradiance.luminance(), received.variances);
        }
    }

    /// Rays of element `e` in the running round.
    pub fn rays_of(&self, problem: &Problem, e: u32) -> u32 {
        if self.rounds == 0 {
            return if (e as usize).is_multiple_of(TRIAL_OF) { RAYS_OF_TRIAL } else { 0 };
        }
        let wanted = self.neighbours.wanted(&problem.mesh, e, self.rays_for_need, self.ray_flux);
        let wanted = wanted.min(MOST * self.rays.max(1.0));
        if wanted < LEAST_WANTED && self.ray_flux.is_finite() { 0 } else { (wanted as u32).max(FEWEST_RAYS) }
    }

    /// What the rays have told so far.
    pub fn neighbours(&self) -> &Neighbours {
        &self.neighbours
    }

    fn element(&self, problem: &Problem, light: &mut DirectEstimator, e: u32) -> Received {
        let count = self.rays_of(problem, e);
        if count == 0 {
            return Received::default();
        }
        let rays = split(count, self.neighbours.cosine_share(e));
        let mut sum = Rgb::BLACK;
        let mut comparisons = COSINE_SHARES.map(|share| Comparison::new(share, count));
        let traced = light.look(e, rays, |sight| {
            let irradiance = sight.irradiance(rays);
            sum += irradiance;
            comparisons.iter_mut().for_each(|comparison| comparison.add(&sight, irradiance.luminance()));
        });
        let shadow = light.lamps(e, count, |_, irradiance| sum += irradiance);
        let variances = comparisons.map(|comparison| comparison.variance());
        Received { irradiance: sum, variances, rays: count, traced: (traced + shadow) as u32 }
    }

    /// Weight of `rays` rays of element `e` against what was shot.
    fn weight(&self, problem: &Problem, e: u32, rays: u32) -> f32 {
        let worth = self.neighbours.worth_of_shooting(&problem.mesh, e, self.ray_flux);
        (f64::from(rays) / (f64::from(rays) + worth)) as f32
    }

    fn elements_per_piece(&self) -> usize {
        ((RAYS_PER_PIECE as f64 / self.rays.max(1.0)) as usize).max(1)
    }

    fn range(&self, piece: u64) -> Range<usize> {
        let size = self.elements_per_piece();
        let first = (piece as usize).saturating_mul(size).min(self.elements);
        first..first.saturating_add(size).min(self.elements)
    }
}
