//! One complete solution: emission, incremental shooting, regular shooting, gathering.

use super::light::{Light, Origin};
use super::merging::{Merging, Variances, mean_irradiance, radiosity_variance};
use crate::Problem;
use crate::math::Rgb;
use crate::math::hash::{derive, unit_f64};
use crate::sampling::OwenSobol;
use crate::sampling::address::{Address, Counters};
use crate::solution::Balance;
use crate::solvers::allocation::Allocation;
use crate::solvers::{Part, gathering, shooting};
use std::ops::Range;

/// Share of a replicate's rays that shoot; the others gather.
const SHOOTING_SHARE: f64 = 0.6;
/// Incremental shooting stops when less than this share of the emitted power is unshot.
const UNSHOT_LIMIT: f64 = 1e-6;

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

/// What one replicate teaches the next about where rays are best spent. It never touches an expected value.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Experience {
    /// Reflected over emitted power.
    pub reflected_share: f64,
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

    fn next(self) -> Stage {
        match self {
            Stage::Lamps => Stage::Emission,
            Stage::Emission => Stage::Incremental,
            Stage::Incremental => Stage::Regular,
            Stage::Regular => Stage::Gathering,
            Stage::Gathering | Stage::Done => Stage::Done,
        }
    }
}

impl Experience {
    /// What to expect before anything is known: the closed room of mean reflectivity `rho` reflects `rho / (1 - rho)`
    /// of what is emitted.
    pub fn expected(problem: &Problem) -> Experience {
        let mesh = &problem.mesh;
        let weighted = |e| f64::from(mesh.area(e)) * f64::from(mesh.reflectivity(e).luminance());
        let rho = (mesh.elements().map(weighted).sum::<f64>() / mesh.total_area()).clamp(0.0, 0.95);
        Experience { reflected_share: rho / (1.0 - rho) }
    }
}

impl Relaxation {
    pub fn new(problem: &Problem, address: Address, seed: u64, rays: u64, experience: &Experience) -> Relaxation {
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
            light: Light::new(elements, lights > 0),
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
        let luminous_flux = move |i| (i, f64::from(self.flux(problem, stage, i).luminance()));
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
            let rays = self.rays_of_step(stage, experience);
            let u = unit_f64(derive(self.seed, self.step));
            self.step += 1;
            if stage == Stage::Gathering {
                self.merging = self.compare(problem);
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

    /// Rays for a step of `stage`; zero if there is nothing to do.
    ///
    /// Emission and reflection share the shooting rays by their expected power, so that all rays carry about the same;
    /// half of those for reflected light go to the incremental steps, half to the regular iteration.
    fn rays_of_step(&self, stage: Stage, experience: &Experience) -> u64 {
        let shooting = SHOOTING_SHARE * self.rays_planned as f64;
        let reflected_share = experience.reflected_share;
        let emission_rays = shooting / (1.0 + reflected_share);
        let share = self.shot / self.balance.emitted.max(f64::MIN_POSITIVE);
        let left = |rays: f64| (rays - self.rays_done as f64).max(0.0) as u64;
        match stage {
            Stage::Gathering if self.balance.emitted > 0.0 => left(self.rays_planned as f64),
            _ if self.shot <= 0.0 => 0,
            Stage::Lamps | Stage::Emission => (emission_rays * share).ceil() as u64,
            Stage::Incremental if share < UNSHOT_LIMIT => 0,
            Stage::Incremental => {
                let reflected_rays = 0.5 * (shooting - emission_rays);
                (reflected_rays * share / reflected_share.max(1e-3)).ceil().max(1.0) as u64
            }
            Stage::Regular => left(shooting),
            Stage::Gathering | Stage::Done => 0,
        }
    }

    /// Traces one piece of the running step.
    pub fn part(&self, problem: &Problem, piece: u64) -> Part {
        let sequence = &OwenSobol::new(self.address.sequence_seed(self.seed, self.step));
        let (counters, allocation) = (&self.counters, &self.allocation);
        if self.stage == Stage::Gathering {
            let sweep = gathering::Sweep { problem, sequence, counters, allocation };
            return sweep.gather(piece, |i, n, j| {
                let [direct, indirect] = self.merging.weights(problem.mesh.area(i), n);
                (problem.mesh.emission(j) * direct + self.reflected_radiosity(problem, j) * indirect) / n as f32
            });
        }
        let sweep = shooting::Sweep { problem, sequence, counters, allocation, total: self.shot };
        sweep.shoot(piece, |i| self.flux(problem, self.stage, i))
    }

    /// Takes in the next part; after the last one of the step, prepares the next step.
    pub fn absorb(&mut self, problem: &Problem, part: Part, experience: &Experience) {
        self.pieces_absorbed += 1;
        self.rays_done += part.rays;
        self.light.land(&part);
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

    /// Radiosity [lm/m²] that element `e` reflects.
    fn reflected_radiosity(&self, problem: &Problem, e: u32) -> Rgb {
        problem.mesh.reflectivity(e) * self.light.on(e) / problem.mesh.area(e)
    }

    /// The variances of shooting and gathering that this complete solution leads to expect.
    fn compare(&self, problem: &Problem) -> Merging {
        let mesh = &problem.mesh;
        // A line meets radiosity Be with probability E / Be: variance E Be, averaged over the emitted power.
        let (mut power, mut power_exitance) = (0.0, 0.0);
        for e in mesh.elements().filter(|&e| !mesh.emission(e).is_black()) {
            let emitted = f64::from(mesh.emitted_flux(e).luminance());
            power += emitted;
            power_exitance += emitted * f64::from(mesh.emission(e).luminance());
        }
        let direct = mean_irradiance(problem, &self.light.direct);
        let exitance = if power > 0.0 { power_exitance / power } else { 0.0 };
        let indirect = mean_irradiance(problem, &self.light.indirect);
        let indirect_ray_flux = self.reflected / self.reflected_rays.max(1) as f64;
        let variance = radiosity_variance(problem, |e| self.reflected_radiosity(problem, e));
        Merging {
            direct: Variances::new(direct, self.emission_ray_flux, direct * exitance),
            indirect: Variances::new(indirect, indirect_ray_flux, variance),
        }
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
            let shot = self.light.from_lamps(e) + shot_direct * (1.0 - direct) + shot_indirect * (1.0 - indirect);
            shot / area + self.light.landed(e)
        })
    }
}
