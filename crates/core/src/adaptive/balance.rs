//! Neighbours differ by one level at most: what lies beyond an edge of a leaf is split until its area is no more than four times as
//! large, a quarter of a level given or taken for triangles that are not similar.
//!
//! So elements become large gradually, light has no kinks where they do, and no element has a row of tiny ones along its edge. A probe just
//! beyond the middle of each edge finds the neighbour, on the same triangle or on one that goes on smoothly from it ([`super::borders`]). Linear in the
//! leaves, times the depth.

use super::borders::Borders;
use super::forest::{Forest, Leaf};
use crate::Problem;
use crate::mesh::surface_area;
use glam::Vec2;

/// A neighbour larger than this many times the area is split.
const LARGER: f64 = 8.0;
/// How far beyond an edge the neighbour is looked for, as a share of the height above it.
const BEYOND: f32 = 0.1;

/// Splits leaves of `forest` until neighbours differ by one level at most.
pub fn balance(problem: &Problem, forest: &mut Forest) {
    let borders = Borders::of(&problem.scene, problem.geometry.as_ref());
    let areas: Vec<f64> = (0..problem.scene.triangles.len() as u32).map(|t| surface_area(&problem.scene, t)).collect();
    let area = |leaf: &Leaf| areas[leaf.triangle as usize] * f64::from(leaf.area_share());
    let mut leaves = forest.leaves();
    while let Some(leaf) = leaves.pop() {
        if !forest.is_leaf(&leaf) {
            continue;
        }
        let most = LARGER * area(&leaf);
        for (triangle, uv) in probes(problem, &borders, &leaf) {
            loop {
                let neighbour = forest.leaf_at(triangle, uv);
                if area(&neighbour) <= most {
                    break;
                }
                let Some(parts) = forest.split(&neighbour) else { break };
                leaves.extend(parts);
            }
        }
    }
}

/// Points just beyond the middle of each edge of `leaf`.
pub(super) fn probes(problem: &Problem, borders: &Borders, leaf: &Leaf) -> Vec<(u32, Vec2)> {
    let mut probes = Vec::with_capacity(3);
    for k in 0..3 {
        let [a, b, opposite] = [0, 1, 2].map(|corner| leaf.corners[(corner + k) % 3]);
        let middle = 0.5 * (a + b);
        let beyond = middle + BEYOND * (middle - opposite);
        if beyond.min_element() >= 0.0 && beyond.x + beyond.y <= 1.0 {
            probes.push((leaf.triangle, beyond));
        } else {
            let geometry = problem.geometry.as_ref();
            probes.extend(borders.across(geometry, leaf.triangle, middle, beyond));
        }
    }
    probes
}
