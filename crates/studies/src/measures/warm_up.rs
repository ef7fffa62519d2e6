//! `warm-up`: how a single complete solution gets from the first step to the last.
//!
//! `at` is the number of samples of the whole solution; each row has a place of its own: how many sixty-fourths of them had been drawn,
//! rounded up, after the last step before the next place. `missing` is how much of the reflected power is not there yet, relative to all of it (its
//! absolute value, for noise adds some).

use super::Measure;
use crate::Error;
use crate::bench::Drive;
use crate::reference::Kind;
use crate::results::Row;
use crate::task::Task;
use isolux_core::solvers::{MonteCarlo, Solver};
use isolux_core::{Problem, Solution};

/// Places of a whole solution.
const LOOKS: f64 = 64.0;

pub struct WarmUp;

impl Measure for WarmUp {
    fn columns(&self) -> &'static [&'static str] {
        &["samples", "missing", "error"]
    }

    fn has_own_places(&self) -> bool {
        true
    }

    fn measure(&mut self, task: &mut Task) -> Result<Option<Vec<Row>>, Error> {
        let settings = task.single(task.point.at as u64)?;
        let Some(reference) = task.reference(Kind::Of(settings.method.walk))? else { return Ok(None) };
        let problem = task.problem()?;
        let mut solver = MonteCarlo::new(&problem, settings)?;
        let exact = reflected(&problem, |e| reference.on(e));
        let (mut rows, mut drive) = (Vec::new(), Drive::new());
        while drive.go_on(&mut solver, &problem) {
            if task.is_stopped() {
                return Ok(None);
            }
            if drive.is_between_steps() {
                let solution = solver.solution(&problem);
                let missing = (reflected(&problem, |e| lux(&solution, e)) / exact - 1.0).abs();
                let error = reference.error(&problem, &solution);
                let samples = solution.work.rays as f64;
                let place = (samples / task.point.at * LOOKS - 0.01).ceil();
                rows.pop_if(|row: &mut Row| row.at == place);
                rows.push(task.row(place, vec![samples, missing, error]));
            }
        }
        Ok(Some(rows))
    }
}

fn lux(solution: &Solution, e: u32) -> f64 {
    solution.irradiance[e as usize].luminance_f64()
}

/// Luminous flux [lm] that surfaces reflect where irradiance [lux] falls on them.
fn reflected(problem: &Problem, irradiance: impl Fn(u32) -> f64) -> f64 {
    let mesh = &problem.mesh;
    mesh.elements().map(|e| f64::from(mesh.area(e)) * mesh.reflectivity(e).luminance_f64() * irradiance(e)).sum()
}
