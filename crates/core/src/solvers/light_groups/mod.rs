//! Solves each group of light sources for itself, all at once, with any solver: radiosity is linear in the emission.
//!
//! ```text
//! B = Σ_g B_g,    B_g = Be_g + rho F B_g
//! ```
//!
//! Each group has a solver of its own, which sees a scene without any other source, and random numbers of its own. Biased as that
//! solver is. The groups take turns, whoever is furthest behind first, so that all are about equally good whenever somebody
//! breaks off. Rays are shared out
//!
//! ```text
//! N_g = N (Φ_g / Φ + 1 / G) / 2       Φ_g: flux of group g, G: number of groups
//! ```
//!
//! because the variance of group g falls as `Φ_g² / N_g`: that of the sum is least if N_g goes with the flux, and all groups are equally
//! good, relative to themselves, if they have the same number. Half of each: the sum has at most twice its least variance, and a
//! lamp that is turned up later at most twice that of equal shares.
//!
//! Cost: the rays of one solve; memory for the state of each group's solver, and for one copy of the elements.

mod rounds;

use super::monte_carlo::{Budget, extended_from};
use super::{Part, Progress, Solver};
use crate::math::Rgb;
use crate::math::hash::derive;
use crate::scene::{Grouping, LightGroup, MOST_GROUPS};
use crate::solution::{GroupLight, Provenance, Solution};
use crate::{Error, Problem, superposition};
use std::ops::Range;
use std::sync::OnceLock;

/// Parameters that say how much one group was told to do.
const AMOUNT: [&str; 3] = ["rays", "rounds", "extended from"];

/// The solver's state: a checkpoint, as it is.
#[derive(serde::Serialize, serde::Deserialize)]
pub struct LightGroups {
    /// What was asked for, of all groups together, and before the last of it what that extends.
    asked: Vec<Budget>,
    budget: Budget,
    seed: u64,
    groups: Vec<LightGroup>,
    /// Those of each group.
    members: Vec<Member>,
    /// Whose turn it is, and its rays when that began.
    turn: usize,
    rays_before: u64,
    /// How much larger the error of the sum is than the one that is asked for.
    excess: Option<f64>,
    /// What the group whose turn it is sees. Made again if the state was loaded.
    #[serde(skip)]
    view: OnceLock<Problem>,
}

#[derive(serde::Serialize, serde::Deserialize)]
struct Member {
    /// Flux [lm] by channel.
    flux: [f64; 3],
    /// Of all rays.
    share: f64,
    solver: Box<dyn Solver>,
}

impl Member {
    fn rays(&self) -> u64 {
        self.solver.progress().rays
    }

    fn is_finished(&self) -> bool {
        self.solver.step().is_none()
    }

    /// Its share of so many rays.
    fn part_of(&self, rays: u64) -> u64 {
        (self.share * rays as f64).ceil() as u64
    }

    fn lumens(&self) -> f64 {
        luminous(self.flux)
    }
}

fn luminous(flux: [f64; 3]) -> f64 {
    Rgb::from(flux.map(|flux| flux as f32)).luminance_f64()
}

impl LightGroups {
    /// `make` gives the solver of a problem, with its budget and seed; `budget` is that of all groups together.
    ///
    /// # Errors
    /// Those of [`Grouping::groups`], and of `make`; what it refuses for the whole problem is refused, too.
    pub fn new<E: From<Error>>(
        problem: &Problem,
        grouping: &Grouping,
        budget: Budget,
        seed: u64,
        make: impl Fn(&Problem, Budget, u64) -> Result<Box<dyn Solver>, E>,
    ) -> Result<LightGroups, E> {
        drop(make(problem, budget, seed)?);
        let groups = grouping.groups(&problem.scene)?;
        let fluxes: Vec<[f64; 3]> = groups.iter().map(|group| problem.flux_of(group)).collect();
        let all: f64 = fluxes.iter().copied().map(luminous).sum();
        let mut view = problem.clone();
        let mut members = Vec::with_capacity(groups.len());
        for (k, &flux) in fluxes.iter().enumerate() {
            let of_flux = luminous(flux) / all.max(f64::MIN_POSITIVE);
            let share = 0.5 * (of_flux + 1.0 / groups.len() as f64);
            view.light_only(problem, &groups, k);
            let solver = make(&view, rounds::first_budget(problem, budget, share), derive(seed, k as u64))?;
            members.push(Member { flux, share, solver });
        }
        let mut solver = LightGroups {
            asked: Vec::new(),
            budget,
            seed,
            groups,
            members,
            turn: 0,
            rays_before: 0,
            excess: None,
            view: view.into(),
        };
        solver.give_turn(problem);
        Ok(solver)
    }

    fn rays(&self) -> u64 {
        self.members.iter().map(Member::rays).sum()
    }

    /// After a step. A turn lasts for as many rays as there are elements, so that what it costs to change does not count.
    fn end_step(&mut self, problem: &Problem) {
        let member = &self.members[self.turn];
        let is_over = member.rays().saturating_sub(self.rays_before) >= problem.mesh.len() as u64;
        if is_over || member.is_finished() {
            self.give_turn(problem);
        }
        if self.step().is_none() {
            self.next_round(problem);
        }
    }

    /// It is the turn of the group that is furthest behind, if any has something to do.
    fn give_turn(&mut self, problem: &Problem) {
        let behind = |member: &Member| member.rays() as f64 / member.share;
        let waiting = self.members.iter().enumerate().filter(|(_, member)| !member.is_finished());
        let Some((next, member)) = waiting.min_by(|(_, a), (_, b)| behind(a).total_cmp(&behind(b))) else { return };
        (self.turn, self.rays_before) = (next, member.rays());
        match self.view.get_mut() {
            Some(view) => view.light_only(problem, &self.groups, next),
            None => self.view = view_of(problem, &self.groups, next).into(),
        }
    }

    /// That of the first group, but for what concerns all of them.
    fn provenance(&self, problem: &Problem, first: &Provenance) -> Provenance {
        let mut parameters = first.parameters.clone();
        // Deterministic methods are not told how much to do, and take no seed.
        if first.seed == derive(self.seed, 0) {
            parameters.retain(|(name, _)| !AMOUNT.contains(&name.as_str()));
            parameters.splice(0..0, self.budget.parameters().into_iter().chain(extended_from(&self.asked)));
        }
        let names: Vec<&str> = self.groups.iter().map(|group| group.name.as_str()).collect();
        parameters.push(("light groups".to_owned(), names.join("; ")));
        Provenance { scene_hash: problem.scene.hash(), seed: self.seed, parameters, ..first.clone() }
    }
}

/// What number `k` of the `groups` sees.
fn view_of(problem: &Problem, groups: &[LightGroup], k: usize) -> Problem {
    let mut view = problem.clone();
    view.light_only(problem, groups, k);
    view
}

#[typetag::serde]
impl Solver for LightGroups {
    fn step(&self) -> Option<Range<u64>> {
        self.members[self.turn].solver.step()
    }

    fn part(&self, problem: &Problem, piece: u64) -> Part {
        let view = self.view.get_or_init(|| view_of(problem, &self.groups, self.turn));
        self.members[self.turn].solver.part(view, piece)
    }

    fn absorb(&mut self, problem: &Problem, part: Part) {
        let ends_step = self.step().is_none_or(|left| left.end - left.start == 1);
        let view = self.view.get_or_init(|| view_of(problem, &self.groups, self.turn));
        self.members[self.turn].solver.absorb(view, part);
        if ends_step {
            self.end_step(problem);
        }
    }

    fn solution(&self, problem: &Problem) -> Solution {
        let mut view = problem.clone();
        let part = |(k, (group, member)): (usize, (&LightGroup, &Member))| {
            view.light_only(problem, &self.groups, k);
            let (group, solution) = (group.clone(), member.solver.solution(&view));
            GroupLight { group, flux: member.flux, factor: Rgb::WHITE, solution }
        };
        let groups: Vec<GroupLight> = self.groups.iter().zip(&self.members).enumerate().map(part).collect();
        let provenance = self.provenance(problem, &groups[0].solution.provenance);
        let sum = superposition::sum(problem, &groups, provenance);
        Solution { groups, ..sum }
    }

    fn go_on(&mut self, problem: &Problem, budget: Budget) -> Result<(), Error> {
        self.extend(problem, budget)
    }

    fn fits(&self, problem: &Problem) -> bool {
        let count = self.groups.len();
        if !(1..=MOST_GROUPS).contains(&count) || self.members.len() != count || self.turn >= count {
            return false;
        }
        self.groups.iter().all(|group| group.fits(&problem.scene))
            && (0..count).all(|k| self.members[k].solver.fits(&view_of(problem, &self.groups, k)))
    }

    fn progress(&self) -> Progress {
        let of = |member: &Member| (member.lumens(), member.solver.progress());
        let all: Vec<(f64, Progress)> = self.members.iter().map(of).collect();
        let lumens: f64 = all.iter().map(|(lumens, _)| lumens).sum();
        // As if all groups lit the scene as well as they emit.
        let square = |(lumens, progress): &(f64, Progress)| Some((lumens * progress.rms_error?).powi(2));
        let squares: Option<f64> = all.iter().filter(|(lumens, _)| *lumens > 0.0).map(square).sum();
        let (_, running) = all[self.turn];
        Progress {
            rays: all.iter().map(|(_, progress)| progress.rays).sum(),
            rays_in_all: all.iter().map(|(_, progress)| progress.rays_in_all).sum(),
            rms_error: squares.map(|squares| squares.sqrt() / lumens),
            asked: self.budget.accuracy(),
            excess: self.excess,
            ..running
        }
    }
}
