//! Putting triangles together where a mesh is finer than the light on it.
//!
//! Neighbours become one element in the order of what it would be wrong by, as long as they are of one object, look about the same way and do not
//! emit (bottom-up merging: Ward 1963, "Hierarchical grouping to optimize an objective function"). Errors only grow as regions do, so what an edge
//! was worth when it was last looked at is a lower bound, and the least of them is looked at first. O(n log n) in the triangles.

use super::light::{Light, OnTriangle};
use crate::math::DisjointSets;
use crate::mesh::{BEND, sides, surface_area, triangle_neighbours};
use crate::scene::{Scene, Shape};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Greatest extent of a region, in edges of a square of the largest area.
const EXTENT: f32 = 2.0;

/// Triangles that may be put together, one pair of regions after the other.
pub struct Merges {
    triangles: usize,
    /// By error.
    steps: Vec<Merge>,
}

/// What makes one region of those that two triangles are in.
#[derive(Clone, Copy, Debug)]
struct Merge {
    /// Error [lux² m²] of the region as one element.
    error: f32,
    pair: (u32, u32),
    /// How many elements there are fewer.
    sides: u64,
}

/// Triangles that are one element.
#[derive(Clone, Copy, Debug)]
struct Region {
    /// Area [m²], and normal times area.
    area: f64,
    vector: DVec3,
    /// Corners of the box around it [m].
    low: Vec3,
    high: Vec3,
    /// Mean light [lux] on front and back.
    light: [f64; 2],
    /// Error [lux² m²] as one element.
    error: f64,
}

impl Merges {
    /// All that may be put together in `scene` where `light` is known, up to regions of the area `largest` [m²].
    pub fn of(scene: &Scene, light: &Light, largest: f64) -> Merges {
        let triangles = scene.triangles.len();
        let may_join = |t: u32| {
            let is_small = surface_area(scene, t) < largest;
            is_small && scene.shape == Shape::Triangles && !scene.material_of(t).is_emitter()
        };
        let pairs = triangle_neighbours(scene).into_iter().filter(|&(a, b)| may_join(a) && may_join(b));
        let mut regions: Vec<Region> =
            (0..triangles as u32).into_par_iter().map(|t| Region::of(scene, light, t)).collect();
        let mut sets = DisjointSets::new(triangles);
        let mut waiting: BinaryHeap<Reverse<(u32, u32, u32)>> = BinaryHeap::new();
        // Errors are not negative, so their bits are in the order of their values.
        let bits = |region: &Region| (region.error as f32).to_bits();
        waiting.extend(pairs.filter_map(|(a, b)| {
            let both = regions[a as usize].with(&regions[b as usize], largest)?;
            Some(Reverse((bits(&both), a, b)))
        }));
        let mut steps = Vec::new();
        while let Some(Reverse((bound, a, b))) = waiting.pop() {
            let (one, other) = (sets.least(a), sets.least(b));
            if one == other {
                continue;
            }
            let Some(both) = regions[one as usize].with(&regions[other as usize], largest) else { continue };
            if bits(&both) > bound {
                waiting.push(Reverse((bits(&both), a, b)));
                continue;
            }
            sets.join(one, other);
            regions[one.min(other) as usize] = both;
            steps.push(Merge { error: f32::from_bits(bound), pair: (a, b), sides: sides(scene, a) });
        }
        Merges { triangles, steps }
    }

    /// Errors [lux² m²] of all regions that may be, in ascending order, and how many elements each saves.
    pub fn errors(&self) -> impl Iterator<Item = (f32, u64)> + '_ {
        self.steps.iter().map(|step| (step.error, step.sides))
    }

    /// For each triangle the least one of its region, if regions have at most this `error` [lux² m²]; nothing if none has.
    pub fn leaders(&self, error: f32) -> Vec<u32> {
        let mut sets = DisjointSets::new(self.triangles);
        let fitting = self.steps.iter().take_while(|step| step.error <= error);
        let count = fitting.map(|step| sets.join(step.pair.0, step.pair.1)).count();
        if count > 0 { (0..self.triangles as u32).map(|t| sets.least(t)).collect() } else { Vec::new() }
    }
}

impl Region {
    fn of(scene: &Scene, light: &Light, triangle: u32) -> Region {
        let [a, b, c] = scene.corners(triangle);
        let area = surface_area(scene, triangle);
        let OnTriangle { mean, error } = light.on(triangle);
        Region {
            area,
            vector: (b - a).cross(c - a).normalize_or_zero().as_dvec3() * area,
            low: a.min(b).min(c),
            high: a.max(b).max(c),
            light: mean.map(f64::from),
            error: f64::from(error),
        }
    }

    /// Both together, if they may be.
    fn with(&self, other: &Region, largest: f64) -> Option<Region> {
        let (area, vector) = (self.area + other.area, self.vector + other.vector);
        let (low, high) = (self.low.min(other.low), self.high.max(other.high));
        let look_alike = self.vector.dot(other.vector) >= BEND * self.vector.length() * other.vector.length();
        let is_compact = area <= largest && low.distance(high) <= EXTENT * (largest as f32).sqrt();
        if !(look_alike && is_compact && vector.length() >= BEND * area) {
            return None;
        }
        let share = other.area / area.max(f64::MIN_POSITIVE);
        let difference = [0, 1].map(|side| other.light[side] - self.light[side]);
        let light = [0, 1].map(|side| self.light[side] + share * difference[side]);
        let between: f64 = difference.iter().map(|d| d * d).sum();
        let error = self.error + other.error + area * share * (1.0 - share) * between;
        Some(Region { area, vector, low, high, light, error })
    }
}
