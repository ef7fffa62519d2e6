//! Regular power shooting from scratch: the whole power in every iteration, all of them averaged (Neumann et al. 1995).
//!
//! Direct light `d = F Pe` is shot once. Iteration k shoots all that surfaces reflect, and what lands is averaged in:
//! `b_k = (1 - 1/k) b_(k-1) + 1/k F rho (d + b_(k-1))`, with `b_0 = 0`; the solution is `d + b_K`.
//!
//! **Biased, however many rays there are.** Bounce k appears in iteration k only, and the mean drags the early iterations
//! behind it: of the light in a closed room of reflectivity 1/2 it has 90 % after eight iterations, at 0.8 55 %, at 0.9 a
//! third. That is what the warm-up of `stochastic-ray` is for, which averages as many; this order shows what it is worth. The
//! error bars do not contain what is missing, the balance's unshot light does. Cost: one ray a sample.

use super::Entry;
use crate::sampling::address::Address;
use crate::solvers::monte_carlo::relaxation::{Course, Relaxation, Stage};

/// Iterations that are averaged.
const AVERAGED: u32 = 8;

pub(super) const ENTRY: Entry = Entry {
    name: "regular",
    what: "the whole power in every iteration, and the mean without a warm-up: too dark, for comparison",
    source: "Neumann et al. 1995",
    pools: |_| true,
    natural_address: |_| Address::PerIteration,
    natural_replicates: 16,
    tells_light_apart: |_| true,
    check: |_| Ok(()),
    make: |problem, settings| Box::new(Relaxation::new(problem, settings, course())),
};

fn course() -> Course {
    Course::new(&[Stage::Lamps, Stage::Emission, Stage::Averaged { share: 1.0, iterations: AVERAGED }])
}
