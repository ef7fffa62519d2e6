//! Who drives a solver: threads, and somebody who watches.

use crate::solvers::{Part, Progress, Solver};
use crate::{Problem, Solution};
use rayon::prelude::*;
use std::ops::ControlFlow;

/// Pieces in flight for each thread: enough that nobody waits for the last of them, few enough that memory stays small.
const PIECES_PER_THREAD: u64 = 16;

/// Runs `solver` on the current rayon pool until it is done, or until `observe` breaks off, and returns the best
/// solution it has. `observe` is called many times a second.
///
/// The solution has the same bits for any number of threads: parts are pure and are absorbed in the order of their pieces.
pub fn run(
    solver: &mut dyn Solver,
    problem: &Problem,
    mut observe: impl FnMut(&Progress) -> ControlFlow<()>,
) -> Solution {
    watch(solver, problem, |solver| observe(&solver.progress()))
}

/// As [`run`], with somebody who sees the solver itself, and may ask it for the best solution so far or save its state.
pub fn watch(
    solver: &mut dyn Solver,
    problem: &Problem,
    mut observe: impl FnMut(&dyn Solver) -> ControlFlow<()>,
) -> Solution {
    let window = PIECES_PER_THREAD * rayon::current_num_threads() as u64;
    while let Some(pieces) = solver.step() {
        let now = pieces.start..pieces.end.min(pieces.start + window);
        let parts: Vec<Part> = now.into_par_iter().map(|piece| solver.part(problem, piece)).collect();
        parts.into_iter().for_each(|part| solver.absorb(problem, part));
        if observe(solver).is_break() {
            break;
        }
    }
    solver.solution(problem)
}
