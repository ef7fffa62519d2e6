//! The study `studies/methods`: all methods on `cubes` with as many rays, against references with a hundred times as many.
//!
//! `methods [OUT]` writes `result.csv` into the folder OUT (`studies/methods`).

#![allow(clippy::print_stdout)]

use anyhow::Result;
use isolux_core::mesh::Resolution;
use isolux_core::run::run;
use isolux_core::sampling::SequenceName;
use isolux_core::scene::builtin::builtin;
use isolux_core::solvers::Solver;
use isolux_core::solvers::deterministic::{self, DETERMINISTIC};
use isolux_core::solvers::monte_carlo::axes::Walk;
use isolux_core::solvers::monte_carlo::{Budget, Method, MonteCarlo, Settings};
use isolux_core::{Problem, Solution};
use isolux_io::files::OutputFile;
use isolux_testing::battery::{methods, with_method};
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

const SCENE: &str = "cubes";
const ELEMENTS: u64 = 2000;
const RAYS: u64 = 4_000_000;
/// Times as many rays for the references.
const REFERENCE: u64 = 100;
/// Runs whose squared errors are averaged.
const SEEDS: std::ops::RangeInclusive<u64> = 1..=5;

fn main() -> Result<()> {
    let out = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("studies/methods"), PathBuf::from);
    let file = OutputFile::create(&out.join("result.csv"))?;
    let problem = Problem::new(builtin(SCENE)?, Resolution::Elements(ELEMENTS))?;
    println!("references: {} times {RAYS} rays, discrete and continuous", REFERENCE);
    let reference = |name: &str| -> Result<Solution> {
        let settings = with_method(Method::named(name)?, with_rays(RAYS * REFERENCE, 1000));
        Ok(solve(&mut MonteCarlo::new(&problem, settings)?, &problem))
    };
    let (discrete, continuous) = (reference("stochastic-jacobi")?, reference("particle-tracing")?);
    let mut table = "method,sequence,rays,seconds,rms_error,stated_error,reference_error\n".to_owned();
    for trial in methods() {
        for sequence in ["random", "owen-sobol"] {
            let sequence: SequenceName = sequence.parse()?;
            let method = Method { sequence, ..trial.method };
            let reference = if method.walk == Walk::Discrete { &discrete } else { &continuous };
            let make = |seed| -> Result<Box<dyn Solver>> {
                Ok(Box::new(MonteCarlo::new(&problem, with_method(method, with_rays(RAYS, seed)))?))
            };
            let line = measure(&problem, reference, make)?;
            let _ = writeln!(table, "\"{}\",{sequence},{line}", trial.name);
            println!("{:50} {:11} {line}", trial.name, sequence.entry().name);
        }
    }
    for entry in DETERMINISTIC {
        let make = |_| Ok((entry.make)(&problem, &deterministic::Settings::default())?);
        let line = measure(&problem, &discrete, make)?;
        let _ = writeln!(table, "{},none,{line}", entry.name);
        println!("{:50} {:11} {line}", entry.name, "");
    }
    file.finish(table.as_bytes())?;
    Ok(())
}

fn with_rays(rays: u64, seed: u64) -> Settings {
    Settings { budget: Budget::Rays(rays), seed, ..Settings::default() }
}

fn solve(solver: &mut dyn Solver, problem: &Problem) -> Solution {
    run(solver, problem, |_| ControlFlow::Continue(()))
}

/// Rays and seconds of a run, its RMS error, the one it states itself, and that of the reference.
fn measure(problem: &Problem, reference: &Solution, make: impl Fn(u64) -> Result<Box<dyn Solver>>) -> Result<String> {
    let own = reference.rms_error();
    let (mut rays, mut seconds, mut square, mut stated, mut runs) = (0, 0.0, 0.0, 0.0, 0.0);
    for seed in SEEDS {
        let start = Instant::now();
        let solution = solve(make(seed)?.as_mut(), problem);
        seconds += start.elapsed().as_secs_f64();
        rays += solution.work.rays;
        square += difference(problem, &solution, reference).powi(2) - own.powi(2);
        stated += solution.rms_error().powi(2);
        runs += 1.0;
        if solution.work.replicates == 0 {
            break;
        }
    }
    let [error, stated] = [square, stated].map(|sum: f64| (sum / runs).max(0.0).sqrt());
    Ok(format!("{:.0},{:.2},{error:.5},{stated:.5},{own:.5}", rays as f64 / runs, seconds / runs))
}

/// Area-weighted RMS difference of luminance irradiance, relative to the reference's mean.
fn difference(problem: &Problem, a: &Solution, b: &Solution) -> f64 {
    let (mut area, mut sum, mut sum_sq) = (0.0, 0.0, 0.0);
    for e in problem.mesh.elements() {
        let weight = f64::from(problem.mesh.area(e));
        let [a, b] = [a, b].map(|solution| solution.irradiance[e as usize].luminance_f64());
        area += weight;
        sum += weight * b;
        sum_sq += weight * (a - b).powi(2);
    }
    (sum_sq / area).sqrt() / (sum / area)
}
