//! Solves: driven here, watched by a function of Python.

use crate::background::in_background;
use crate::fail::Fail;
use crate::problem::Problem;
use crate::request::Request;
use crate::solution::Solution;
use isolux_core::scene::Grouping;
use isolux_core::solvers::Progress;
use isolux_core::solvers::monte_carlo::Budget;
use isolux_core::{Accuracy, Error, Quantity, run};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// When a solve is done: the entries of a dict.
#[derive(FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
pub struct Limits {
    error: Option<f64>,
    confidence: f64,
    error_of: String,
    rays: Option<u64>,
    /// [s]
    time: Option<f64>,
}

/// Light groups: `objects`, `materials`, or lists of names.
#[derive(FromPyObject)]
pub enum Groups {
    By(String),
    Listed(Vec<(String, Vec<String>)>),
}

/// How a solve came to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ended {
    Complete,
    Time,
    /// By Ctrl-C.
    Interrupted,
    /// By the function that watches.
    Stopped,
}

impl Ended {
    fn name(self) -> &'static str {
        match self {
            Ended::Complete => "complete",
            Ended::Time => "time",
            Ended::Interrupted => "interrupted",
            Ended::Stopped => "stopped",
        }
    }
}

/// What the thread that solves and the one that waits tell each other.
struct Shared {
    ended: Ended,
    progress: Option<Progress>,
}

/// Solves `problem`; `watch(stage, rays, rays_in_all, error, excess, seconds)` is called several times a second and ends the solve if it
/// says so. The solution, how it ended, and why the method is biased, if it is.
#[pyfunction]
pub fn solve(
    problem: &Bound<Problem>,
    request: &Request,
    limits: Limits,
    groups: Option<Groups>,
    threads: Option<usize>,
    watch: &Bound<PyAny>,
) -> Result<(Solution, &'static str, Option<&'static str>), Fail> {
    let py = problem.py();
    let inner = &*problem.get().inner;
    let budget = limits.budget(&inner.scene, request)?;
    let time = limits.duration()?;
    let groups = groups.map(Groups::grouping).transpose()?;
    check_threads(threads)?;

    let shared = Mutex::new(Shared { ended: Ended::Complete, progress: None });
    let locked = || shared.lock().unwrap_or_else(PoisonError::into_inner);
    let start = Instant::now();
    let look = || {
        match py.check_signals() {
            Err(error) if error.is_instance_of::<PyKeyboardInterrupt>(py) => locked().ended = Ended::Interrupted,
            Err(error) => {
                locked().ended = Ended::Stopped;
                return Err(error);
            }
            Ok(()) => {}
        }
        let Some(now) = locked().progress.take() else { return Ok(()) };
        let Progress { stage, rays, rays_in_all, rms_error, excess, .. } = now;
        let error = rms_error.filter(|error| error.is_finite());
        let said = watch.call1((stage, rays, rays_in_all, error, excess, start.elapsed().as_secs_f64()));
        if said.as_ref().map_or(true, |said| said.is_truthy().unwrap_or(true)) && locked().ended == Ended::Complete {
            locked().ended = Ended::Stopped;
        }
        said.map(drop)
    };
    let work = || -> Result<_, Error> {
        let mut solver = request.chosen.solver(inner, budget, groups.as_ref())?;
        let mut solution = run::run(&mut *solver, inner, |progress| {
            let mut shared = locked();
            shared.progress = Some(*progress);
            if shared.ended == Ended::Complete && time.is_some_and(|time| start.elapsed() >= time) {
                shared.ended = Ended::Time;
            }
            if shared.ended == Ended::Complete { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        let by = match locked().ended {
            Ended::Complete => None,
            Ended::Time => Some("by the time limit"),
            Ended::Interrupted | Ended::Stopped => Some("by the user"),
        };
        // Files say, too, that these are not the rays the other parameters ask for.
        solution.provenance.parameters.extend(by.map(|by| ("stopped".to_owned(), by.to_owned())));
        Ok((solution, solver.progress().bias))
    };
    let (solution, bias) = in_background(py, threads, look, work)??;
    let ended = locked().ended.name();
    Ok((Solution::new(problem.clone().unbind(), solution), ended, bias))
}

impl Limits {
    /// As the core says it.
    ///
    /// # Errors
    /// For what makes no sense, or not with the method.
    pub fn budget(&self, scene: &isolux_core::scene::Scene, request: &Request) -> Result<Budget, Error> {
        request.chosen.check_limits(self.error.is_some(), self.rays.is_some())?;
        let share = |name, value: f64| {
            let allowed = "a share above 0 and below 1; 0.02 is two hundredths";
            let is_share = value > 0.0 && value < 1.0;
            is_share.then_some(value).ok_or_else(|| Error::Parameter { name, value: value.to_string(), allowed })
        };
        let accuracy = match self.error {
            None => None,
            Some(error) => Some(Accuracy {
                error: share("error", error)?,
                confidence: share("confidence", self.confidence)?,
                of: quantity(scene, &self.error_of)?,
            }),
        };
        if self.rays == Some(0) {
            return Err(Error::Parameter { name: "rays", value: "0".to_owned(), allowed: "at least one ray" });
        }
        Ok(Budget::asked(accuracy, self.rays, self.time.is_some()).unwrap_or(Budget::Heuristic))
    }

    /// The time, if it is limited.
    ///
    /// # Errors
    /// If it is not above 0.
    pub fn duration(&self) -> Result<Option<Duration>, Error> {
        self.time.map(seconds).transpose()
    }

    /// What is left after cutting took some of the time, and of the rays all but what the `budget` has.
    pub fn left(self, budget: Budget, took: Duration) -> Limits {
        let time = self.time.map(|time| (time - took.as_secs_f64()).max(1e-3));
        Limits { rays: budget.most_rays(), time, ..self }
    }
}

/// Whose error is meant: rms, max, mean, or object:NAME.
///
/// # Errors
/// For anything else, and an object that is not there.
pub fn quantity(scene: &isolux_core::scene::Scene, text: &str) -> Result<Quantity, Error> {
    match (text, text.strip_prefix("object:")) {
        ("rms", _) => Ok(Quantity::Rms),
        ("max", _) => Ok(Quantity::Max),
        ("mean", _) => Ok(Quantity::Mean),
        (_, Some(name)) => Quantity::of_object(scene, name),
        _ => Err(Error::unknown_name("error", text, ["rms", "max", "mean", "object:NAME"])),
    }
}

fn seconds(time: f64) -> Result<Duration, Error> {
    let allowed = "a number of seconds above 0";
    let known = Duration::try_from_secs_f64(time).ok().filter(|time| !time.is_zero());
    known.ok_or_else(|| Error::Parameter { name: "time", value: time.to_string(), allowed })
}

fn check_threads(threads: Option<usize>) -> Result<(), Error> {
    match threads {
        Some(threads) if !(1..=1024).contains(&threads) => {
            Err(Error::Parameter { name: "threads", value: threads.to_string(), allowed: "1 to 1024 threads" })
        }
        _ => Ok(()),
    }
}

impl Groups {
    fn grouping(self) -> Result<Grouping, Error> {
        match self {
            Groups::Listed(lists) => Ok(Grouping::Listed(lists)),
            Groups::By(by) if by == "objects" => Ok(Grouping::Objects),
            Groups::By(by) if by == "materials" => Ok(Grouping::Materials),
            Groups::By(other) => Err(Error::unknown_name("light grouping", &other, ["objects", "materials"])),
        }
    }
}
