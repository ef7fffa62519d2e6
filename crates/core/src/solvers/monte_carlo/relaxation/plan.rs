//! How the rays of one complete solution are shared between its steps.
//!
//! Emission and reflection share the shooting rays by their expected power, so that all rays carry about the same. The stages
//! share those of reflection as their course says.

use super::course::Stage;
use crate::solvers::monte_carlo::{Experience, patience};

/// Incremental shooting stops when less than this share of the emitted power is unshot, and warming up when as little of it can
/// be missing.
const UNSHOT_LIMIT: f64 = 1e-6;

/// The rays of one sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Share of the rays that shoot.
    pub shooting: f64,
    pub rays: u64,
    pub experience: Experience,
}

impl Plan {
    /// Rays for the next step of `stage`, of which so many iterations are done. The step shoots `power`, a share of the emitted
    /// power, after `done` rays of earlier steps. Zero if there is nothing to do.
    pub fn rays_of_step(&self, stage: Stage, iteration: u32, power: f64, done: u64) -> u64 {
        let shooting = self.shooting * self.rays as f64;
        let emission = shooting / (1.0 + self.experience.reflected_share);
        let reflected = shooting - emission;
        match stage {
            Stage::Gathering => self.rays.saturating_sub(done),
            _ if power <= 0.0 => 0,
            Stage::Lamps | Stage::Emission => (emission * power).ceil() as u64,
            Stage::Multipath { share } => (share * reflected).ceil() as u64,
            Stage::Incremental { .. } if power < UNSHOT_LIMIT => 0,
            Stage::Incremental { share, every_step } => {
                let expected = if every_step { power } else { self.experience.reflected_share };
                let rays = (share * reflected * power / expected.max(1e-3)).ceil().max(1.0) as u64;
                rays.min(patience(self.rays).saturating_sub(done))
            }
            Stage::WarmUp { .. } if iteration >= self.warm_up() => 0,
            Stage::WarmUp { share } => (share * reflected / f64::from(self.warm_up())).ceil() as u64,
            Stage::Averaged { iterations, .. } if iteration >= iterations => 0,
            Stage::Averaged { share, iterations } => (share * reflected / f64::from(iterations)).ceil() as u64,
            Stage::Regular => (shooting as u64).saturating_sub(done),
        }
    }

    /// Iterations until the light that is missing, `rho^k` of all after k of them, is below the limit.
    fn warm_up(&self) -> u32 {
        let rho = self.experience.mean_reflectivity().clamp(0.1, 0.99);
        (UNSHOT_LIMIT.ln() / rho.ln()).ceil() as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INCREMENTAL: Stage = Stage::Incremental { share: 0.5, every_step: false };

    fn plan(rays: u64) -> Plan {
        Plan { shooting: 0.6, rays, experience: Experience { reflected_share: 1.0 } }
    }

    #[test]
    fn light_that_nothing_absorbs_is_given_up() {
        let plan = plan(100);
        for growth in [1.0, 1.1, 1e9] {
            let (mut done, mut share, mut steps) = (0, 1.0, 0);
            while plan.rays_of_step(INCREMENTAL, 0, share, done) > 0 {
                done += plan.rays_of_step(INCREMENTAL, 0, share, done);
                share *= growth;
                steps += 1;
            }
            assert_eq!(done, 201_000);
            assert!(steps < 20_000, "{steps}");
        }
    }

    #[test]
    fn the_rays_of_all_steps_add_up() {
        // A room that reflects half: each step shoots half of what the step before shot, as much as was emitted in all.
        let plan = plan(100_000);
        let mut done = plan.rays_of_step(Stage::Emission, 0, 1.0, 0);
        let mut share = 0.5;
        loop {
            let rays = plan.rays_of_step(INCREMENTAL, 0, share, done);
            if rays == 0 {
                break;
            }
            done += rays;
            share /= 2.0;
        }
        let incremental = done - 30_000;
        assert!((15_000..15_030).contains(&incremental), "{incremental}");
        done += plan.rays_of_step(Stage::Regular, 0, 1.0, done);
        assert_eq!(done, 60_000);
        assert_eq!(done + plan.rays_of_step(Stage::Gathering, 0, 0.0, done), 100_000);
    }

    #[test]
    fn the_rays_of_iterations_add_up() {
        let plan = Plan { shooting: 1.0, ..plan(100_000) };
        let rays_of = |stage: Stage| -> u64 {
            (0..).map(|iteration| plan.rays_of_step(stage, iteration, 1.0, 0)).take_while(|&rays| rays > 0).sum()
        };
        let emission = plan.rays_of_step(Stage::Emission, 0, 1.0, 0);
        let warm_up = rays_of(Stage::WarmUp { share: 0.1 });
        let averaged = rays_of(Stage::Averaged { share: 0.9, iterations: 8 });
        assert!((99_900..100_100).contains(&(emission + warm_up + averaged)), "{emission} {warm_up} {averaged}");
        assert!((0.5f64).powi(plan.warm_up() as i32) <= UNSHOT_LIMIT);
    }

    #[test]
    fn steps_that_have_a_share_each_have_it_whatever_they_shoot() {
        let stage = Stage::Incremental { share: 0.1, every_step: true };
        let rays = |power| plan(100_000).rays_of_step(stage, 0, power, 0);
        assert!([0.9, 0.3, 0.01].iter().all(|&power| (2_999..=3_001).contains(&rays(power))), "{}", rays(0.3));
        assert_eq!(rays(0.5 * UNSHOT_LIMIT), 0);
    }
}
