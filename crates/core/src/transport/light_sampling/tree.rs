//! A binary tree over emitters: what a group of them sends to a receiver far away.
//!
//! The emitters of a node are neighbours in its order, so a node is a range. Halves are split at the median along the longest side
//! of their box, O(n log² n).

use super::emitter::Emitter;
use super::receiver::{FLOOR, Receiver};
use glam::Vec3;
use std::f32::consts::PI;

/// A group of emitters.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Node {
    /// The range of its emitters.
    pub first: u32,
    pub end: u32,
    /// Numbers of its halves; those of a single emitter are of no meaning.
    pub halves: [u32; 2],
    /// A sphere around it [m].
    center: Vec3,
    radius: f32,
    /// Emitted luminous flux [lm], and its sum with the normals as signs.
    flux: f32,
    axis: Vec3,
}

impl Node {
    pub fn is_single(&self) -> bool {
        self.end - self.first == 1
    }

    /// About what `receiver` gets from the node, were nothing in between [lux]; 0 only if it gets nothing for certain.
    ///
    /// `(axis · w⁺ + rest / 4) cos / (pi d²)`: the flux the way its normals point, and the rest as a closed convex body sends it,
    /// whose mean projected area is a quarter of its surface.
    pub fn irradiance(&self, receiver: &Receiver) -> f32 {
        let way = self.center - receiver.center;
        let height = way.dot(receiver.normal);
        if receiver.is_above(self.center, self.radius) {
            return 0.0;
        }
        let distance = way.length().max(f32::MIN_POSITIVE);
        let cos = ((height + self.radius) / distance).min(1.0);
        let towards = -self.axis.dot(way) / distance;
        let rest = 0.25 * (self.flux - self.axis.length());
        let sent = (towards.max(0.0) + rest.max(0.0)).max(FLOOR * self.flux);
        let size = self.radius + receiver.radius;
        sent * cos.max(receiver.floor()) / (PI * (distance * distance).max(size * size))
    }
}

/// The tree over `emitters`, which it puts into its own order, the root first; and the number each emitter had.
pub fn build(emitters: &mut Vec<Emitter>, around: impl Fn(&Emitter) -> (Vec3, f32)) -> (Vec<Node>, Vec<u32>) {
    let spheres: Vec<(Vec3, f32)> = emitters.iter().map(around).collect();
    let mut order: Vec<u32> = (0..emitters.len() as u32).collect();
    let mut nodes = Vec::with_capacity(2 * emitters.len());
    if !emitters.is_empty() {
        split(emitters, &spheres, &mut order, 0, &mut nodes);
    }
    *emitters = order.iter().map(|&k| emitters[k as usize]).collect();
    (nodes, order)
}

/// Adds the node of the emitters in `order`, of which `first` come before, with all below it; returns its number.
fn split(emitters: &[Emitter], spheres: &[(Vec3, f32)], order: &mut [u32], first: u32, nodes: &mut Vec<Node>) -> u32 {
    let number = nodes.len() as u32;
    nodes.push(node(emitters, spheres, order, first));
    if order.len() > 1 {
        let center = |k: u32| spheres[k as usize].0;
        let (low, high) =
            order.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), &k| (l.min(center(k)), h.max(center(k))));
        let longest = (high - low).max_position();
        let middle = order.len() / 2;
        order.sort_unstable_by(|&a, &b| center(a)[longest].total_cmp(&center(b)[longest]).then(a.cmp(&b)));
        let (left, right) = order.split_at_mut(middle);
        let left = split(emitters, spheres, left, first, nodes);
        let right = split(emitters, spheres, right, first + middle as u32, nodes);
        nodes[number as usize].halves = [left, right];
    }
    number
}

fn node(emitters: &[Emitter], spheres: &[(Vec3, f32)], order: &[u32], first: u32) -> Node {
    let (mut low, mut high, mut flux, mut axis) = (Vec3::INFINITY, Vec3::NEG_INFINITY, 0.0, Vec3::ZERO);
    for &k in order {
        let (center, radius) = spheres[k as usize];
        (low, high) = (low.min(center - radius), high.max(center + radius));
        let emitter = &emitters[k as usize];
        flux += emitter.flux() as f32;
        axis += emitter.normal * emitter.flux() as f32;
    }
    let center = 0.5 * (low + high);
    let radius =
        order.iter().map(|&k| spheres[k as usize].0.distance(center) + spheres[k as usize].1).fold(0.0, f32::max);
    Node { first, end: first + order.len() as u32, halves: [0; 2], center, radius, flux, axis }
}
