//! What a solve is told of its method: the names that people write, looked up in the tables of the core.

use crate::background::in_background;
use crate::fail::Fail;
use crate::problem::Problem;
use crate::scene::Scene;
use crate::solve::Limits;
use isolux_core::Error;
use isolux_core::adaptive::{Meshed, PATIENCE, Spread, Wish};
use isolux_core::choice::{Choice, TableEntry};
use isolux_core::sampling::address::Address;
use isolux_core::solvers::monte_carlo::LightPart;
use isolux_core::solvers::monte_carlo::axes::Axis;
use isolux_core::solvers::{Asked, Chosen};
use isolux_core::transport::Leaving;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A method with what it is told.
#[pyclass(frozen, module = "isolux._native")]
pub struct Request {
    pub chosen: Chosen,
    light: LightPart,
}

/// The entries of a dict; `None`, and what is not in it, are as the method has them.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Options {
    method: Option<String>,
    #[pyo3(default)]
    sequence: Option<String>,
    #[pyo3(default)]
    order: Option<String>,
    #[pyo3(default)]
    lines: Option<String>,
    #[pyo3(default)]
    walk: Option<String>,
    #[pyo3(default)]
    address: Option<String>,
    #[pyo3(default)]
    estimator: Option<String>,
    #[pyo3(default)]
    direction: Option<String>,
    #[pyo3(default)]
    survival: Option<String>,
    #[pyo3(default)]
    first_shot: Option<String>,
    #[pyo3(default)]
    seed: Option<u64>,
    #[pyo3(default)]
    replicates: Option<u32>,
    #[pyo3(default)]
    leaving: Option<String>,
    #[pyo3(default)]
    light: Option<String>,
    #[pyo3(default)]
    factors: Option<String>,
    #[pyo3(default)]
    unshot: Option<f64>,
    #[pyo3(default)]
    ambient: bool,
    #[pyo3(default)]
    link_power: Option<f64>,
}

/// How a scene is cut: the entries of a dict.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Cut {
    elements: Option<u64>,
    max_edge: Option<f32>,
    mesh: Option<String>,
    contacts: Option<bool>,
}

#[pymethods]
impl Request {
    #[new]
    fn new(options: Options) -> Result<Request, Fail> {
        let light = named("light", options.light, &LightPart::ALL, LightPart::name)?;
        let asked = Asked {
            method: options.method,
            sequence: choice(options.sequence)?,
            order: choice(options.order)?,
            lines: axis(options.lines)?,
            walk: axis(options.walk)?,
            address: named("address", options.address, &Address::ALL, Address::name)?,
            estimator: axis(options.estimator)?,
            direction: axis(options.direction)?,
            survival: axis(options.survival)?,
            first_shot: axis(options.first_shot)?,
            seed: options.seed,
            replicates: options.replicates,
            leaving: named("leaving", options.leaving, &Leaving::ALL, Leaving::name)?,
            light,
            factors: options.factors,
            unshot: options.unshot,
            ambient: options.ambient,
            link_power: options.link_power,
        };
        Ok(Request { chosen: asked.chosen()?, light: light.unwrap_or_default() })
    }

    #[getter]
    fn is_deterministic(&self) -> bool {
        self.chosen.is_deterministic()
    }

    /// Cuts `scene` as suits the method and the `limits`; and the limits that are left.
    fn problem(
        &self,
        py: Python,
        scene: &Scene,
        cut: Cut,
        limits: Limits,
        threads: Option<usize>,
    ) -> Result<(Problem, Limits), Fail> {
        let scene = scene.inner.clone();
        let budget = limits.budget(&scene, self)?;
        let spread = named("mesh", cut.mesh, &Spread::ALL, Spread::name)?;
        let resolution = self.chosen.resolution(cut.elements, cut.max_edge);
        let (along_contacts, light) = (cut.contacts.unwrap_or(true), self.light);
        let wish = Wish { resolution, spread, along_contacts, budget, light };
        let (time, start) = (limits.duration()?, Instant::now());
        let is_late = || time.is_some_and(|time| start.elapsed() > time.mul_f64(PATIENCE));
        let is_interrupted = AtomicBool::new(false);
        let look = || py.check_signals().inspect_err(|_| is_interrupted.store(true, Ordering::Relaxed));
        let work = || -> Result<Meshed, Error> {
            let check = |problem: &isolux_core::Problem| self.chosen.solver(problem, budget, None).map(drop);
            wish.cut(scene, check, |_| match is_interrupted.load(Ordering::Relaxed) || is_late() {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            })
        };
        let Meshed { problem, budget } = in_background(py, threads, look, work)??;
        let took = if wish.is_adaptive() { start.elapsed() } else { Duration::ZERO };
        Ok((Problem::new(problem), limits.left(budget, took)))
    }
}

fn choice<E: TableEntry>(name: Option<String>) -> Result<Option<Choice<E>>, Error> {
    name.map(|name| name.parse()).transpose()
}

fn axis<A: Axis>(name: Option<String>) -> Result<Option<A>, Error> {
    named(A::NAME, name, A::ALL, A::name)
}

fn named<T: Copy>(
    kind: &'static str,
    name: Option<String>,
    all: &[T],
    name_of: fn(T) -> &'static str,
) -> Result<Option<T>, Error> {
    let Some(name) = name else { return Ok(None) };
    let found = all.iter().copied().find(|&member| name_of(member) == name);
    found.map(Some).ok_or_else(|| Error::unknown_name(kind, &name, all.iter().map(|&member| name_of(member))))
}
