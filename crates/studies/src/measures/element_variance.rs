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

use super::bins::{Bin, by_area};
use super::{Measure, row, rows_by};
use crate::Error;
use crate::bench::{Bench, Watch, single, solve};
use crate::results::Row;
use crate::run::Point;
use crate::spec::Spec;
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

    fn measure(
        &mut self,
        bench: &mut Bench,
        spec: &Spec,
        point: &Point,
        watch: &mut Watch,
    ) -> Result<Option<Vec<Row>>, Error> {
        let (scene, series) = (&spec.scenes[point.scene], &spec.series[point.series]);
        let problem = bench.problem(scene, scene.elements)?;
        if series.axis("estimate") == Some("gathering") {
            let Some(radiosity) = self.radiosity(&problem, spec, point, watch)? else { return Ok(None) };
            let rays = series.axis("rays").and_then(|rays| rays.parse().ok()).unwrap_or(64);
            return gathering(&problem, &radiosity, rays, (spec, point), watch);
        }
        let settings = single(series.method()?, point.at as u64 * u64::from(RUNS), point.seed);
        let settings = Settings { replicates: RUNS, ..settings };
        let Some(solution) = solve(&mut MonteCarlo::new(&problem, settings)?, &problem, "", watch) else {
            return Ok(None);
        };
        let flux = power(&problem, &solution) / point.at;
        let variance = |e: u32| f64::from(solution.std_error[e as usize].luminance()).powi(2) * f64::from(RUNS);
        let irradiance = |e: u32| solution.irradiance[e as usize].luminance_f64();
        let bins = by_area(&problem, usize::MAX);
        let of_bin = |bin: &Bin| {
            let expected = bin.mean(|e| irradiance(e) * flux / f64::from(problem.mesh.area(e)));
            values(spec, point, bin, bin.mean(variance), expected, bin.mean(irradiance))
        };
        Ok(Some(bins.iter().map(of_bin).collect()))
    }
}

fn values(spec: &Spec, point: &Point, bin: &Bin, variance: f64, expected: f64, irradiance: f64) -> Row {
    let (reduced, relative) = (variance / irradiance, variance.sqrt() / irradiance);
    row(spec, point, bin.area, vec![bin.area, variance, expected, variance / expected, reduced, relative])
}

/// Luminous flux [lm] that leaves all surfaces.
fn power(problem: &Problem, solution: &Solution) -> f64 {
    let flux = |e| f64::from(problem.mesh.area(e)) * solution.radiosity(problem, e).luminance_f64();
    problem.mesh.elements().map(flux).sum()
}

impl ElementVariance {
    fn radiosity(
        &mut self,
        problem: &Problem,
        spec: &Spec,
        point: &Point,
        watch: &mut Watch,
    ) -> Result<Option<Vec<f64>>, Error> {
        if let Some((_, known)) = self.radiosity.as_ref().filter(|(scene, _)| *scene == point.scene) {
            return Ok(Some(known.clone()));
        }
        let settings =
            Settings { budget: Budget::Rays(spec.reference_rays.unwrap_or(1e7) as u64), ..Settings::default() };
        let mut solver = MonteCarlo::new(problem, settings)?;
        let Some(solution) = solve(&mut solver, problem, "reference", watch) else { return Ok(None) };
        let known: Vec<f64> = problem.mesh.elements().map(|e| solution.radiosity(problem, e).luminance_f64()).collect();
        self.radiosity = Some((point.scene, known.clone()));
        Ok(Some(known))
    }
}

fn gathering(
    problem: &Problem,
    radiosity: &[f64],
    rays: u32,
    (spec, point): (&Spec, &Point),
    watch: &mut Watch,
) -> Result<Option<Vec<Row>>, Error> {
    let estimate = |run| {
        let seed = point.seed * u64::from(RUNS) + u64::from(run);
        rows_by("local-lines", problem, &FactorSettings { rays, seed, ..FactorSettings::default() })
    };
    let runs = (0..RUNS).map(estimate).collect::<Result<Vec<_>, _>>()?;
    let mut rows = Vec::new();
    for bin in by_area(problem, MOST) {
        if watch("").is_break() {
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
        rows.push(values(spec, point, &bin, mean(1), mean(2), mean(0)));
    }
    Ok(Some(rows))
}
