//! `convergence`: the error of one complete solution against its number of samples.
//!
//! `at` is the number of samples that a run is asked for. The run is a single complete solution, not the mean of replicates: that
//! would hide half of what better sample numbers do. A span of a global line counts as two samples, one for each end.

use super::Measure;
use crate::Error;
use crate::reference::Kind;
use crate::results::Row;
use crate::task::Task;
use isolux_core::solvers::monte_carlo::MonteCarlo;
use std::time::Instant;

pub struct Convergence;

impl Measure for Convergence {
    fn columns(&self) -> &'static [&'static str] {
        &["samples", "seconds", "error"]
    }

    fn measure(&mut self, task: &mut Task) -> Result<Option<Vec<Row>>, Error> {
        let settings = task.single(task.point.at as u64)?;
        let Some(reference) = task.reference(Kind::Of(settings.method.walk))? else { return Ok(None) };
        let problem = task.problem()?;
        let mut solver = MonteCarlo::new(&problem, settings)?;
        let start = Instant::now();
        let Some(solution) = task.solve(&mut solver, &problem) else { return Ok(None) };
        let seconds = start.elapsed().as_secs_f64();
        let error = reference.error(&problem, &solution);
        Ok(Some(vec![task.row(task.point.at, vec![solution.work.rays as f64, seconds, error])]))
    }
}
