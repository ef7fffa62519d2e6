//! Independent runs of the solver on one problem, judged together against an exact answer.

use crate::budget;
use crate::projections::{Deviation, projections};
use crate::statistics::p_of_t;
use isolux_core::math::Rgb;
use isolux_core::run::run;
use isolux_core::solvers::MonteCarlo;
use isolux_core::solvers::monte_carlo::{Budget, Settings};
use isolux_core::transport::Leaving;
use isolux_core::{Problem, Solution};
use rayon::prelude::*;
use std::ops::ControlFlow;

/// One colour per element, in double precision for exact answers.
pub type Exact = Vec<[f64; 3]>;

/// Projections with random signs in every comparison.
const RANDOM: usize = 4;

/// The solution after a whole run.
pub fn solve(problem: &Problem, settings: Settings) -> Solution {
    solve_until(problem, settings, u64::MAX)
}

/// The solution after a run, or as soon as it has taken `rays` rays.
///
/// # Panics
/// If the settings are refused.
pub fn solve_until(problem: &Problem, settings: Settings, rays: u64) -> Solution {
    let mut solver = MonteCarlo::new(problem, settings).expect("the settings of a test are allowed");
    let enough = |done| if done >= rays { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    run(&mut solver, problem, |progress| enough(progress.rays))
}

/// Default settings but for the number of rays.
pub fn with_rays(rays: u64) -> Settings {
    Settings { budget: Budget::Rays(rays), ..Settings::default() }
}

/// The same with elements of constant radiosity to the letter: what the dense systems solve.
pub fn constant_elements(rays: u64) -> Settings {
    Settings { leaving: Leaving::WholeElement, ..with_rays(rays) }
}

/// Runs that differ in nothing but their seeds, `0..runs`.
pub fn ensemble(problem: &Problem, settings: Settings, runs: u64) -> Vec<Solution> {
    (0..runs).into_par_iter().map(|seed| solve(problem, Settings { seed, ..settings })).collect()
}

/// The irradiances [lux] of all runs.
pub fn irradiances(runs: &[Solution]) -> Vec<Vec<Rgb>> {
    runs.iter().map(|solution| solution.irradiance.clone()).collect()
}

/// The radiosities [lm/m²] of all runs.
pub fn radiosities(problem: &Problem, runs: &[Solution]) -> Vec<Vec<Rgb>> {
    let of = |solution: &Solution| problem.mesh.elements().map(|e| solution.radiosity(problem, e)).collect();
    runs.iter().map(of).collect()
}

/// How far the mean of independent `runs` is from `exact`: all projections in all channels.
pub fn deviations(problem: &Problem, runs: &[Vec<Rgb>], exact: &[[f64; 3]]) -> Vec<Deviation> {
    let all = projections(problem, RANDOM, 1);
    let of_channel = |c: usize| {
        let channel = |run: &Vec<Rgb>| run.iter().map(|value| f64::from(value.to_array()[c])).collect();
        let runs: Vec<Vec<f64>> = runs.iter().map(channel).collect();
        let exact: Vec<f64> = exact.iter().map(|value| value[c]).collect();
        let named = |d: Deviation| Deviation { name: format!("{} of channel {c}", d.name), ..d };
        all.iter().map(|projection| named(projection.deviation(&runs, &exact))).collect::<Vec<_>>()
    };
    (0..3).flat_map(of_channel).collect()
}

/// How many comparisons [`assert_exact`] makes on a scene of `objects` objects.
pub const fn comparisons(objects: u32) -> u32 {
    3 * (1 + objects + RANDOM as u32)
}

/// Holds the mean of independent `runs` against `exact`.
///
/// # Panics
/// If chance does not explain the deviation of a projection, or if `test` is not in the budget's register.
pub fn assert_exact(test: &str, problem: &Problem, runs: &[Vec<Rgb>], exact: &[[f64; 3]]) {
    for Deviation { name, t, dof } in deviations(problem, runs, exact) {
        budget::assert_t_of(test, &name, t, dof);
    }
}

/// Whether [`assert_exact`] would fail: how a test proves that it sees a planted fault.
pub fn refutes_exact(problem: &Problem, runs: &[Vec<Rgb>], exact: &[[f64; 3]]) -> bool {
    deviations(problem, runs, exact).iter().any(|d| budget::refutes(p_of_t(d.t, d.dof)))
}
