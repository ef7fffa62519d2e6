//! Stochastic ray radiosity: the whole power in every iteration, and the mean over iterations (Neumann et al. 1995).
//!
//! Direct light `d = F Pe` is shot once. Each iteration shoots all that surfaces reflect, and `F rho (d + b)` lands: in the
//! warm-up it takes the place of b, later it is averaged in, so that b is the mean so far. The solution is `d + b`. Unbiased as
//! every [`Relaxation`]: the warm-up lasts until as little is missing as others leave unshot. Cost: one ray a sample.

use super::Entry;
use crate::sampling::address::Address;
use crate::solvers::monte_carlo::relaxation::{Course, Relaxation, Stage};

/// Share of the rays for reflected light that warm up.
const WARM_UP_SHARE: f64 = 0.1;
/// Iterations that are averaged.
const AVERAGED: u32 = 8;

pub(super) const ENTRY: Entry = Entry {
    name: "stochastic-ray",
    what: "the whole power in every iteration; after a warm-up the mean over iterations",
    source: "Neumann et al. 1995",
    pools: |_| true,
    natural_address: |_| Address::PerIteration,
    natural_replicates: 16,
    tells_light_apart: |_| true,
    check: |_| Ok(()),
    make: |problem, settings| Box::new(Relaxation::new(problem, settings, course())),
};

fn course() -> Course {
    Course::new(&[
        Stage::Lamps,
        Stage::Emission,
        Stage::WarmUp { share: WARM_UP_SHARE },
        Stage::Averaged { share: 1.0 - WARM_UP_SHARE, iterations: AVERAGED },
    ])
}
