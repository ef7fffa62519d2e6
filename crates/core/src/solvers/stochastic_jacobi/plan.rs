//! How the rays of one complete solution are shared between its steps.
//!
//! Emission and reflection share the shooting rays by their expected power, so that all rays carry about the same; half of
//! those for reflected light go to the incremental steps, half to the regular iteration. The rest gathers.

use super::relaxation::Stage;
use crate::Problem;

/// Share of the rays that shoot; the others gather.
const SHOOTING_SHARE: f64 = 0.6;
/// Incremental shooting stops when less than this share of the emitted power is unshot.
const UNSHOT_LIMIT: f64 = 1e-6;
/// Incremental shooting gives up after this many times the planned rays, and so many more. A room of mean reflectivity 0.9999
/// stays below; where nothing absorbs light it would go on for ever. What is left is the balance's unshot light.
const PATIENCE: (u64, u64) = (10, 200_000);

/// What one complete solution teaches the next about where rays are best spent. It never touches an expected value.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Experience {
    /// Reflected over emitted power.
    pub reflected_share: f64,
}

impl Experience {
    /// What to expect before anything is known: the closed room of mean reflectivity `rho` reflects `rho / (1 - rho)`
    /// of what is emitted.
    pub fn expected(problem: &Problem) -> Experience {
        let mesh = &problem.mesh;
        let weighted = |e| f64::from(mesh.area(e)) * mesh.reflectivity(e).luminance_f64();
        let rho = (mesh.elements().map(weighted).sum::<f64>() / mesh.total_area()).clamp(0.0, 0.95);
        Experience { reflected_share: rho / (1.0 - rho) }
    }
}

/// The rays of one complete solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    pub rays: u64,
    /// Expected reflected over emitted power.
    pub reflected_share: f64,
}

impl Plan {
    /// Rays for a step of `stage` that shoots `share` of the emitted power, after `done` rays of earlier steps; zero if there is
    /// nothing to do.
    pub fn rays_of_step(&self, stage: Stage, share: f64, done: u64) -> u64 {
        let shooting = SHOOTING_SHARE * self.rays as f64;
        let emission = shooting / (1.0 + self.reflected_share);
        match stage {
            Stage::Gathering => self.rays.saturating_sub(done),
            _ if share <= 0.0 => 0,
            Stage::Lamps | Stage::Emission => (emission * share).ceil() as u64,
            Stage::Incremental if share < UNSHOT_LIMIT => 0,
            Stage::Incremental => {
                let incremental = 0.5 * (shooting - emission);
                let rays = (incremental * share / self.reflected_share.max(1e-3)).ceil().max(1.0) as u64;
                let patience = self.rays.saturating_mul(PATIENCE.0).saturating_add(PATIENCE.1);
                rays.min(patience.saturating_sub(done))
            }
            Stage::Regular => (shooting as u64).saturating_sub(done),
            Stage::Done => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_that_nothing_absorbs_is_given_up() {
        let plan = Plan { rays: 100, reflected_share: 1.0 };
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
        let plan = Plan { rays: 100_000, reflected_share: 1.0 };
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
}
