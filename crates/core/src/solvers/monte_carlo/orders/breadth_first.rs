//! Breadth first: all landed light is shot in the next step, until none is left (Shirley 1991).
//!
//! With the emitted power `D_0 = Pe`, step k shoots `D_k` and lands `D_(k+1) = rho F D_k`; the solution is the sum of all
//! steps, and the rays of each are in proportion to what it shoots. Unbiased as every [`Relaxation`]. Cost: one ray a sample.

use super::Entry;
use crate::sampling::address::Address;
use crate::solvers::monte_carlo::relaxation::{Course, Relaxation, Stage};

pub(super) const ENTRY: Entry = Entry {
    name: "breadth-first",
    what: "all of it in the next step, until none is left",
    source: "Shirley 1991",
    pools: |_| true,
    natural_address: |_| Address::PerIteration,
    natural_replicates: 16,
    tells_light_apart: |_| true,
    check: |_| Ok(()),
    make: |problem, settings| Box::new(Relaxation::new(problem, settings, course())),
};

/// One sweep.
pub(super) fn course() -> Course {
    Course::new(&[Stage::Lamps, Stage::Emission, Stage::Incremental { share: 1.0, every_step: false }])
}
