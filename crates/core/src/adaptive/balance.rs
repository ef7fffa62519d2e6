//! Neighbours differ by one level at most: an edge is no more than twice as long as one it meets, so there is at most one vertex of others on it.
//!
//! So elements become large gradually, light has no kinks where they do, and no element has a row of tiny ones along its edge. A probe just
//! beyond the middle of each edge finds the neighbour, on the same triangle or on one that goes on smoothly from it ([`super::borders`]), and one
//! that is too long there is bisected at that edge. Linear in the leaves, times the depth.

use super::borders::Borders;
use super::forest::{Forest, Leaf};
use crate::Problem;
use glam::{Vec2, Vec3};

/// An edge longer than this many times one it meets is halved: twice, and something for triangles that do not share whole edges.
const LONGER: f32 = 2.1;
/// How far beyond an edge the neighbour is looked for, as a share of the height above it.
const BEYOND: f32 = 0.02;

/// Bisects leaves of `forest` until neighbours differ by one level at most. Triangles that are put together, those with a leader, stay as they
/// are.
pub fn balance(problem: &Problem, borders: &Borders, forest: &mut Forest, leaders: &[u32]) {
    let mut is_together = vec![false; problem.scene.triangles.len()];
    for (t, &leader) in (0..).zip(leaders).filter(|&(t, &leader)| t != leader) {
        is_together[t as usize] = true;
        is_together[leader as usize] = true;
    }
    let mut leaves = forest.leaves();
    while let Some(leaf) = leaves.pop() {
        if !forest.is_leaf(&leaf) || is_together[leaf.triangle as usize] {
            continue;
        }
        for Probe { triangle, uv, length } in probes(problem, borders, &leaf) {
            loop {
                let (neighbour, within) = forest.leaf_at(triangle, uv);
                let (opposite, met) = edge_at(problem, &neighbour, within);
                if met <= LONGER * length || is_together[triangle as usize] {
                    break;
                }
                let Some(halves) = forest.bisect(&neighbour, opposite) else { break };
                leaves.extend(halves);
            }
        }
    }
}

/// A point just beyond an edge.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    pub triangle: u32,
    pub uv: Vec2,
    /// Length of the edge [m].
    pub length: f32,
}

/// Points just beyond the middle of each edge of `leaf`.
pub fn probes(problem: &Problem, borders: &Borders, leaf: &Leaf) -> Vec<Probe> {
    let mut probes = Vec::with_capacity(3);
    let positions = positions(problem, leaf);
    for k in 0..3 {
        let [a, b, opposite] = [0, 1, 2].map(|corner| leaf.corners[(corner + k) % 3]);
        let length = positions[k].distance(positions[(k + 1) % 3]);
        let middle = 0.5 * (a + b);
        let beyond = middle + BEYOND * (middle - opposite);
        if beyond.min_element() >= 0.0 && beyond.x + beyond.y <= 1.0 {
            probes.push(Probe { triangle: leaf.triangle, uv: beyond, length });
        } else {
            let across = borders.across(problem.geometry.as_ref(), leaf.triangle, middle, beyond);
            probes.extend(across.map(|(triangle, uv)| Probe { triangle, uv, length }));
        }
    }
    probes
}

/// The corner of `leaf` opposite the edge that is nearest to the point `uv` on it, and the length of that edge [m].
pub fn edge_at(problem: &Problem, leaf: &Leaf, uv: Vec2) -> (u8, f32) {
    let weights = [1.0 - uv.x - uv.y, uv.x, uv.y];
    let opposite = (1..3).fold(0, |least, k| if weights[k] < weights[least] { k } else { least });
    let positions = positions(problem, leaf);
    (opposite as u8, positions[(opposite + 1) % 3].distance(positions[(opposite + 2) % 3]))
}

/// Positions [m] of the corners of `leaf`, on the flat triangle.
fn positions(problem: &Problem, leaf: &Leaf) -> [Vec3; 3] {
    let [a, b, c] = problem.scene.corners(leaf.triangle);
    leaf.corners.map(|uv| a + uv.x * (b - a) + uv.y * (c - a))
}
