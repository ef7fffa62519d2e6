//! Everything that is fast, in one complete solution: light is shot once, and every element then improves what landed on it.
//!
//! 1. *Shooting* (local lines, incremental): the power level, and a first irradiance, direct and indirect apart.
//! 2. *Direct light*: each element looks for the lights ([`direct`]).
//! 3. *Bundles*: elements gather what the others reflect, up to a level of radiosity, along bundles of parallel global lines
//!    ([`bundles`]).
//! 4. *Surplus*: what bright elements reflect beyond that level they shoot along local lines ([`surplus`], [`spread`]).
//! 5. *Local lines*: elements that few lines of a bundle cross gather all of it along rays of their own ([`local`]).
//!
//! Each estimate of direct and of indirect light is unbiased, and they are merged with weights that depend on what is expected, or on
//! earlier complete solutions, never on their own noise. What is gathered is noisy, but averages over many elements, and the noise is
//! another in each complete solution. How the rays are shared is decided in [`plan`], by what a *pilot* of few rays has told, which only
//! shoots and looks for the lights and is then forgotten. With few rays for each element all shoot.
//!
//! Unbiased but for the quotient of counted crossings of elements that have enough of them, of order 1 / N_i (see
//! [`crate::transport::bundle_gather`]). Bundles see elements of one radiosity, wherever light has landed on them. Cost: one ray a
//! sample; a crossing costs as much as an eighth of a ray.
//!
//! Memory: beside that of a [`Relaxation`] 8 bytes an element for rays of the surplus, 48 bytes an element while bundles gather, and 32
//! more for each of at most four pieces in flight.

mod bundles;
mod direct;
mod indirect;
mod local;
mod plan;
mod spread;
mod surplus;
mod surroundings;
#[cfg(test)]
mod tests;

use self::bundles::Bundles;
use self::direct::Direct;
use self::indirect::Indirect;
use self::local::Local;
use self::plan::Plan;
use self::spread::RayFlux;
use self::surplus::Surplus;
use super::complete::CompleteSolution;
use super::relaxation::{Course, Relaxation, Stage};
use super::{Experience, LightPart, Settings, sources};
use crate::Problem;
use crate::math::Rgb;
use crate::math::hash::{derive, unit_f64};
use crate::sampling::{Sequence, SequenceName};
use crate::solution::Balance;
use crate::solvers::Part;
use std::ops::Range;

/// With fewer rays an element than this there is no time to look around.
const FEWEST_RAYS: u64 = 4;
/// The pilot shoots this share of the rays of the first complete solution.
const PILOT: u64 = 8;

/// What is being done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
enum Phase {
    Shooting,
    Direct,
    Bundles,
    Surplus,
    Local,
    Done,
}

/// The state of one complete solution, and what it has learned from those before.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
pub struct Auto {
    sequence: SequenceName,
    wanted: LightPart,
    seed: u64,
    phase: Phase,
    /// Luminous flux of all lights [lm].
    emitted: f64,
    /// The running plan, and for how many rays it was made.
    plan: Plan,
    planned_for: u64,
    ray_flux: RayFlux,
    /// What surroundings leave of noise.
    lasting_noise: f64,
    /// Rays, or what costs as much: of the pilot, and of the phases after shooting.
    rays_of_pilot: u64,
    rays_after: u64,
    /// Seed and rays of the complete solution that follows the running pilot.
    after_pilot: Option<(u64, u64)>,
    shooting: Relaxation,
    direct: Direct,
    bundles: Bundles,
    surplus: Surplus,
    local: Local,
    /// What the last complete solution has told of indirect light.
    indirect: Indirect,
}

impl Auto {
    /// Ready to be started.
    pub fn new(problem: &Problem, settings: &Settings) -> Auto {
        let stages = [Stage::Lamps, Stage::Emission, Stage::Incremental { share: 1.0, every_step: false }];
        Auto {
            sequence: settings.method.sequence,
            wanted: settings.light,
            seed: settings.seed,
            phase: Phase::Done,
            emitted: sources::total(problem),
            plan: Plan::default(),
            planned_for: 0,
            ray_flux: RayFlux::default(),
            lasting_noise: surroundings::lasting_noise(problem),
            rays_of_pilot: 0,
            rays_after: 0,
            after_pilot: None,
            shooting: Relaxation::new(problem, settings, Course::new(&stages)),
            direct: Direct::new(problem, settings),
            bundles: Bundles::default(),
            surplus: Surplus::default(),
            local: Local::default(),
            indirect: Indirect::default(),
        }
    }

    /// Begins the next phase that has something to do.
    fn next_phase(&mut self, problem: &Problem) {
        self.phase = match self.phase {
            Phase::Shooting => {
                self.ray_flux = self.plan.ray_flux(self.power(self.shooting.experience()));
                match self.after_pilot {
                    Some(_) if self.wanted == LightPart::All => self.direct.begin_trial(),
                    _ => self.direct.begin(problem, self.plan.direct, self.ray_flux[0]),
                }
                Phase::Direct
            }
            Phase::Direct => {
                self.indirect = Indirect::of(problem, &self.shooting, self.ray_flux, self.lasting_noise);
                let surplus = self.plan.surplus as f64 / problem.mesh.total_area();
                let known = |bundles, crossings| self.indirect.precision(self.ray_flux, bundles, crossings, surplus);
                self.bundles.begin(problem, self.plan.bundles, known, self.shooting.light());
                Phase::Bundles
            }
            Phase::Bundles => {
                let u = unit_f64(derive(self.seed, Phase::Surplus as u64));
                let rays = if self.plan.bundles > 0 { self.plan.surplus } else { 0 };
                self.surplus.begin(problem, rays, self.bundles.precision().level(), u, &mut self.shooting);
                Phase::Surplus
            }
            Phase::Surplus => {
                self.bundles.merge(problem, &mut self.shooting);
                let u = unit_f64(derive(self.seed, Phase::Local as u64));
                self.local.begin(problem, self.plan.local, self.bundles.precision(), u, &mut self.shooting);
                Phase::Local
            }
            Phase::Local | Phase::Done => Phase::Done,
        };
        self.skip_idle_phases(problem);
    }

    /// Begins the next phase if the running one has nothing to do, and after the pilot what it was for.
    fn skip_idle_phases(&mut self, problem: &Problem) {
        if self.phase != Phase::Done {
            if self.pieces_of_phase().is_empty() {
                self.next_phase(problem);
            }
        } else if let Some((seed, rays)) = self.after_pilot.take() {
            let experience = self.shooting.experience();
            self.rays_of_pilot = self.shooting.rays() + self.rays_after;
            self.plan_for(problem, rays, &experience);
            self.begin(problem, seed, &experience);
        }
    }

    fn pieces_of_phase(&self) -> Range<u64> {
        match self.phase {
            Phase::Shooting => self.shooting.pieces().unwrap_or(0..0),
            Phase::Direct => self.direct.pieces(),
            Phase::Bundles => self.bundles.pieces(),
            Phase::Surplus => self.surplus.pieces(),
            Phase::Local => self.local.pieces(),
            Phase::Done => 0..0,
        }
    }

    /// Flux [lm] that is emitted, and reflected.
    fn power(&self, experience: Experience) -> [f64; 2] {
        [self.emitted, self.emitted * experience.reflected_share]
    }

    /// Makes the best plan for complete solutions of so many `rays`, by what the last one or the pilot has told.
    fn plan_for(&mut self, problem: &Problem, rays: u64, experience: &Experience) {
        let direct = (self.wanted == LightPart::All).then(|| self.direct.learned());
        self.plan = Plan::best(problem, rays, self.power(*experience), direct, &self.indirect);
        self.planned_for = rays;
    }

    /// Begins to shoot by the running plan.
    fn begin(&mut self, problem: &Problem, seed: u64, experience: &Experience) {
        (self.seed, self.rays_after, self.phase) = (seed, 0, Phase::Shooting);
        // Incremental shooting takes as many rays as are planned, whatever share of them the power deserves: as if surfaces reflected as
        // much. Where they reflect next to nothing it may take more of them than it needs, but a thousand times at most.
        let planned = self.plan.experience();
        let share = planned.reflected_share / experience.reflected_share.max(planned.reflected_share * 1e-3);
        self.shooting.set_share_of_incremental(share, self.plan.ray_flux(self.power(*experience)));
        self.shooting.restart(problem, seed, self.plan.emission + self.plan.reflection, &planned);
        self.skip_idle_phases(problem);
    }

    /// The numbers of the running phase, independent of those of the others.
    fn numbers(&self) -> Box<dyn Sequence> {
        self.sequence.make(derive(self.seed, u64::MAX - self.phase as u64))
    }
}

#[typetag::serde]
impl CompleteSolution for Auto {
    fn restart(&mut self, problem: &Problem, seed: u64, rays: u64, experience: &Experience) {
        (self.rays_of_pilot, self.after_pilot) = (0, None);
        let mut first_seed = seed;
        if rays == self.planned_for {
            // The plan stays for all complete solutions of as many rays.
        } else if rays < FEWEST_RAYS * problem.mesh.len() as u64 {
            (self.plan, self.planned_for) = (Plan::only_shooting(rays, experience.reflected_share), 0);
        } else if self.planned_for == 0 {
            self.plan = Plan::only_shooting(rays / PILOT, experience.reflected_share);
            (first_seed, self.after_pilot) = (derive(seed, PILOT), Some((seed, rays)));
        } else {
            self.plan_for(problem, rays, experience);
        }
        self.begin(problem, first_seed, experience);
    }

    fn pieces(&self) -> Option<Range<u64>> {
        (self.phase != Phase::Done).then(|| self.pieces_of_phase())
    }

    fn part(&self, problem: &Problem, piece: u64) -> Part {
        match self.phase {
            Phase::Shooting => self.shooting.part(problem, piece),
            Phase::Direct => self.direct.part(problem, piece),
            Phase::Bundles => self.bundles.part(problem, self.numbers().as_ref(), piece),
            Phase::Surplus => self.surplus.part(problem, self.numbers().as_ref(), self.shooting.light(), piece),
            Phase::Local => self.local.part(problem, self.numbers().as_ref(), &self.shooting, piece),
            Phase::Done => Part::default(),
        }
    }

    fn absorb(&mut self, problem: &Problem, part: Part, _: &Experience) {
        if self.phase != Phase::Shooting {
            self.rays_after += part.rays;
        }
        let complete = match self.phase {
            Phase::Shooting => {
                self.shooting.absorb(problem, part, &self.plan.experience());
                self.shooting.pieces().is_none()
            }
            Phase::Direct => self.direct.absorb(problem, &part, &mut self.shooting),
            Phase::Bundles => self.bundles.absorb(&part),
            Phase::Surplus => self.surplus.absorb(&part, &mut self.shooting),
            Phase::Local => self.local.absorb(problem, &part, &mut self.shooting),
            Phase::Done => false,
        };
        if complete {
            self.next_phase(problem);
        }
    }

    fn irradiance(&self, problem: &Problem, e: u32) -> Rgb {
        self.shooting.irradiance(problem, e)
    }

    fn fits(&self, problem: &Problem) -> bool {
        self.shooting.fits(problem) && self.direct.fits(problem) && self.bundles.fits(problem)
    }

    fn rays(&self) -> u64 {
        self.rays_of_pilot + self.shooting.rays() + self.rays_after
    }

    fn balance(&self) -> Balance {
        self.shooting.balance()
    }

    fn retire(&mut self) {
        self.shooting.retire();
        (self.surplus, self.local) = (Surplus::default(), Local::default());
    }

    fn experience(&self) -> Experience {
        self.shooting.experience()
    }

    fn stage(&self) -> &'static str {
        match self.phase {
            _ if self.after_pilot.is_some() => "looking where rays pay",
            Phase::Shooting => self.shooting.stage(),
            Phase::Direct => "looking for the lights",
            Phase::Bundles => "gathering along bundles",
            Phase::Surplus => "shooting from bright surfaces",
            Phase::Local => "gathering along local lines",
            Phase::Done => "done",
        }
    }
}
