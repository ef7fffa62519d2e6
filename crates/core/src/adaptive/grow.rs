//! Growing the tree of a triangle: where to cut, and what a single element on a patch would be wrong by.
//!
//! ```text
//! error of a patch    A Σ variance of E over its sides,
//! ```
//!
//! at points that are spread evenly over it. It is bisected from the corner for which the means of its halves differ most, so
//! elements grow long where the light does not change (greedy bisection: Cohen, Dyn, Hecht & Mirebeau 2012, "Adaptive multiresolution
//! analysis based on anisotropic triangulations"); but not from one that would make a splinter: noise may look like a reason to.

use super::light::Light;
use super::samples::{Samples, WHOLE};
use crate::mesh::{MOST_BISECTIONS, halves};
use glam::{Vec2, Vec3};

/// Mark of a patch that is not bisected.
pub const LEAF: u32 = 0;
/// Halves are at least so good, if one can be: 1 is equilateral.
const LEAST_QUALITY: f32 = 0.2;

/// A patch, whole or bisected.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Error [lux² m²] of a single element; not more than that of the patch it is half of.
    pub error: f32,
    /// Its first half, or [`LEAF`].
    pub first: u32,
    /// The corner from which it is bisected.
    pub from: u8,
}

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Error [lux² m²] that every patch exceeds that is bisected.
    pub error: f32,
    /// Area [m²] that every half exceeds.
    pub smallest: f64,
    /// Area [m²] above which a patch is bisected, whatever the light.
    pub largest: f64,
}

/// A patch that grows.
struct Patch {
    number: usize,
    /// Positions [m] of its corners.
    corners: [Vec3; 3],
    /// Barycentric coordinates of its corners on the triangle.
    on_triangle: [Vec2; 3],
    /// Area [m²].
    area: f64,
    depth: usize,
}

impl Patch {
    /// Its halves, numbered from `first`, if it is bisected from its corner `from`.
    fn halves(&self, first: u32, from: u8) -> [Patch; 2] {
        let (corners, on_triangle) = (halves(self.corners, from), halves(self.on_triangle, from));
        [0, 1].map(|half| Patch {
            number: first as usize + half,
            corners: corners[half],
            on_triangle: on_triangle[half],
            area: 0.5 * self.area,
            depth: self.depth + 1,
        })
    }
}

impl Rule {
    /// Whether `patch` is to be bisected, as it is wrong by `error` [lux² m²] as one element.
    fn asks_for(&self, patch: &Patch, error: f32) -> bool {
        let is_wrong = patch.area > self.largest || error > self.error;
        is_wrong && 0.5 * patch.area > self.smallest && patch.depth < MOST_BISECTIONS
    }
}

/// Grows the tree of `triangle` of `area` [m²] with these `corners` [m] on, as far as `rule` allows.
pub fn grow(nodes: &mut Vec<Node>, light: &Light, triangle: u32, corners: [Vec3; 3], area: f64, rule: &Rule) {
    let root = Patch { number: 0, corners, on_triangle: WHOLE, area, depth: 0 };
    grow_below(nodes, light, triangle, root, rule);
}

/// Grows the leaves below `patch` on.
fn grow_below(nodes: &mut Vec<Node>, light: &Light, triangle: u32, patch: Patch, rule: &Rule) {
    let Node { first, from, error } = nodes[patch.number];
    if first != LEAF {
        let halves = patch.halves(first, from);
        return halves.into_iter().for_each(|half| grow_below(nodes, light, triangle, half, rule));
    }
    if rule.asks_for(&patch, error) {
        let is_whole = patch.depth == 0;
        let samples = if is_whole {
            Samples::of_triangle(light, triangle)
        } else {
            Samples::of(light, triangle, patch.on_triangle)
        };
        bisect(nodes, light, triangle, patch, samples, rule);
    }
}

/// Bisects `patch` with the light there, and its halves as `rule` asks for it.
fn bisect(nodes: &mut Vec<Node>, light: &Light, triangle: u32, patch: Patch, samples: Samples, rule: &Rule) {
    let (from, first) = (best_corner(&patch, &samples), nodes.len() as u32);
    let node = &mut nodes[patch.number];
    (node.from, node.first) = (from, first);
    if patch.area > rule.largest {
        node.error = f32::INFINITY;
    }
    let error = node.error;
    let halves = patch.halves(first, from);
    let mut of_half = samples.halved(from);
    for (half, samples) in halves.iter().zip(&mut of_half) {
        if samples.are_few() {
            *samples = Samples::of(light, triangle, half.on_triangle);
        }
        let error = error.min(half.area as f32 * samples.mean_and_variance().1);
        nodes.push(Node { error, first: LEAF, from: 0 });
    }
    for (half, samples) in halves.into_iter().zip(of_half) {
        if rule.asks_for(&half, nodes[half.number].error) {
            bisect(nodes, light, triangle, half, samples, rule);
        }
    }
}

/// The corner from which to bisect `patch`.
fn best_corner(patch: &Patch, samples: &Samples) -> u8 {
    let quality = |from: u8| halves(patch.corners, from).map(quality).into_iter().fold(f32::INFINITY, f32::min);
    let qualities = [0, 1, 2].map(quality);
    let fine = |from: &u8| qualities[usize::from(*from)] >= LEAST_QUALITY;
    let gain = |from: u8| (from, samples.between(from));
    let best = (0..3).filter(fine).map(gain).max_by(|a, b| a.1.total_cmp(&b.1));
    let roundest = || (0..3).max_by(|&a, &b| qualities[usize::from(a)].total_cmp(&qualities[usize::from(b)]));
    best.map(|(from, _)| from).or_else(roundest).unwrap_or(0)
}

/// `4 √3 A / (a² + b² + c²)`: 1 for an equilateral triangle, 0 for a splinter (Bank 1990).
fn quality([a, b, c]: [Vec3; 3]) -> f32 {
    let edges = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
    let twice_area = (b - a).cross(c - a).length();
    if edges > 0.0 { 2.0 * 3f32.sqrt() * twice_area / edges } else { 0.0 }
}
