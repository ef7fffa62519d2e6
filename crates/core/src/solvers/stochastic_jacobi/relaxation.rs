//! One complete solution: emission, incremental shooting, regular shooting, gathering.
//!
//! Light is kept as the flux that falls on each element, in two parts that converge differently: *direct* light comes
//! straight from a source (lights without extent apart, for nothing can gather them), *indirect* light from a reflection.

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
    Lamps,
    Emission,
    Incremental,
    Regular,
    Gathering,
    Done,
}

impl Stage {
    pub fn name(self) -> &'static str {
        match self {
            Stage::Lamps | Stage::Emission => "shooting direct light",
            Stage::Incremental => "shooting reflected light",
            Stage::Regular => "shooting all light again",
            Stage::Gathering => "gathering",
            Stage::Done => "done",
        }
    }
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
    /// Flux [lm] on each element from lights without extent; empty in a scene without them.
    lamps: Vec<Rgb>,
    direct: Vec<Rgb>,
    indirect: Vec<Rgb>,
    /// Flux [lm] that each element has yet to shoot.
    unshot: Vec<Rgb>,
    /// The elements that have unshot flux, in order.
    active: Vec<u32>,
    /// What has landed in the running step.
    landed: Vec<[f64; 3]>,
    /// In a step of few rays, the elements on which something has landed; late steps must not cost as much as early ones.
    touched: Option<Vec<u32>>,
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
        let elements = problem.mesh.len();
        let lights = problem.scene.lights.len();
        let dark = || vec![Rgb::BLACK; elements];
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
            lamps: if lights > 0 { dark() } else { Vec::new() },
            direct: dark(),
            indirect: dark(),
            unshot: dark(),
            active: Vec::new(),
            touched: None,
            landed: vec![[0.0; 3]; elements],
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
        self.counters.reset();
        for flux in [&mut self.lamps, &mut self.direct, &mut self.indirect, &mut self.unshot] {
            flux.fill(Rgb::BLACK);
        }
        self.active.clear();
        self.landed.fill([0.0; 3]);
        (self.emission_ray_flux, self.reflected) = (0.0, 0.0);
        let emitted = self.emitted(problem);
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

    pub fn pieces(&self) -> Range<u64> {
        0..shooting::pieces(self.allocation.rays())
    }

    /// What source `i` shoots in the running step [lm].
    fn flux(&self, problem: &Problem, i: u32) -> Rgb {
        match self.stage {
            Stage::Lamps => {
                let light = &problem.scene.lights[i as usize - problem.mesh.len()];
                light.flux(problem.geometry.bounding_sphere().1)
            }
            Stage::Emission => problem.mesh.emitted_flux(i),
            Stage::Incremental => self.unshot[i as usize],
            Stage::Regular => problem.mesh.reflectivity(i) * self.landed_so_far(i),
            Stage::Gathering | Stage::Done => Rgb::BLACK,
        }
    }

    /// All flux on element `i` [lm].
    fn landed_so_far(&self, i: u32) -> Rgb {
        let i = i as usize;
        self.lamps.get(i).copied().unwrap_or_default() + self.direct[i] + self.indirect[i]
    }

    /// Luminous flux [lm] of every source of the running step.
    fn sources<'a>(&'a self, problem: &'a Problem) -> Box<dyn Iterator<Item = (u32, f64)> + 'a> {
        let elements = problem.mesh.len() as u32;
        let luminous_flux = move |i| (i, f64::from(self.flux(problem, i).luminance()));
        match self.stage {
            Stage::Lamps => Box::new((elements..elements + problem.scene.lights.len() as u32).map(luminous_flux)),
            Stage::Incremental => Box::new(self.active.iter().copied().map(luminous_flux)),
            _ => Box::new((0..elements).map(luminous_flux)),
        }
    }

    /// Luminous flux of all sources [lm].
    fn emitted(&mut self, problem: &Problem) -> f64 {
        [Stage::Lamps, Stage::Emission]
            .into_iter()
            .map(|stage| {
                self.stage = stage;
                self.source_flux(problem)
            })
            .sum()
    }

    fn source_flux(&self, problem: &Problem) -> f64 {
        self.sources(problem).map(|(_, flux)| flux).sum()
    }

    /// Prepares the first step of `stage`, or of the next stage that has something to do.
    fn enter(&mut self, stage: Stage, problem: &Problem, experience: &Experience) {
        self.stage = stage;
        self.pieces_absorbed = 0;
        let rays = self.rays_of_step(problem, experience);
        let u = unit_f64(derive(self.seed, self.step));
        self.step += 1;
        self.allocation = match stage {
            Stage::Done => return,
            Stage::Gathering => {
                self.merging = self.compare(problem);
                self.merging.allocate(problem, rays, u)
            }
            _ => Allocation::systematic(self.sources(problem), self.shot, rays, u),
        };
        let is_small = rays < problem.mesh.len() as u64 / 4;
        self.touched = (is_small && stage != Stage::Gathering).then(Vec::new);
        if self.allocation.rays() == 0 {
            self.enter(self.following(), problem, experience);
        }
    }

    /// Rays for the step about to begin; zero if there is nothing to do. Sets the flux to be shot.
    ///
    /// Emission and reflection share the shooting rays by their expected power, so that all carry about the same power.
    fn rays_of_step(&mut self, problem: &Problem, experience: &Experience) -> u64 {
        self.shot = self.source_flux(problem);
        let shooting = SHOOTING_SHARE * self.rays_planned as f64;
        let reflected_share = experience.reflected_share;
        let emission_rays = shooting / (1.0 + reflected_share);
        let share = self.shot / self.balance.emitted.max(f64::MIN_POSITIVE);
        let left = |rays: f64| (rays - self.rays_done as f64).max(0.0) as u64;
        match self.stage {
            _ if self.shot <= 0.0 && self.stage != Stage::Gathering => 0,
            Stage::Lamps | Stage::Emission => (emission_rays * share).ceil() as u64,
            Stage::Incremental if share < UNSHOT_LIMIT => 0,
            // Half the rays for reflected light go here, half to the regular iteration.
            Stage::Incremental => {
                let reflected_rays = 0.5 * (shooting - emission_rays);
                (reflected_rays * share / reflected_share.max(1e-3)).ceil().max(1.0) as u64
            }
            Stage::Regular => left(shooting),
            Stage::Gathering => left(self.rays_planned as f64),
            Stage::Done => 0,
        }
    }

    fn following(&self) -> Stage {
        match self.stage {
            Stage::Lamps => Stage::Emission,
            Stage::Emission => Stage::Incremental,
            Stage::Incremental => Stage::Regular,
            Stage::Regular => Stage::Gathering,
            Stage::Gathering | Stage::Done => Stage::Done,
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
        sweep.shoot(piece, |i| self.flux(problem, i))
    }

    /// Takes in the next part; after the last one of the step, prepares the next step.
    pub fn absorb(&mut self, problem: &Problem, part: Part, experience: &Experience) {
        self.pieces_absorbed += 1;
        self.rays_done += part.rays;
        for landing in &part.landings {
            let landed = &mut self.landed[landing.element as usize];
            landed.iter_mut().zip(landing.light).for_each(|(sum, light)| *sum += f64::from(light));
        }
        if let Some(touched) = &mut self.touched {
            touched.extend(part.landings.iter().map(|landing| landing.element));
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
            Stage::Lamps => self.reflect(problem),
            Stage::Emission => {
                self.emission_ray_flux = self.shot / rays as f64;
                self.reflect(problem);
            }
            Stage::Incremental => {
                self.reflected_rays += rays;
                self.reflect(problem);
                return self.enter(Stage::Incremental, problem, experience);
            }
            Stage::Regular => {
                let share = rays as f32 / (rays + self.reflected_rays) as f32;
                self.reflected_rays += rays;
                for (flux, landed) in self.indirect.iter_mut().zip(&mut self.landed) {
                    *flux = *flux * (1.0 - share) + to_rgb(&std::mem::take(landed)) * share;
                }
            }
            // What was gathered stays in `landed` until the estimate is read.
            Stage::Gathering => {
                self.stage = Stage::Done;
                return;
            }
            Stage::Done => {}
        }
        self.enter(self.following(), problem, experience);
    }

    /// Turns what has landed into unshot flux, and keeps the books. What an incremental step has shot is gone; what
    /// lamps have lit waits until the surfaces have shot, too.
    fn reflect(&mut self, problem: &Problem) {
        if self.stage == Stage::Incremental {
            self.active.drain(..).for_each(|e| self.unshot[e as usize] = Rgb::BLACK);
        }
        let touched = self.touched.take().map(|mut touched| {
            touched.sort_unstable();
            touched.dedup();
            touched
        });
        match touched {
            Some(touched) => touched.into_iter().for_each(|e| self.reflect_element(problem, e)),
            None => problem.mesh.elements().for_each(|e| self.reflect_element(problem, e)),
        }
        if self.stage == Stage::Emission && !self.lamps.is_empty() {
            self.active.sort_unstable();
            self.active.dedup();
        }
        self.balance.unshot = self.active.iter().map(|&e| f64::from(self.unshot[e as usize].luminance())).sum();
        if self.stage == Stage::Lamps {
            self.balance.unshot += self.balance.emitted - self.shot;
        }
    }

    fn reflect_element(&mut self, problem: &Problem, e: u32) {
        let k = e as usize;
        let landed = std::mem::take(&mut self.landed[k]);
        if landed == [0.0; 3] {
            return;
        }
        let flux = match self.stage {
            Stage::Lamps => &mut self.lamps[k],
            Stage::Emission => &mut self.direct[k],
            _ => &mut self.indirect[k],
        };
        *flux += to_rgb(&landed);
        let rho = problem.mesh.reflectivity(e);
        let reflected = rho * to_rgb(&landed);
        self.unshot[k] += reflected;
        self.active.push(e);
        self.reflected += f64::from(reflected.luminance());
        self.balance.absorbed += luminance(&std::array::from_fn(|c| landed[c] * (1.0 - f64::from(rho.to_array()[c]))));
    }

    /// Radiosity [lm/m²] that element `e` reflects.
    fn reflected_radiosity(&self, problem: &Problem, e: u32) -> Rgb {
        problem.mesh.reflectivity(e) * self.landed_so_far(e) / problem.mesh.area(e)
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
        let direct = mean_irradiance(problem, &self.direct);
        let exitance = if power > 0.0 { power_exitance / power } else { 0.0 };
        let indirect_ray_flux = self.reflected / self.reflected_rays.max(1) as f64;
        let variance = radiosity_variance(problem, |e| self.reflected_radiosity(problem, e));
        Merging {
            direct: Variances::new(direct, self.emission_ray_flux, direct * exitance),
            indirect: Variances::new(mean_irradiance(problem, &self.indirect), indirect_ray_flux, variance),
        }
    }

    /// What this complete solution teaches the next one.
    pub fn experience(&self) -> Experience {
        Experience { reflected_share: self.reflected / self.balance.emitted.max(f64::MIN_POSITIVE) }
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
            let lamps = self.lamps.get(k).copied().unwrap_or_default();
            let shot = lamps + self.direct[k] * (1.0 - direct) + self.indirect[k] * (1.0 - indirect);
            shot / area + to_rgb(&self.landed[k])
        })
    }

    /// Irradiance [lux] of element `e` as far as the running complete solution has come.
    pub fn irradiance_so_far(&self, problem: &Problem, e: u32) -> Rgb {
        self.landed_so_far(e) / problem.mesh.area(e)
    }
}

fn to_rgb(sum: &[f64; 3]) -> Rgb {
    Rgb::new(sum[0] as f32, sum[1] as f32, sum[2] as f32)
}

fn luminance(sum: &[f64; 3]) -> f64 {
    0.2126 * sum[0] + 0.7152 * sum[1] + 0.0722 * sum[2]
}
