//! The algorithms, one a file, behind one trait that knows nothing of threads, clocks or files.

mod allocation;
pub mod budget;
mod chosen;
pub mod deterministic;
pub mod direct_light;
mod gathering;
mod independent;
mod light_groups;
pub mod monte_carlo;
mod replicates;
mod shooting;
mod totals;

pub use chosen::{Asked, Chosen, DETERMINISTIC_ELEMENTS};
pub use direct_light::DirectLight;
pub use independent::mean_of_independent;
pub use light_groups::LightGroups;
pub use monte_carlo::MonteCarlo;

use crate::form_factors::Row;
use crate::solvers::direct_light::Received;
use crate::solvers::monte_carlo::Budget;
use crate::transport::bundle_gather::Sums;
use crate::transport::{Span, Spot};
use crate::{Accuracy, Error, Problem, Solution};
use std::ops::Range;

/// A radiosity algorithm as a sequence of steps, each made of independent pieces.
///
/// A driver (see [`crate::run`]) calls [`step`](Solver::step), computes the [`part`](Solver::part)s of all pieces in any
/// order, on any threads or machines, and [`absorb`](Solver::absorb)s them **in the order of their pieces**. So the
/// result has the same bits for any number of workers. The state is plain data (serde), saved with the name of its type: a
/// checkpoint, whenever no piece is being absorbed.
#[typetag::serde]
pub trait Solver: Send + Sync {
    /// The pieces of the running step that have not been absorbed yet, or `None` when the work is done. After the last piece of
    /// a step has been absorbed these are the pieces of the next step.
    fn step(&self) -> Option<Range<u64>>;

    /// Computes one piece. Pure: the same state and piece give the same bits.
    fn part(&self, problem: &Problem, piece: u64) -> Part;

    /// Takes in the part of the next piece in order.
    fn absorb(&mut self, problem: &Problem, part: Part);

    /// The best solution so far; may be called whenever no piece is being absorbed.
    fn solution(&self, problem: &Problem) -> Solution;

    /// Extends the work, running or finished, to a larger `budget`. Work that has an end of its own is only as long as it is.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a budget that does not extend the work, or means nothing to the method.
    fn go_on(&mut self, _: &Problem, budget: Budget) -> Result<(), Error> {
        let allowed = "a deterministic method draws no random numbers, and has an end of its own";
        let refused = |name, value: String| Err(Error::Parameter { name, value, allowed });
        match budget {
            Budget::Rays(rays) => refused("rays", rays.to_string()),
            Budget::Accuracy { accuracy, .. } => refused("error", accuracy.error.to_string()),
            Budget::Heuristic | Budget::Endless => Ok(()),
        }
    }

    /// Whether a loaded state has a value for each element of `problem` wherever it needs one.
    fn fits(&self, problem: &Problem) -> bool;

    /// How far the work is, for people.
    fn progress(&self) -> Progress;
}

/// What tracing one piece gave: light that landed, and light that was lost.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Part {
    pub landings: Vec<Landing>,
    /// Particles that go on from an element in the next step.
    pub survivors: Vec<Particle>,
    /// Where global lines join surfaces, for solvers that send light along them one after the other.
    pub spans: Vec<Span>,
    /// Flux [lm, luminance] that surfaces absorbed, of particles.
    pub absorbed: f64,
    /// Flux [lm, luminance] that hit nothing.
    pub escaped: f64,
    /// Flux [lm, luminance] that hit the back of a one-sided surface.
    pub back_face: f64,
    pub rays: u64,
    /// Rows of a matrix, for solvers that need one: form factors, or links of a hierarchy.
    pub rows: Vec<Row>,
    /// What neighbouring elements received straight from the lights, for solvers whose elements look for these.
    pub received: Vec<Received>,
    /// What the crossings of bundles have seen.
    pub sums: Option<Sums>,
}

/// Light that arrived on an element.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Landing {
    pub element: u32,
    /// Where on the element a line ended; of no meaning when gathering.
    pub spot: Spot,
    /// Its meaning is the solver's: a flux [lm] when shooting, a sum of radiosities [lm/m²] when gathering.
    pub light: [f32; 3],
}

/// A particle that leaves an element.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Particle {
    /// The source it leaves: an element, or after these a light without extent.
    pub source: u32,
    /// The element for which it gathers; of no meaning when shooting.
    pub home: u32,
    /// Number of the point of the source's stream that its line takes.
    pub index: u32,
    /// Reflections behind it.
    pub depth: u32,
    /// Flux [lm] that it carries, or its weight when gathering.
    pub light: [f32; 3],
}

/// A snapshot of a running solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What the solver is doing, in a few words.
    pub stage: &'static str,
    pub rays: u64,
    /// Rays the whole run will take, if known.
    pub rays_in_all: Option<u64>,
    /// Power not yet shot in the current complete solution, relative to the emitted power.
    pub unshot: f64,
    /// [`Solution::rms_error`] so far, if known.
    pub rms_error: Option<f64>,
    /// The accuracy that is asked for, if one is.
    pub asked: Option<Accuracy>,
    /// Why the method is biased, if it is.
    pub bias: Option<&'static str>,
    /// How many times as large the error is as the one that is asked for, if one is, and it is known.
    pub excess: Option<f64>,
}
