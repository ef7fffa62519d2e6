//! From scene to light: how far each of some methods comes in the same time on one thread, and how long the first of them would take
//! to the same error.
//!
//! Errors are those that the methods state themselves. Error falls with the root of time, so a method with half the error in the same
//! time is four times as fast.

use anyhow::Result;
use isolux_core::Problem;
use isolux_core::mesh::Resolution;
use isolux_core::run::run;
use isolux_core::scene::builtin::builtin;
use isolux_core::solvers::monte_carlo::{Budget, Method, MonteCarlo, Settings};
use isolux_core::transport::Leaving;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::time::Instant;

const SCENES: [&str; 2] = ["cornell-box", "office"];
const ELEMENTS: u64 = 200_000;
/// The others are compared with the first.
const METHODS: [&str; 3] = ["stochastic-jacobi", "shirley", "auto"];
const SECONDS: f64 = 10.0;

/// How far a method came.
struct Reached {
    seconds: f64,
    rays: u64,
    error: f64,
}

/// The table, as Markdown.
pub fn table() -> Result<String> {
    let mut table =
        "| scene | method | million rays/s | error over the area | times as fast |\n|---|---|---|---|---|\n".to_owned();
    let thread = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    for scene in SCENES {
        let problem = Problem::new(builtin(scene)?, Resolution::Elements(ELEMENTS))?;
        let mut first = None;
        for method in METHODS {
            let Reached { seconds, rays, error } = thread.install(|| reach(&problem, method))?;
            // Seconds to an error of 1.
            let cost = seconds * error * error;
            let faster = *first.get_or_insert(cost) / cost;
            let (rate, percent) = (rays as f64 * 1e-6 / seconds, 100.0 * error);
            writeln!(table, "| {scene} | {method} | {rate:.2} | {percent:.2} % | **{faster:.1}** |")?;
        }
    }
    Ok(table)
}

/// Solves with that method for some seconds.
fn reach(problem: &Problem, name: &str) -> Result<Reached> {
    let method = Method::named(name)?;
    let (budget, replicates, leaving) = (Budget::Endless, method.natural_replicates(), Leaving::WholeElement);
    let start = Instant::now();
    let mut solver = MonteCarlo::new(problem, Settings { method, budget, replicates, leaving, ..Settings::default() })?;
    let solution = run(&mut solver, problem, |_| match start.elapsed().as_secs_f64() < SECONDS {
        true => ControlFlow::Continue(()),
        false => ControlFlow::Break(()),
    });
    Ok(Reached { seconds: start.elapsed().as_secs_f64(), rays: solution.work.rays, error: solution.rms_error() })
}
