//! The published experiments with Monte Carlo radiosity, each run by one command.
//!
//! A study is a `study.toml` (question, scenes, series, sample counts, seeds, plots, and the signs by which a published claim
//! shows) and one of the [`measures`]. [`run`] measures point by point, keeps every point in `result.csv` as soon as it is
//! there, and picks up where it was stopped; then it fits slopes ([`fit`]), draws ([`plot`]) and looks for the signs ([`signs`]).

mod bench;
mod error;
pub mod fit;
pub mod machine;
pub mod measures;
pub mod plot;
pub mod ratios;
mod reference;
pub mod report;
pub mod results;
pub mod run;
mod series;
pub mod signs;
pub mod spec;
mod stopwatch;
mod task;

pub use error::Error;
pub use run::{Options, Outcome, Progress, SCENES, left_out, run};
pub use spec::Spec;

/// A study that can be asked for by name.
#[derive(Clone, Copy, Debug)]
pub struct Study {
    pub name: &'static str,
    /// Its `study.toml`.
    pub text: &'static str,
}

macro_rules! studies {
    ($($name:literal),+ $(,)?) => {
        &[$(Study { name: $name, text: include_str!(concat!("../../../studies/", $name, "/study.toml")) }),+]
    };
}

/// All studies. A new one is a folder in `studies/` and a line here.
pub const STUDIES: &[Study] = studies![
    "order",
    "lines",
    "walk",
    "sequences",
    "form-factor-variance",
    "warm-up",
    "variance",
    "cost",
    "ray-count",
    "speed",
    "coverage",
];

impl Study {
    /// The study called `name`.
    ///
    /// # Errors
    /// [`isolux_core::Error::UnknownName`] with the nearest name.
    pub fn named(name: &str) -> Result<Study, Error> {
        let found = STUDIES.iter().find(|study| study.name == name);
        found.copied().ok_or_else(|| {
            isolux_core::Error::unknown_name("study", name, STUDIES.iter().map(|study| study.name)).into()
        })
    }

    /// What it asks, measures and draws.
    ///
    /// # Errors
    /// [`Error::Spec`] if its `study.toml` is wrong, which a test excludes.
    pub fn spec(&self) -> Result<Spec, Error> {
        Spec::parse(self.name, self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolux_core::solvers::deterministic::DETERMINISTIC;

    #[test]
    fn every_study_of_the_table_can_be_read_and_run() {
        for study in STUDIES {
            let spec = study.spec().unwrap_or_else(|error| panic!("{error}"));
            for spec in [spec.clone(), spec.quick()] {
                let measure = measures::named(&spec.measure).unwrap();
                spec.check(measure.columns()).unwrap_or_else(|error| panic!("{}: {error}", study.name));
                let is_known = |name: &str| DETERMINISTIC.iter().any(|entry| entry.name == name);
                for series in
                    spec.series.iter().filter(|series| series.axis("method").is_some_and(|name| !is_known(name)))
                {
                    series.method().unwrap_or_else(|error| panic!("{}, {}: {error}", study.name, series.name));
                }
            }
        }
    }
}
