//! Random walks: particles follow the light from the lights, or back from the elements to be measured.
//!
//! *Shooting.* N particles are born with flux `Pe_T / N` in the colour of their source. A particle of flux `w` that visits element k
//! scores on its irradiance, times `1 / A_k`, by the estimator: *collision* `w` at every visit, *survival* `w / sigma_k` if it
//! survives, *absorption* `w / (1 - sigma_k)` if it ends there. *Gathering.* `n_i` particles of weight 1 start on every element i; a
//! visit of k scores `Be_k / n_i` times the weight on the irradiance of i, by the same estimators. Either goes on with weight
//! `rho_k / sigma_k`; `sigma_k` is the luminance of the reflectivity, kept off 0 and 1 where only some visits score, so
//! that every element can be measured. All are unbiased with independent numbers; where the counters of elements run on, the points
//! of a low-discrepancy sequence avoid each other, and the bias falls with the number of particles.
//!
//! A *discrete* walk goes on from a new point of the element, a *continuous* one (Pattanaik & Mudur 1992) from the point hit. With
//! the address `per-particle` line k takes the numbers `5k` to `5k + 4` of the particle's point; with `per-element` every element owns a stream
//! and a counter (Bekaert, Cools & Willems 1999), so particles are traced one reflection a step. The survival is decided by the
//! fifth number of the point that the line took.
//!
//! Keller's walks (1996) take the whole path from one point, numbers `5 + 2k` and `6 + 2k` for reflection k, and of N particles the
//! first `N rho^k` are reflected k times, with weight `rho_k / rho`; number 4 chooses the source. Biased by the walks' end: less
//! than one particle's share of the power. Cost: one ray a visit.

mod flight;

use self::flight::Flight;
use super::axes::Direction;
use super::complete::CompleteSolution;
use super::{Experience, Method, sources, to_rgb};
use crate::Problem;
use crate::math::Rgb;
use crate::math::hash::{derive, unit_f64};
use crate::sampling::address::{Address, Counters};
use crate::solution::Balance;
use crate::solvers::allocation::Allocation;
use crate::solvers::{Part, Particle, shooting};
use std::ops::Range;

/// Particles that are in memory together, with the address `per-element`.
const WAVE: u64 = 1 << 20;

/// The state of one complete solution.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
pub struct Walks {
    method: Method,
    seed: u64,
    rays_done: u64,
    /// Where the particles are born.
    births: Allocation,
    /// Luminous flux of all sources [lm].
    emitted: f64,
    counters: Counters,
    /// Particles that were born, and with the address `per-element` those in flight and those of the next step.
    born: u64,
    in_flight: Vec<Particle>,
    survivors: Vec<Particle>,
    pieces_absorbed: u64,
    /// Scores: flux on every element [lm], or irradiance [lux] when gathering.
    scores: Vec<[f64; 3]>,
    /// Mean reflectivity that the light meets.
    mean_reflectivity: f64,
    balance: Balance,
    reflected: f64,
}

impl Walks {
    pub fn new(problem: &Problem, method: Method) -> Walks {
        Walks {
            method,
            seed: 0,
            rays_done: 0,
            births: Allocation::default(),
            emitted: 0.0,
            counters: method.address.counters(sources::count(problem)),
            born: 0,
            in_flight: Vec::new(),
            survivors: Vec::new(),
            pieces_absorbed: 0,
            scores: vec![[0.0; 3]; problem.mesh.len()],
            mean_reflectivity: 0.0,
            balance: Balance::default(),
            reflected: 0.0,
        }
    }

    fn gathers(&self) -> bool {
        self.method.direction == Direction::Gathering
    }

    fn steps_together(&self) -> bool {
        self.method.address == Address::PerElement
    }

    /// Particles of the running step.
    fn particles(&self) -> u64 {
        if self.steps_together() { self.in_flight.len() as u64 } else { self.births.rays() }
    }

    fn flight<'a>(&'a self, problem: &'a Problem) -> Flight<'a> {
        Flight {
            problem,
            method: self.method,
            sequence: self.method.sequence.make(self.seed),
            births: &self.births,
            birth_flux: self.emitted / self.births.rays().max(1) as f64,
            mean_reflectivity: self.mean_reflectivity,
        }
    }

    /// With the address `per-element`: gives the survivors the next points of their elements, or lets a wave be born.
    fn next_flight(&mut self, problem: &Problem) {
        self.pieces_absorbed = 0;
        self.in_flight = std::mem::take(&mut self.survivors);
        if self.in_flight.is_empty() {
            let wave = self.born..(self.born + WAVE).min(self.births.rays());
            self.in_flight = self.flight(problem).newborn(wave.clone());
            self.born = wave.end;
        }
        // Neighbours in memory are neighbours in space.
        self.in_flight.sort_by_key(|particle| particle.source);
        for particle in &mut self.in_flight {
            particle.index = self.counters.next(particle.source) as u32;
            self.counters.advance(particle.source, 1);
        }
    }

    /// Closes the books of a complete solution.
    fn finish(&mut self, problem: &Problem) {
        let mesh = &problem.mesh;
        let flux = |e: u32| self.irradiance(problem, e) * mesh.area(e);
        let reflected = mesh.elements().map(|e| (mesh.reflectivity(e) * flux(e)).luminance_f64()).sum();
        let landed: f64 = mesh.elements().map(|e| flux(e).luminance_f64()).sum();
        self.reflected = reflected;
        if self.gathers() {
            self.balance.absorbed = landed - self.reflected;
            self.balance.unshot = self.emitted - self.balance.absorbed;
        }
    }
}

#[typetag::serde]
impl CompleteSolution for Walks {
    fn restart(&mut self, problem: &Problem, seed: u64, rays: u64, experience: &Experience) {
        (self.seed, self.rays_done, self.born) = (seed, 0, 0);
        self.counters.reset();
        self.scores.fill([0.0; 3]);
        self.emitted = sources::total(problem);
        self.balance = Balance { emitted: self.emitted, unshot: self.emitted, ..Balance::default() };
        self.mean_reflectivity = experience.mean_reflectivity();
        // A walk has 1 / (1 - rho) visits on average.
        let particles = (rays as f64 * (1.0 - self.mean_reflectivity)).ceil() as u64;
        let u = unit_f64(derive(seed, u64::MAX));
        let elements = problem.mesh.len();
        self.births = if self.gathers() {
            let equal = problem.mesh.elements().map(|e| (e, 1.0));
            Allocation::systematic(equal, elements as f64, particles.max(elements as u64), u)
        } else {
            Allocation::systematic(sources::luminous(problem), self.emitted, particles.max(1), u)
        };
        self.pieces_absorbed = 0;
        self.in_flight.clear();
        self.survivors.clear();
        if self.steps_together() {
            self.next_flight(problem);
        }
    }

    fn pieces(&self) -> Option<Range<u64>> {
        let pieces = shooting::pieces(self.particles());
        (self.pieces_absorbed < pieces).then_some(self.pieces_absorbed..pieces)
    }

    fn part(&self, problem: &Problem, piece: u64) -> Part {
        let range = shooting::ray_range(piece, self.particles());
        let flight = self.flight(problem);
        if self.steps_together() {
            flight.one_reflection(&self.in_flight[range.start as usize..range.end as usize])
        } else {
            flight.whole_walks(range)
        }
    }

    fn absorb(&mut self, problem: &Problem, part: Part, _: &Experience) {
        self.pieces_absorbed += 1;
        self.rays_done += part.rays;
        for landing in &part.landings {
            let score = &mut self.scores[landing.element as usize];
            score.iter_mut().zip(landing.light).for_each(|(sum, light)| *sum += f64::from(light));
        }
        if !self.gathers() {
            self.balance.absorbed += part.absorbed;
            self.balance.escaped += part.escaped;
            self.balance.back_face += part.back_face;
            self.balance.unshot -= part.absorbed + part.escaped + part.back_face;
        }
        self.survivors.extend(part.survivors);
        if self.steps_together() && self.pieces().is_none() {
            self.next_flight(problem);
        }
        if self.pieces().is_none() {
            self.finish(problem);
        }
    }

    fn irradiance(&self, problem: &Problem, e: u32) -> Rgb {
        let score = to_rgb(&self.scores[e as usize]);
        if self.gathers() { score } else { score / problem.mesh.area(e) }
    }

    fn fits(&self, problem: &Problem) -> bool {
        self.scores.len() == problem.mesh.len()
    }

    fn rays(&self) -> u64 {
        self.rays_done
    }

    fn balance(&self) -> Balance {
        self.balance
    }

    fn experience(&self) -> Experience {
        Experience { reflected_share: self.reflected / self.emitted.max(f64::MIN_POSITIVE) }
    }

    fn stage(&self) -> &'static str {
        if self.gathers() { "walking back to the lights" } else { "following particles" }
    }
}
