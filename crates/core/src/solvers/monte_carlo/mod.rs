//! Monte Carlo radiosity, by any method of the survey (see [`method`]).
//!
//! The estimate is the mean of independently randomised *complete solutions* (see [`complete`]), and their spread gives every
//! element its standard error. Which of them are biased, and by how much, is said where they are: [`orders`], [`relaxation`],
//! [`walks`]. What is estimated is the solution with constant elements if light leaves them from
//! anywhere, a less leaky one if it leaves from where it landed, and the radiosity equation itself for continuous walks. The
//! error bars do not contain what elements of finite size cost. Cost: one ray a sample.

mod auto;
pub mod axes;
mod complete;
mod experience;
mod light;
mod meaning;
pub mod method;
pub mod orders;
mod relaxation;
mod rounds;
mod settings;
mod sources;
mod walks;

pub use method::{METHODS, Method, NamedMethod};
pub(super) use rounds::{extended_from, rays_for};
pub use settings::{Budget, LightPart, Settings};

use self::complete::CompleteSolution;
use self::experience::Experience;
use super::replicates::Replicates;
use super::totals::Totals;
use super::{Part, Progress, Solver, budget};
use crate::math::Rgb;
use crate::math::hash::derive;
use crate::solution::{Balance, Provenance, Solution, Work};
use crate::{Error, Problem};
use std::ops::Range;

/// Rays of a step are numbered in 32 bits.
const MOST_RAYS_EACH: u64 = u32::MAX as u64;
/// More rays an element than this make more complete solutions, not larger ones: in each step light leaves an element from
/// nine points at most (see [`crate::transport::footprint`]).
const RAYS_PER_ELEMENT: u64 = 1000;

/// The solver's state: a checkpoint, as it is.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
pub struct MonteCarlo {
    settings: Settings,
    /// Independent complete solutions in a round.
    replicates_in_round: u32,
    /// Rays of each replicate of the running round.
    rays_each: u64,
    /// Rays of the whole run, if it has an end.
    rays_in_all: Option<u64>,
    replicates: Replicates,
    totals: Totals,
    /// Number of the running replicate.
    replicate: u32,
    complete: Box<dyn CompleteSolution>,
    experience: Experience,
    /// Sum of the balances of the finished replicates [lm].
    balance: Balance,
    rays: u64,
    finished: bool,
    rms_error: Option<f64>,
    /// What was asked for before the budget of the settings, if that extends the run.
    extended: Vec<Budget>,
    /// Rays that one more round shall bring the run to.
    until: Option<u64>,
    /// How much larger the error is than the one that is asked for.
    excess: Option<f64>,
}

impl MonteCarlo {
    /// # Errors
    /// [`Error::Meaningless`] for a method that has no meaning, here or at all; [`Error::Parameter`] for 0 or 2 to 7 replicates, or fewer rays than replicates.
    pub fn new(problem: &Problem, settings: Settings) -> Result<MonteCarlo, Error> {
        settings.method.check()?;
        settings.method.check_light(settings.light)?;
        settings.method.check_scene(&problem.scene)?;
        let parameter = |name, value: u64, allowed| Err(Error::Parameter { name, value: value.to_string(), allowed });
        if settings.replicates != 1 && settings.replicates < 8 {
            let allowed = "at least 8 are needed for an error bar, or 1 for none";
            return parameter("replicates", settings.replicates.into(), allowed);
        }
        let rays_in_all = match settings.budget {
            Budget::Heuristic => Some(budget::rays(&problem.mesh)),
            Budget::Rays(rays) | Budget::Accuracy { most_rays: Some(rays), .. }
                if rays < u64::from(settings.replicates) =>
            {
                return parameter("rays", rays, "every replicate needs at least one ray, so ask for more");
            }
            Budget::Rays(rays) => Some(rays),
            Budget::Accuracy { .. } if settings.replicates == 1 => {
                return parameter("replicates", 1, "at least 8 are needed to know the error");
            }
            Budget::Accuracy { .. } | Budget::Endless => None,
        };
        // A first round of a few rays for each element: a first answer soon, with its error bar.
        let first = (4 * problem.mesh.len() as u64).max(1000 * u64::from(settings.replicates));
        let rays_in_round = match settings.budget {
            Budget::Accuracy { most_rays: Some(rays), .. } => first.min(rays),
            _ => rays_in_all.unwrap_or(first),
        };
        let (replicates_in_round, rays_each) = rounds::shape(problem, &settings, rays_in_round);
        let experience = Experience::expected(problem);
        let mut complete = (settings.method.order.entry().make)(problem, &settings);
        complete.restart(problem, derive(settings.seed, 0), rays_each, &experience);
        Ok(MonteCarlo {
            settings,
            replicates_in_round,
            rays_each,
            rays_in_all,
            replicates: Replicates::new(problem.mesh.len()),
            totals: Totals::default(),
            replicate: 0,
            complete,
            experience,
            balance: Balance::default(),
            rays: 0,
            finished: false,
            rms_error: None,
            extended: Vec::new(),
            until: None,
            excess: None,
        })
    }

    /// Whether there is what was asked for, or no light at all.
    fn is_finished(&self) -> bool {
        self.finished || self.is_dark()
    }

    fn round_is_complete(&self) -> bool {
        self.replicates.count_in_round() == self.replicates_in_round
    }

    fn is_dark(&self) -> bool {
        self.complete.balance().emitted <= 0.0
    }

    /// Takes a finished complete solution into the estimate and starts the next one.
    fn next_replicate(&mut self, problem: &Problem) {
        let complete = self.complete.as_ref();
        let irradiance = problem.mesh.elements().map(|e| complete.irradiance(problem, e));
        let square = self.replicates.push(complete.rays(), irradiance, |e| problem.mesh.area(e));
        self.totals.push(problem, |e| complete.irradiance(problem, e), square);
        self.experience = complete.experience();
        self.balance = self.balance + complete.balance();
        self.replicate += 1;
        if let Some(certainty) = self.totals.certainty(self.replicates.weight()) {
            self.rms_error = Some(certainty.rms());
        }
        if self.round_is_complete() {
            self.next_round(problem);
        }
        if self.is_finished() {
            return self.complete.retire();
        }
        self.start_replicate(problem);
    }

    fn start_replicate(&mut self, problem: &Problem) {
        let seed = derive(self.settings.seed, u64::from(self.replicate));
        self.complete.restart(problem, seed, self.rays_each, &self.experience);
    }

    fn provenance(&self, problem: &Problem) -> Provenance {
        let mut parameters = self.settings.budget.parameters();
        parameters.push(("replicates".to_owned(), self.settings.replicates.to_string()));
        parameters.extend(extended_from(&self.extended));
        if self.settings.method.has_leaving() {
            parameters.push(("leaving".to_owned(), self.settings.leaving.name().to_owned()));
        }
        parameters.push(("light".to_owned(), self.settings.light.name().to_owned()));
        parameters.extend(self.settings.method.parameters());
        Provenance {
            scene: problem.scene.name.clone(),
            scene_hash: problem.scene.hash(),
            method: self.settings.method.name().to_owned(),
            parameters,
            seed: self.settings.seed,
            version: crate::VERSION.to_owned(),
        }
    }
}

#[typetag::serde]
impl Solver for MonteCarlo {
    fn step(&self) -> Option<Range<u64>> {
        if self.is_finished() { None } else { self.complete.pieces() }
    }

    fn part(&self, problem: &Problem, piece: u64) -> Part {
        self.complete.part(problem, piece)
    }

    fn absorb(&mut self, problem: &Problem, part: Part) {
        self.rays += part.rays;
        self.complete.absorb(problem, part, &self.experience);
        if self.complete.pieces().is_none() {
            self.next_replicate(problem);
        }
    }

    fn solution(&self, problem: &Problem) -> Solution {
        let (unfinished, dark) = (self.replicates.count() == 0, self.is_dark());
        let mean = |e| if unfinished { self.complete.irradiance(problem, e) } else { self.replicates.estimate(e).0 };
        let std_error = |e| match unfinished {
            _ if dark => Rgb::BLACK,
            true => Rgb::grey(f32::NAN),
            false => self.replicates.estimate(e).1.map(f32::sqrt),
        };
        let balance = if unfinished { self.complete.balance() } else { self.balance / f64::from(self.replicate) };
        Solution {
            irradiance: problem.mesh.elements().map(mean).collect(),
            std_error: problem.mesh.elements().map(std_error).collect(),
            certainty: self.totals.certainty(self.replicates.weight()),
            work: Work { rays: self.rays, replicates: self.replicates.count() },
            balance,
            provenance: self.provenance(problem),
            groups: Vec::new(),
        }
    }

    fn go_on(&mut self, problem: &Problem, budget: Budget) -> Result<(), Error> {
        self.extend(problem, budget)
    }

    fn fits(&self, problem: &Problem) -> bool {
        // The memory of the last complete solution was given back.
        let is_retired = self.replicate > 0 && self.is_finished();
        self.replicates.fits(problem.mesh.len()) && (is_retired || self.complete.fits(problem))
    }

    fn progress(&self) -> Progress {
        Progress {
            stage: self.complete.stage(),
            rays: self.rays,
            rays_in_all: self.rays_in_all,
            unshot: {
                let Balance { unshot, emitted, .. } = self.complete.balance();
                unshot / emitted.max(f64::MIN_POSITIVE)
            },
            rms_error: self.rms_error,
            asked: self.settings.budget.accuracy(),
            bias: self.settings.method.bias(),
            excess: self.excess,
        }
    }
}

/// Most rays that a complete solution of `planned` rays takes before it gives up: ten times as many, and 200,000. A room of mean
/// reflectivity 0.9999 stays below; where nothing absorbs light it would go on for ever. What is left is the balance's unshot light.
fn patience(planned: u64) -> u64 {
    planned.saturating_mul(10).saturating_add(200_000)
}

/// A sum kept in double precision, as a colour.
fn to_rgb(sum: &[f64; 3]) -> Rgb {
    Rgb::new(sum[0] as f32, sum[1] as f32, sum[2] as f32)
}
