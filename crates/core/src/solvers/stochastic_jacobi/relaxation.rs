//! One complete solution: emission, incremental shooting, regular shooting, gathering.

use super::light::{Light, Origin};
use super::merging::Merging;
use super::plan::{Experience, Plan};
use crate::Problem;
use crate::math::Rgb;
use crate::math::hash::{derive, unit_f64};
use crate::sampling::OwenSobol;
use crate::sampling::address::{Address, Counters};
use crate::solution::Balance;
use crate::solvers::allocation::Allocation;
use crate::solvers::{Part, gathering, shooting};
use crate::transport::{Footprint, Leaving};
use std::ops::Range;

/// What the running step does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Stage {
    /// Lights without extent shoot what they emit.
    Lamps,
    /// Surfaces shoot what they emit.
    Emission,
    /// Surfaces shoot what they have not shot yet, again and again.
    Incremental,
    /// Surfaces shoot all they reflect, once.
    Regular,
    Gathering,
    Done,
}

/// The state of one complete solution.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Relaxation {
    seed: u64,
    rays_planned: u64,
    rays_done: u64,
    stage: Stage,
    step: u64,
    pieces_absorbed: u64,
    allocation: Allocation,
    address: Address,
    counters: Counters,
    light: Light,
    /// Luminous flux [lm] that the running step shoots.
    shot: f64,
    /// Flux [lm] of each ray that left an emitting surface.
    emission_ray_flux: f64,
    /// Rays of incremental and regular shooting.
    reflected_rays: u64,
    /// All luminous flux reflected so far [lm].
    reflected: f64,
    merging: Merging,
    balance: Balance,
}

impl Stage {
    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Lamps | Stage::Emission => "shooting direct light",
            Stage::Incremental => "shooting reflected light",
            Stage::Regular => "shooting all light again",
            Stage::Gathering => "gathering",
            Stage::Done => "done",
        }
    }

    pub fn next(self) -> Stage {
        match self {
            Stage::Lamps => Stage::Emission,
            Stage::Emission => Stage::Incremental,
            Stage::Incremental => Stage::Regular,
            Stage::Regular => Stage::Gathering,
            Stage::Gathering | Stage::Done => Stage::Done,
        }
    }
}

impl Relaxation {
    pub fn new(
        problem: &Problem,
        (address, leaving): (Address, Leaving),
        seed: u64,
        rays: u64,
        experience: &Experience,
    ) -> Relaxation {
        let (elements, lights) = (problem.mesh.len(), problem.scene.lights.len());
        let mut relaxation = Relaxation {
            seed,
            rays_planned: rays,
            rays_done: 0,
            stage: Stage::Lamps,
            step: 0,
            pieces_absorbed: 0,
            allocation: Allocation::default(),
            address,
            counters: address.counters(elements + lights),
            light: Light::new(elements, lights > 0, leaving),
            shot: 0.0,
            emission_ray_flux: 0.0,
            reflected_rays: 0,
            reflected: 0.0,
            merging: Merging::default(),
            balance: Balance::default(),
        };
        relaxation.restart(problem, seed, rays, experience);
        relaxation
    }

    /// Starts an independent complete solution in the same memory.
    pub fn restart(&mut self, problem: &Problem, seed: u64, rays: u64, experience: &Experience) {
        self.seed = seed;
        self.rays_planned = rays;
        (self.rays_done, self.step, self.reflected_rays) = (0, 0, 0);
        (self.emission_ray_flux, self.reflected) = (0.0, 0.0);
        self.counters.reset();
        self.light.clear();
        let emitted = self.source_flux(problem, Stage::Lamps) + self.source_flux(problem, Stage::Emission);
        self.balance = Balance { emitted, unshot: emitted, ..Balance::default() };
        self.enter(Stage::Lamps, problem, experience);
    }

    pub fn stage(&self) -> Stage {
        self.stage
    }

    pub fn rays(&self) -> u64 {
        self.rays_done
    }

    pub fn balance(&self) -> Balance {
        self.balance
    }

    pub fn unshot_share(&self) -> f64 {
        self.balance.unshot / self.balance.emitted.max(f64::MIN_POSITIVE)
    }

    /// What this complete solution teaches the next one.
    pub fn experience(&self) -> Experience {
        Experience { reflected_share: self.reflected / self.balance.emitted.max(f64::MIN_POSITIVE) }
    }

    /// Irradiance [lux] of element `e` as far as the running complete solution has come.
    pub fn irradiance_so_far(&self, problem: &Problem, e: u32) -> Rgb {
        self.light.on(e) / problem.mesh.area(e)
    }

    pub fn pieces(&self) -> Range<u64> {
        0..shooting::pieces(self.allocation.rays())
    }

    /// What source `i` shoots in `stage` [lm].
    fn flux(&self, problem: &Problem, stage: Stage, i: u32) -> Rgb {
        match stage {
            Stage::Lamps => {
                let light = &problem.scene.lights[i as usize - problem.mesh.len()];
                light.flux(problem.geometry.bounding_sphere().1)
            }
            Stage::Emission => problem.mesh.emitted_flux(i),
            Stage::Incremental => self.light.unshot(i),
            Stage::Regular => problem.mesh.reflectivity(i) * self.light.on(i),
            Stage::Gathering | Stage::Done => Rgb::BLACK,
        }
    }

    /// Luminous flux [lm] of every source of `stage`.
    fn sources<'a>(&'a self, problem: &'a Problem, stage: Stage) -> Box<dyn Iterator<Item = (u32, f64)> + 'a> {
        let elements = problem.mesh.len() as u32;
        let luminous_flux = move |i| (i, self.flux(problem, stage, i).luminance_f64());
        match stage {
            Stage::Lamps => Box::new((elements..elements + problem.scene.lights.len() as u32).map(luminous_flux)),
            Stage::Incremental => Box::new(self.light.active().map(luminous_flux)),
            _ => Box::new((0..elements).map(luminous_flux)),
        }
    }

    fn source_flux(&self, problem: &Problem, stage: Stage) -> f64 {
        self.sources(problem, stage).map(|(_, flux)| flux).sum()
    }

    /// Prepares the next step of `stage`, or of the first stage after it that has something to do.
    fn enter(&mut self, stage: Stage, problem: &Problem, experience: &Experience) {
        let mut stage = stage;
        while stage != Stage::Done {
            self.shot = self.source_flux(problem, stage);
            let plan = Plan { rays: self.rays_planned, reflected_share: experience.reflected_share };
            let share = self.shot / self.balance.emitted.max(f64::MIN_POSITIVE);
            let rays = plan.rays_of_step(stage, share, self.rays_done);
            let u = unit_f64(derive(self.seed, self.step));
            self.step += 1;
            if stage == Stage::Gathering {
                self.merging = Merging::expect(problem, &self.light, self.emission_ray_flux, self.reflected_ray_flux());
                self.allocation = self.merging.allocate(problem, rays, u);
            } else {
                self.allocation = Allocation::systematic(self.sources(problem, stage), self.shot, rays, u);
                self.light.expect(rays);
            }
            if self.allocation.rays() > 0 {
                break;
            }
            stage = stage.next();
        }
        self.stage = stage;
        self.pieces_absorbed = 0;
    }

    /// Traces one piece of the running step.
    pub fn part(&self, problem: &Problem, piece: u64) -> Part {
        let sequence = &OwenSobol::new(self.address.sequence_seed(self.seed, self.step));
        let (counters, allocation) = (&self.counters, &self.allocation);
        if self.stage == Stage::Gathering {
            let sweep = gathering::Sweep { problem, sequence, counters, allocation };
            return sweep.gather(piece, |i, n, j, spot| {
                let [direct, indirect] = self.merging.weights(problem.mesh.area(i), n);
                (problem.mesh.emission(j) * direct + self.light.seen_radiosity(&problem.mesh, j, spot) * indirect)
                    / n as f32
            });
        }
        let sweep = shooting::Sweep { problem, sequence, counters, allocation, total: self.shot };
        let reflects = matches!(self.stage, Stage::Incremental | Stage::Regular);
        sweep.shoot(piece, |i| {
            let footprint = if reflects { self.light.footprint(i) } else { Footprint::WHOLE };
            (self.flux(problem, self.stage, i), footprint)
        })
    }

    /// Takes in the next part; after the last one of the step, prepares the next step.
    pub fn absorb(&mut self, problem: &Problem, part: Part, experience: &Experience) {
        self.pieces_absorbed += 1;
        self.rays_done += part.rays;
        self.light.land(&part);
        if self.stage != Stage::Gathering {
            self.light.mark(&part);
        }
        if matches!(self.stage, Stage::Lamps | Stage::Emission | Stage::Incremental) {
            self.balance.escaped += part.escaped;
            self.balance.back_face += part.back_face;
        }
        if self.pieces_absorbed == self.pieces().end {
            self.finish_step(problem, experience);
        }
    }

    fn finish_step(&mut self, problem: &Problem, experience: &Experience) {
        for (source, count) in self.allocation.counts() {
            self.counters.advance(source, count);
        }
        let rays = self.allocation.rays();
        match self.stage {
            Stage::Lamps => self.reflect(problem, Origin::Lamps),
            Stage::Emission => {
                self.emission_ray_flux = self.shot / rays as f64;
                self.reflect(problem, Origin::Emission);
            }
            Stage::Incremental => {
                self.reflected_rays += rays;
                self.light.spend_unshot();
                self.reflect(problem, Origin::Reflection);
                return self.enter(Stage::Incremental, problem, experience);
            }
            Stage::Regular => {
                self.light.average_in(rays as f32 / (rays + self.reflected_rays) as f32);
                self.reflected_rays += rays;
            }
            // What was gathered stays landed until the estimate is read.
            Stage::Gathering | Stage::Done => {}
        }
        self.enter(self.stage.next(), problem, experience);
    }

    /// Ends a step that shot light for the first time, and keeps the books.
    fn reflect(&mut self, problem: &Problem, origin: Origin) {
        let landed = self.light.reflect(&problem.mesh, origin);
        self.balance.absorbed += landed.absorbed;
        self.reflected += landed.reflected;
        let still_to_emit = if origin == Origin::Lamps { self.balance.emitted - self.shot } else { 0.0 };
        self.balance.unshot = self.light.unshot_total() + still_to_emit;
    }

    /// Flux [lm] of the rays that carried reflected light, were it spread evenly over them.
    fn reflected_ray_flux(&self) -> f64 {
        self.reflected / self.reflected_rays.max(1) as f64
    }

    /// Irradiance [lux] of every element of a finished complete solution, gathered light merged in.
    pub fn irradiance<'a>(&'a self, problem: &'a Problem) -> impl Iterator<Item = Rgb> + 'a {
        let mut gathered = self.allocation.counts().peekable();
        problem.mesh.elements().map(move |e| {
            let area = problem.mesh.area(e);
            let [direct, indirect] = match gathered.next_if(|&(element, _)| element == e) {
                Some((_, n)) => self.merging.weights(area, n),
                None => [0.0; 2],
            };
            let k = e as usize;
            let (shot_direct, shot_indirect) = (self.light.direct[k], self.light.indirect[k]);
            let shot = self.light.lamp_flux(e) + shot_direct * (1.0 - direct) + shot_indirect * (1.0 - indirect);
            shot / area + self.light.landed(e)
        })
    }
}
