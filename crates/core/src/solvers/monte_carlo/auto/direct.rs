//! Direct light that each element looks for ([`DirectLight`]), merged with what was shot.
//!
//! One round of it belongs to each complete solution that has enough rays. Its weight follows from variances that a trial and
//! earlier complete solutions have shown. The trial is not merged with anything: no estimate is weighted by its own noise.

use crate::Problem;
use crate::solvers::Part;
use crate::solvers::direct_light::{DirectLight, Neighbours};
use crate::solvers::monte_carlo::Settings as Run;
use crate::solvers::monte_carlo::relaxation::Relaxation;
use std::ops::Range;

#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Direct {
    light: DirectLight,
    /// Of the running round or trial.
    pieces: u64,
    absorbed: u64,
}

impl Direct {
    pub fn new(problem: &Problem, run: &Run) -> Direct {
        let light = DirectLight::new(problem, run.seed, run.method.sequence);
        Direct { light, pieces: 0, absorbed: 0 }
    }

    pub fn fits(&self, problem: &Problem) -> bool {
        self.light.fits(problem)
    }

    /// What rays are worth, as far as they were tried.
    pub fn learned(&self) -> &Neighbours {
        self.light.neighbours()
    }

    pub fn begin_trial(&mut self) {
        self.light.begin_trial();
        (self.pieces, self.absorbed) = (self.light.pieces(), 0);
    }

    /// Begins the round of a complete solution, with so many rays, if any, after rays of so much flux [lm] have shot.
    pub fn begin(&mut self, problem: &Problem, rays: u64, ray_flux: f64) {
        (self.pieces, self.absorbed) = (0, 0);
        if rays > 0 {
            self.light.begin_round(problem, rays as f64, ray_flux);
            self.pieces = self.light.pieces();
        }
    }

    pub fn pieces(&self) -> Range<u64> {
        self.absorbed..self.pieces
    }

    pub fn part(&self, problem: &Problem, piece: u64) -> Part {
        let received = self.light.piece(problem, piece);
        let rays = received.iter().map(|received| u64::from(received.traced)).sum();
        Part { received, rays, ..Part::default() }
    }

    /// Merges the next piece in order with what was `shot`, unless this is the trial; whether it was the last.
    pub fn absorb(&mut self, problem: &Problem, part: &Part, shot: &mut Relaxation) -> bool {
        self.light.merge(problem, self.absorbed, &part.received, |e, irradiance, weight| {
            shot.light_mut().merge_direct(e, irradiance * problem.mesh.area(e), weight);
        });
        self.light.learn(self.absorbed, &part.received);
        self.absorbed += 1;
        let complete = self.absorbed == self.pieces;
        if complete {
            self.light.end_round();
        }
        complete
    }
}
