//! Stochastic Jacobi radiosity: all landed light until none is left, then the whole once more, then gathering (Bekaert 1999).
//!
//! Incremental steps give a first solution, the regular iteration (Neumann et al. 1995) shoots all that it reflects, and the
//! two are averaged by their rays. Along local lines further rays gather where shooting is noisy, on small elements, and the
//! two are merged by their variances. Unbiased as every [`Relaxation`]. Cost: one ray a sample.

use super::Entry;
use crate::sampling::address::Address;
use crate::solvers::monte_carlo::axes::Lines;
use crate::solvers::monte_carlo::relaxation::{Course, Relaxation, Stage};

/// Share of the rays that shoot where the others gather.
const SHOOTING_SHARE: f64 = 0.6;
/// Share of the shooting rays for reflected light that shoot it step by step; the others shoot the whole once more.
const INCREMENTAL_SHARE: f64 = 0.5;

pub(super) const ENTRY: Entry = Entry {
    name: "stochastic-jacobi",
    what: "all of it until none is left, then the whole once more; local lines then gather",
    source: "Neumann et al. 1995; Bekaert 1999",
    pools: |_| true,
    natural_address: |_| Address::PerIteration,
    natural_replicates: 16,
    tells_light_apart: |_| true,
    check: |_| Ok(()),
    make: |problem, settings| Box::new(Relaxation::new(problem, settings, course(settings.method.lines))),
};

fn course(lines: Lines) -> Course {
    let incremental = Stage::Incremental { share: INCREMENTAL_SHARE, every_step: false };
    let mut course = Course::new(&[Stage::Lamps, Stage::Emission, incremental, Stage::Regular]);
    if lines == Lines::Local {
        course.stages.push(Stage::Gathering);
        course.shooting = SHOOTING_SHARE;
    }
    course
}
