//! One point that is to be measured, with all that a measure needs for it.

use crate::Error;
use crate::bench::{Bench, Watch, single, solve};
use crate::reference::{Kind, Reference};
use crate::results::Row;
use crate::run::Point;
use crate::spec::{SceneSpec, Series, Spec};
use isolux_core::form_factors::{self, WAYS, Way};
use isolux_core::solvers::Solver;
use isolux_core::solvers::monte_carlo::Settings;
use isolux_core::{Problem, Solution};
use std::sync::Arc;

pub struct Task<'a> {
    pub bench: &'a mut Bench,
    pub spec: &'a Spec,
    pub point: Point,
    pub watch: &'a mut Watch<'a>,
}

impl<'a> Task<'a> {
    pub fn scene(&self) -> &'a SceneSpec {
        &self.spec.scenes[self.point.scene]
    }

    pub fn series(&self) -> &'a Series {
        &self.spec.series[self.point.series]
    }

    /// Its scene, cut into as many elements as the spec says.
    ///
    /// # Errors
    /// If there is no such scene.
    pub fn problem(&mut self) -> Result<Arc<Problem>, Error> {
        self.bench.problem(self.scene(), self.scene().elements)
    }

    /// A reference of its scene; `None` if somebody has stopped it.
    ///
    /// # Errors
    /// Those of [`Bench::reference`].
    pub fn reference(&mut self, kind: Kind) -> Result<Option<Arc<Reference>>, Error> {
        self.bench.reference(self.spec, self.scene(), kind, self.watch)
    }

    /// The method of its series, in one complete solution of `rays` rays.
    ///
    /// # Errors
    /// Those of [`Series::method`].
    pub fn single(&self, rays: u64) -> Result<Settings, Error> {
        Ok(single(self.series().method()?, rays, self.point.seed))
    }

    /// Runs `solver` to its end; `None` if somebody has stopped it.
    pub fn solve(&mut self, solver: &mut dyn Solver, problem: &Problem) -> Option<Solution> {
        solve(solver, problem, "", self.watch)
    }

    /// Whether somebody has stopped it.
    pub fn is_stopped(&mut self) -> bool {
        (self.watch)("").is_break()
    }

    /// A row of its series, at this place.
    pub fn row(&self, at: f64, values: Vec<f64>) -> Row {
        Row { scene: self.scene().name.clone(), series: self.series().name.clone(), at, seed: self.point.seed, values }
    }
}

/// The way to form factors called `name`, for a few rows: a whole matrix might be too large.
///
/// # Errors
/// [`isolux_core::Error::UnknownName`], and those of the way.
pub fn rows_by(name: &str, problem: &Problem, settings: &form_factors::Settings) -> Result<Box<dyn Way>, Error> {
    let found = WAYS.iter().find(|way| way.name == name);
    let way = found.ok_or_else(|| {
        isolux_core::Error::unknown_name("way to form factors", name, WAYS.iter().map(|way| way.name))
    })?;
    Ok((way.make)(problem, settings)?)
}
