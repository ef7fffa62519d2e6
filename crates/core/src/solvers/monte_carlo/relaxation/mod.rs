//! Relaxation: light is pooled on the elements, which shoot it step after step (Neumann et al. 1995; Bekaert 1999).
//!
//! Which steps there are, and with how many rays, is the order's affair: its [`Course`]. What a step shoots along which lines
//! is in `step.rs`, what it leaves behind in `books.rs`. Unbiased with the address `per-iteration`, for a course without bias,
//! but for the unshot power that is left at the end: at most 10^-6 of the emitted, unless hardly anything is absorbed (see
//! [`plan`]); the balance reports it. A warm-up leaves as little.

mod books;
mod course;
mod draw;
mod line_set;
mod merging;
mod multipath;
mod plan;
mod step;
mod sweeps;

pub use self::course::{Course, Stage};

use self::draw::Draw;
use self::line_set::LineSet;
use self::merging::Merging;
use self::plan::Plan;
use self::sweeps::Sweeps;
use super::axes::FirstShot;
use super::complete::CompleteSolution;
use super::light::Light;
use super::{Experience, LightPart, Method, Settings, sources};
use crate::Problem;
use crate::math::Rgb;
use crate::math::hash::{derive, unit_f64};
use crate::sampling::address::Counters;
use crate::solution::Balance;
use crate::solvers::Part;
use crate::solvers::allocation::Allocation;
use crate::transport::Leaving;
use std::ops::Range;

/// The state of one complete solution.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
pub struct Relaxation {
    method: Method,
    course: Course,
    seed: u64,
    rays_planned: u64,
    rays_done: u64,
    /// Place of the running stage in the course; beyond it when the solution is complete.
    place: usize,
    step: u64,
    pieces_absorbed: u64,
    /// Iterations of the running stage that are done.
    iteration: u32,
    draw: Draw,
    counters: Counters,
    light: Light,
    /// What of it is wanted.
    wanted: LightPart,
    /// Luminous flux [lm] that the running step shoots.
    shot: f64,
    /// Flux [lm] that the running step has lost: into the open, and to the backs of one-sided surfaces.
    lost: [f64; 2],
    /// Flux [lm] that global lines took too little, or too much if negative: they cross an element as often as chance will.
    adrift: f64,
    /// Shares of the landings of direct and of reflected light that are noted.
    noted: [f64; 2],
    /// Flux [lm] of each ray that left an emitting surface.
    emission_ray_flux: f64,
    /// Rays of incremental and regular shooting.
    reflected_rays: u64,
    /// All luminous flux reflected so far [lm].
    reflected: f64,
    merging: Merging,
    balance: Balance,
    /// Balance of direct light alone, from which those of whole iterations start.
    direct_balance: Balance,
    sweeps: Sweeps,
}

impl Relaxation {
    /// A relaxation that follows `course`, ready to be started.
    pub fn new(problem: &Problem, settings: &Settings, course: Course) -> Relaxation {
        let method = settings.method;
        // A global line crosses all of an element: its light leaves from all of it.
        let leaving = if method.has_leaving() { settings.leaving } else { Leaving::WholeElement };
        Relaxation {
            method,
            seed: 0,
            rays_planned: 0,
            rays_done: 0,
            place: course.stages.len(),
            step: 0,
            pieces_absorbed: 0,
            iteration: 0,
            draw: Draw::Local(Allocation::default()),
            counters: method.address.counters(sources::count(problem)),
            light: Light::new(problem.mesh.len(), !problem.scene.lights.is_empty(), leaving),
            wanted: settings.light,
            shot: 0.0,
            lost: [0.0; 2],
            adrift: 0.0,
            noted: [1.0; 2],
            emission_ray_flux: 0.0,
            reflected_rays: 0,
            reflected: 0.0,
            merging: Merging::default(),
            balance: Balance::default(),
            direct_balance: Balance::default(),
            sweeps: Sweeps::new(course.sweeps, problem.mesh.len()),
            course,
        }
    }

    /// Gives incremental shooting this share of the rays that are left to reflected light, in the next complete solution. So rays of
    /// direct and of reflected light no longer carry the same flux [lm], but these.
    pub fn set_share_of_incremental(&mut self, share_of_rays: f64, ray_flux: [f64; 2]) {
        for stage in &mut self.course.stages {
            if let Stage::Incremental { share, .. } = stage {
                *share = share_of_rays;
            }
        }
        let most = ray_flux[0].max(ray_flux[1]);
        self.noted = ray_flux.map(|flux| if most > 0.0 { flux / most } else { 1.0 });
    }

    /// The running stage; none when the solution is complete.
    fn stage(&self) -> Option<Stage> {
        self.course.stages.get(self.place).copied()
    }

    fn start_sweep(&mut self, problem: &Problem, experience: &Experience) {
        self.reflected_rays = 0;
        (self.emission_ray_flux, self.reflected, self.adrift) = (0.0, 0.0, 0.0);
        self.light.clear();
        let emitted = sources::total(problem);
        self.balance = Balance { emitted, unshot: emitted, ..Balance::default() };
        self.place = 0;
        self.begin_stage(problem, experience);
    }

    /// Begins the stage, or the first after it that has something to do.
    fn begin_stage(&mut self, problem: &Problem, experience: &Experience) {
        self.iteration = 0;
        while let Some(stage) = self.stage() {
            if self.prepare(stage, problem, experience) {
                return;
            }
            self.place += 1;
        }
    }

    /// Prepares the next step of `stage`; whether there is anything to do.
    fn prepare(&mut self, stage: Stage, problem: &Problem, experience: &Experience) -> bool {
        self.shot = self.sources(problem, stage).map(|(_, flux)| flux).sum();
        if stage.is_multipath() && self.method.first_shot == FirstShot::Same {
            self.shot += sources::of_surfaces(problem);
        }
        let rays = self.rays_of_step(stage, experience);
        let u = unit_f64(derive(self.seed, self.step));
        self.step += 1;
        self.draw = if stage == Stage::Gathering {
            let expected = Merging::expect(problem, &self.light, self.emission_ray_flux, self.reflected_ray_flux());
            self.merging = if self.wanted == LightPart::Indirect { expected.of_indirect_light() } else { expected };
            self.light.show(&problem.mesh);
            Draw::Local(self.merging.allocate(problem, rays, u))
        } else if self.uses_global_lines(stage) {
            self.light.expect(u64::MAX);
            Draw::Lines(LineSet::new(problem, self.method.lines, rays))
        } else {
            self.light.expect(rays);
            Draw::Local(Allocation::systematic(self.sources(problem, stage), self.shot, rays, u))
        };
        self.pieces_absorbed = 0;
        self.lost = [0.0; 2];
        let anything = self.draw.pieces() > 0;
        if stage.is_multipath() && anything {
            // It leaves share by share; on average all of it has left with the last line.
            self.adrift += self.shot;
            self.light.spend_unshot();
        }
        anything
    }

    fn rays_of_step(&self, stage: Stage, experience: &Experience) -> u64 {
        let rays = (self.rays_planned as f64 * self.sweeps.share()) as u64;
        let plan = Plan { shooting: self.course.shooting, rays, experience: *experience };
        let power = self.shot / self.balance.emitted.max(f64::MIN_POSITIVE);
        plan.rays_of_step(stage, self.iteration, power, self.rays_done - self.sweeps.rays_before)
    }

    /// Ends a step, and prepares the next one: of the same stage, of the next, or of the next sweep.
    fn finish_step(&mut self, stage: Stage, problem: &Problem, experience: &Experience) {
        if let Draw::Local(allocation) = &self.draw {
            allocation.counts().for_each(|(source, count)| self.counters.advance(source, count));
        }
        self.iteration += 1;
        self.settle(stage, problem);
        if stage.repeats() && self.prepare(stage, problem, experience) {
            return;
        }
        self.place += 1;
        self.begin_stage(problem, experience);
        let flux = |e| self.light.part_on(self.wanted, e);
        if self.stage().is_none() && self.sweeps.close(flux, self.balance, self.rays_done) {
            self.start_sweep(problem, experience);
        }
    }
}

#[typetag::serde]
impl CompleteSolution for Relaxation {
    fn restart(&mut self, problem: &Problem, seed: u64, rays: u64, experience: &Experience) {
        self.seed = seed;
        self.rays_planned = rays;
        (self.rays_done, self.step) = (0, 0);
        self.counters.reset();
        self.sweeps.reset();
        self.start_sweep(problem, experience);
    }

    fn pieces(&self) -> Option<Range<u64>> {
        self.stage().map(|_| self.pieces_absorbed..self.draw.pieces())
    }

    fn part(&self, problem: &Problem, piece: u64) -> Part {
        self.stage().map(|stage| self.part_of(stage, problem, piece)).unwrap_or_default()
    }

    fn absorb(&mut self, problem: &Problem, part: Part, experience: &Experience) {
        let Some(stage) = self.stage() else { return };
        self.pieces_absorbed += 1;
        self.rays_done += part.rays;
        match stage {
            Stage::Multipath { .. } => self.walk_along(problem, &part),
            Stage::Gathering => self.light.land(&part),
            _ => {
                self.light.land(&part);
                self.light.mark(&part, self.noted[usize::from(stage.reflects())]);
            }
        }
        self.lost[0] += part.escaped;
        self.lost[1] += part.back_face;
        if self.pieces_absorbed == self.draw.pieces() {
            self.finish_step(stage, problem, experience);
        }
    }

    fn irradiance(&self, problem: &Problem, e: u32) -> Rgb {
        self.sweeps.flux(e, self.light.part_on(self.wanted, e), self.stage().is_none()) / problem.mesh.area(e)
    }

    fn retire(&mut self) {
        self.light = Light::new(0, false, Leaving::WholeElement);
        self.draw = Draw::Local(Allocation::default());
    }

    fn fits(&self, problem: &Problem) -> bool {
        let elements = problem.mesh.len();
        self.light.fits(elements, !problem.scene.lights.is_empty()) && self.sweeps.fits(elements)
    }

    fn rays(&self) -> u64 {
        self.rays_done
    }

    fn balance(&self) -> Balance {
        self.sweeps.balance(self.balance)
    }

    fn experience(&self) -> Experience {
        Experience { reflected_share: self.reflected / self.balance.emitted.max(f64::MIN_POSITIVE) }
    }

    fn stage(&self) -> &'static str {
        self.stage().map_or("done", Stage::name)
    }
}
