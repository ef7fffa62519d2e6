//! What sends out light of its own: emitting elements, and after them, by number, the lights without extent.

use crate::Problem;
use crate::math::Rgb;

/// Number of sources: elements and lights.
pub fn count(problem: &Problem) -> usize {
    problem.mesh.len() + problem.scene.lights.len()
}

/// Flux [lm] that source `i` sends out of its own.
pub fn flux(problem: &Problem, i: u32) -> Rgb {
    match (i as usize).checked_sub(problem.mesh.len()) {
        None => problem.mesh.emitted_flux(i),
        Some(light) => problem.scene.lights[light].flux(problem.geometry.bounding_sphere().1),
    }
}

/// Luminous flux [lm] of every source.
pub fn luminous(problem: &Problem) -> impl Iterator<Item = (u32, f64)> {
    (0..count(problem) as u32).map(|i| (i, flux(problem, i).luminance_f64()))
}

/// Luminous flux [lm] of all emitting surfaces.
pub fn of_surfaces(problem: &Problem) -> f64 {
    problem.mesh.elements().map(|e| problem.mesh.emitted_flux(e).luminance_f64()).sum()
}

/// Luminous flux [lm] of all sources.
pub fn total(problem: &Problem) -> f64 {
    luminous(problem).map(|(_, flux)| flux).sum()
}
