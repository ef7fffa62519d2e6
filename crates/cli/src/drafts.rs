//! Drafts: the files of a solve, written again and again while it runs, so that somebody can watch the light come.
//!
//! A draft is the best solution so far. Its pictures have one ray a pixel, and the values at the vertices are plain means: no noise
//! is taken out, and what is covered is not looked for. Each file is replaced in one step.

use crate::failure::Failure;
use crate::output::Outputs;
use isolux_core::Problem;
use isolux_core::solvers::Solver;
use isolux_core::view::VertexField;
use isolux_io::export::{ExportOptions, Smoothing};
use std::time::{Duration, Instant};

/// The first draft comes after this time, however rare they are: somebody is waiting for it.
const FIRST: Duration = Duration::from_millis(500);

/// Writes drafts when it is time to.
pub struct Drafts<'a> {
    outputs: &'a Outputs,
    options: ExportOptions,
    every: Duration,
    start: Instant,
    next: Duration,
    /// The field of the last draft, whose vertices serve the next one.
    field: Option<VertexField>,
    /// Why there are no more of them.
    pub failure: Option<Failure>,
}

impl Drafts<'_> {
    /// Drafts of `outputs` with at least `every` of solving between two of them.
    pub fn new(outputs: &Outputs, options: ExportOptions, every: Duration, start: Instant) -> Drafts<'_> {
        let options = ExportOptions { samples: 1, smoothing: Smoothing::None, ..options };
        Drafts { outputs, options, every, start, next: every.min(FIRST), field: None, failure: None }
    }

    /// Writes what `solver` has so far, if it is time to. If that fails there are no more drafts: the work goes on.
    pub fn write(&mut self, solver: &dyn Solver, problem: &Problem) {
        if self.start.elapsed() < self.next || self.failure.is_some() {
            return;
        }
        let mut solution = solver.solution(problem);
        solution.provenance.parameters.push(("stopped".to_owned(), "not yet".to_owned()));
        match self.outputs.write_draft(problem, &solution, &self.options, self.field.take()) {
            Ok(field) => self.field = field,
            Err(failure) => self.failure = Some(failure),
        }
        self.next = self.start.elapsed() + self.every;
    }
}
