//! The direct solution: the dense system by LU decomposition, for small scenes, the reference for all others.
//!
//! ```text
//! (1 - F rho) E = F Be,      for each channel
//! ```
//!
//! Goral, Torrance, Greenberg & Battaile 1984. Biased by the form factors and the constant elements only. Cost: n³ for each
//! channel, and 8 n² bytes for those that run at the same time; so at most 4000 elements.

use super::Settings;
use super::lu;
use super::matrix_solver::{MatrixSolver, Method, landing, light_of};
use super::system::{Light, Surfaces, System, plus};
use crate::solvers::Landing;
use crate::{Error, Problem};

/// The name of the method.
pub const NAME: &str = "direct";
/// Half a gigabyte with all three channels at the same time, and a minute or so.
const MOST_ELEMENTS: usize = 4000;

/// Before or after the one step.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Direct {
    irradiance: Vec<Light>,
    emitted: f64,
    done: bool,
}

/// The solver.
///
/// # Errors
/// Those of [`MatrixSolver::new`]; [`Error::Parameter`] for more than 4000 elements, or a surface that reflects all it
/// receives: then there may be no solution.
pub fn solver(problem: &Problem, settings: &Settings) -> Result<MatrixSolver, Error> {
    let refuse = |name, value: String, allowed| Err(Error::Parameter { name, value, allowed });
    let mesh = &problem.mesh;
    if mesh.len() > MOST_ELEMENTS {
        let allowed = "the direct method takes 4000 elements at most; use gauss-seidel or stochastic-jacobi";
        return refuse("elements", mesh.len().to_string(), allowed);
    }
    let brightest = mesh.elements().map(|e| mesh.reflectivity(e).max_channel()).fold(0.0, f32::max);
    if brightest >= 1.0 {
        return refuse("reflectivity", brightest.to_string(), "the direct method needs reflectivities below 1");
    }
    MatrixSolver::new(problem, settings, NAME, |surfaces| Direct {
        irradiance: vec![[0.0; 3]; surfaces.area.len()],
        emitted: surfaces.emitted(),
        done: false,
    })
}

impl Direct {
    /// Irradiance of one channel, dark if rounding has made the system singular.
    fn channel(surfaces: &Surfaces, system: &System, c: usize) -> Vec<f64> {
        let n = surfaces.area.len();
        let mut matrix = vec![0.0; n * n];
        let mut direct = vec![0.0; n];
        for i in 0..n {
            matrix[i * n + i] = 1.0;
            for (j, f) in system.factors.row(i) {
                matrix[i * n + j] -= f * surfaces.reflectivity[j][c];
                direct[i] += f * surfaces.emission[j][c];
            }
        }
        lu::solve(matrix, direct).unwrap_or(vec![0.0; n])
    }
}

#[typetag::serde]
impl Method for Direct {
    fn stage(&self) -> &'static str {
        "solving the dense system"
    }

    /// One for each channel.
    fn pieces(&self, _: &System) -> Option<u64> {
        (!self.done && self.emitted > 0.0).then_some(3)
    }

    fn part(&self, system: &System, piece: u64) -> Vec<Landing> {
        let c = piece as usize;
        let of_channel = |e: f64| std::array::from_fn(|k| if k == c { e } else { 0.0 });
        let irradiance = Direct::channel(&system.surfaces, system, c);
        irradiance.into_iter().enumerate().map(|(i, e)| landing(i, of_channel(e))).collect()
    }

    fn absorb(&mut self, _: &System, landings: Vec<Landing>) {
        for landing in &landings {
            let e = &mut self.irradiance[landing.element as usize];
            *e = plus(*e, light_of(landing));
        }
    }

    fn end_step(&mut self, _: &System) {
        self.done = true;
    }

    fn irradiance(&self) -> &[Light] {
        &self.irradiance
    }

    fn fits(&self, elements: usize) -> bool {
        self.irradiance.len() == elements
    }

    fn unshot(&self) -> f64 {
        if self.done { 0.0 } else { self.emitted }
    }
}
