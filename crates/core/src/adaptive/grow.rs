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
use crate::mesh::{MOST_BISECTIONS, cells, halved, halves};
use glam::{Vec2, Vec3};

/// Barycentric coordinates of the corners of a triangle on itself.
pub const WHOLE: [Vec2; 3] = [Vec2::ZERO, Vec2::X, Vec2::Y];
/// Mark of a patch that is not bisected.
pub const LEAF: u32 = 0;
/// A patch with fewer samples gets new ones of its own.
const FEWEST: usize = 12;
/// Samples along the edge of a patch that gets new ones, and of an element of a whole triangle; most of them along the edge of that.
const ALONG_EDGE: u16 = 4;
const MOST_ALONG_EDGE: u16 = 512;
/// Halves are at least so good, if one can be: 1 is equilateral.
const LEAST_QUALITY: f32 = 0.2;

/// A patch, whole or bisected.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Error [lux² m²] of a single element; not more than that of the patch it is half of.
    pub error: f32,
    /// Its first half, or [`LEAF`].
    pub first: u32,
    /// The corner from which it would be bisected.
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

/// Barycentric coordinates on a patch, and the light there [lux] on the front and on the back.
type Sample = (Vec2, [f32; 2]);

/// The tree of `triangle` of `area` [m²] with these `corners` [m], grown as far as `rule` allows.
pub fn tree(light: &Light, triangle: u32, corners: [Vec3; 3], area: f64, rule: &Rule) -> Vec<Node> {
    let mut nodes = vec![Node { error: f32::INFINITY, first: LEAF, from: 0 }];
    let root = Patch { number: 0, corners, on_triangle: WHOLE, area, depth: 0 };
    let samples = samples(light, triangle, WHOLE, along(light, triangle));
    grow(&mut nodes, light, triangle, root, samples, rule);
    nodes
}

fn grow(nodes: &mut Vec<Node>, light: &Light, triangle: u32, patch: Patch, mut samples: Vec<Sample>, rule: &Rule) {
    if samples.len() < FEWEST {
        samples = self::samples(light, triangle, patch.on_triangle, ALONG_EDGE);
    }
    let node = &mut nodes[patch.number];
    let light_error = patch.area as f32 * moments(&samples).1;
    let is_large = patch.area > rule.largest;
    node.error = if is_large { f32::INFINITY } else { node.error.min(light_error) };
    node.from = best_corner(&patch, &samples);
    let Node { error, from, .. } = *node;
    if !is_large && error <= rule.error || 0.5 * patch.area <= rule.smallest || patch.depth == MOST_BISECTIONS {
        return;
    }
    let first = nodes.len();
    nodes[patch.number].first = first as u32;
    nodes.extend([Node { error, first: LEAF, from: 0 }; 2]);
    let mut of_half = [Vec::new(), Vec::new()];
    samples.into_iter().for_each(|(uv, light)| {
        let (half, within) = halved(uv, from);
        of_half[half as usize].push((within, light));
    });
    let corners = halves(patch.corners, from).into_iter().zip(halves(patch.on_triangle, from));
    for (half, ((corners, on_triangle), samples)) in corners.zip(of_half).enumerate() {
        let (area, depth) = (0.5 * patch.area, patch.depth + 1);
        grow(nodes, light, triangle, Patch { number: first + half, corners, on_triangle, area, depth }, samples, rule);
    }
}

/// The light in the middles of the cells of a patch with these corners on `triangle`, so many divisions along its edge.
fn samples(light: &Light, triangle: u32, [a, b, c]: [Vec2; 3], divisions: u16) -> Vec<Sample> {
    let sample = |cell| {
        let uv = cells::corners(cell, divisions).iter().sum::<Vec2>() / 3.0;
        (uv, light.at(triangle, a + uv.x * (b - a) + uv.y * (c - a)))
    };
    (0..cells::count(divisions)).map(sample).collect()
}

/// Mean [lux] of the light on both sides of `triangle`, and its variance [lux²], both sides added.
pub fn mean_and_variance(light: &Light, triangle: u32) -> ([f32; 2], f32) {
    moments(&samples(light, triangle, WHOLE, along(light, triangle)))
}

/// Mean [lux] of the light on both sides, and its variance [lux²], both sides added.
fn moments(samples: &[Sample]) -> ([f32; 2], f32) {
    let count = samples.len() as f32;
    let mean = [0, 1].map(|side| samples.iter().map(|(_, light)| light[side]).sum::<f32>() / count);
    let square = |(_, light): &Sample| (light[0] - mean[0]).powi(2) + (light[1] - mean[1]).powi(2);
    (mean, samples.iter().map(square).sum::<f32>() / (count - 1.0))
}

/// Divisions for the samples of a whole triangle.
fn along(light: &Light, triangle: u32) -> u16 {
    let along = f64::from(ALONG_EDGE) * f64::from(light.elements_on(triangle)).sqrt();
    (along.ceil() as u16).min(MOST_ALONG_EDGE)
}

/// The corner from which to bisect `patch`.
fn best_corner(patch: &Patch, samples: &[Sample]) -> u8 {
    let quality = |from: u8| halves(patch.corners, from).map(quality).into_iter().fold(f32::INFINITY, f32::min);
    let qualities = [0, 1, 2].map(quality);
    let fine = |from: &u8| qualities[usize::from(*from)] >= LEAST_QUALITY;
    let gain = |from: u8| (from, between(samples, from));
    let best = (0..3).filter(fine).map(gain).max_by(|a, b| a.1.total_cmp(&b.1));
    let roundest = || (0..3).max_by(|&a, &b| qualities[usize::from(a)].total_cmp(&qualities[usize::from(b)]));
    best.map(|(from, _)| from).or_else(roundest).unwrap_or(0)
}

/// Variance [lux²] between the halves of a patch that is bisected from corner `from`, both sides added.
fn between(samples: &[Sample], from: u8) -> f32 {
    let (mut sums, mut counts) = ([[0.0; 2]; 2], [0.0; 2]);
    for (uv, light) in samples {
        let half = halved(*uv, from).0 as usize;
        counts[half] += 1.0;
        (0..2).for_each(|side| sums[half][side] += light[side]);
    }
    if counts.contains(&0.0) {
        return 0.0;
    }
    let difference = |side: usize| sums[0][side] / counts[0] - sums[1][side] / counts[1];
    let weight: f32 = counts[0] * counts[1] / (counts[0] + counts[1]).powi(2);
    weight * (difference(0).powi(2) + difference(1).powi(2))
}

/// `4 √3 A / (a² + b² + c²)`: 1 for an equilateral triangle, 0 for a splinter (Bank 1990).
fn quality([a, b, c]: [Vec3; 3]) -> f32 {
    let edges = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
    let twice_area = (b - a).cross(c - a).length();
    if edges > 0.0 { 2.0 * 3f32.sqrt() * twice_area / edges } else { 0.0 }
}
