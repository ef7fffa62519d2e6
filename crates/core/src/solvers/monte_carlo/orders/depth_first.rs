//! Depth first: light goes on as soon as it has landed.
//!
//! Along local lines that is the random walk, particle by particle ([`Walks`]). Along global lines it is multipath (Sbert,
//! Pueyo, Neumann & Purgathofer 1996): what has landed on an element leaves with the next line that crosses it, and what still
//! waits when the lines are used up is shot step by step. Whether it is biased is said there: [`Walks`],
//! `relaxation/multipath.rs`. Cost: one ray a visit; one line for all the elements that it crosses.

use super::Entry;
use crate::Error;
use crate::sampling::address::Address;
use crate::solvers::monte_carlo::Method;
use crate::solvers::monte_carlo::axes::{FirstShot, Lines, Survival, Walk};
use crate::solvers::monte_carlo::relaxation::{Course, Relaxation, Stage};
use crate::solvers::monte_carlo::walks::Walks;

/// Share of the rays for reflected light that multipath keeps for each step that shoots what waits when its lines are used up.
const LEFT_OVER_SHARE: f64 = 0.1;

pub(super) const ENTRY: Entry = Entry {
    name: "depth-first",
    what: "at once, particle by particle; where lines are global, with the next line",
    source: "Pattanaik & Mudur 1992; Sbert et al. 1996",
    pools: |lines| lines != Lines::Local,
    natural_address,
    // Multipath does so if the first shot is apart; a walk scores all its visits together.
    natural_replicates: 16,
    tells_light_apart: |method| method.lines != Lines::Local && method.first_shot == FirstShot::Local,
    check,
    make: |problem, settings| match settings.method.lines {
        Lines::Local => Box::new(Walks::new(problem, settings.method)),
        _ => Box::new(Relaxation::new(problem, settings, multipath(settings.method.first_shot))),
    },
};

fn natural_address(method: &Method) -> Address {
    match method.lines {
        Lines::Local if method.walk == Walk::Continuous || method.survival == Survival::Fraction => {
            Address::PerParticle
        }
        Lines::Local => Address::PerElement,
        _ => Address::PerIteration,
    }
}

fn check(method: &Method) -> Result<(), Error> {
    if method.lines == Lines::Bundle {
        let what = "the lines of a bundle have no order in which light could go from one to the next";
        return Err(Error::Meaningless { what, nearest: "--order breadth-first, or --lines global" });
    }
    Ok(())
}

fn multipath(first_shot: FirstShot) -> Course {
    let lines = Stage::Multipath { share: 1.0 - LEFT_OVER_SHARE };
    let left_over = Stage::Incremental { share: LEFT_OVER_SHARE, every_step: true };
    match first_shot {
        FirstShot::Same => Course::new(&[Stage::Lamps, lines, left_over]),
        FirstShot::Local => Course::new(&[Stage::Lamps, Stage::Emission, lines, left_over]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solvers::monte_carlo::orders::OrderName;

    #[test]
    fn bundles_are_refused() {
        let transillumination = Method::named("transillumination").unwrap();
        let error = Method { order: OrderName::DEPTH_FIRST, ..transillumination }.check().unwrap_err();
        assert!(error.to_string().contains("lines of a bundle have no order"), "{error}");
    }
}
