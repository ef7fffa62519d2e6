//! Checkpoints: the state of a solve, written again and again while it runs, so that whatever stops it costs a few seconds of work.
//!
//! Each replaces the one before in one step. One that cannot be written is told once; the solve goes on, the one before stays, and the
//! next is tried. Those that nobody asked for begin later, and are gone when all outputs are there.

use crate::failure::Failure;
use crate::output::Outputs;
use crate::resume::Place;
use isolux_core::Problem;
use isolux_core::solvers::Solver;
use isolux_io::checkpoint_file::{self, Clock};
use std::path::Path;
use std::time::{Duration, Instant};

/// Least time between two checkpoints.
const LEAST: Duration = Duration::from_secs(2);
/// A solve that takes less is solved again, if nobody asked for checkpoints.
const WORTH_KEEPING: Duration = Duration::from_secs(5);
/// The share of the time that they may take is one over this.
const RARITY: u32 = 50;

/// Writes checkpoints when it is time to.
pub struct Checkpoints<'a> {
    outputs: &'a Outputs,
    place: Place,
    /// So much time between two, whatever they take.
    every: Option<Duration>,
    start: Instant,
    /// At the start.
    clock: Clock,
    next: Duration,
    has_failed: bool,
    is_written: bool,
}

impl Checkpoints<'_> {
    /// Checkpoints at `place`, which is open among the `outputs`, of a solve that goes on at `start`, when its clock showed `clock`.
    pub fn new(
        outputs: &Outputs,
        place: Place,
        every: Option<Duration>,
        start: Instant,
        clock: Clock,
    ) -> Checkpoints<'_> {
        let first = if matches!(place, Place::Asked(_)) { LEAST } else { WORTH_KEEPING };
        let next = every.unwrap_or(first);
        Checkpoints { outputs, place, every, start, clock, next, has_failed: false, is_written: false }
    }

    /// Writes the state of `solver`, if it is time to.
    ///
    /// # Errors
    /// A failure, the first time that it cannot be written.
    pub fn write_in_time(&mut self, solver: &dyn Solver, problem: &Problem) -> Result<(), Failure> {
        if self.start.elapsed() < self.next { Ok(()) } else { self.write(solver, problem) }
    }

    /// Writes the state of `solver`.
    ///
    /// # Errors
    /// As [`Checkpoints::write_in_time`].
    pub fn write(&mut self, solver: &dyn Solver, problem: &Problem) -> Result<(), Failure> {
        let begin = self.start.elapsed();
        let clock = Clock { solved: self.clock.solved + begin, ..self.clock };
        let bytes = checkpoint_file::write(problem, solver, clock).map_err(Failure::from);
        let written = bytes.and_then(|bytes| self.outputs.write_checkpoint(&bytes));
        let end = self.start.elapsed();
        self.next = end + self.every.unwrap_or(LEAST.max(RARITY * (end - begin)));
        self.is_written |= written.is_ok();
        let is_news = written.is_err() && !std::mem::replace(&mut self.has_failed, written.is_err());
        if is_news { written } else { Ok(()) }
    }

    /// Writes the last one, if somebody may go on with it: where it was asked for, and where the solve `is_interrupted` after it has
    /// taken a while.
    ///
    /// # Errors
    /// As [`Checkpoints::write_in_time`].
    pub fn write_last(&mut self, solver: &dyn Solver, problem: &Problem, is_interrupted: bool) -> Result<(), Failure> {
        let is_wanted = matches!(self.place, Place::Asked(_)) || is_interrupted && self.is_written;
        if is_wanted { self.write(solver, problem) } else { Ok(()) }
    }

    /// The checkpoint that is there and that nobody asked for.
    pub fn beside(&self) -> Option<&Path> {
        match &self.place {
            Place::Beside(path) if self.is_written => Some(path),
            _ => None,
        }
    }
}
