//! `warm-up`: how a single complete solution gets from the first step to the last.
//!
//! `at` is the number of samples of the whole solution; each row has a place of its own: how many sixty-fourths of them had been drawn,
//! rounded up, after the last step before the next place. `missing` is how much of the reflected power is not there yet, relative to all of it (its
//! absolute value, for noise adds some).

use super::{Measure, row};
use crate::Error;
use crate::bench::{Bench, Drive, Watch, single};
use crate::results::Row;
use crate::run::Point;
use crate::spec::Spec;
use isolux_core::solvers::{MonteCarlo, Solver};
use isolux_core::{Problem, Solution};

/// Places of a whole solution.
const LOOKS: f64 = 64.0;

pub struct WarmUp;

impl Measure for WarmUp {
    fn columns(&self) -> &'static [&'static str] {
        &["samples", "missing", "error"]
    }

    fn measure(
        &mut self,
        bench: &mut Bench,
        spec: &Spec,
        point: &Point,
        watch: &mut Watch,
    ) -> Result<Option<Vec<Row>>, Error> {
        let (scene, method) = (&spec.scenes[point.scene], spec.series[point.series].method()?);
        let Some(reference) = bench.reference(spec, scene, method.walk, watch)? else { return Ok(None) };
        let problem = bench.problem(scene, scene.elements)?;
        let mut solver = MonteCarlo::new(&problem, single(method, point.at as u64, point.seed))?;
        let exact = reflected(&problem, |e| reference.on(e));
        let (mut rows, mut drive) = (Vec::new(), Drive::new());
        while drive.go_on(&mut solver, &problem) {
            if watch("").is_break() {
                return Ok(None);
            }
            if drive.is_between_steps() {
                let solution = solver.solution(&problem);
                let missing = (reflected(&problem, |e| lux(&solution, e)) / exact - 1.0).abs();
                let error = reference.error(&problem, &solution);
                let samples = solution.work.rays as f64;
                let place = (samples / point.at * LOOKS - 0.01).ceil();
                rows.pop_if(|row: &mut Row| row.at == place);
                rows.push(row(spec, point, place, vec![samples, missing, error]));
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
