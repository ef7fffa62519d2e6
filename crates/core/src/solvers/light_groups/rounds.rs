//! How far light groups go: the share of each, and more for all of them where the sum is not as accurate as was asked for, or somebody
//! extends the run.
//!
//! Every group has an end of its own. When all have come to it the accuracy of the sum is looked at, and each is extended by its share of
//! the rays that the sum lacks, as one run would be (see `rays_for`).

use super::{LightGroups, Member};
use crate::solvers::monte_carlo::{Budget, rays_for};
use crate::solvers::{Progress, Solver, budget};
use crate::{Error, Problem};

/// Least rays of a group's first round, where an accuracy is asked for.
const FIRST_RAYS: f64 = 8000.0;

/// What one group is asked for first, of a budget for all of them.
pub fn first_budget(problem: &Problem, asked: Budget, share: f64) -> Budget {
    let rays = |rays: f64| Budget::Rays((share * rays).ceil() as u64);
    match asked {
        Budget::Heuristic => rays(budget::rays(&problem.mesh) as f64),
        Budget::Rays(all) => rays(all as f64),
        Budget::Endless => Budget::Endless,
        Budget::Accuracy { most_rays, .. } => {
            let first = (4.0 * problem.mesh.len() as f64).max(FIRST_RAYS / share);
            rays(most_rays.map_or(first, |most| first.min(most as f64)))
        }
    }
}

impl LightGroups {
    /// After all groups have finished: more rays for all of them, if the sum is not as accurate as was asked for.
    pub(super) fn next_round(&mut self, problem: &Problem) {
        let Budget::Accuracy { accuracy, most_rays } = self.budget else { return };
        let (rays, excess) = (self.rays(), accuracy.excess(problem, &self.solution(problem)));
        let left = most_rays.map_or(u64::MAX, |most| most.saturating_sub(rays));
        self.excess = Some(excess);
        let is_accurate = excess <= 1.0;
        // A round that adds next to nothing is not worth its cost.
        if !is_accurate && left > rays / 100 {
            // A group that cannot go on stays as it is.
            let _ = self.add_rays(problem, rays_for(rays, excess).min(left));
        }
    }

    /// Extends all groups by their shares of so many rays.
    fn add_rays(&mut self, problem: &Problem, rays: u64) -> Result<(), Error> {
        self.extend_each(problem, |member| {
            let Progress { rays: traced, rays_in_all, .. } = member.solver.progress();
            Budget::Rays(traced.max(rays_in_all.unwrap_or(0)) + member.part_of(rays))
        })
    }

    /// Extends each group to a budget.
    fn extend_each(&mut self, problem: &Problem, budget: impl Fn(&Member) -> Budget) -> Result<(), Error> {
        let mut view = problem.clone();
        for (k, member) in self.members.iter_mut().enumerate() {
            view.light_only(problem, &self.groups, k);
            let budget = budget(member);
            member.solver.go_on(&view, budget)?;
        }
        self.give_turn(problem);
        Ok(())
    }

    /// See [`Solver::go_on`](crate::solvers::Solver::go_on).
    pub(super) fn extend(&mut self, problem: &Problem, budget: Budget) -> Result<(), Error> {
        if budget == Budget::Heuristic || budget == self.budget {
            return Ok(());
        }
        match budget {
            Budget::Heuristic | Budget::Endless => self.extend_each(problem, |_| budget)?,
            Budget::Rays(rays) => self.extend_each(problem, |member| Budget::Rays(member.part_of(rays)))?,
            // Groups without an end need one, where the accuracy is looked at.
            Budget::Accuracy { .. } if self.budget == Budget::Endless => self.add_rays(problem, self.rays() / 4)?,
            Budget::Accuracy { .. } => {}
        }
        self.asked.push(std::mem::replace(&mut self.budget, budget));
        self.excess = None;
        if self.step().is_none() {
            self.next_round(problem);
        }
        Ok(())
    }
}
