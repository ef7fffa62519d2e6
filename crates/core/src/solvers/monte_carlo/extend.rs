//! A run that goes on beyond what it was asked for: further rounds of complete solutions.
//!
//! The running round comes to its end as planned. Then either one more round brings the rays to what is asked for now, or rounds
//! double until the driver stops. Rounds are merged as those of any run ([`Replicates`](crate::solvers::replicates)), so the estimate
//! is as good as its bias, and its error bars as honest. Cost: what a finished run has learned of where rays are best spent is learned anew.

use super::{Budget, MonteCarlo, Settings, most_rays_each, shape_of_round};
use crate::math::hash::derive;
use crate::{Error, Problem};

impl MonteCarlo {
    /// See [`Solver::go_on`](crate::solvers::Solver::go_on).
    pub(super) fn extend(&mut self, problem: &Problem, budget: Budget) -> Result<(), Error> {
        if budget == Budget::Heuristic || budget == self.settings.budget {
            return Ok(());
        }
        let refused = |name, value: u64, allowed| Err(Error::Parameter { name, value: value.to_string(), allowed });
        if self.settings.replicates == 1 {
            return refused(
                "replicates",
                1,
                "a run without error bars cannot be extended: rounds are weighted by them",
            );
        }
        let asked_before = self.rays_in_all.unwrap_or_default().max(self.rays);
        if let Some(rays) = budget.rays().filter(|&rays| rays <= asked_before) {
            return refused("rays", rays, "the run has traced or planned as many already; ask for more in all");
        }
        let was_finished = self.is_finished();
        self.extended.push(std::mem::replace(&mut self.settings.budget, budget));
        (self.rays_in_all, self.until) = (budget.rays(), budget.rays());
        if was_finished && !self.is_finished() {
            self.start_again(problem);
        }
        Ok(())
    }

    /// Starts the next complete solution of a finished run, whose last one has given its memory back.
    fn start_again(&mut self, problem: &Problem) {
        // Whatever it draws beside the seed of each complete solution must be new.
        let seed = derive(self.settings.seed, u64::MAX - u64::from(self.replicate));
        self.complete = (self.settings.method.order.entry().make)(problem, &Settings { seed, ..self.settings });
        if self.round_is_complete() {
            self.next_round(problem);
        }
        self.start_replicate(problem);
    }

    /// Closes the running round and plans the next: one that brings the rays to what is asked for, or one with twice as many.
    pub(super) fn next_round(&mut self, problem: &Problem) {
        self.replicates.close_round();
        match self.until.take() {
            None => self.rays_each = (2 * self.rays_each).min(most_rays_each(problem, &self.settings)),
            Some(rays) => {
                let lacking = rays.saturating_sub(self.rays);
                (self.replicates_in_round, self.rays_each) = shape_of_round(problem, &self.settings, lacking);
            }
        }
    }

    /// Whether one more round is to come.
    pub(super) fn lacks_rays(&self) -> bool {
        self.until.is_some_and(|rays| rays > self.rays)
    }

    /// What the provenance says of an extended run: from what it was extended.
    pub(super) fn extended_from(&self) -> Option<(String, String)> {
        let before = self.extended.iter().map(|budget| format!("{} {}", budget.in_words().0, budget.in_words().1));
        let before: Vec<String> = before.collect();
        (!before.is_empty()).then(|| ("extended from".to_owned(), before.join(", then ")))
    }
}
