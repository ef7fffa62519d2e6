//! Particles on their way: lines, scores, survival.

use crate::Problem;
use crate::geometry::{Hit, Ray};
use crate::math::warp::square_to_cosine_hemisphere;
use crate::math::{Frame, Rgb};
use crate::sampling::{Sample, Sequence};
use crate::solvers::allocation::Allocation;
use crate::solvers::monte_carlo::axes::{Direction, Estimator, Survival, Walk};
use crate::solvers::monte_carlo::{Method, sources};
use crate::solvers::shooting::BATCH;
use crate::solvers::{Landing, Part, Particle};
use crate::transport::{Departure, Footprint, Spot, lamp};
use glam::Vec2;
use std::ops::Range;

/// Where only some visits score, particles survive with a probability between this and one less this.
const LEAST_PROBABILITY: f32 = 0.1;
/// No particle is reflected more often; what it still carries is the balance's unshot light.
const MOST_REFLECTIONS: u32 = 20_000;

/// What particles need to know on their way.
pub struct Flight<'a> {
    pub problem: &'a Problem,
    pub method: Method,
    pub sequence: Box<dyn Sequence>,
    pub births: &'a Allocation,
    /// Luminous flux [lm] of a particle at its birth, when shooting.
    pub birth_flux: f64,
    pub mean_reflectivity: f64,
}

/// A particle and the numbers that its line takes: five of a point, from `first` on.
#[derive(Clone, Copy)]
struct Traveller {
    particle: Particle,
    stream: u64,
    index: u64,
    first: u32,
}

/// Of these five numbers, the one that decides survival.
const SURVIVAL: u32 = 4;

/// What a visit did with a particle.
struct Visit {
    /// Times the light that came: what the visit scores.
    score: f32,
    /// The light with which it goes on, if it does.
    survivor: Option<Rgb>,
}

impl Flight<'_> {
    /// The particles of `range` as they are born; the indices of their points are not set.
    pub fn newborn(&self, range: Range<u64>) -> Vec<Particle> {
        let shares = self.births.shares(range);
        let born = shares.flat_map(|share| {
            let particle = self.birth(share.source, share.rays);
            std::iter::repeat_n(particle, share.count as usize)
        });
        born.collect()
    }

    /// One of the `count` particles that are born at `source`.
    fn birth(&self, source: u32, count: u32) -> Particle {
        let light = if self.method.direction == Direction::Gathering {
            Rgb::grey(1.0 / count as f32)
        } else {
            let flux = sources::flux(self.problem, source);
            flux * (self.birth_flux / flux.luminance_f64()) as f32
        };
        Particle { source, home: source, index: 0, depth: 0, light: light.to_array() }
    }

    /// Sends each particle along one line; those that go on are survivors of the part.
    pub fn one_reflection(&self, particles: &[Particle]) -> Part {
        let mut part = Part { rays: particles.len() as u64, ..Part::default() };
        for batch in particles.chunks(BATCH) {
            let traveller = |&particle: &Particle| Traveller {
                particle,
                stream: particle.source.into(),
                index: particle.index.into(),
                first: 0,
            };
            let travellers: Vec<Traveller> = batch.iter().map(traveller).collect();
            let rays = travellers.iter().map(|t| self.departure(t)).collect::<Vec<_>>();
            self.arrive(&travellers, &rays, &mut part, |part, particle, _, _| part.survivors.push(particle));
        }
        part
    }

    /// Follows the particles with the numbers `range` to their ends.
    pub fn whole_walks(&self, range: Range<u64>) -> Part {
        let mut part = Part::default();
        let born = self.newborn(range.clone());
        for (first, batch) in range.step_by(BATCH).zip(born.chunks(BATCH)) {
            let mut travellers: Vec<Traveller> = (first..)
                .zip(batch)
                .map(|(index, &particle)| self.with_source(Traveller { particle, stream: 0, index, first: 0 }))
                .collect();
            let mut rays: Vec<Ray> = travellers.iter().map(|t| self.departure(t)).collect();
            while !travellers.is_empty() {
                part.rays += travellers.len() as u64;
                let (mut next, mut next_rays) = (Vec::new(), Vec::new());
                self.arrive(&travellers, &rays, &mut part, |_, particle, traveller, hit| {
                    let traveller = Traveller { particle, first: self.numbers_before(particle.depth), ..*traveller };
                    next_rays.push(match self.method.walk {
                        Walk::Discrete => self.departure(&traveller),
                        Walk::Continuous => self.reflection(&traveller, hit),
                    });
                    next.push(traveller);
                });
                (travellers, rays) = (next, next_rays);
            }
        }
        part
    }

    /// Keller's particles choose their source by a number of their own: the first of them are not those of the first source.
    fn with_source(&self, mut traveller: Traveller) -> Traveller {
        if self.method.survival == Survival::Fraction {
            let x = f64::from(self.number(&traveller, 4));
            let birth = ((x * self.births.rays() as f64) as u64).min(self.births.rays() - 1);
            if let Some(share) = self.births.shares(birth..birth + 1).next() {
                traveller.particle = self.birth(share.source, share.rays);
            }
        }
        traveller
    }

    /// First of the numbers that the line after reflection `depth` takes, with the address `per-particle`. Keller's lines take
    /// two, after five at birth; they are the last two of four as for the others.
    fn numbers_before(&self, depth: u32) -> u32 {
        if self.method.survival == Survival::Fraction { 1 + 2 * depth } else { 5 * depth }
    }

    fn number(&self, traveller: &Traveller, number: u32) -> f32 {
        self.sequence.number(traveller.stream, traveller.index, traveller.first.saturating_add(number))
    }

    /// The line of a particle that leaves from anywhere on its source.
    fn departure(&self, traveller: &Traveller) -> Ray {
        let sample: Sample = std::array::from_fn(|number| self.number(traveller, number as u32));
        let source = traveller.particle.source;
        match (source as usize).checked_sub(self.problem.mesh.len()) {
            None => Departure::new(self.problem, source, Footprint::WHOLE).ray(sample),
            Some(light) => {
                let sphere = self.problem.geometry.bounding_sphere();
                lamp::ray(&self.problem.scene.lights[light], sample, sphere)
            }
        }
    }

    /// The line of a particle that leaves from the point where it landed.
    fn reflection(&self, traveller: &Traveller, hit: &Hit) -> Ray {
        let geometry = &self.problem.geometry;
        let (point, front) = geometry.surface(hit.triangle, hit.uv);
        let normal = if hit.back { -front } else { front };
        let local = square_to_cosine_hemisphere(Vec2::new(self.number(traveller, 2), self.number(traveller, 3)));
        Ray {
            origin: point + normal * geometry.lift(),
            direction: Frame::about(normal).to_world(local),
            from: hit.triangle,
        }
    }

    /// Traces `rays`, scores, and hands the particles that go on to `next`, with where they landed.
    fn arrive(
        &self,
        travellers: &[Traveller],
        rays: &[Ray],
        part: &mut Part,
        mut next: impl FnMut(&mut Part, Particle, &Traveller, &Hit),
    ) {
        let mut hits = vec![Hit::MISS; rays.len()];
        self.problem.geometry.closest(rays, &mut hits);
        for (traveller, hit) in travellers.iter().zip(&hits) {
            let light = Rgb::from(traveller.particle.light);
            let luminance = light.luminance_f64();
            if hit.is_miss() {
                part.escaped += luminance;
                continue;
            }
            let Some(element) = self.problem.mesh.at(hit.triangle, hit.uv, hit.back) else {
                part.back_face += luminance;
                continue;
            };
            let (reflectivity, emission) = self.colors(element, hit);
            let visit = self.visit(traveller, light, reflectivity);
            let (scores_on, score) = match self.method.direction {
                Direction::Shooting => (element, light * visit.score),
                Direction::Gathering => (traveller.particle.home, light * emission * visit.score),
            };
            if visit.score > 0.0 {
                part.landings.push(Landing { element: scores_on, spot: Spot::default(), light: score.to_array() });
            }
            part.absorbed += luminance - visit.survivor.unwrap_or_default().luminance_f64();
            let depth = traveller.particle.depth + 1;
            if let Some(light) = visit.survivor.filter(|_| depth <= MOST_REFLECTIONS) {
                let particle = Particle { source: element, depth, light: light.to_array(), ..traveller.particle };
                next(part, particle, traveller, hit);
            }
        }
    }

    /// Reflectivity and self-emitted exitance [lm/m²]: means of the element for a discrete walk, those of the point for a
    /// continuous one.
    fn colors(&self, element: u32, hit: &Hit) -> (Rgb, Rgb) {
        match self.method.walk {
            Walk::Discrete => (self.problem.mesh.reflectivity(element), self.problem.mesh.emission(element)),
            Walk::Continuous => self.problem.scene.colors_at(hit.triangle, hit.uv),
        }
    }

    fn visit(&self, traveller: &Traveller, light: Rgb, reflectivity: Rgb) -> Visit {
        if self.method.survival == Survival::Fraction {
            let going_on = self.births.rays() as f64 * self.mean_reflectivity.powi(traveller.particle.depth as i32 + 1);
            let goes_on = (traveller.index + 1) as f64 <= going_on;
            let reflected = light * reflectivity / self.mean_reflectivity as f32;
            return Visit { score: 1.0, survivor: (goes_on && !reflected.is_black()).then_some(reflected) };
        }
        let sigma = match self.method.estimator {
            Estimator::Collision => reflectivity.luminance().min(1.0),
            _ => reflectivity.luminance().clamp(LEAST_PROBABILITY, 1.0 - LEAST_PROBABILITY),
        };
        let survives = self.number(traveller, SURVIVAL) < sigma;
        let score = match self.method.estimator {
            Estimator::Collision => 1.0,
            Estimator::Survival => f32::from(u8::from(survives)) / sigma,
            Estimator::Absorption => f32::from(u8::from(!survives)) / (1.0 - sigma),
        };
        let reflected = light * reflectivity / sigma;
        Visit { score, survivor: (survives && !reflected.is_black()).then_some(reflected) }
    }
}
