//! `coverage`: how often is the true error as small as the one that was asked for?
//!
//! `at` is the confidence that is asked for. A point is fifty solves that differ in their seeds, each until its error is at most a
//! twentieth with that confidence: the RMS error over all elements; or with `of = "mean"` that of the scene's mean irradiance, at most a
//! two-hundredth. `kept` is
//! the share of them whose true error is no larger, and shall be no less than `at`; `error` is the RMS of their true errors over
//! the one that was asked for, and `rays` the mean of their rays.

use super::Measure;
use crate::Error;
use crate::reference::{Kind, Reference};
use crate::results::Row;
use crate::task::Task;
use isolux_core::run::run;
use isolux_core::solvers::monte_carlo::{Budget, LightPart, MonteCarlo, Settings};
use isolux_core::transport::Leaving;
use isolux_core::{Accuracy, Problem, Quantity, Solution};
use rayon::prelude::*;
use std::ops::ControlFlow;

/// Solves at each point.
const SOLVES: u64 = 50;
/// The errors that are asked for: of all elements, and of the mean.
const ERROR: f64 = 0.05;
const ERROR_OF_MEAN: f64 = 0.005;

pub struct Coverage;

impl Measure for Coverage {
    fn columns(&self) -> &'static [&'static str] {
        &["confidence", "rays", "kept", "error"]
    }

    fn measure(&mut self, task: &mut Task) -> Result<Option<Vec<Row>>, Error> {
        let of_mean = task.series().says("of", "mean")?;
        let (of, asked) = if of_mean { (Quantity::Mean, ERROR_OF_MEAN) } else { (Quantity::Rms, ERROR) };
        let method = task.series().method()?;
        let Some(reference) = task.reference(Kind::Light(LightPart::All))? else { return Ok(None) };
        let problem = task.problem()?;
        let accuracy = Accuracy { error: asked, confidence: task.point.at, of };
        let settings = |seed| Settings {
            method,
            seed,
            budget: Budget::Accuracy { accuracy, most_rays: None },
            replicates: method.natural_replicates(),
            leaving: Leaving::WholeElement,
            light: LightPart::All,
        };
        let first = task.point.seed * SOLVES;
        let solve = |seed| -> Result<Solution, Error> {
            let mut solver = MonteCarlo::new(&problem, settings(seed))?;
            Ok(run(&mut solver, &problem, |_| ControlFlow::Continue(())))
        };
        let solutions: Vec<Solution> = (first..first + SOLVES).into_par_iter().map(solve).collect::<Result<_, _>>()?;
        if task.is_stopped() {
            return Ok(None);
        }
        let mean = |of: &dyn Fn(&Solution) -> f64| solutions.iter().map(of).sum::<f64>() / SOLVES as f64;
        let error = |solution: &Solution| true_error(of, &reference, &problem, solution) / asked;
        let kept = mean(&|solution| f64::from(u8::from(error(solution) <= 1.0)));
        let rays = mean(&|solution| solution.work.rays as f64);
        let rms = mean(&|solution| error(solution).powi(2)).sqrt();
        Ok(Some(vec![task.row(task.point.at, vec![task.point.at, rays, kept, rms])]))
    }
}

fn true_error(of: Quantity, reference: &Reference, problem: &Problem, solution: &Solution) -> f64 {
    if of != Quantity::Mean {
        return reference.error(problem, solution);
    }
    let mesh = &problem.mesh;
    let flux = |irradiance: &dyn Fn(u32) -> f64| -> f64 {
        mesh.elements().map(|e| f64::from(mesh.area(e)) * irradiance(e)).sum()
    };
    (flux(&|e| solution.irradiance[e as usize].luminance_f64()) / flux(&|e| reference.on(e)) - 1.0).abs()
}
