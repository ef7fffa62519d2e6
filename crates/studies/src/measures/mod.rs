//! What studies measure, one a file.

mod bins;
mod convergence;
mod cost;
mod element_variance;
mod form_factor_variance;
mod ray_count;
mod warm_up;

use crate::Error;
use crate::bench::{Bench, Watch};
use crate::results::Row;
use crate::run::Point;
use crate::spec::Spec;
use isolux_core::Problem;
use isolux_core::form_factors::{self, WAYS, Way};

/// How a study turns a point into rows of its table.
pub trait Measure {
    /// The columns of the table.
    fn columns(&self) -> &'static [&'static str];

    /// Measures one point; `None` if `watch` breaks off. The same spec and point give the same rows, but for seconds.
    ///
    /// # Errors
    /// If what the spec asks for cannot be solved.
    fn measure(
        &mut self,
        bench: &mut Bench,
        spec: &Spec,
        point: &Point,
        watch: &mut Watch,
    ) -> Result<Option<Vec<Row>>, Error>;
}

/// Makes a measure.
type Make = fn() -> Box<dyn Measure>;

/// All measures, by the name that a `study.toml` calls them. A new one is a file in this folder and a line here.
pub const MEASURES: &[(&str, Make)] = &[
    ("convergence", || Box::new(convergence::Convergence)),
    ("form-factor-variance", || Box::new(form_factor_variance::FormFactorVariance)),
    ("warm-up", || Box::new(warm_up::WarmUp)),
    ("element-variance", || Box::new(element_variance::ElementVariance::default())),
    ("cost", || Box::new(cost::Cost)),
    ("ray-count", || Box::new(ray_count::RayCount)),
];

/// The measure called `name`.
///
/// # Errors
/// [`isolux_core::Error::UnknownName`].
pub fn named(name: &str) -> Result<Box<dyn Measure>, Error> {
    let found = MEASURES.iter().find(|(known, _)| *known == name);
    found
        .map(|(_, make)| make())
        .ok_or_else(|| isolux_core::Error::unknown_name("measure", name, MEASURES.iter().map(|(name, _)| *name)).into())
}

/// A row of `point`.
fn row(spec: &Spec, point: &Point, at: f64, values: Vec<f64>) -> Row {
    let (scene, series) = (spec.scenes[point.scene].name.clone(), spec.series[point.series].name.clone());
    Row { scene, series, at, seed: point.seed, values }
}

/// The way to form factors called `name`, for a few rows: a whole matrix might be too large.
fn rows_by(name: &str, problem: &Problem, settings: &form_factors::Settings) -> Result<Box<dyn Way>, Error> {
    let found = WAYS.iter().find(|way| way.name == name);
    let way = found.ok_or_else(|| {
        isolux_core::Error::unknown_name("way to form factors", name, WAYS.iter().map(|way| way.name))
    })?;
    Ok((way.make)(problem, settings)?)
}
