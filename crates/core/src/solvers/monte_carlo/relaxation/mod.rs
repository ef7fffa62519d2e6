//! Relaxation: light is pooled on the elements, which shoot it step after step (Neumann et al. 1995; Bekaert 1999).
//!
//! What a step shoots is the order's affair ([`stage`]); which lines carry it is decided in one place, [`Relaxation::part`].
//! Unbiased with the address `per-iteration` but for the unshot power that is left at the end: at most 10^-6 of the emitted, unless
//! hardly anything is absorbed (see [`plan`]); the balance reports it. The warm-up of `stochastic-ray` leaves as little.

mod books;
mod draw;
mod line_set;
mod merging;
mod multipath;
mod plan;
mod stage;
mod sweeps;

use self::draw::Draw;
use self::line_set::LineSet;
use self::merging::Merging;
use self::plan::{AVERAGED, Plan};
use self::stage::Stage;
use self::sweeps::Sweeps;
use super::axes::{FirstShot, Lines, Order};
use super::complete::CompleteSolution;
use super::light::{Light, Origin};
use super::{Experience, Method, Settings, sources};
use crate::Problem;
use crate::math::Rgb;
use crate::math::hash::{derive, unit_f64};
use crate::sampling::Sequence;
use crate::sampling::address::Counters;
use crate::solution::Balance;
use crate::solvers::allocation::Allocation;
use crate::solvers::{Part, gathering, shooting};
use crate::transport::{Footprint, Leaving};
use std::ops::Range;

/// The state of one complete solution.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Relaxation {
    method: Method,
    seed: u64,
    rays_planned: u64,
    rays_done: u64,
    stage: Stage,
    step: u64,
    pieces_absorbed: u64,
    /// Iterations of the running stage that are done.
    iteration: u32,
    draw: Draw,
    counters: Counters,
    light: Light,
    /// Luminous flux [lm] that the running step shoots.
    shot: f64,
    /// Flux [lm] that the running step has lost: into the open, and to the backs of one-sided surfaces.
    lost: [f64; 2],
    /// Flux [lm] that global lines took too little, or too much if negative: they cross an element as often as chance will.
    adrift: f64,
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
    pub fn new(problem: &Problem, settings: &Settings) -> Relaxation {
        let method = settings.method;
        // A global line crosses all of an element: its light leaves from all of it.
        let leaving = if method.has_leaving() { settings.leaving } else { Leaving::WholeElement };
        Relaxation {
            method,
            seed: 0,
            rays_planned: 0,
            rays_done: 0,
            stage: Stage::Done,
            step: 0,
            pieces_absorbed: 0,
            iteration: 0,
            draw: Draw::Local(Allocation::default()),
            counters: method.address.counters(sources::count(problem)),
            light: Light::new(problem.mesh.len(), !problem.scene.lights.is_empty(), leaving),
            shot: 0.0,
            lost: [0.0; 2],
            adrift: 0.0,
            emission_ray_flux: 0.0,
            reflected_rays: 0,
            reflected: 0.0,
            merging: Merging::default(),
            balance: Balance::default(),
            direct_balance: Balance::default(),
            sweeps: Sweeps::new(method.order, problem.mesh.len()),
        }
    }

    /// Starts a sweep: of the order `staged` there are several in a complete solution.
    fn start_sweep(&mut self, problem: &Problem, experience: &Experience) {
        self.reflected_rays = 0;
        (self.emission_ray_flux, self.reflected, self.adrift) = (0.0, 0.0, 0.0);
        self.light.clear();
        let emitted = sources::total(problem);
        self.balance = Balance { emitted, unshot: emitted, ..Balance::default() };
        self.enter(Stage::Lamps, problem, experience);
    }

    /// The stage after `stage`.
    fn after(&self, stage: Stage) -> Stage {
        let stages = Stage::of(self.method);
        let place = stages.iter().position(|&other| other == stage);
        place.and_then(|place| stages.get(place + 1)).copied().unwrap_or(Stage::Done)
    }

    /// Whether the lines of `stage` are the method's global ones.
    fn uses_global_lines(&self, stage: Stage) -> bool {
        let first_shot = stage == Stage::Emission && self.method.first_shot == FirstShot::Same;
        self.method.lines != Lines::Local && (stage.reflects() || stage == Stage::Multipath || first_shot)
    }

    /// What source `i` shoots in `stage` [lm].
    fn flux(&self, problem: &Problem, stage: Stage, i: u32) -> Rgb {
        match stage {
            Stage::Lamps | Stage::Emission => sources::flux(problem, i),
            Stage::Multipath | Stage::Incremental => self.light.unshot(i),
            Stage::WarmUp | Stage::Regular => problem.mesh.reflectivity(i) * self.light.on(i),
            Stage::Gathering | Stage::Done => Rgb::BLACK,
        }
    }

    /// Luminous flux [lm] of every source of `stage`.
    fn sources<'a>(&'a self, problem: &'a Problem, stage: Stage) -> Box<dyn Iterator<Item = (u32, f64)> + 'a> {
        let elements = problem.mesh.len() as u32;
        let luminous_flux = move |i| (i, self.flux(problem, stage, i).luminance_f64());
        match stage {
            Stage::Lamps => Box::new((elements..sources::count(problem) as u32).map(luminous_flux)),
            Stage::Multipath | Stage::Incremental => Box::new(self.light.active().map(luminous_flux)),
            _ => Box::new((0..elements).map(luminous_flux)),
        }
    }

    /// Prepares the next step of `stage`, or of the first stage after it that has something to do.
    fn enter(&mut self, stage: Stage, problem: &Problem, experience: &Experience) {
        let mut stage = stage;
        if stage != self.stage {
            self.iteration = 0;
        }
        while stage != Stage::Done {
            self.shot = self.sources(problem, stage).map(|(_, flux)| flux).sum();
            if stage == Stage::Multipath && self.method.first_shot == FirstShot::Same {
                self.shot += sources::of_surfaces(problem);
            }
            let rays = self.rays_of_step(stage, experience);
            let u = unit_f64(derive(self.seed, self.step));
            self.step += 1;
            self.draw = if stage == Stage::Gathering {
                self.merging = Merging::expect(problem, &self.light, self.emission_ray_flux, self.reflected_ray_flux());
                Draw::Local(self.merging.allocate(problem, rays, u))
            } else if self.uses_global_lines(stage) {
                self.light.expect(u64::MAX);
                Draw::Lines(LineSet::new(problem, self.method.lines, rays))
            } else {
                self.light.expect(rays);
                Draw::Local(Allocation::systematic(self.sources(problem, stage), self.shot, rays, u))
            };
            if self.draw.pieces() > 0 {
                break;
            }
            stage = self.after(stage);
            self.iteration = 0;
        }
        self.stage = stage;
        self.pieces_absorbed = 0;
        self.lost = [0.0; 2];
    }

    fn rays_of_step(&self, stage: Stage, experience: &Experience) -> u64 {
        let plan = self.plan(experience);
        let averaged = stage == Stage::Regular && self.method.order == Order::StochasticRay;
        if (stage == Stage::WarmUp && self.iteration >= plan.warm_up()) || (averaged && self.iteration >= AVERAGED) {
            return 0;
        }
        let share = self.shot / self.balance.emitted.max(f64::MIN_POSITIVE);
        plan.rays_of_step(stage, share, self.rays_done - self.sweeps.rays_before)
    }

    fn plan(&self, experience: &Experience) -> Plan {
        let rays = (self.rays_planned as f64 * self.sweeps.share()) as u64;
        let gathers = Stage::of(self.method).contains(&Stage::Gathering);
        Plan { order: self.method.order, gathers, rays, experience: *experience }
    }

    fn shoot(&self, problem: &Problem, allocation: &Allocation, sequence: &dyn Sequence, piece: u64) -> Part {
        let sweep = shooting::Sweep { problem, sequence, counters: &self.counters, allocation, total: self.shot };
        sweep.shoot(piece, |i| {
            let footprint = if self.stage.reflects() { self.light.footprint(i) } else { Footprint::WHOLE };
            (self.flux(problem, self.stage, i), footprint)
        })
    }

    fn gather(&self, problem: &Problem, allocation: &Allocation, sequence: &dyn Sequence, piece: u64) -> Part {
        let sweep = gathering::Sweep { problem, sequence, counters: &self.counters, allocation };
        sweep.gather(piece, |i, n, j, spot| {
            let [direct, indirect] = self.merging.weights(problem.mesh.area(i), n);
            (problem.mesh.emission(j) * direct + self.light.seen_radiosity(&problem.mesh, j, spot) * indirect)
                / n as f32
        })
    }

    fn finish_step(&mut self, problem: &Problem, experience: &Experience) {
        if let Draw::Local(allocation) = &self.draw {
            allocation.counts().for_each(|(source, count)| self.counters.advance(source, count));
        }
        let rays = self.draw.rays();
        self.iteration += 1;
        match self.stage {
            Stage::Lamps => self.reflect(problem, Origin::Lamps),
            Stage::Emission => {
                self.emission_ray_flux = self.shot / rays as f64;
                self.reflect(problem, Origin::Emission);
                self.direct_balance = self.balance;
            }
            Stage::Multipath => {
                self.reflected_rays += rays;
                // On average all that surfaces emit has left; the rest of it is adrift.
                if self.method.first_shot == FirstShot::Same {
                    self.adrift += sources::of_surfaces(problem);
                }
                self.light.find_active();
                self.balance.escaped += self.lost[0];
                self.balance.back_face += self.lost[1];
                self.balance.unshot = self.light.unshot_total() + self.adrift;
            }
            Stage::Incremental => {
                self.reflected_rays += rays;
                self.light.spend_unshot();
                self.reflect(problem, Origin::Reflection);
            }
            Stage::WarmUp => self.iterate(problem, 1.0),
            Stage::Regular if self.method.order == Order::StochasticRay => {
                self.iterate(problem, 1.0 / self.iteration as f32);
            }
            Stage::Regular => {
                self.light.average_in(rays as f32 / (rays + self.reflected_rays) as f32);
                self.reflected_rays += rays;
            }
            Stage::Gathering => self.merge_gathered(problem),
            Stage::Done => {}
        }
        let repeats = match self.stage {
            Stage::Incremental | Stage::WarmUp => true,
            Stage::Regular => self.method.order == Order::StochasticRay,
            _ => false,
        };
        let next = if repeats { self.stage } else { self.after(self.stage) };
        self.enter(next, problem, experience);
        if self.stage == Stage::Done && self.sweeps.close(&self.light, self.balance, self.rays_done) {
            self.start_sweep(problem, experience);
        }
    }
}

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
        (self.stage != Stage::Done).then(|| 0..self.draw.pieces())
    }

    fn part(&self, problem: &Problem, piece: u64) -> Part {
        let seed = self.method.address.sequence_seed(self.seed, self.step);
        let sequence = self.method.sequence.make(seed);
        match &self.draw {
            Draw::Local(allocation) if self.stage == Stage::Gathering => {
                self.gather(problem, allocation, sequence.as_ref(), piece)
            }
            Draw::Local(allocation) => self.shoot(problem, allocation, sequence.as_ref(), piece),
            Draw::Lines(lines) if self.stage == Stage::Multipath => lines.collect(problem, sequence.as_ref(), piece),
            Draw::Lines(lines) => lines.shoot(problem, sequence.as_ref(), piece, |i| self.flux(problem, self.stage, i)),
        }
    }

    fn absorb(&mut self, problem: &Problem, part: Part, experience: &Experience) {
        self.pieces_absorbed += 1;
        self.rays_done += part.rays;
        if self.stage == Stage::Multipath {
            self.walk_along(problem, &part);
        } else {
            self.light.land(&part);
        }
        if !matches!(self.stage, Stage::Multipath | Stage::Gathering) {
            self.light.mark(&part);
        }
        self.lost[0] += part.escaped;
        self.lost[1] += part.back_face;
        if self.pieces_absorbed == self.draw.pieces() {
            self.finish_step(problem, experience);
        }
    }

    fn irradiance(&self, problem: &Problem, e: u32) -> Rgb {
        self.sweeps.flux(e, self.light.on(e), self.stage == Stage::Done) / problem.mesh.area(e)
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
        self.stage.name()
    }
}
