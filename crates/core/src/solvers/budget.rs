//! How many rays: the heuristic for stochastic radiosity (Bekaert 1999).
//!
//! Shooting N rays gives element i the variance `rho_i b_i P_T / (A_i N)`. A relative error of about the mean radiosity at
//! three standard deviations therefore takes `N ≈ 9 max_i rho_i A_T / A_i`, where the tenth of the elements with the
//! largest `rho_i / A_i` is left out of the maximum.
//!
//! In a scene of equal elements that is only 9 rays an element. A picture wants about ten times as many, and there they
//! cost seconds, so the recommendation never falls below [`RAYS_PER_ELEMENT`].

use crate::mesh::ElementMesh;

/// Share of the elements that the heuristic leaves out.
const WORST: f64 = 0.1;
/// The least that is recommended for each element.
pub const RAYS_PER_ELEMENT: u64 = 100;

/// The heuristic's number of rays for one unit of accuracy, or [`RAYS_PER_ELEMENT`] for each element if that is more.
pub fn rays(mesh: &ElementMesh) -> u64 {
    (heuristic(mesh, WORST).ceil() as u64).max(RAYS_PER_ELEMENT * mesh.len() as u64)
}

/// `9 max_i rho_i A_T / A_i`, where the share `left_out` of the elements with the largest `rho_i / A_i` does not count.
pub fn heuristic(mesh: &ElementMesh, left_out: f64) -> f64 {
    let ratio = |e| mesh.reflectivity(e).luminance() / mesh.area(e);
    let mut ratios: Vec<f32> = mesh.elements().map(ratio).collect();
    let rank = ((ratios.len() - 1) as f64 * (1.0 - left_out.clamp(0.0, 1.0))) as usize;
    let (_, worst, _) = ratios.select_nth_unstable_by(rank, f32::total_cmp);
    9.0 * f64::from(*worst) * mesh.total_area()
}
