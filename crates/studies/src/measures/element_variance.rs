//! `element-variance`: variance of the irradiance of single elements against their area, beside the formulas.
//!
//! `at` is the number of rays of a complete solution; where `estimate = "gathering"`, `rays` is that of each element.
//!
//! - A *method*: variance of one complete solution, from the spread of 64; expected of shooting is `V[E_i] = E_i P_T / (A_i N)`.
//! - *Gathering*: rays from element i meet radiosities `B_j` that are known, so `E_i` is estimated by `Σ_j F_ij B_j` with form
//!   factors by local lines; expected is `(Σ_j F_ij B_j² - (Σ_j F_ij B_j)²) / n_i`.
//!
//! Each row has a place of its own: the mean area of the elements over which it is the mean. `reduced` is their variance over their
//! irradiance, `relative` the standard deviation over the irradiance, and `ratio` the measured over the expected variance.

use super::Measure;
use super::bins::{Bin, by_area};
use crate::Error;
use crate::bench::solve;
use crate::results::Row;
use crate::task::{Task, rows_by};
use isolux_core::form_factors::Settings as FactorSettings;
use isolux_core::solvers::monte_carlo::{Budget, MonteCarlo, Settings};
use isolux_core::{Problem, Solution};
use rayon::prelude::*;

/// Complete solutions, or gathered estimates, whose spread is measured.
const RUNS: u32 = 64;
/// Elements of each bin that gather.
const MOST: usize = 60;

#[derive(Default)]
pub struct ElementVariance {
    /// What gathering meets: the radiosity [lm/m²] of every element of a scene.
    radiosity: Option<(usize, Vec<f64>)>,
}

impl Measure for ElementVariance {
    fn columns(&self) -> &'static [&'static str] {
        &["area", "variance", "expected", "ratio", "reduced", "relative"]
    }

    fn has_own_places(&self) -> bool {
        true
    }

    fn measure(&mut self, task: &mut Task) -> Result<Option<Vec<Row>>, Error> {
        let problem = task.problem()?;
        if task.series().says("estimate", "gathering")? {
            let Some(radiosity) = self.radiosity(task, &problem)? else { return Ok(None) };
            return gathering(task, &problem, radiosity);
        }
        let rays = task.point.at;
        let settings = Settings { replicates: RUNS, ..task.single(rays as u64 * u64::from(RUNS))? };
        let mut solver = MonteCarlo::new(&problem, settings)?;
        let Some(solution) = task.solve(&mut solver, &problem) else { return Ok(None) };
        let flux = power(&problem, &solution) / rays;
        let variance = |e: u32| f64::from(solution.std_error[e as usize].luminance()).powi(2) * f64::from(RUNS);
        let irradiance = |e: u32| solution.irradiance[e as usize].luminance_f64();
        let bins = by_area(&problem, usize::MAX);
        let of_bin = |bin: &Bin| {
            let expected = bin.mean(|e| irradiance(e) * flux / f64::from(problem.mesh.area(e)));
            values(task, bin, bin.mean(variance), expected, bin.mean(irradiance))
        };
        Ok(Some(bins.iter().map(of_bin).collect()))
    }
}

fn values(task: &Task, bin: &Bin, variance: f64, expected: f64, irradiance: f64) -> Row {
    let (reduced, relative) = (variance / irradiance, variance.sqrt() / irradiance);
    task.row(bin.area, vec![bin.area, variance, expected, variance / expected, reduced, relative])
}

/// Luminous flux [lm] that leaves all surfaces.
fn power(problem: &Problem, solution: &Solution) -> f64 {
    let flux = |e| f64::from(problem.mesh.area(e)) * solution.radiosity(problem, e).luminance_f64();
    problem.mesh.elements().map(flux).sum()
}

impl ElementVariance {
    /// The radiosities of the task's scene, solved once; `None` if somebody has stopped it.
    fn radiosity(&mut self, task: &mut Task, problem: &Problem) -> Result<Option<&[f64]>, Error> {
        let scene = task.point.scene;
        if self.radiosity.as_ref().is_none_or(|(known, _)| *known != scene) {
            let rays = task.spec.reference_rays.unwrap_or(1e7) as u64;
            let settings = Settings { budget: Budget::Rays(rays), ..Settings::default() };
            let mut solver = MonteCarlo::new(problem, settings)?;
            let Some(solution) = solve(&mut solver, problem, "reference", task.watch) else { return Ok(None) };
            let of_element = |e| solution.radiosity(problem, e).luminance_f64();
            self.radiosity = Some((scene, problem.mesh.elements().map(of_element).collect()));
        }
        Ok(self.radiosity.as_ref().map(|(_, radiosity)| radiosity.as_slice()))
    }
}

fn gathering(task: &mut Task, problem: &Problem, radiosity: &[f64]) -> Result<Option<Vec<Row>>, Error> {
    let (rays, first) = (task.series().number("rays")?, task.point.seed * u64::from(RUNS));
    let estimate = |run| {
        let settings = FactorSettings { rays, seed: first + u64::from(run), ..FactorSettings::default() };
        rows_by("local-lines", problem, &settings)
    };
    let runs = (0..RUNS).map(estimate).collect::<Result<Vec<_>, _>>()?;
    let mut rows = Vec::new();
    for bin in by_area(problem, MOST) {
        if task.is_stopped() {
            return Ok(None);
        }
        // Mean, variance, and mean of the squared radiosities that lines meet.
        let of_element = |&e: &u32| {
            let (mut sum, mut sum_sq, mut met_sq) = (0.0, 0.0, 0.0);
            for run in &runs {
                let row = run.row(problem, e);
                let weighted = |power: i32| {
                    row.entries.iter().map(|&(j, factor)| factor * radiosity[j as usize].powi(power)).sum::<f64>()
                };
                let irradiance = weighted(1);
                (sum, sum_sq, met_sq) = (sum + irradiance, sum_sq + irradiance.powi(2), met_sq + weighted(2));
            }
            let count = runs.len() as f64;
            let (mean, met_sq) = (sum / count, met_sq / count);
            [mean, (sum_sq / count - mean.powi(2)) * count / (count - 1.0), (met_sq - mean.powi(2)) / f64::from(rays)]
        };
        let of_elements: Vec<[f64; 3]> = bin.elements.par_iter().map(of_element).collect();
        let mean = |k: usize| of_elements.iter().map(|values| values[k]).sum::<f64>() / of_elements.len() as f64;
        rows.push(values(task, &bin, mean(1), mean(2), mean(0)));
    }
    Ok(Some(rows))
}
