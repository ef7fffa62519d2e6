//! Direct light on an element: light rays and cosine rays, combined by multiple importance sampling.
//!
//! ```text
//! E_i = (1 / A_i) ∫_Ai ∫ Be(y) cos / pi dw dx  ≈  Σ_k Be(y_k) cos_k / pi · d_k / (d_c² + d_l²),      d_c = n_c p_c,  d_l = n_l p_l
//! ```
//!
//! for n_c rays in cosine-distributed directions, density `p_c = cos / pi`, and n_l in directions of a [`LightSampler`], density p_l,
//! from uniform points of the element; y_k is what ray k sees, and d_k the d of its own kind (the power heuristic of Veach & Guibas,
//! Optimally Combining Sampling Techniques, SIGGRAPH 1995: the balance heuristic lets the few cosine rays that hit a small lamp spoil
//! what light rays know well). A light ray counts only if it ends on the emitter at which it aims. Both kinds of rays meet
//! surfaces as all rays do, so no light is seen by one kind and not by the other. Unbiased, and no ray counts for more than `Be / n_c`.
//!
//! Lights without extent: `I cos / r²` at uniform points of the element, a shadow ray each. Cost: one ray a sample.

use super::light_sampling::{Cut, Emitter, Receiver};
use super::{Departure, Footprint, LightSampler, Spot, lamp};
use crate::Problem;
use crate::geometry::{Hit, Ray};
use crate::math::warp::{square_to_cosine_hemisphere, square_to_triangle};
use crate::math::{Frame, Rgb};
use crate::sampling::{Sample, Sequence};
use crate::scene::Light;
use glam::Vec2;
use std::f32::consts::FRAC_1_PI;

/// Streams that an element owns.
pub const STREAMS: u64 = 3;
/// Fewest points for a light without extent, however many there are.
const FEWEST_POINTS: u32 = 4;

/// How many rays of each kind an element sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Rays {
    /// Towards emitters.
    pub light: u32,
    /// In cosine-distributed directions.
    pub cosine: u32,
}

/// An emitter that a ray has seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// From where on the element.
    pub spot: Spot,
    /// Exitance [lm/m²] of the emitter.
    pub emission: Rgb,
    /// Density [1/sr] of its direction among light rays, and among cosine rays.
    pub light: f32,
    pub cosine: f32,
    /// Whether it was a light ray that has seen it.
    pub aimed: bool,
}

/// The direct light of a problem, element by element; holds working memory.
pub struct DirectEstimator<'a> {
    problem: &'a Problem,
    sampler: &'a LightSampler,
    sequence: &'a dyn Sequence,
    cut: Cut,
    samples: Vec<Sample>,
    rays: Vec<Ray>,
    sent: Vec<Sent>,
    hits: Vec<Hit>,
}

/// What must be known of a ray when it arrives.
#[derive(Clone, Copy)]
struct Sent {
    spot: Spot,
    /// Density [1/sr] of its direction among cosine rays.
    cosine: f32,
    /// Of a light ray: its emitter, and the density [1/sr] among light rays.
    aim: Option<(u32, f32)>,
}

impl<'a> DirectEstimator<'a> {
    /// Element e draws its numbers from streams 3e to 3e + 2 of `sequence`.
    pub fn new(problem: &'a Problem, sampler: &'a LightSampler, sequence: &'a dyn Sequence) -> DirectEstimator<'a> {
        let (samples, rays, sent, hits) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        DirectEstimator { problem, sampler, sequence, cut: Cut::default(), samples, rays, sent, hits }
    }

    /// Irradiance [lux] of `element` from all emitters and lights, and the number of rays it took.
    pub fn irradiance(&mut self, element: u32, rays: Rays) -> (Rgb, u64) {
        let mut sum = Rgb::BLACK;
        let traced = self.look(element, rays, |sight| sum += sight.irradiance(rays));
        let shadow = self.lamps(element, rays.light + rays.cosine, |_, irradiance| sum += irradiance);
        (sum, traced + shadow)
    }

    /// Sends `rays` from `element` and hands each emitter that is seen to `each`; returns the number of rays traced.
    pub fn look(&mut self, element: u32, rays: Rays, mut each: impl FnMut(Sight)) -> u64 {
        self.sampler.cut(&Receiver::new(self.problem, element), &mut self.cut);
        if self.cut.is_empty() {
            return 0;
        }
        self.send(element, rays);
        self.hits.clear();
        self.hits.resize(self.rays.len(), Hit::MISS);
        self.problem.geometry.closest(&self.rays, &mut self.hits);
        for ((ray, sent), hit) in self.rays.iter().zip(&self.sent).zip(&self.hits) {
            let seen = match sent.aim {
                Some((emitter, density)) => {
                    let Emitter { triangle, back, .. } = self.sampler.emitters()[emitter as usize];
                    ((hit.triangle, hit.back) == (triangle, back)).then_some((emitter, density))
                }
                None => self
                    .sampler
                    .emitter_at(self.problem, hit)
                    .map(|emitter| (emitter, self.sampler.density(self.problem, &self.cut, ray, hit, emitter))),
            };
            if let Some((emitter, light)) = seen {
                let emission = self.sampler.emitters()[emitter as usize].emission;
                each(Sight { spot: sent.spot, emission, light, cosine: sent.cosine, aimed: sent.aim.is_some() });
            }
        }
        self.rays.len() as u64
    }

    /// Makes the rays of `element`; those that would leave below its horizon see nothing and are left out.
    fn send(&mut self, element: u32, rays: Rays) {
        let departure = Departure::new(self.problem, element, Footprint::WHOLE);
        self.rays.clear();
        self.sent.clear();
        for (kind, count) in [(0, rays.light), (1, rays.cosine)] {
            self.draw(element, kind, 0, count);
            for &[x1, x2, x3, x4] in &self.samples {
                let (uv, s) = (square_to_triangle(Vec2::new(x1, x2)), Vec2::new(x3, x4));
                let start = departure.start(uv);
                let (direction, aim) = if kind == 0 {
                    match self.sampler.aim(self.problem, &self.cut, start.origin, s) {
                        Some((emitter, aim)) => (aim.direction, Some((emitter, aim.density))),
                        None => continue,
                    }
                } else {
                    (Frame::about(start.normal).to_world(square_to_cosine_hemisphere(s)), None)
                };
                let cosine = direction.dot(start.normal) * FRAC_1_PI;
                if cosine > 0.0 {
                    self.rays.push(start.ray(direction));
                    self.sent.push(Sent { spot: Spot::at(uv), cosine, aim });
                }
            }
        }
    }

    /// What lights without extent give `element` [lux], from about `points` points in all, handed to `each` with the spot; returns the
    /// number of shadow rays.
    pub fn lamps(&mut self, element: u32, points: u32, mut each: impl FnMut(Spot, Rgb)) -> u64 {
        let lights: &[Light] = &self.problem.scene.lights;
        let departure = Departure::new(self.problem, element, Footprint::WHOLE);
        let mut traced = 0;
        for (light, number) in lights.iter().zip(0..) {
            let points = (points / lights.len() as u32).max(FEWEST_POINTS);
            self.draw(element, 2, u64::from(points) * number, points);
            let (mut reach, mut given) = (Vec::new(), Vec::new());
            self.rays.clear();
            for &[x1, x2, ..] in &self.samples {
                let uv = square_to_triangle(Vec2::new(x1, x2));
                let start = departure.start(uv);
                if let Some(shine) = lamp::shine(light, start.origin, start.normal) {
                    self.rays.push(start.ray(shine.direction));
                    reach.push(shine.distance);
                    given.push((Spot::at(uv), shine.irradiance / points as f32));
                }
            }
            let mut blocked = vec![false; self.rays.len()];
            self.problem.geometry.any(&self.rays, &reach, &mut blocked);
            given
                .iter()
                .zip(&blocked)
                .filter(|(_, blocked)| !**blocked)
                .for_each(|(&(spot, light), _)| each(spot, light));
            traced += self.rays.len() as u64;
        }
        traced
    }

    /// Points `first, first + 1, ...`, `count` of them, of one of the element's streams.
    fn draw(&mut self, element: u32, stream: u64, first: u64, count: u32) {
        self.samples.clear();
        self.samples.resize(count as usize, [0.0; 4]);
        self.sequence.fill(STREAMS * u64::from(element) + stream, first, &mut self.samples);
    }
}

impl Sight {
    /// What this ray adds to the irradiance [lux] of its element, which sends so many.
    pub fn irradiance(&self, rays: Rays) -> Rgb {
        let (cosine, light) = (rays.cosine as f32 * self.cosine, rays.light as f32 * self.light);
        let own = if self.aimed { light } else { cosine };
        self.emission * (self.cosine * own / (cosine * cosine + light * light))
    }
}
