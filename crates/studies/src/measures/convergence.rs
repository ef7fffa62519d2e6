//! `convergence`: the error of one complete solution against its number of samples.
//!
//! `at` is the number of samples that a run is asked for. The run is a single complete solution, not the mean of replicates: that
//! would hide half of what better sample numbers do. A span of a global line counts as two samples, one for each end.

use super::{Measure, row};
use crate::Error;
use crate::bench::{Bench, Watch, single, solve};
use crate::results::Row;
use crate::run::Point;
use crate::spec::Spec;
use isolux_core::solvers::monte_carlo::MonteCarlo;
use std::time::Instant;

pub struct Convergence;

impl Measure for Convergence {
    fn columns(&self) -> &'static [&'static str] {
        &["samples", "seconds", "error"]
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
        let start = Instant::now();
        let Some(solution) = solve(&mut solver, &problem, "", watch) else { return Ok(None) };
        let seconds = start.elapsed().as_secs_f64();
        let error = reference.error(&problem, &solution);
        Ok(Some(vec![row(spec, point, point.at, vec![solution.work.rays as f64, seconds, error])]))
    }
}
