//! How the time to a fixed accuracy grows with the number of elements, from 10^4 to 10^6, with the default method.
//!
//! `growth [SCENE...]` (`cubes office`) solves each scene with 32 rays an element. The solution states its error e; since that
//! falls like `1 / sqrt(rays)`, an error of 5 % takes `(e / 5 %)²` times as many rays and seconds. The least of three runs counts, for
//! other programs only take time. The exponent is the slope by least squares of ln seconds over ln elements. Reading and cutting the scene
//! is not counted. The study `cost` has smaller scenes and other methods, too.

#![allow(clippy::print_stdout)]

use anyhow::Result;
use isolux_core::Problem;
use isolux_core::mesh::Resolution;
use isolux_core::run::run;
use isolux_core::scene::builtin::builtin;
use isolux_core::solvers::MonteCarlo;
use isolux_core::solvers::monte_carlo::{Budget, METHODS, Settings};
use std::ops::ControlFlow;
use std::time::Instant;

const ELEMENTS: [u64; 5] = [10_000, 31_600, 100_000, 316_000, 1_000_000];
const RAYS_PER_ELEMENT: u64 = 32;
const RUNS: u64 = 3;
const ACCURACY: f64 = 0.05;

fn main() -> Result<()> {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let scenes = if asked.is_empty() { vec!["cubes".to_owned(), "office".to_owned()] } else { asked };
    for name in scenes {
        println!("| {name}: elements | triangles | rays to 5 % | seconds to 5 % |");
        println!("|---|---|---|---|");
        let (mut rays, mut seconds) = (Vec::new(), Vec::new());
        for elements in ELEMENTS {
            let problem = Problem::new(builtin(&name)?, Resolution::Elements(elements))?;
            let n = problem.mesh.len() as f64;
            let cost = cost(&problem)?;
            println!("| {n:.0} | {} | {:.3e} | {:.2} |", problem.scene.triangles.len(), cost.rays, cost.seconds);
            rays.push((n, cost.rays));
            seconds.push((n, cost.seconds));
        }
        println!("\nrays n^{:.2}, seconds n^{:.2}\n", slope(&rays), slope(&seconds));
    }
    Ok(())
}

/// What an error of 5 % costs.
struct Cost {
    rays: f64,
    seconds: f64,
}

fn cost(problem: &Problem) -> Result<Cost> {
    let method = METHODS[0].method;
    let replicates = method.natural_replicates();
    let mut least = Cost { rays: f64::INFINITY, seconds: f64::INFINITY };
    for seed in 1..=RUNS {
        let budget = Budget::Rays(RAYS_PER_ELEMENT * problem.mesh.len() as u64);
        let mut solver =
            MonteCarlo::new(problem, Settings { method, replicates, budget, seed, ..Settings::default() })?;
        let start = Instant::now();
        let solution = run(&mut solver, problem, |_| ControlFlow::Continue(()));
        let times = (solution.rms_error() / ACCURACY).powi(2);
        least.seconds = least.seconds.min(start.elapsed().as_secs_f64() * times);
        least.rays = least.rays.min(solution.work.rays as f64 * times);
    }
    Ok(least)
}

/// Slope of ln y over ln x by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let mean = |value: fn(&(f64, f64)) -> f64| logs.iter().map(value).sum::<f64>() / logs.len() as f64;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let covariance: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    covariance / logs.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}
