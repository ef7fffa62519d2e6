//! The lines of a step: from the elements, or across the whole scene.

use super::line_set::LineSet;
use crate::solvers::allocation::Allocation;
use crate::solvers::shooting;

/// The lines of a step.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub enum Draw {
    Local(Allocation),
    Lines(LineSet),
}

impl Draw {
    pub fn pieces(&self) -> u64 {
        match self {
            Draw::Local(allocation) => shooting::pieces(allocation.rays()),
            Draw::Lines(lines) => lines.pieces(),
        }
    }

    /// Expected number of samples.
    pub fn rays(&self) -> u64 {
        match self {
            Draw::Local(allocation) => allocation.rays(),
            Draw::Lines(lines) => lines.samples(),
        }
    }
}
