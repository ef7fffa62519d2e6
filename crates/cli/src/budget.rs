//! `--error`, `--rays` and `--time`: when a solve is done.

use crate::accuracy::AccuracyArguments;
use crate::failure::Failure;
use crate::numbers::{parse_count, parse_time};
use isolux_core::scene::Scene;
use isolux_core::solvers::monte_carlo::Budget;
use std::time::Duration;

#[derive(Clone, Debug, clap::Args)]
pub struct BudgetArguments {
    #[command(flatten)]
    pub accuracy: AccuracyArguments,

    /// Number of rays, like 1e6, 200k or 3M; with --error at most so many [default: by the number of elements]
    #[arg(long, value_name = "N", value_parser = parse_count)]
    pub rays: Option<u64>,

    /// Time to solve, at most, like 90, 90s, 2min or 1.5h; reading and writing come on top
    #[arg(long, value_name = "TIME", value_parser = parse_time)]
    pub time: Option<Duration>,
}

impl BudgetArguments {
    /// What is asked for in `scene` but for the time, which the driver watches; `None` if nothing is.
    ///
    /// # Errors
    /// Those of [`AccuracyArguments::accuracy`].
    pub fn budget(&self, scene: &Scene) -> Result<Option<Budget>, Failure> {
        Ok(Budget::asked(self.accuracy.accuracy(scene)?, self.rays, self.time.is_some()))
    }
}
