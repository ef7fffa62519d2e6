//! `cost`: seconds and rays to a fixed accuracy against the number of elements.
//!
//! `at` is the number of elements. A stochastic method runs with 32 rays an element and states its error e; since that falls like
//! `1 / sqrt(rays)`, an error of 5 % takes `(e / 5 %)²` times as many rays and seconds. A deterministic one runs until a
//! thousandth of the light is unshot; its error is that of its form factors, and so that this does not grow where elements get
//! smaller, hemicubes have four pixels to each element of the scene. Reading and cutting the scene is not counted.

use super::Measure;
use crate::Error;
use crate::results::Row;
use crate::task::Task;
use isolux_core::form_factors;
use isolux_core::solvers::Solver;
use isolux_core::solvers::deterministic::{self, DETERMINISTIC};
use isolux_core::solvers::monte_carlo::{MonteCarlo, Settings};
use std::time::Instant;

const ACCURACY: f64 = 0.05;
const RAYS_PER_ELEMENT: u64 = 32;
/// Complete solutions from which a method knows its error.
const REPLICATES: u32 = 16;

pub struct Cost;

/// Hemicubes of `(2 sqrt(n))²` pixels on their top for n elements.
fn settings_for(elements: u64) -> deterministic::Settings {
    let resolution = 2 * (elements as f64).sqrt().round() as u16;
    let default = deterministic::Settings::default();
    let factors = form_factors::Settings { resolution, ..default.factors };
    deterministic::Settings { factors, unshot: 1e-3, ..default }
}

impl Measure for Cost {
    fn columns(&self) -> &'static [&'static str] {
        &["elements", "rays", "seconds"]
    }

    fn measure(&mut self, task: &mut Task) -> Result<Option<Vec<Row>>, Error> {
        let problem = task.bench.problem(task.scene(), task.point.at as u64)?;
        let elements = problem.mesh.len() as u64;
        let name = task.series().axis("method").unwrap_or_default();
        let entry = DETERMINISTIC.iter().find(|entry| entry.name == name);
        let mut solver: Box<dyn Solver> = match entry {
            Some(entry) => (entry.make)(&problem, &settings_for(elements))?,
            None => {
                let settings = task.single(RAYS_PER_ELEMENT * elements)?;
                Box::new(MonteCarlo::new(&problem, Settings { replicates: REPLICATES, ..settings })?)
            }
        };
        let start = Instant::now();
        let Some(solution) = task.solve(solver.as_mut(), &problem) else { return Ok(None) };
        let seconds = start.elapsed().as_secs_f64();
        let times = if entry.is_some() { 1.0 } else { (solution.rms_error() / ACCURACY).powi(2) };
        let values = vec![elements as f64, solution.work.rays as f64 * times, seconds * times];
        Ok(Some(vec![task.row(task.point.at, values)]))
    }
}
