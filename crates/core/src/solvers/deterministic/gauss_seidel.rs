//! Gauss-Seidel iteration: one element after the other gathers from the newest radiosities.
//!
//! ```text
//! E_i <- (Σ_{j != i} F_ij B_j + F_ii Be_i) / (1 - rho_i F_ii),      B_i <- Be_i + rho_i E_i,      i = 1, 2, ... n
//! ```
//!
//! About half the sweeps of Jacobi's, but each element waits for the one before. So the work is cut in blocks: what a block
//! gathers from outside of it is summed on all threads, what its elements gather from each other in turn. That is the
//! sequential method in another order of addition. Cohen & Greenberg 1985. Biased by the form factors and the constant
//! elements only. Cost: all form factors once a sweep.

use super::Settings;
use super::matrix_solver::{MOST_SWEEPS, MatrixSolver, Method, landing, light_of};
use super::system::{Light, Surfaces, System, luminance, minus};
use crate::solvers::Landing;
use crate::{Error, Problem};
use std::ops::Range;

/// The name of the method.
pub const NAME: &str = "gauss-seidel";
/// Elements of a block, and rows of a piece.
const BLOCK: usize = 64;
const ROWS_PER_PIECE: usize = 8;

/// The state of a sweep.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct GaussSeidel {
    limit: f64,
    irradiance: Vec<Light>,
    radiosity: Vec<Light>,
    /// What the elements of the running block gathered from outside of it [lux].
    from_outside: Vec<Light>,
    block: usize,
    /// Luminous flux [lm] by which the running sweep has changed the radiosities, and the whole of the last one.
    change: f64,
    unshot: f64,
    emitted: f64,
    sweeps: u64,
}

/// The solver.
///
/// # Errors
/// Those of [`MatrixSolver::new`].
pub fn solver(problem: &Problem, settings: &Settings) -> Result<MatrixSolver, Error> {
    MatrixSolver::new(problem, settings, NAME, |surfaces| GaussSeidel::new(surfaces, settings.unshot))
}

impl GaussSeidel {
    /// Before the first sweep. Sweeps end when one has changed no more than this share of the emitted power.
    pub fn new(surfaces: &Surfaces, limit: f64) -> GaussSeidel {
        let emitted = surfaces.emitted();
        GaussSeidel {
            limit,
            irradiance: vec![[0.0; 3]; surfaces.area.len()],
            radiosity: surfaces.emission.clone(),
            from_outside: Vec::new(),
            block: 0,
            change: 0.0,
            unshot: emitted,
            sweeps: 0,
            emitted,
        }
    }

    /// The elements of the running block.
    fn elements(&self) -> Range<usize> {
        let first = self.block * BLOCK;
        first..(first + BLOCK).min(self.radiosity.len())
    }
}

#[typetag::serde]
impl Method for GaussSeidel {
    fn stage(&self) -> &'static str {
        "gathering"
    }

    fn pieces(&self, _: &System) -> Option<u64> {
        let goes_on = self.unshot > self.limit * self.emitted && self.unshot <= 1e6 * self.emitted;
        (goes_on && self.sweeps < MOST_SWEEPS).then(|| self.elements().len().div_ceil(ROWS_PER_PIECE) as u64)
    }

    fn part(&self, system: &System, piece: u64) -> Vec<Landing> {
        let block = self.elements();
        let first = block.start + piece as usize * ROWS_PER_PIECE;
        let outside = |i: usize| {
            let others = system.factors.row(i).filter(|(j, _)| !block.contains(j));
            others.fold([0.0; 3], |sum, (j, f)| std::array::from_fn(|c| sum[c] + f * self.radiosity[j][c]))
        };
        (first..(first + ROWS_PER_PIECE).min(block.end)).map(|i| landing(i, outside(i))).collect()
    }

    fn absorb(&mut self, _: &System, landings: Vec<Landing>) {
        self.from_outside.extend(landings.iter().map(light_of));
    }

    fn end_step(&mut self, system: &System) {
        let surfaces = &system.surfaces;
        let block = self.elements();
        for (i, outside) in block.clone().zip(std::mem::take(&mut self.from_outside)) {
            let (mut arrived, mut own) = (outside, 0.0);
            for (j, f) in system.factors.row(i).filter(|(j, _)| block.contains(j)) {
                let seen = if i == j { surfaces.emission[i] } else { self.radiosity[j] };
                (0..3).for_each(|c| arrived[c] += f * seen[c]);
                own = if i == j { f } else { own };
            }
            self.irradiance[i] = std::array::from_fn(|c| arrived[c] / (1.0 - surfaces.reflectivity[i][c] * own));
            let new = surfaces.radiosity(i, self.irradiance[i]);
            self.change += surfaces.area[i] * luminance(minus(new, self.radiosity[i])).abs();
            self.radiosity[i] = new;
        }
        self.block += 1;
        if block.end == self.radiosity.len() {
            self.block = 0;
            self.sweeps += 1;
            self.unshot = std::mem::take(&mut self.change);
        }
    }

    fn irradiance(&self) -> &[Light] {
        &self.irradiance
    }

    fn fits(&self, elements: usize) -> bool {
        [self.irradiance.len(), self.radiosity.len()] == [elements; 2]
    }

    fn unshot(&self) -> f64 {
        self.unshot
    }
}
