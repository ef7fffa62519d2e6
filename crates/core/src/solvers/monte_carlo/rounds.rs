//! When a run is done, and how large the next round of complete solutions is; also of a run that goes on beyond what it was asked for.
//!
//! Rounds are merged by what they are worth ([`Replicates`](crate::solvers::replicates)), so the estimate is as good as its bias, and its
//! error bars as honest. Whether it is accurate enough is looked at between rounds only, and they grow: whoever looks often
//! finds a lucky estimate in the end, and stops too early. Cost of extending: what a finished run has learned of where rays are best spent is
//! learned anew.

use super::{Budget, MOST_RAYS_EACH, MonteCarlo, RAYS_PER_ELEMENT, Settings};
use crate::math::hash::derive;
use crate::solvers::Solver;
use crate::transport::Leaving;
use crate::{Error, Problem};

impl MonteCarlo {
    /// After a complete round: there is what was asked for, or the next round is planned.
    pub(super) fn next_round(&mut self, problem: &Problem) {
        let next = match self.settings.budget {
            Budget::Endless => Some((self.replicates_in_round, self.doubled(problem))),
            Budget::Accuracy { accuracy, most_rays } => {
                let excess = accuracy.excess(problem, &self.solution(problem));
                let left = most_rays.map_or(u64::MAX, |most| most.saturating_sub(self.rays));
                let rays = rays_for(self.rays, excess).min(left);
                let is_last = excess <= 1.0 || left < u64::from(self.settings.replicates);
                self.excess = Some(excess);
                self.rays_in_all = Some(if is_last { self.rays } else { self.rays + rays });
                (!is_last).then(|| shape(problem, &self.settings, rays))
            }
            Budget::Heuristic | Budget::Rays(_) => {
                let lacking = self.until.take().map_or(0, |rays| rays.saturating_sub(self.rays));
                (lacking > 0).then(|| shape(problem, &self.settings, lacking))
            }
        };
        self.finished = next.is_none();
        if let Some(next) = next {
            self.totals.close_round(self.replicates.weight());
            self.replicates.close_round();
            (self.replicates_in_round, self.rays_each) = next;
        }
    }

    /// Twice as many rays for each complete solution, if there may be so many.
    fn doubled(&self, problem: &Problem) -> u64 {
        (2 * self.rays_each).min(most_rays_each(problem, &self.settings))
    }

    /// See [`Solver::go_on`](crate::solvers::Solver::go_on).
    pub(super) fn extend(&mut self, problem: &Problem, budget: Budget) -> Result<(), Error> {
        if budget == Budget::Heuristic || budget == self.settings.budget {
            return Ok(());
        }
        let refused = |name, value: u64, allowed| Err(Error::Parameter { name, value: value.to_string(), allowed });
        if self.settings.replicates == 1 {
            let allowed = "a run without error bars cannot be extended: rounds are weighted by them";
            return refused("replicates", 1, allowed);
        }
        let asked_before = self.rays_in_all.unwrap_or_default().max(self.rays);
        if let Some(rays) = budget.rays().filter(|&rays| rays <= asked_before) {
            return refused("rays", rays, "the run has traced or planned as many already; ask for more in all");
        }
        self.extended.push(std::mem::replace(&mut self.settings.budget, budget));
        (self.rays_in_all, self.until, self.excess) = (budget.rays(), budget.rays(), None);
        if self.finished {
            self.start_again(problem);
        }
        Ok(())
    }

    /// Starts the next complete solution of a finished run, whose last one has given its memory back.
    fn start_again(&mut self, problem: &Problem) {
        self.next_round(problem);
        if !self.finished {
            // Whatever it draws beside the seed of each complete solution must be new.
            let seed = derive(self.settings.seed, u64::MAX - u64::from(self.replicate));
            self.complete = (self.settings.method.order.entry().make)(problem, &Settings { seed, ..self.settings });
            self.start_replicate(problem);
        }
    }
}

/// What the provenance says of an extended run: from what it was extended, by the budgets `before` its last one.
pub fn extended_from(before: &[Budget]) -> Option<(String, String)> {
    let in_words = |budget: &Budget| {
        let parameters = budget.parameters().into_iter().map(|(name, value)| format!("{name} {value}"));
        parameters.collect::<Vec<_>>().join(" ")
    };
    let before: Vec<String> = before.iter().map(in_words).collect();
    (!before.is_empty()).then(|| ("extended from".to_owned(), before.join(", then ")))
}

/// Rays of the round that shall bring the error down to what is asked for, where it is `excess` times as large after so many
/// `rays`: it falls with the root of the rays. A little more than that, so that it need not be tried again; not many times as many, for the
/// error is not known well after few, and not very few, for a round has its cost.
pub fn rays_for(rays: u64, excess: f64) -> u64 {
    let (rays, excess) = (rays as f64, if excess.is_nan() { f64::INFINITY } else { excess });
    ((1.1 * excess * excess - 1.0) * rays).clamp(rays / 4.0, 4.0 * rays) as u64
}

/// Complete solutions of a round of so many rays, and the rays of each.
pub(super) fn shape(problem: &Problem, settings: &Settings, rays: u64) -> (u32, u64) {
    let most_each = most_rays_each(problem, settings);
    let replicates = rays.div_ceil(most_each).clamp(settings.replicates.into(), u32::MAX.into()) as u32;
    (replicates, rays.div_ceil(replicates.into()))
}

/// Most rays of a complete solution.
fn most_rays_each(problem: &Problem, settings: &Settings) -> u64 {
    if settings.method.has_leaving() && settings.leaving == Leaving::WhereLanded {
        (RAYS_PER_ELEMENT * problem.mesh.len() as u64).clamp(1000, MOST_RAYS_EACH)
    } else {
        MOST_RAYS_EACH
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_round_has_as_many_rays_as_the_error_lacks() {
        assert_eq!(rays_for(1000, 2.0), 3400);
        assert_eq!(rays_for(1000, 1.01), 250, "a round has its cost");
        assert_eq!(rays_for(1000, 100.0), 4000, "the error is not known well yet");
        assert_eq!(rays_for(1000, f64::NAN), 4000);
    }
}
