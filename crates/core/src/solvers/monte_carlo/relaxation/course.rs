//! What a relaxation does step after step, by its order.

use crate::solvers::monte_carlo::Method;
use crate::solvers::monte_carlo::axes::{FirstShot, Lines, Order};

/// What the running step does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Stage {
    /// Lights without extent shoot what they emit.
    Lamps,
    /// Surfaces shoot what they emit.
    Emission,
    /// Light leaves with every global line that crosses the element on which it has landed.
    Multipath,
    /// Surfaces shoot what they have not shot yet, again and again.
    Incremental,
    /// Surfaces shoot all they reflect; what lands takes the place of what had landed before.
    WarmUp,
    /// Surfaces shoot all they reflect; what lands is averaged in.
    Regular,
    Gathering,
    Done,
}

impl Stage {
    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Lamps | Stage::Emission => "shooting direct light",
            Stage::Multipath => "sending light along global lines",
            Stage::Incremental => "shooting reflected light",
            Stage::WarmUp => "warming up",
            Stage::Regular => "shooting all light again",
            Stage::Gathering => "gathering",
            Stage::Done => "done",
        }
    }

    /// Whether what is shot was reflected.
    pub fn reflects(self) -> bool {
        matches!(self, Stage::Incremental | Stage::WarmUp | Stage::Regular)
    }

    /// The stages of `method` in their order.
    pub fn of(method: Method) -> &'static [Stage] {
        use Stage::{Emission, Gathering, Incremental, Lamps, Multipath, Regular, WarmUp};
        match (method.order, method.lines) {
            (Order::StochasticJacobi, Lines::Local) => &[Lamps, Emission, Incremental, Regular, Gathering],
            (Order::StochasticJacobi, _) => &[Lamps, Emission, Incremental, Regular],
            (Order::StochasticRay, _) => &[Lamps, Emission, WarmUp, Regular],
            (Order::DepthFirst, _) if method.first_shot == FirstShot::Same => &[Lamps, Multipath, Incremental],
            (Order::DepthFirst, _) => &[Lamps, Emission, Multipath, Incremental],
            (Order::BreadthFirst | Order::Staged | Order::Wdrs, _) => &[Lamps, Emission, Incremental],
        }
    }
}
