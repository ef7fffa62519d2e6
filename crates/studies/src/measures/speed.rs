//! `speed`: error against seconds on one thread.
//!
//! `at` is the time [s] that a run is given; its error is looked at after 1/4 s and at each doubling, which is a place of its own.
//! Looking is not counted, nor are reading the scene and building what rays and bundles need. Runs are as users have them: rounds of 16
//! complete solutions, light leaves from where it landed. Relative errors of luminance irradiance against the reference, whose own
//! variance is taken off the first two:
//!
//! - `weighted`: RMS over the area, relative to the mean; `unweighted`: RMS over the elements, each relative to its own irradiance;
//! - `median` over the elements of the absolute relative error.

use super::{Measure, row};
use crate::Error;
use crate::bench::{Bench, Drive, Watch};
use crate::results::Row;
use crate::run::Point;
use crate::spec::Spec;
use isolux_core::solvers::Solver;
use isolux_core::solvers::monte_carlo::{Budget, MonteCarlo, Settings};
use std::time::Instant;

/// The first look [s].
const FIRST: f64 = 0.25;

pub struct Speed;

impl Measure for Speed {
    fn columns(&self) -> &'static [&'static str] {
        &["seconds", "weighted", "unweighted", "median"]
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
        let settings = Settings { method, seed: point.seed, budget: Budget::Endless, ..Settings::default() };
        let Ok(single) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else { return Ok(None) };
        let (mut rows, mut drive) = (Vec::new(), Drive::new());
        let (mut start, mut next) = (Instant::now(), FIRST);
        let mut solver = MonteCarlo::new(&problem, settings)?;
        while next <= point.at * 1.001 && single.install(|| drive.go_on(&mut solver, &problem)) {
            if watch("").is_break() {
                return Ok(None);
            }
            let elapsed = start.elapsed();
            if elapsed.as_secs_f64() >= next {
                let [weighted, unweighted, median] = reference.errors(&problem, &solver.solution(&problem));
                rows.push(row(spec, point, next, vec![elapsed.as_secs_f64(), weighted, unweighted, median]));
                while next <= elapsed.as_secs_f64() {
                    next *= 2.0;
                }
                start += start.elapsed() - elapsed;
            }
        }
        Ok(Some(rows))
    }
}
