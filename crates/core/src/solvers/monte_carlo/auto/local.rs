//! What elements gather along local lines, those above all that few lines of a bundle cross.
//!
//! An element whose indirect light is known as well as n lines would tell it gets as many lines as it lacks: the merged variance is
//! then the same for all elements that gather, and the sum of the variances is least (Lagrange).

use super::indirect::Precision;
use crate::Problem;
use crate::sampling::Sequence;
use crate::sampling::address::Counters;
use crate::solvers::allocation::{Allocation, SAMPLE};
use crate::solvers::monte_carlo::relaxation::Relaxation;
use crate::solvers::{Part, gathering, shooting};
use std::ops::Range;

#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Local {
    allocation: Allocation,
    absorbed: u64,
    /// How well indirect light is known before.
    known: Precision,
}

impl Local {
    /// Begins anew with so many `rays`, where indirect light is `known` so well; `u` in [0, 1).
    pub fn begin(&mut self, problem: &Problem, rays: u64, known: Precision, u: f64, shot: &mut Relaxation) {
        (self.absorbed, self.known) = (0, known);
        if rays == 0 {
            self.allocation = Allocation::default();
            return;
        }
        shot.light_mut().show(&problem.mesh);
        let area = |e| f64::from(problem.mesh.area(e));
        let every = problem.mesh.len().div_ceil(SAMPLE);
        let limit = known.limit(problem.mesh.elements().step_by(every).map(area), rays as f64 / every as f64);
        let lacking = |e| (limit - known.lines(area(e))).max(0.0);
        let all = problem.mesh.elements().map(lacking).sum();
        let weights = problem.mesh.elements().map(|e| (e, lacking(e)));
        self.allocation = Allocation::systematic(weights, all, rays, u);
    }

    pub fn pieces(&self) -> Range<u64> {
        self.absorbed..shooting::pieces(self.allocation.rays())
    }

    /// Gathers along the lines of `piece` what elements reflect in `shot`.
    pub fn part(&self, problem: &Problem, sequence: &dyn Sequence, shot: &Relaxation, piece: u64) -> Part {
        let (counters, light) = (Counters::default(), shot.light());
        let sweep = gathering::Sweep { problem, sequence, counters: &counters, allocation: &self.allocation };
        let look = |seen| (light.shown(seen), light.footprint(seen));
        sweep.gather(piece, look, |_, n, (radiosity, footprint), spot| radiosity * footprint.density(spot) / n as f32)
    }

    /// Takes in the next piece in order, and merges all of it with `shot` after the last; whether it was that.
    pub fn absorb(&mut self, problem: &Problem, part: &Part, shot: &mut Relaxation) -> bool {
        shot.light_mut().land(part);
        self.absorbed += 1;
        let complete = self.absorbed == self.pieces().end;
        if complete {
            for (e, n) in self.allocation.counts() {
                let (area, n) = (problem.mesh.area(e), f64::from(n));
                shot.light_mut().merge_landed(e, area, (n / (n + self.known.lines(area.into()))) as f32);
            }
        }
        complete
    }
}
