//! `speed`: error against seconds on one thread, of all light and of light that was reflected at least once.
//!
//! `at` is the time [s] that a run is given; its error is looked at after 1/4 s and at each doubling, which is a place of its own.
//! Seconds are processor time. Looking is not counted, nor are reading the scene and building the ray structure. Runs are as users
//! have them: rounds of as many complete solutions as suit the method, an error bar for each element. But light leaves from whole
//! elements. Where it leaves from where it landed each kind of line has its own idea of where that is (a spot for what is shot, a cell for
//! what is gathered), so that methods differ by more than their noise where surfaces nearly touch; of elements of constant radiosity
//! there is but one solution. Errors are those of [`Reference::errors`](crate::reference::Reference::errors). Reflected light has a run of
//! its own, where the method can tell it.

use super::Measure;
use crate::Error;
use crate::bench::Drive;
use crate::reference::{Errors, Kind};
use crate::results::Row;
use crate::stopwatch::Stopwatch;
use crate::task::Task;
use isolux_core::solvers::Solver;
use isolux_core::solvers::monte_carlo::{Budget, LightPart, MonteCarlo, Settings};
use isolux_core::transport::Leaving;
use std::time::{Duration, Instant};

/// The first look [s].
const FIRST: f64 = 0.25;
/// How long it works before it may look again.
const STRETCH: Duration = Duration::from_millis(10);

pub struct Speed;

/// What one look saw: seconds, and the errors; not numbers where there was none.
type Look = [f64; 4];
const NO_LOOK: Look = [f64::NAN; 4];

impl Measure for Speed {
    fn columns(&self) -> &'static [&'static str] {
        &[
            "seconds",
            "weighted",
            "unweighted",
            "median",
            "indirect-seconds",
            "indirect-weighted",
            "indirect-unweighted",
            "indirect-median",
        ]
    }

    fn has_own_places(&self) -> bool {
        true
    }

    fn measure(&mut self, task: &mut Task) -> Result<Option<Vec<Row>>, Error> {
        let method = task.series().method()?;
        let Some(all) = looks(task, LightPart::All)? else { return Ok(None) };
        let mut indirect = vec![NO_LOOK; all.len()];
        if method.check_light(LightPart::Indirect).is_ok() {
            let Some(looks) = looks(task, LightPart::Indirect)? else { return Ok(None) };
            indirect = looks;
        }
        let row = |(k, (all, indirect))| task.row(place(k), [all, indirect].concat());
        Ok(Some(all.into_iter().zip(indirect).enumerate().map(row).collect()))
    }
}

/// Seconds of look k.
fn place(k: usize) -> f64 {
    FIRST * 2f64.powi(k as i32)
}

/// Looks at a run for that light, at all places up to the point's; `None` if somebody has stopped it.
fn looks(task: &mut Task, light: LightPart) -> Result<Option<Vec<Look>>, Error> {
    let Some(reference) = task.reference(Kind::Light(light))? else { return Ok(None) };
    let problem = task.problem()?;
    let method = task.series().method()?;
    let (budget, replicates, seed) = (Budget::Endless, method.natural_replicates(), task.point.seed);
    let leaving = Leaving::WholeElement;
    let settings = Settings { method, light, seed, budget, replicates, leaving };
    let mut looks = vec![NO_LOOK; (0..).take_while(|&k| place(k) <= task.point.at * 1.001).count()];
    let (mut stopwatch, mut drive) = (Stopwatch::new()?, Drive::new());
    let mut solver = stopwatch.time(|| MonteCarlo::new(&problem, settings))?;
    while looks.last().is_some_and(|last| last[0].is_nan()) {
        let goes_on = stopwatch.time(|| {
            let start = Instant::now();
            while drive.go_on(&mut solver, &problem) {
                if start.elapsed() > STRETCH {
                    return true;
                }
            }
            false
        });
        if task.is_stopped() {
            return Ok(None);
        }
        if !goes_on {
            break;
        }
        let seconds = stopwatch.seconds();
        // The last place that was passed: a long step may pass several.
        let passed = (0..looks.len()).rev().find(|&k| place(k) <= seconds);
        if let Some(look) = passed.map(|k| &mut looks[k]).filter(|look| look[0].is_nan()) {
            let irradiance = solver.solution(&problem).irradiance;
            let errors = reference.errors(&problem.mesh, |e| irradiance[e as usize].luminance_f64());
            let Errors { weighted, unweighted, median } = errors;
            *look = [seconds, weighted, unweighted, median];
        }
    }
    Ok(Some(looks))
}
