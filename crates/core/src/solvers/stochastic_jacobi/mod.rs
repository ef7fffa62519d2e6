//! Stochastic Jacobi radiosity (Neumann et al. 1995; Bekaert 1999; Dutré, Bekaert & Bala 2006, chapter 6).
//!
//! One *complete solution* (see [`relaxation`]) shoots the emitted light, relaxes the reflected light by incremental
//! shooting until nothing is left to shoot, improves it by a regular shooting iteration, and cleans small elements by
//! gathering. The estimate is the mean of independently randomised complete solutions, and their spread gives every
//! element its standard error.
//!
//! Unbiased but for the unshot power that each complete solution leaves: at most 10^-6 of the emitted, unless hardly anything
//! is absorbed (see [`plan`]); the balance reports it. What is estimated with [`Leaving::WholeElement`] is the solution with constant
//! elements, with [`Leaving::WhereLanded`] one that leaks less. The error bars do not contain what elements of finite size cost.
//! Cost: one ray a sample; time per complete solution grows like n log n with n elements.

mod light;
mod merging;
mod plan;
mod relaxation;

use self::plan::Experience;
use self::relaxation::{Relaxation, Stage};
use super::replicates::Replicates;
use super::{Part, Progress, Solver, budget};
use crate::math::Rgb;
use crate::math::hash::derive;
use crate::sampling::address::Address;
use crate::solution::{Balance, Provenance, Solution, Work, relative_error};
use crate::transport::Leaving;
use crate::{Error, Problem};
use std::ops::Range;

/// The name of the method in tables and provenance.
pub const NAME: &str = "stochastic-jacobi";

/// Rays of a step are numbered in 32 bits.
const MOST_RAYS_EACH: u64 = u32::MAX as u64;
/// More rays an element than this make more complete solutions, not larger ones: in each step light leaves an element from
/// nine points at most (see [`crate::transport::footprint`]).
const RAYS_PER_ELEMENT: u64 = 1000;

/// How much work, and which random numbers.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Settings {
    pub seed: u64,
    pub budget: Budget,
    /// Independent complete solutions in a round, from 8; there are more if there are very many rays for each element.
    pub replicates: u32,
    pub address: Address,
    pub leaving: Leaving,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Budget {
    /// The number of rays that [`budget::rays`] recommends.
    Heuristic,
    /// This many rays, give or take the rays of one iteration.
    Rays(u64),
    /// Until the driver stops: rounds of replicates, each round with twice the rays of the one before.
    Endless,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            seed: 1,
            budget: Budget::Heuristic,
            replicates: 16,
            address: Address::default(),
            leaving: Leaving::default(),
        }
    }
}

/// The solver's state: a checkpoint, as it is.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct StochasticJacobi {
    settings: Settings,
    /// Independent complete solutions in a round.
    replicates_in_round: u32,
    /// Rays of each replicate of the running round.
    rays_each: u64,
    /// Rays of the whole run, if it has an end.
    rays_in_all: Option<u64>,
    replicates: Replicates,
    /// Number of the running replicate.
    replicate: u32,
    relaxation: Relaxation,
    experience: Experience,
    /// Sum of the balances of the finished replicates [lm].
    balance: Balance,
    rays: u64,
    rms_error: Option<f64>,
}

impl StochasticJacobi {
    /// # Errors
    /// [`Error::Parameter`] for fewer than 8 replicates or fewer rays than those.
    pub fn new(problem: &Problem, settings: Settings) -> Result<StochasticJacobi, Error> {
        let parameter = |name, value: u64, allowed| Err(Error::Parameter { name, value: value.to_string(), allowed });
        if settings.replicates < 8 {
            return parameter("replicates", settings.replicates.into(), "at least 8 are needed for an error bar");
        }
        let rays_in_all = match settings.budget {
            Budget::Heuristic => Some(budget::rays(&problem.mesh)),
            Budget::Rays(rays) if rays < u64::from(settings.replicates) => {
                return parameter("rays", rays, "every replicate needs at least one ray, so ask for more");
            }
            Budget::Rays(rays) => Some(rays),
            Budget::Endless => None,
        };
        // A first round of a few rays for each element: a first answer soon, with its error bar.
        let rays_in_round =
            rays_in_all.unwrap_or((4 * problem.mesh.len() as u64).max(1000 * u64::from(settings.replicates)));
        let most_each = most_rays_each(problem, settings.leaving);
        let replicates_in_round =
            rays_in_round.div_ceil(most_each).clamp(settings.replicates.into(), u32::MAX.into()) as u32;
        let rays_each = rays_in_round.div_ceil(replicates_in_round.into());
        let experience = Experience::expected(problem);
        let relaxation = Relaxation::new(
            problem,
            (settings.address, settings.leaving),
            derive(settings.seed, 0),
            rays_each,
            &experience,
        );
        Ok(StochasticJacobi {
            settings,
            replicates_in_round,
            rays_each,
            rays_in_all,
            replicates: Replicates::new(problem.mesh.len()),
            replicate: 0,
            relaxation,
            experience,
            balance: Balance::default(),
            rays: 0,
            rms_error: None,
        })
    }

    /// Whether the round that was asked for is complete, or there is no light at all.
    fn is_finished(&self) -> bool {
        let complete = self.settings.budget != Budget::Endless && self.replicate == self.replicates_in_round;
        complete || self.is_dark()
    }

    fn is_dark(&self) -> bool {
        self.relaxation.balance().emitted <= 0.0
    }

    /// Takes a finished complete solution into the estimate and starts the next one.
    fn next_replicate(&mut self, problem: &Problem) {
        self.replicates.push(self.relaxation.rays(), self.relaxation.irradiance(problem));
        self.experience = self.relaxation.experience();
        self.balance = self.balance + self.relaxation.balance();
        self.replicate += 1;
        if self.replicates.count_in_round() >= 2 {
            self.rms_error = Some(relative_error(problem, |e| {
                let (mean, variance) = self.replicates.estimate(e);
                (mean, variance.map(f32::sqrt))
            }));
        }
        if self.is_finished() {
            return;
        }
        if self.settings.budget == Budget::Endless && self.replicates.count_in_round() == self.replicates_in_round {
            self.replicates.close_round();
            self.rays_each = (2 * self.rays_each).min(most_rays_each(problem, self.settings.leaving));
        }
        let seed = derive(self.settings.seed, u64::from(self.replicate));
        self.relaxation.restart(problem, seed, self.rays_each, &self.experience);
    }

    fn provenance(&self, problem: &Problem) -> Provenance {
        let (name, value) = match self.settings.budget {
            Budget::Heuristic => ("rays", "heuristic".to_owned()),
            Budget::Rays(rays) => ("rays", rays.to_string()),
            Budget::Endless => ("rounds", "doubling".to_owned()),
        };
        Provenance {
            scene: problem.scene.name.clone(),
            scene_hash: problem.scene.hash(),
            method: NAME.to_owned(),
            parameters: vec![
                (name.to_owned(), value),
                ("replicates".to_owned(), self.replicates_in_round.to_string()),
                ("sequence".to_owned(), "owen-sobol".to_owned()),
                ("address".to_owned(), self.settings.address.name().to_owned()),
                ("leaving".to_owned(), self.settings.leaving.name().to_owned()),
            ],
            seed: self.settings.seed,
            version: crate::VERSION.to_owned(),
        }
    }
}

impl Solver for StochasticJacobi {
    fn step(&self) -> Option<Range<u64>> {
        (!self.is_finished()).then(|| self.relaxation.pieces())
    }

    fn part(&self, problem: &Problem, piece: u64) -> Part {
        self.relaxation.part(problem, piece)
    }

    fn absorb(&mut self, problem: &Problem, part: Part) {
        self.rays += part.rays;
        self.relaxation.absorb(problem, part, &self.experience);
        if self.relaxation.stage() == Stage::Done {
            self.next_replicate(problem);
        }
    }

    fn solution(&self, problem: &Problem) -> Solution {
        let unfinished = self.replicates.count() == 0;
        let mean =
            |e| if unfinished { self.relaxation.irradiance_so_far(problem, e) } else { self.replicates.estimate(e).0 };
        let std_error = |e| match unfinished {
            _ if self.is_dark() => Rgb::BLACK,
            true => Rgb::grey(f32::NAN),
            false => self.replicates.estimate(e).1.map(f32::sqrt),
        };
        let balance = if unfinished { self.relaxation.balance() } else { self.balance / f64::from(self.replicate) };
        Solution {
            irradiance: problem.mesh.elements().map(mean).collect(),
            std_error: problem.mesh.elements().map(std_error).collect(),
            work: Work { rays: self.rays, replicates: self.replicates.count() },
            balance,
            provenance: self.provenance(problem),
        }
    }

    fn progress(&self) -> Progress {
        Progress {
            stage: self.relaxation.stage().name(),
            rays: self.rays,
            rays_in_all: self.rays_in_all,
            unshot: self.relaxation.unshot_share(),
            rms_error: self.rms_error,
        }
    }
}

/// Most rays of a complete solution.
fn most_rays_each(problem: &Problem, leaving: Leaving) -> u64 {
    match leaving {
        Leaving::WhereLanded => (RAYS_PER_ELEMENT * problem.mesh.len() as u64).clamp(1000, MOST_RAYS_EACH),
        Leaving::WholeElement => MOST_RAYS_EACH,
    }
}

/// A sum kept in double precision, as a colour.
fn to_rgb(sum: &[f64; 3]) -> Rgb {
    Rgb::new(sum[0] as f32, sum[1] as f32, sum[2] as f32)
}
