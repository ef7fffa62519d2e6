//! The steps of a relaxation: what each shoots, and along which lines.

use super::draw::Draw;
use super::{Relaxation, Stage};
use crate::Problem;
use crate::math::Rgb;
use crate::sampling::Sequence;
use crate::solvers::allocation::Allocation;
use crate::solvers::monte_carlo::axes::{FirstShot, Lines};
use crate::solvers::monte_carlo::sources;
use crate::solvers::{Part, gathering, shooting};
use crate::transport::Footprint;

impl Relaxation {
    /// Whether the lines of `stage` are the method's global ones.
    pub(super) fn uses_global_lines(&self, stage: Stage) -> bool {
        let first_shot = stage == Stage::Emission && self.method.first_shot == FirstShot::Same;
        self.method.lines != Lines::Local && (stage.reflects() || stage.is_multipath() || first_shot)
    }

    /// What source `i` shoots in `stage` [lm].
    fn flux(&self, problem: &Problem, stage: Stage, i: u32) -> Rgb {
        match stage {
            Stage::Lamps | Stage::Emission => sources::flux(problem, i),
            Stage::Multipath { .. } | Stage::Incremental { .. } => self.light.unshot(i),
            Stage::WarmUp { .. } | Stage::Averaged { .. } | Stage::Regular => {
                problem.mesh.reflectivity(i) * self.light.on(i)
            }
            Stage::Gathering => Rgb::BLACK,
        }
    }

    /// Luminous flux [lm] of every source of `stage`.
    pub(super) fn sources<'a>(
        &'a self,
        problem: &'a Problem,
        stage: Stage,
    ) -> Box<dyn Iterator<Item = (u32, f64)> + 'a> {
        let elements = problem.mesh.len() as u32;
        let luminous_flux = move |i| (i, self.flux(problem, stage, i).luminance_f64());
        match stage {
            Stage::Lamps => Box::new((elements..sources::count(problem) as u32).map(luminous_flux)),
            Stage::Multipath { .. } | Stage::Incremental { .. } => Box::new(self.light.active().map(luminous_flux)),
            _ => Box::new((0..elements).map(luminous_flux)),
        }
    }

    /// Computes one piece of a step of `stage`.
    pub(super) fn part_of(&self, stage: Stage, problem: &Problem, piece: u64) -> Part {
        let sequence = self.method.sequence.make(self.method.address.sequence_seed(self.seed, self.step));
        let sequence = sequence.as_ref();
        match &self.draw {
            Draw::Local(allocation) if stage == Stage::Gathering => self.gather(problem, allocation, sequence, piece),
            Draw::Local(allocation) => self.shoot(stage, problem, allocation, sequence, piece),
            Draw::Lines(lines) if stage.is_multipath() => lines.collect(problem, sequence, piece),
            Draw::Lines(lines) => lines.shoot(problem, sequence, piece, |i| self.flux(problem, stage, i)),
        }
    }

    fn shoot(
        &self,
        stage: Stage,
        problem: &Problem,
        allocation: &Allocation,
        sequence: &dyn Sequence,
        piece: u64,
    ) -> Part {
        let sweep = shooting::Sweep { problem, sequence, counters: &self.counters, allocation, total: self.shot };
        sweep.shoot(piece, |i| {
            let footprint = if stage.reflects() { self.light.footprint(i) } else { Footprint::WHOLE };
            (self.flux(problem, stage, i), footprint)
        })
    }

    fn gather(&self, problem: &Problem, allocation: &Allocation, sequence: &dyn Sequence, piece: u64) -> Part {
        let sweep = gathering::Sweep { problem, sequence, counters: &self.counters, allocation };
        let look = |j| (problem.mesh.emission(j), self.light.shown(j), self.light.footprint(j));
        sweep.gather(piece, look, |i, n, (emission, reflected, footprint), spot| {
            let [direct, indirect] = self.merging.weights(problem.mesh.area(i), n);
            (emission * direct + reflected * (footprint.density(spot) * indirect)) / n as f32
        })
    }
}
