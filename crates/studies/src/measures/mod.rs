//! What studies measure, one a file.

mod bins;
mod convergence;
mod cost;
mod coverage;
mod element_variance;
mod form_factor_variance;
mod ray_count;
mod speed;
mod warm_up;

use crate::Error;
use crate::results::Row;
use crate::task::Task;

/// How a study turns a point into rows of its table.
pub trait Measure {
    /// The columns of the table.
    fn columns(&self) -> &'static [&'static str];

    /// Whether its rows have places of their own, which are not where the point is.
    fn has_own_places(&self) -> bool {
        false
    }

    /// Measures one point; `None` if somebody has stopped it. The same spec and point give the same rows, but for seconds.
    ///
    /// # Errors
    /// If what the spec asks for cannot be solved.
    fn measure(&mut self, task: &mut Task) -> Result<Option<Vec<Row>>, Error>;
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
    ("coverage", || Box::new(coverage::Coverage)),
    ("speed", || Box::new(speed::Speed)),
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
