//! Direct light of all elements in independent rounds, and what is learned from them about where rays are best spent.
//!
//! Each round elements send rays (see [`crate::transport::direct_light`]) from streams scrambled anew. A single element sends too few to
//! know how good they are, so neighbours put together what theirs tell: 64 elements that follow each other in the mesh.
//!
//! - Which share of the rays are cosine rays: of a few shares the one with the least variance v of a ray,
//!
//!   ```text
//!   ∫ f² (d_c³ + d_l³) / (d_c² + d_l²)²  -  (∫ f w)² / n_c  -  (∫ f (1 - w))² / n_l,      w = d_c² / (d_c² + d_l²),  f = Be cos / pi
//!   ```
//!
//!   So elements that touch a window send cosine rays, and those lit by small lamps light rays.
//! - The weight against light that was shot with Φ lumens a ray, whose variance is `V_s = E Φ / A`: `V_s / (V_s + v / n)`.
//! - How many rays an element sends: with `n = (k sqrt(a v) - v / V_s)+` the sum of `a V` over all elements is least (Neyman 1934),
//!   where V is the merged variance. With a = A that would be the area-weighted mean square error, with a = 1 the plain one;
//!   `a = sqrt(A)` serves both. Where nothing is seen, or shooting does better, no rays are sent.
//!
//! A trial before the first round shows something of all neighbours. Unbiased: weights and numbers of rays follow from earlier rounds.
//! Cost: one ray a sample, which takes twice as long as one of shooting; 1 byte an element.

use crate::Problem;
use crate::math::Rgb;
use crate::math::hash::derive;
use crate::sampling::SequenceName;
use crate::transport::direct_light::{Rays, Sight};
use crate::transport::{DirectEstimator, LightSampler};
use std::ops::Range;

/// Shares of cosine rays among which neighbours choose.
pub const COSINE_SHARES: [f32; 4] = [0.0625, 0.25, 0.5, 0.875];
/// The share of the trial.
const FIRST_SHARE: u8 = 1;
/// Elements that learn from each other.
const NEIGHBOURS: usize = 64;
/// Rays of the mean of all elements that count as the neighbours' own, as long as these have sent few.
const RAYS_OF_PRIOR: f32 = 4.0;
/// One of so many elements takes part in the trial.
const TRIAL_OF: usize = 4;
/// Rays of one piece, about.
const RAYS_PER_PIECE: usize = 1 << 14;
/// Most rays of an element, as a multiple of the mean.
const MOST: f64 = 256.0;
/// Fewest rays of an element that sends any: one of each kind.
const FEWEST_RAYS: u32 = 3;
/// Who wants fewer sends none, if others have shot.
const LEAST_WANTED: f64 = 1.5;
/// Elements by which the rays are shared out, about.
const SAMPLE: usize = 4096;
/// Number of rays for which shares are compared: of these all shares are whole numbers.
const RAYS_OF_COMPARISON: u32 = 16;
/// Rays of an element in the trial.
const RAYS_OF_TRIAL: u32 = 4;
/// Least variance of a ray, relative to the square of the mean: few rays cannot tell that there is less.
const EVEN: f32 = 0.01;

/// What one round gave an element.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Received {
    /// Irradiance [lux].
    pub irradiance: Rgb,
    /// Variance of a ray with each of the [`COSINE_SHARES`] [lux²].
    pub variances: [f32; 4],
    pub rays: u32,
}

/// What neighbours have learned: sums over their rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
struct Learned {
    rays: f32,
    irradiance: f32,
    variances: [f32; 4],
    /// Number in [`COSINE_SHARES`] of their share of cosine rays.
    share: u8,
}

impl Learned {
    /// Adds what `weight` times the rays of others have told.
    fn add(&mut self, other: &Learned, weight: f32) {
        self.rays += weight * other.rays;
        self.irradiance += weight * other.irradiance;
        self.variances.iter_mut().zip(other.variances).for_each(|(sum, variance)| *sum += weight * variance);
    }
}

/// Rounds of direct light.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct DirectLight {
    seed: u64,
    sequence: SequenceName,
    sampler: LightSampler,
    learned: Vec<Learned>,
    /// What the running round teaches, with what was learned before.
    fresh: Vec<Learned>,
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
        let learned = Learned { share: FIRST_SHARE, ..Learned::default() };
        DirectLight {
            seed,
            sequence,
            sampler: LightSampler::new(problem),
            learned: vec![learned; elements.div_ceil(NEIGHBOURS)],
            fresh: vec![learned; elements.div_ceil(NEIGHBOURS)],
            elements,
            rounds: 0,
            rays: 0.0,
            rays_for_need: 0.0,
            ray_flux: f64::INFINITY,
        }
    }

    /// Begins the trial.
    pub fn begin_trial(&mut self) {
        (self.rounds, self.rays) = (0, f64::from(RAYS_OF_TRIAL) / TRIAL_OF as f64);
    }

    /// Begins a round of about `rays` rays in all, to be merged with light that was shot with so much flux [lm] a ray (infinite if there
    /// is none).
    pub fn begin_round(&mut self, problem: &Problem, rays: f64, ray_flux: f64) {
        self.rounds += 1;
        self.learn_from_round();
        (self.rays, self.ray_flux) = (rays / self.elements as f64, ray_flux);
        let every = self.elements.div_ceil(SAMPLE);
        let sample = problem.mesh.elements().step_by(every);
        self.rays_for_need = self.rays_for_need(problem, sample, rays / every as f64, ray_flux);
    }

    /// What the sum of `sqrt(A) V` over `elements` would be if they had `rays` rays together, merged with rays of so much flux [lm].
    pub fn expected_variance(
        &self,
        problem: &Problem,
        elements: impl Iterator<Item = u32> + Clone,
        rays: f64,
        ray_flux: f64,
    ) -> f64 {
        let each = self.rays_for_need(problem, elements.clone(), rays, ray_flux);
        let of_element = |e| {
            let (own, worth) = (self.wanted(problem, e, each, ray_flux), self.worth_of_shooting(problem, e, ray_flux));
            let own = if own < LEAST_WANTED { 0.0 } else { own };
            let variance = self.expected(e).1;
            if variance > 0.0 { f64::from(problem.mesh.area(e)).sqrt() * variance / (own + worth) } else { 0.0 }
        };
        elements.map(of_element).sum()
    }

    /// The k with which `elements` want `rays` rays together.
    fn rays_for_need(
        &self,
        problem: &Problem,
        elements: impl Iterator<Item = u32> + Clone,
        rays: f64,
        ray_flux: f64,
    ) -> f64 {
        let all = |each: f64| elements.clone().map(|e| self.wanted(problem, e, each, ray_flux)).sum::<f64>();
        let (mut low, mut high) = (0.0, 1.0);
        while all(high) < rays && high < 1e30 {
            (low, high) = (high, 4.0 * high);
        }
        for _ in 0..10 {
            let middle = 0.5 * (low + high);
            if all(middle) > rays { high = middle } else { low = middle }
        }
        high
    }

    /// What the round taught holds from now on. Where few rays were sent the mean over all elements stands in.
    fn learn_from_round(&mut self) {
        let mut all = Learned::default();
        self.fresh.iter().for_each(|fresh| all.add(fresh, 1.0));
        let few = if all.rays > 0.0 { RAYS_OF_PRIOR / all.rays } else { 0.0 };
        for (learned, fresh) in self.learned.iter_mut().zip(&self.fresh) {
            *learned = *fresh;
            learned.add(&all, few);
            let best = (0..).zip(learned.variances).min_by(|a, b| a.1.total_cmp(&b.1));
            learned.share = best.map_or(FIRST_SHARE, |(share, _)| share);
        }
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
            let (learned, rays) = (&mut self.fresh[e / NEIGHBOURS], received.rays as f32);
            learned.rays += rays;
            learned.irradiance += rays * received.irradiance.luminance();
            learned.variances.iter_mut().zip(received.variances).for_each(|(sum, variance)| *sum += rays * variance);
        }
    }

    /// Rays of element `e` in the running round.
    pub fn rays_of(&self, problem: &Problem, e: u32) -> u32 {
        if self.rounds == 0 {
            return if (e as usize).is_multiple_of(TRIAL_OF) { RAYS_OF_TRIAL } else { 0 };
        }
        let wanted = self.wanted(problem, e, self.rays_for_need, self.ray_flux).min(MOST * self.rays.max(1.0));
        if wanted < LEAST_WANTED && self.ray_flux.is_finite() { 0 } else { (wanted as u32).max(FEWEST_RAYS) }
    }

    /// The share of cosine rays of element `e` in the running round.
    pub fn cosine_share(&self, e: u32) -> f32 {
        COSINE_SHARES[usize::from(self.learned[e as usize / NEIGHBOURS].share)]
    }

    fn element(&self, problem: &Problem, light: &mut DirectEstimator, e: u32) -> Received {
        let count = self.rays_of(problem, e);
        if count == 0 {
            return Received::default();
        }
        let rays = split(count, self.cosine_share(e));
        let mut sum = Rgb::BLACK;
        let mut trials = COSINE_SHARES.map(|share| Trial::new(split(RAYS_OF_COMPARISON, share), count));
        let traced = light.look(e, rays, |sight| {
            let irradiance = sight.irradiance(rays);
            sum += irradiance;
            trials.iter_mut().for_each(|trial| trial.add(&sight, irradiance.luminance()));
        });
        let shadow = light.lamps(e, count, |_, irradiance| sum += irradiance);
        let variances = trials.map(|trial| trial.variance() * RAYS_OF_COMPARISON as f32);
        Received { irradiance: sum, variances, rays: (traced + shadow) as u32 }
    }

    /// Weight of `rays` rays of element `e` against what was shot.
    fn weight(&self, problem: &Problem, e: u32, rays: u32) -> f32 {
        let worth = self.worth_of_shooting(problem, e, self.ray_flux);
        (f64::from(rays) / (f64::from(rays) + worth)) as f32
    }

    /// Mean irradiance of the neighbours of element `e` [lux], and variance of a ray [lux²].
    fn expected(&self, e: u32) -> (f64, f64) {
        let Learned { rays, irradiance, variances, share } = self.learned[e as usize / NEIGHBOURS];
        if rays <= 0.0 {
            return (0.0, 0.0);
        }
        let mean = irradiance / rays;
        (f64::from(mean), f64::from((variances[usize::from(share)] / rays).max(EVEN * mean * mean)))
    }

    /// `v / V_s`: rays that would tell as much as was shot.
    fn worth_of_shooting(&self, problem: &Problem, e: u32, ray_flux: f64) -> f64 {
        let (irradiance, variance) = self.expected(e);
        if irradiance <= 0.0 || ray_flux.is_infinite() {
            return 0.0;
        }
        variance * f64::from(problem.mesh.area(e)) / (irradiance * ray_flux)
    }

    /// `(k sqrt(a v) - v / V_s)+`
    fn wanted(&self, problem: &Problem, e: u32, each: f64, ray_flux: f64) -> f64 {
        let need = (f64::from(problem.mesh.area(e)).sqrt() * self.expected(e).1).sqrt();
        (each * need - self.worth_of_shooting(problem, e, ray_flux)).max(0.0)
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

/// `rays` with this share of cosine rays, at least one of each kind.
fn split(rays: u32, cosine_share: f32) -> Rays {
    let cosine = ((rays as f32 * cosine_share).round() as u32).clamp(1, rays - 1);
    Rays { light: rays - cosine, cosine }
}

/// What the rays of an element tell of the variance with other numbers of rays.
#[derive(Clone, Copy, Debug)]
struct Trial {
    rays: Rays,
    /// Rays that were sent.
    sent: u32,
    /// The first integral of the variance.
    square: f32,
    /// The other two, by the parts that both kinds of rays add to the mean: their sums and sums of squares.
    by_cosine: [f32; 2],
    by_light: [f32; 2],
}

impl Trial {
    fn new(rays: Rays, sent: u32) -> Trial {
        Trial { rays, sent, square: 0.0, by_cosine: [0.0; 2], by_light: [0.0; 2] }
    }

    /// Adds a ray that has added `irradiance` [lux].
    fn add(&mut self, sight: &Sight, irradiance: f32) {
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

    /// Unbiased, so it may be negative: products of two different rays stand for the squares of means.
    fn variance(&self) -> f32 {
        let sent = self.sent as f32;
        let squared = |[sum, sum_sq]: [f32; 2]| (sum * sum - sum_sq) * sent / (sent - 1.0);
        self.square
            - squared(self.by_cosine) / self.rays.cosine as f32
            - squared(self.by_light) / self.rays.light as f32
    }
}
