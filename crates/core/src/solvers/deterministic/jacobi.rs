//! Jacobi iterations, in three forms that differ in the direction of the work only.
//!
//! ```text
//! gather        E_i  <- Σ_j F_ij B_j                  every element collects;  B = Be + rho E after each iteration
//! shoot         A_j E_j <- Σ_i A_i B_i F_ij           every element distributes all its power
//! incremental   A_j E_j += Σ_i A_i D_i F_ij           every element distributes what it has not distributed yet, D
//! ```
//!
//! After k iterations all three hold the light of at most k bounces, the same to rounding. Converges if reflectivities are
//! below one; the unshot power falls by the mean reflectivity each time. Biased by the form factors and the constant elements
//! only. Cost: all form factors once an iteration. Goral et al. 1984 (gathering); Neumann et al. 1995 and Shirley 1991 have
//! the shooting forms with random numbers.

use super::Settings;
use super::matrix_solver::{MOST_SWEEPS, MatrixSolver, Method, landing, light_of};
use super::system::{Light, Surfaces, System, minus, plus, times};
use crate::solvers::Landing;
use crate::{Error, Problem};

/// Rows of one piece.
const ROWS_PER_PIECE: usize = 128;

/// The direction of the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Form {
    Gather,
    Shoot,
    Incremental,
}

impl Form {
    pub const ALL: [Form; 3] = [Form::Gather, Form::Shoot, Form::Incremental];

    pub fn name(self) -> &'static str {
        match self {
            Form::Gather => "jacobi-gather",
            Form::Shoot => "jacobi-shoot",
            Form::Incremental => "jacobi-incremental",
        }
    }
}

/// The state of an iteration.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Jacobi {
    form: Form,
    limit: f64,
    /// Irradiance [lux] after the last iteration.
    irradiance: Vec<Light>,
    /// What the running iteration distributes: radiosity B, or unshot radiosity D [lm/m²].
    sent: Vec<Light>,
    /// What has arrived in the running iteration [lux].
    arrived: Vec<Light>,
    emitted: f64,
    unshot: f64,
    iterations: u64,
}

/// The solver of one form.
///
/// # Errors
/// Those of [`MatrixSolver::new`].
pub fn solver(problem: &Problem, settings: &Settings, form: Form) -> Result<MatrixSolver, Error> {
    MatrixSolver::new(problem, settings, form.name(), |surfaces| Jacobi::new(surfaces, form, settings.unshot))
}

impl Jacobi {
    /// Before the first iteration: nothing has arrived, all emission is unshot. Iterations end at an unshot share of `limit`.
    pub fn new(surfaces: &Surfaces, form: Form, limit: f64) -> Jacobi {
        let dark = vec![[0.0; 3]; surfaces.area.len()];
        let emitted = surfaces.emitted();
        Jacobi {
            form,
            limit,
            irradiance: dark.clone(),
            sent: surfaces.emission.clone(),
            arrived: dark,
            emitted,
            unshot: emitted,
            iterations: 0,
        }
    }
}

#[typetag::serde]
impl Method for Jacobi {
    fn stage(&self) -> &'static str {
        if self.form == Form::Gather { "gathering" } else { "shooting" }
    }

    /// None are left when hardly any light is unshot, or more than was emitted: then nothing absorbs it.
    fn pieces(&self, system: &System) -> Option<u64> {
        let goes_on = self.unshot > self.limit * self.emitted && self.unshot <= 2.0 * self.emitted;
        (goes_on && self.iterations < MOST_SWEEPS).then(|| system.factors.len().div_ceil(ROWS_PER_PIECE) as u64)
    }

    fn part(&self, system: &System, piece: u64) -> Vec<Landing> {
        let rows = rows(system, piece);
        if self.form == Form::Gather {
            return rows.map(|i| landing(i, system.gathered(i, &self.sent))).collect();
        }
        let area = &system.surfaces.area;
        let mut flux = vec![[0.0; 3]; area.len()];
        for i in rows.filter(|&i| self.sent[i] != [0.0; 3]) {
            for (j, f) in system.factors.row(i) {
                (0..3).for_each(|c| flux[j][c] += area[i] * f * self.sent[i][c]);
            }
        }
        let lit = flux.into_iter().enumerate().filter(|(_, flux)| *flux != [0.0; 3]);
        lit.map(|(j, flux)| landing(j, flux.map(|v| v / area[j]))).collect()
    }

    fn absorb(&mut self, _: &System, landings: Vec<Landing>) {
        for landing in &landings {
            let arrived = &mut self.arrived[landing.element as usize];
            *arrived = plus(*arrived, light_of(landing));
        }
    }

    fn end_step(&mut self, system: &System) {
        self.iterations += 1;
        let surfaces = &system.surfaces;
        let arrived = std::mem::replace(&mut self.arrived, vec![[0.0; 3]; self.sent.len()]);
        if self.form == Form::Incremental {
            self.irradiance.iter_mut().zip(&arrived).for_each(|(e, more)| *e = plus(*e, *more));
            self.sent = arrived.iter().zip(&surfaces.reflectivity).map(|(e, rho)| times(*e, *rho)).collect();
            self.unshot = surfaces.flux(self.sent.iter().copied());
        } else {
            let next: Vec<Light> = arrived.iter().enumerate().map(|(i, &e)| surfaces.radiosity(i, e)).collect();
            self.unshot = surfaces.flux(next.iter().zip(&self.sent).map(|(new, old)| minus(*new, *old))).abs();
            (self.irradiance, self.sent) = (arrived, next);
        }
    }

    fn irradiance(&self) -> &[Light] {
        &self.irradiance
    }

    fn fits(&self, elements: usize) -> bool {
        [self.irradiance.len(), self.sent.len(), self.arrived.len()] == [elements; 3]
    }

    fn unshot(&self) -> f64 {
        self.unshot
    }
}

/// The rows of a piece.
fn rows(system: &System, piece: u64) -> std::ops::Range<usize> {
    let first = piece as usize * ROWS_PER_PIECE;
    first..(first + ROWS_PER_PIECE).min(system.factors.len())
}
