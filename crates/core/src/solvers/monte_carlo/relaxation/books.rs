//! The ends of steps: what has landed falls on its element, and the books are kept.

use super::draw::Draw;
use super::{Relaxation, Stage};
use crate::Problem;
use crate::solution::Balance;
use crate::solvers::monte_carlo::light::{Light, Origin};

impl Relaxation {
    /// Ends a step of `stage`, as the stage wants it.
    pub(super) fn settle(&mut self, stage: Stage, problem: &Problem) {
        let rays = self.draw.rays();
        match stage {
            Stage::Lamps => self.reflect(problem, Origin::Lamps),
            Stage::Emission => {
                self.emission_ray_flux = self.shot / rays as f64;
                self.reflect(problem, Origin::Emission);
                self.direct_balance = self.balance;
            }
            Stage::Multipath { .. } => {
                self.reflected_rays += rays;
                self.end_multipath();
            }
            Stage::Incremental { .. } => {
                self.reflected_rays += rays;
                self.light.spend_unshot();
                self.reflect(problem, Origin::Reflection);
            }
            Stage::WarmUp { .. } => self.iterate(problem, 1.0),
            Stage::Averaged { .. } => self.iterate(problem, 1.0 / self.iteration as f32),
            Stage::Regular => {
                self.light.average_in(rays as f32 / (rays + self.reflected_rays) as f32);
                self.reflected_rays += rays;
            }
            Stage::Gathering => self.merge_gathered(problem),
        }
    }

    /// Ends the lines of multipath: what still waits on elements is to be shot by others.
    fn end_multipath(&mut self) {
        self.light.find_active();
        self.balance.escaped += self.lost[0];
        self.balance.back_face += self.lost[1];
        self.balance.unshot = self.light.unshot_total() + self.adrift;
    }

    /// Ends a step that shot light for the first time, and keeps the books.
    fn reflect(&mut self, problem: &Problem, origin: Origin) {
        let landed = self.light.reflect(&problem.mesh, origin);
        self.balance.escaped += self.lost[0];
        self.balance.back_face += self.lost[1];
        self.balance.absorbed += landed.absorbed;
        self.reflected += landed.reflected;
        if matches!(self.draw, Draw::Lines(_)) {
            self.adrift += self.shot - landed.absorbed - landed.reflected - self.lost[0] - self.lost[1];
        }
        let still_to_emit = if origin == Origin::Lamps { self.balance.emitted - self.shot } else { 0.0 };
        self.balance.unshot = self.light.unshot_total() + still_to_emit + self.adrift;
    }

    /// Ends an iteration that shot all reflected light, and is averaged in with weight `share`. With the means over the
    /// averaged iterations, what is shot is what lands and what is lost; the balance's unshot light is what the light reflected
    /// now differs from what was shot: the noise of the iterations.
    fn iterate(&mut self, problem: &Problem, share: f32) {
        self.light.average_in(share);
        let share = f64::from(share);
        let Balance { emitted, escaped, back_face, .. } = self.direct_balance;
        let average = |direct: f64, mean: f64, now: f64| direct + (mean - direct) * (1.0 - share) + now * share;
        self.balance.escaped = average(escaped, self.balance.escaped, self.lost[0]);
        self.balance.back_face = average(back_face, self.balance.back_face, self.lost[1]);
        let mesh = &problem.mesh;
        let reflected = |e: u32| (mesh.reflectivity(e) * self.light.on(e)).luminance_f64();
        let landed = |e: u32| self.light.on(e).luminance_f64();
        self.reflected = mesh.elements().map(reflected).sum();
        self.balance.absorbed = mesh.elements().map(landed).sum::<f64>() - self.reflected;
        self.balance.unshot = emitted - self.balance.absorbed - self.balance.escaped - self.balance.back_face;
    }

    /// The light as it stands.
    pub fn light(&self) -> &Light {
        &self.light
    }

    /// The light, to be improved by others.
    pub fn light_mut(&mut self) -> &mut Light {
        &mut self.light
    }

    /// Flux [lm] of the rays that carried reflected light, were it spread evenly over them.
    pub(super) fn reflected_ray_flux(&self) -> f64 {
        self.reflected / self.reflected_rays.max(1) as f64
    }

    /// Merges what was gathered with what was shot.
    fn merge_gathered(&mut self, problem: &Problem) {
        let Draw::Local(allocation) = &self.draw else { return };
        for (e, n) in allocation.counts() {
            let area = problem.mesh.area(e);
            let gathered = self.light.landed(e) * area;
            self.light.merge(e, gathered, self.merging.weights(area, n));
        }
    }
}
