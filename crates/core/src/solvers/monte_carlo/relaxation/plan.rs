//! How the rays of one complete solution are shared between its steps.
//!
//! Emission and reflection share the shooting rays by their expected power, so that all rays carry about the same. With the order
//! `stochastic-jacobi` half of those for reflected light go to the incremental steps and half to the regular iteration, and
//! the rest of all rays gathers.

use super::stage::Stage;
use crate::solvers::monte_carlo::axes::Order;
use crate::solvers::monte_carlo::{Experience, patience};

/// Share of the rays that shoot where the others gather.
const SHOOTING_SHARE: f64 = 0.6;
/// Incremental shooting stops when less than this share of the emitted power is unshot, and warming up when as little of it can
/// be missing.
const UNSHOT_LIMIT: f64 = 1e-6;
/// Share of the rays for reflected light of stochastic ray radiosity that warm up.
const WARM_UP_SHARE: f64 = 0.1;
/// Iterations of stochastic ray radiosity that are averaged.
pub const AVERAGED: u32 = 8;
/// Share of the rays for reflected light that multipath keeps for what waits when its lines are used up.
const LEFT_OVER_SHARE: f64 = 0.1;

/// The rays of one complete solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    pub order: Order,
    /// Whether the last stage gathers: stochastic Jacobi along local lines.
    pub gathers: bool,
    pub rays: u64,
    pub experience: Experience,
}

impl Plan {
    /// Rays for a step of `stage` that shoots `share` of the emitted power, after `done` rays of earlier steps; zero if there is
    /// nothing to do.
    pub fn rays_of_step(&self, stage: Stage, share: f64, done: u64) -> u64 {
        let jacobi = self.order == Order::StochasticJacobi;
        let shooting = if self.gathers { SHOOTING_SHARE } else { 1.0 } * self.rays as f64;
        let emission = shooting / (1.0 + self.experience.reflected_share);
        let reflected = shooting - emission;
        match stage {
            Stage::Gathering => self.rays.saturating_sub(done),
            _ if share <= 0.0 => 0,
            Stage::Lamps | Stage::Emission => (emission * share).ceil() as u64,
            Stage::Multipath => ((1.0 - LEFT_OVER_SHARE) * reflected).ceil() as u64,
            Stage::Incremental if share < UNSHOT_LIMIT => 0,
            Stage::Incremental => {
                let incremental = match self.order {
                    Order::StochasticJacobi => 0.5 * reflected,
                    Order::DepthFirst => LEFT_OVER_SHARE * reflected,
                    _ => reflected,
                };
                let expected = if self.order == Order::DepthFirst { share } else { self.experience.reflected_share };
                let rays = (incremental * share / expected.max(1e-3)).ceil().max(1.0) as u64;
                rays.min(patience(self.rays).saturating_sub(done))
            }
            Stage::WarmUp => (WARM_UP_SHARE * reflected / f64::from(self.warm_up())).ceil() as u64,
            Stage::Regular if jacobi => (shooting as u64).saturating_sub(done),
            Stage::Regular => ((1.0 - WARM_UP_SHARE) * reflected / f64::from(AVERAGED)).ceil() as u64,
            Stage::Done => 0,
        }
    }

    /// Iterations until the light that is missing, `rho^k` of all after k of them, is below the limit.
    pub fn warm_up(&self) -> u32 {
        let rho = self.experience.mean_reflectivity().clamp(0.1, 0.99);
        (UNSHOT_LIMIT.ln() / rho.ln()).ceil() as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(rays: u64) -> Plan {
        Plan { order: Order::StochasticJacobi, gathers: true, rays, experience: Experience { reflected_share: 1.0 } }
    }

    #[test]
    fn light_that_nothing_absorbs_is_given_up() {
        let plan = plan(100);
        for growth in [1.0, 1.1, 1e9] {
            let (mut done, mut share, mut steps) = (0, 1.0, 0);
            while plan.rays_of_step(Stage::Incremental, share, done) > 0 {
                done += plan.rays_of_step(Stage::Incremental, share, done);
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
        let mut done = plan.rays_of_step(Stage::Emission, 1.0, 0);
        let mut share = 0.5;
        loop {
            let rays = plan.rays_of_step(Stage::Incremental, share, done);
            if rays == 0 {
                break;
            }
            done += rays;
            share /= 2.0;
        }
        let incremental = done - 30_000;
        assert!((15_000..15_030).contains(&incremental), "{incremental}");
        done += plan.rays_of_step(Stage::Regular, 1.0, done);
        assert_eq!(done, 60_000);
        assert_eq!(done + plan.rays_of_step(Stage::Gathering, 0.0, done), 100_000);
    }

    #[test]
    fn the_rays_of_stochastic_ray_radiosity_add_up() {
        let plan = Plan { order: Order::StochasticRay, gathers: false, ..plan(100_000) };
        let emission = plan.rays_of_step(Stage::Emission, 1.0, 0);
        let warm_up = u64::from(plan.warm_up()) * plan.rays_of_step(Stage::WarmUp, 1.0, 0);
        let averaged = u64::from(AVERAGED) * plan.rays_of_step(Stage::Regular, 1.0, 0);
        assert!((99_900..100_100).contains(&(emission + warm_up + averaged)), "{emission} {warm_up} {averaged}");
        assert!((0.5f64).powi(plan.warm_up() as i32) <= UNSHOT_LIMIT);
    }
}
