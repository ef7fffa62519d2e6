//! How much each element around a vertex counts: as its open area, tilted towards the vertex.
//!
//! ```text
//! w_i = p_i (1 - s g·(d_i - m)),    m = Σ p_i d_i,    g = (Σ p_i (d_i - m)(d_i - m)ᵀ + λ)⁻¹ m
//! ```
//!
//! with shares p of the area, and d from the vertex to the middle of each element. Where elements of different lengths meet, the mean
//! m of the middles lies among the long ones, and shares of area alone would draw the vertex to their light. With s = 1 the value is that
//! of the plane that fits the elements best (weighted least squares; Lancaster and Salkauskas, Mathematics of Computation 1981), so
//! straight gradients are kept. At a border the plane would be extrapolated, noise and all: s is as large as leaves every element
//! at least [`LEAST`] of its share. No weight is negative, so values stay among those of the elements.
//!
//! Linear in the corners of elements, four bytes each; same bits always.

use super::vertices::Vertices;
use crate::Problem;
use crate::math::Rgb;
use glam::{Mat3, Vec3};
use rayon::prelude::*;

/// What an element keeps of its share, at least.
const LEAST: f32 = 0.5;
/// λ, as a share of the square of the way to the farthest middle: below it middles lie in one plane, or in one line.
const RIDGE: f32 = 1e-3;

/// For every vertex the weights of the elements that touch it, which add up to 1.
#[derive(Clone, Debug)]
pub struct VertexWeights {
    /// One after the other, each in the order of [`Vertices::touching`].
    weights: Vec<f32>,
}

impl VertexWeights {
    /// Of elements of whose areas the shares `open` count ([`super::cover`]).
    pub fn new(problem: &Problem, vertices: &Vertices, open: &[f32]) -> VertexWeights {
        let centres: Vec<Vec3> = problem.mesh.elements().into_par_iter().map(|e| problem.centre(e).0).collect();
        let at = |v: u32| {
            let around = vertices.touching(v);
            let areas = around.iter().map(|&e| problem.mesh.area(e) * open[e as usize]).collect();
            let away = around.iter().map(|&e| centres[e as usize] - vertices.position(v)).collect();
            tilted(shares(areas), away)
        };
        VertexWeights { weights: (0..vertices.len() as u32).into_par_iter().flat_map_iter(at).collect() }
    }

    /// Means at `vertices` of `values` of the elements. Summed as deviations from the first, so that equal values have exactly that value
    /// as their mean.
    pub fn means(&self, vertices: &Vertices, values: &[Rgb]) -> Vec<Rgb> {
        let mean = |v: u32| {
            let range = vertices.range(v);
            let Some(&first) = vertices.touching(v).first() else { return Rgb::BLACK };
            let base = values[first as usize];
            let deviation = |(&e, &w): (&u32, &f32)| (values[e as usize] - base) * w;
            base + vertices.touching(v).iter().zip(&self.weights[range]).map(deviation).sum::<Rgb>()
        };
        (0..vertices.len() as u32).into_par_iter().map(mean).collect()
    }
}

/// Shares of the sum; equal ones if there is none.
fn shares(areas: Vec<f32>) -> Vec<f32> {
    let sum: f32 = areas.iter().sum();
    if sum > 0.0 { areas.iter().map(|a| a / sum).collect() } else { vec![1.0 / areas.len() as f32; areas.len()] }
}

/// The weights of elements with these `shares` whose middles lie so far `away` [m] from the vertex.
fn tilted(shares: Vec<f32>, away: Vec<Vec3>) -> Vec<f32> {
    let reach = away.iter().fold(f32::MIN_POSITIVE, |reach, d| reach.max(d.length()));
    let away: Vec<Vec3> = away.iter().map(|d| *d / reach).collect();
    let mean: Vec3 = shares.iter().zip(&away).map(|(p, d)| *d * *p).sum();
    let squares = |d: Vec3| Mat3::from_cols(d * d.x, d * d.y, d * d.z);
    let spread = shares.iter().zip(&away).fold(Mat3::ZERO, |sum, (p, d)| sum + squares(*d - mean) * *p);
    let tilt = (spread + Mat3::IDENTITY * RIDGE).inverse() * mean;
    let lost = |d: &Vec3| tilt.dot(*d - mean);
    let most = away.iter().map(lost).fold(0.0, f32::max);
    let scale = if most > 1.0 - LEAST { (1.0 - LEAST) / most } else { 1.0 };
    shares.iter().zip(&away).map(|(p, d)| p * (1.0 - scale * lost(d))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Middles around a vertex, long elements to the right, and their areas.
    const AROUND: [(f32, f32, f32); 6] =
        [(0.1, 0.3, -0.1), (0.1, -0.2, -0.3), (0.2, 0.4, 0.3), (2.0, 0.9, 0.2), (1.5, 0.7, -0.8), (0.3, -0.1, 0.6)];

    fn weights(shift: f32) -> (Vec<f32>, Vec<Vec3>) {
        let away: Vec<Vec3> = AROUND.iter().map(|&(_, x, y)| Vec3::new(x + shift, y, 0.5 * (x + shift))).collect();
        (tilted(shares(AROUND.iter().map(|a| a.0).collect()), away.clone()), away)
    }

    #[test]
    fn a_vertex_between_elements_of_different_lengths_is_in_the_middle_of_them() {
        let middle = |weights: &[f32], away: &[Vec3]| weights.iter().zip(away).map(|(w, d)| *d * *w).sum::<Vec3>();
        let (weights, away) = weights(-0.45);
        let by_area = middle(&shares(AROUND.iter().map(|a| a.0).collect()), &away);
        assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
        let by_tilt = middle(&weights, &away);
        assert!(by_area.length() > 0.2 && by_tilt.length() < 0.02 * by_area.length(), "{by_area} {by_tilt}");
    }

    #[test]
    fn at_a_border_the_nearest_count_more_and_the_farthest_half_as_much() {
        let (weights, away) = weights(1.0);
        let by_area = shares(AROUND.iter().map(|a| a.0).collect());
        let kept: Vec<f32> = weights.iter().zip(&by_area).map(|(w, p)| w / p).collect();
        assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
        assert!((kept.iter().fold(f32::MAX, |least, k| least.min(*k)) - LEAST).abs() < 1e-5, "{kept:?}");
        let nearest = (0..6).fold(0, |near, k| if away[k].length() < away[near].length() { k } else { near });
        assert!(kept[nearest] > 1.0);
    }

    #[test]
    fn elements_that_are_covered_or_in_one_place_have_weights_too() {
        assert_eq!(tilted(shares(vec![0.0; 2]), vec![Vec3::X, Vec3::Y]).iter().sum::<f32>(), 1.0);
        assert_eq!(tilted(shares(vec![0.0, 3.0]), vec![Vec3::X, Vec3::Y]), [0.0, 1.0]);
        assert_eq!(tilted(shares(vec![1.0, 3.0]), vec![Vec3::ZERO; 2]), [0.25, 0.75]);
        assert!(tilted(shares(Vec::new()), Vec::new()).is_empty());
    }
}
