//! Shirley's sweep in stages, with a whole solution after each (Feda & Purgathofer 1993).
//!
//! Every sweep is a breadth-first solution of its own with twice the rays of the one before; the estimate is their mean,
//! weighted with their rays. So there is something to look at soon, and no ray of it is wasted. Unbiased as every
//! [`Relaxation`]. Cost: one ray a sample.

use super::{Entry, breadth_first};
use crate::sampling::address::Address;
use crate::solvers::monte_carlo::relaxation::{Course, Relaxation};

/// Sweeps of a complete solution.
const SWEEPS: u32 = 4;

pub(super) const ENTRY: Entry = Entry {
    name: "staged",
    what: "as breadth-first, in sweeps of growing numbers of rays, each of them a whole solution",
    source: "Feda & Purgathofer 1993",
    pools: |_| true,
    natural_address: |_| Address::PerIteration,
    natural_replicates: 16,
    tells_light_apart: |_| true,
    check: |_| Ok(()),
    make: |problem, settings| {
        let course = Course { sweeps: SWEEPS, ..breadth_first::course() };
        Box::new(Relaxation::new(problem, settings, course))
    },
};
