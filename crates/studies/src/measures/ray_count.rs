//! `ray-count`: does the recommended number of rays give the error it promises?
//!
//! `at` is a multiple of the recommended number `N = 9 max_i rho_i A_T / A_i` ([`isolux_core::solvers::budget`]). It promises that
//! three standard deviations of the reflected radiosity of an element are about the mean radiosity. Measured is that
//! ratio for every element, with the deviation of one complete solution of N rays from the spread of 32: its median, its 90th
//! percentile and its maximum over the elements; `kept`, the share of elements for which it is at most one; and `error`, the
//! area-weighted RMS error of the whole solution.

use super::Measure;
use crate::Error;
use crate::results::Row;
use crate::task::Task;
use isolux_core::solvers::budget;
use isolux_core::solvers::monte_carlo::{MonteCarlo, Settings};

/// Complete solutions whose spread is measured.
const RUNS: u32 = 32;
/// What takes more rays than this altogether is left out.
const MOST_RAYS: f64 = 1e9;

pub struct RayCount;

impl Measure for RayCount {
    fn columns(&self) -> &'static [&'static str] {
        &["rays", "median", "ninety", "worst", "kept", "error"]
    }

    fn measure(&mut self, task: &mut Task) -> Result<Option<Vec<Row>>, Error> {
        let problem = task.problem()?;
        let left_out = if task.series().says("worst-tenth", "left-out")? { 0.1 } else { 0.0 };
        let rays = (task.point.at * budget::heuristic(&problem.mesh, left_out)).ceil();
        if rays * f64::from(RUNS) > MOST_RAYS {
            return Ok(Some(Vec::new()));
        }
        let settings = Settings { replicates: RUNS, ..task.single(rays as u64 * u64::from(RUNS))? };
        let mut solver = MonteCarlo::new(&problem, settings)?;
        let Some(solution) = task.solve(&mut solver, &problem) else { return Ok(None) };
        let mesh = &problem.mesh;
        let weighted = |e| f64::from(mesh.area(e)) * solution.radiosity(&problem, e).luminance_f64();
        let mean = mesh.elements().map(weighted).sum::<f64>() / mesh.total_area();
        let one = f64::from(RUNS).sqrt();
        let deviation = |e: u32| (mesh.reflectivity(e) * solution.std_error[e as usize]).luminance_f64() * one;
        let mut ratios: Vec<f64> = mesh.elements().map(|e| 3.0 * deviation(e) / mean).collect();
        ratios.sort_by(f64::total_cmp);
        let rank = |share: f64| ratios[((ratios.len() - 1) as f64 * share) as usize];
        let kept = ratios.iter().filter(|&&ratio| ratio <= 1.0).count() as f64 / ratios.len() as f64;
        let error = solution.rms_error() * one;
        Ok(Some(vec![task.row(task.point.at, vec![rays, rank(0.5), rank(0.9), rank(1.0), kept, error])]))
    }
}
