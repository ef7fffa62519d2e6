//! What taking noise out gains, and what it costs in bias: [`isolux_core::view::smooth`] against much better solutions.
//!
//! `smoothing [RAYS...]` (20, 100 and 500 rays an element) solves rooms with the default method and smooths the solutions. Errors are of
//! luminance, the RMS over the area relative to the mean, and the median of the elements' relative errors; the reference has 1000 rays an
//! element, and its own variance is taken off the RMS. The bias is what independent runs have in common: the mean product
//! of the errors of two of them, which has no noise in the mean. *Steep* elements are those across which the reference changes by more than
//! a fifth: borders of shadows, and what is near a lamp. Elements have constant radiosity, so that there is but one solution, whatever the
//! rays. Shares beyond two error bars are those of all elements that are lit.

#![allow(clippy::print_stdout)]

use anyhow::Result;
use isolux_core::mesh::Resolution;
use isolux_core::run::run;
use isolux_core::scene::Scene;
use isolux_core::scene::builtin::builtin;
use isolux_core::solvers::MonteCarlo;
use isolux_core::solvers::monte_carlo::{Budget, METHODS, Settings};
use isolux_core::transport::Leaving;
use isolux_core::view::{VertexField, smooth};
use isolux_core::{Problem, Solution};
use isolux_testing::reference::scenes_folder;
use std::ops::ControlFlow;

const RAYS: [u64; 3] = [20, 100, 500];
const RAYS_OF_REFERENCE: u64 = 1000;
const REPLICATES_OF_REFERENCE: u32 = 16;
/// Change of the reference across an element, relative to its largest value there.
const STEEP: f64 = 0.2;
/// Elements darker than this share of the mean are left out of medians and shares.
const DARK: f64 = 0.01;

fn main() -> Result<()> {
    let asked: Vec<u64> = std::env::args().skip(1).map(|text| text.parse()).collect::<Result<_, _>>()?;
    let rays = if asked.is_empty() { RAYS.to_vec() } else { asked };
    measure("cornell-box", builtin("cornell-box")?, 200_000, &rays)?;
    measure("office", builtin("office")?, 200_000, &rays)?;
    let folder = scenes_folder();
    for (name, file) in [("living room", "living-room.glb"), ("classroom", "classroom.glb")] {
        if let Some(folder) = &folder {
            let room = isolux_io::import::read_scene(&folder.join(file), &Default::default())?;
            measure(name, room, 400_000, &rays)?;
        }
    }
    Ok(())
}

fn measure(name: &str, scene: Scene, elements: u64, rays: &[u64]) -> Result<()> {
    let problem = Problem::new(scene, Resolution::Elements(elements))?;
    let reference = Reference::new(&problem, solve(&problem, RAYS_OF_REFERENCE, REPLICATES_OF_REFERENCE, 1 << 32)?);
    let area = reference.share(&reference.steep);
    println!("\n{name}: {} elements, {:.1} % of the area is steep\n", problem.mesh.len(), 100.0 * area);
    println!(
        "| rays an element | error | smoothed | gain | bias | steep: error | smoothed | bias | median | smoothed | beyond 2 error bars | smoothed |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    for &rays in rays {
        let replicates = METHODS[0].method.natural_replicates();
        let runs = [1, 2].map(|seed| solve(&problem, rays, replicates, seed));
        let [first, second] = runs;
        let raw = [first?, second?];
        let smoothed = [smooth(&problem, &raw[0]), smooth(&problem, &raw[1])];
        let all = vec![true; problem.mesh.len()];
        let percent = |x: f64| format!("{:.2} %", 100.0 * x);
        let [before, after] = [&raw, &smoothed].map(|runs| reference.rms(runs, &all));
        let [steep_before, steep_after] = [&raw, &smoothed].map(|runs| reference.rms(runs, &reference.steep));
        let bias = [&all, &reference.steep].map(|chosen| reference.bias(&smoothed, chosen));
        let [median_before, median_after] = [&raw, &smoothed].map(|runs| reference.median(&runs[0]));
        let [beyond_before, beyond_after] = [&raw, &smoothed].map(|runs| reference.beyond(&runs[0]));
        let numbers =
            [bias[0], steep_before, steep_after, bias[1], median_before, median_after, beyond_before, beyond_after];
        let numbers: Vec<String> = numbers.into_iter().map(percent).collect();
        let gain = before / after;
        println!("| {rays} | {} | {} | {gain:.2} | {} |", percent(before), percent(after), numbers.join(" | "));
    }
    Ok(())
}

fn solve(problem: &Problem, rays: u64, replicates: u32, seed: u64) -> Result<Solution> {
    let budget = Budget::Rays(rays * problem.mesh.len() as u64);
    let (method, leaving) = (METHODS[0].method, Leaving::WholeElement);
    let settings = Settings { method, replicates, budget, seed, leaving, ..Settings::default() };
    Ok(run(&mut MonteCarlo::new(problem, settings)?, problem, |_| ControlFlow::Continue(())))
}

/// A much better solution, and what is needed to hold others against it.
struct Reference<'a> {
    problem: &'a Problem,
    solution: Solution,
    /// Irradiance averaged over the area [lux].
    mean: f64,
    steep: Vec<bool>,
}

impl<'a> Reference<'a> {
    fn new(problem: &'a Problem, solution: Solution) -> Reference<'a> {
        let field = VertexField::as_computed(problem, &solution);
        let is_steep = |e: u32| {
            let [a, b, c] =
                field.vertices_at(problem, problem.mesh.place(e)).map(|v| field.irradiance(v).luminance_f64());
            let (least, most) = (a.min(b).min(c), a.max(b).max(c));
            most - least > STEEP * most
        };
        let steep = problem.mesh.elements().map(is_steep).collect();
        let flux = |e: u32| f64::from(problem.mesh.area(e)) * solution.irradiance[e as usize].luminance_f64();
        let mean = problem.mesh.elements().map(flux).sum::<f64>() / problem.mesh.total_area();
        Reference { problem, solution, mean, steep }
    }

    /// Share of the area that the chosen elements have.
    fn share(&self, chosen: &[bool]) -> f64 {
        self.area(chosen) / self.problem.mesh.total_area()
    }

    fn area(&self, chosen: &[bool]) -> f64 {
        let elements = self.problem.mesh.elements().filter(|&e| chosen[e as usize]);
        elements.map(|e| f64::from(self.problem.mesh.area(e))).sum()
    }

    /// Average over the area of the chosen elements.
    fn average(&self, chosen: &[bool], value: impl Fn(usize) -> f64) -> f64 {
        let elements = self.problem.mesh.elements().filter(|&e| chosen[e as usize]);
        elements.map(|e| f64::from(self.problem.mesh.area(e)) * value(e as usize)).sum::<f64>() / self.area(chosen)
    }

    /// Error [lux] of element `e`.
    fn error(&self, run: &Solution, e: usize) -> f64 {
        run.irradiance[e].luminance_f64() - self.solution.irradiance[e].luminance_f64()
    }

    fn variance(&self, e: usize) -> f64 {
        self.solution.std_error[e].luminance_f64().powi(2)
    }

    fn rms(&self, runs: &[Solution; 2], chosen: &[bool]) -> f64 {
        let square = |e| runs.iter().map(|run| self.error(run, e).powi(2)).sum::<f64>() / 2.0 - self.variance(e);
        self.average(chosen, square).max(0.0).sqrt() / self.mean
    }

    fn bias(&self, runs: &[Solution; 2], chosen: &[bool]) -> f64 {
        let product = |e| self.error(&runs[0], e) * self.error(&runs[1], e) - self.variance(e);
        self.average(chosen, product).max(0.0).sqrt() / self.mean
    }

    fn lit(&self) -> impl Iterator<Item = usize> {
        let least = DARK * self.mean;
        (0..self.problem.mesh.len()).filter(move |&e| self.solution.irradiance[e].luminance_f64() > least)
    }

    fn median(&self, run: &Solution) -> f64 {
        let relative = |e: usize| (self.error(run, e) / self.solution.irradiance[e].luminance_f64()).abs();
        let mut errors: Vec<f64> = self.lit().map(relative).collect();
        errors.sort_by(f64::total_cmp);
        errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// Share of the lit elements that are off by more than two standard errors, the reference's included.
    fn beyond(&self, run: &Solution) -> f64 {
        let variance = |e: usize| run.std_error[e].luminance_f64().powi(2) + self.variance(e);
        let far = self.lit().filter(|&e| self.error(run, e).powi(2) > 4.0 * variance(e)).count();
        far as f64 / self.lit().count() as f64
    }
}
