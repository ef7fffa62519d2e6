//! What bright elements reflect beyond the level up to which others gather from them: they shoot it along local lines.

use crate::Problem;
use crate::sampling::Sequence;
use crate::sampling::address::Counters;
use crate::solvers::allocation::Allocation;
use crate::solvers::monte_carlo::light::Light;
use crate::solvers::monte_carlo::relaxation::Relaxation;
use crate::solvers::{Part, shooting};
use std::ops::Range;

#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Surplus {
    /// [lm/m²].
    level: f64,
    allocation: Allocation,
    /// Luminous flux of all rays [lm].
    total: f64,
    absorbed: u64,
}

impl Surplus {
    /// Begins anew: what elements reflect beyond `level` [lm/m²] is shot by so many `rays`; `u` in [0, 1).
    pub fn begin(&mut self, problem: &Problem, rays: u64, level: f64, u: f64, shot: &mut Relaxation) {
        (self.level, self.absorbed) = (level, 0);
        self.allocation = Allocation::default();
        if rays == 0 || level.is_infinite() {
            return;
        }
        let beyond = |e| {
            let radiosity = shot.light().reflected_radiosity(&problem.mesh, e).luminance_f64();
            (e, f64::from(problem.mesh.area(e)) * (radiosity - level).max(0.0))
        };
        self.total = problem.mesh.elements().map(|e| beyond(e).1).sum();
        self.allocation = Allocation::systematic(problem.mesh.elements().map(beyond), self.total, rays, u);
        shot.light_mut().expect(u64::MAX);
    }

    pub fn pieces(&self) -> Range<u64> {
        self.absorbed..shooting::pieces(self.allocation.rays())
    }

    /// Shoots the rays of `piece`.
    pub fn part(&self, problem: &Problem, sequence: &dyn Sequence, light: &Light, piece: u64) -> Part {
        let (counters, allocation, total) = (Counters::default(), &self.allocation, self.total);
        let sweep = shooting::Sweep { problem, sequence, counters: &counters, allocation, total };
        // Of the same colour as all that the element reflects; its rays carry a share of the total, whatever they are told here.
        sweep.shoot(piece, |e| (light.reflected_radiosity(&problem.mesh, e), light.footprint(e)))
    }

    /// Takes in the next piece in order; whether it was the last.
    pub fn absorb(&mut self, part: &Part, shot: &mut Relaxation) -> bool {
        shot.light_mut().land(part);
        self.absorbed += 1;
        self.absorbed == self.pieces().end
    }
}
