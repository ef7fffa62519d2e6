//! Direct light that each element looks for ([`DirectLight`]), merged with what was shot.
//!
//! One round of it belongs to each complete solution that has enough rays. Its weight follows from variances that
//! earlier complete solutions have shown. Before the first of them there is a trial, which is not merged with anything: no
//! estimate is weighted by its own noise.

use crate::Problem;
use crate::solvers::Part;
use crate::solvers::direct_light::{DirectLight, Neighbours};
use crate::solvers::monte_carlo::Settings as Run;
use crate::solvers::monte_carlo::relaxation::Relaxation;
use std::ops::Range;

#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Direct {
    light: DirectLight,
    /// Rays of the running complete solution; 0 if there is no round.
    rays: u64,
    /// Flux [lm] of the rays that have shot.
    ray_flux: f64,
    /// Whether the trial is over.
    tried: bool,
    absorbed: u64,
}

impl Direct {
    pub fn new(problem: &Problem, run: &Run) -> Direct {
        let light = DirectLight::new(problem, run.seed, run.method.sequence);
        Direct { light, rays: 0, ray_flux: 0.0, tried: false, absorbed: 0 }
    }

    pub fn fits(&self, problem: &Problem) -> bool {
        self.light.fits(problem)
    }

    /// What rays are worth, if they were tried.
    pub fn learned(&self) -> Option<&Neighbours> {
        self.tried.then_some(self.light.neighbours())
    }

    /// Begins the round of a complete solution, with so many rays, after rays of so much flux [lm] have shot.
    pub fn begin(&mut self, problem: &Problem, rays: u64, ray_flux: f64) {
        (self.rays, self.ray_flux) = (rays, ray_flux);
        self.begin_round(problem);
    }

    fn begin_round(&mut self, problem: &Problem) {
        self.absorbed = 0;
        match self.rays {
            0 => {}
            _ if !self.tried => self.light.begin_trial(),
            rays => self.light.begin_round(problem, rays as f64, self.ray_flux),
        }
    }

    pub fn pieces(&self) -> Range<u64> {
        if self.rays > 0 { self.absorbed..self.light.pieces() } else { 0..0 }
    }

    pub fn part(&self, problem: &Problem, piece: u64) -> Part {
        let received = self.light.piece(problem, piece);
        let rays = received.iter().map(|received| u64::from(received.traced)).sum();
        Part { received, rays, ..Part::default() }
    }

    /// Merges the next piece in order with what was `shot`; whether it was the last of this complete solution.
    pub fn absorb(&mut self, problem: &Problem, part: &Part, shot: &mut Relaxation) -> bool {
        self.light.merge(problem, self.absorbed, &part.received, |e, irradiance, weight| {
            shot.light_mut().merge_direct(e, irradiance * problem.mesh.area(e), weight);
        });
        self.light.learn(self.absorbed, &part.received);
        self.absorbed += 1;
        if self.absorbed < self.light.pieces() {
            return false;
        }
        let complete = self.tried;
        if !complete {
            self.tried = true;
            self.begin_round(problem);
        }
        complete
    }
}
