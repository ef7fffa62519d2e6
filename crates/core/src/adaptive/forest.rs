//! Trees of patches: each is split while a single element on it would have too large an error.
//!
//! ```text
//! error = A (variance between the samples of the pilot on it + g² (a² + b² + c²) / 72)
//! ```
//!
//! where the second term is what irradiance varies within each sample's own element, a triangle with edges a, b, c (its second moments, for a
//! gradient of any direction). A patch smaller than the pilot's elements has no samples of its own: it has the g of the larger patch, and its own edges.
//! Needles are cut across first, for elements of the size that their light asks for.

use super::gradient::{Known, Sample, Summary};
use crate::Problem;
use crate::mesh::{Cut, MOST_SPLITS, PARTS, Slices, cells, slices, surface_area};
use crate::scene::Scene;
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// Mark of a patch that is not split.
const LEAF: u32 = 0;
/// The error of an equilateral triangle is this times g² times the fourth power of its edge.
const EQUILATERAL: f64 = 0.018;
/// Parts are larger than this share of the pilot's elements: two levels below them nothing is known.
const BELOW_PILOT: f64 = 1.0 / 32.0;
/// Parts are larger than this share of the mean element: else the deepest shadows would take all elements.
const SMALLEST: f64 = 1.0 / 512.0;

/// When to split.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Error [lux² m²] above which a patch is split.
    pub error: f64,
    /// Area [m²] that every part exceeds.
    pub smallest: f64,
}

impl Rule {
    /// That of a mesh of so many `elements`, before anything is split.
    pub fn coarsest(problem: &Problem, elements: u64) -> Rule {
        Rule { error: f64::INFINITY, smallest: SMALLEST * problem.mesh.total_area() / elements as f64 }
    }
}

/// The trees of all triangles.
#[derive(Clone, Debug)]
pub struct Forest {
    trees: Vec<Tree>,
}

/// The patches of a triangle: first its slices, then four for each patch that is split.
#[derive(Clone, Debug)]
struct Tree {
    slices: Slices,
    /// The first part of each patch, or [`LEAF`].
    first: Vec<u32>,
}

/// A patch that is not split.
#[derive(Clone, Copy, Debug)]
pub struct Leaf {
    pub triangle: u32,
    pub number: u32,
    /// Barycentric coordinates of its corners on the triangle.
    pub corners: [Vec2; 3],
}

impl Leaf {
    /// Share of the triangle's area.
    pub fn area_share(&self) -> f32 {
        let [a, b, c] = self.corners;
        (b - a).perp_dot(c - a)
    }
}

impl Forest {
    /// All patches split as `rule` asks for the light that is `known`.
    pub fn grown(problem: &Problem, known: &Known, rule: &Rule) -> Forest {
        let tree = |t: u32| Tree::grown(&problem.scene, t, known.on(t), rule);
        Forest { trees: (0..problem.scene.triangles.len() as u32).into_par_iter().map(tree).collect() }
    }

    /// Number of elements that it would have.
    pub fn count(problem: &Problem, known: &Known, rule: &Rule) -> u64 {
        let count = |t: u32| sides(problem, t) * Tree::grown(&problem.scene, t, known.on(t), rule).leaf_count();
        (0..problem.scene.triangles.len() as u32).into_par_iter().map(count).sum()
    }

    /// Number of elements, both sides of two-sided surfaces counted.
    pub fn element_count(&self, problem: &Problem) -> u64 {
        (0..).zip(&self.trees).map(|(t, tree)| sides(problem, t) * tree.leaf_count()).sum()
    }

    /// All leaves.
    pub fn leaves(&self) -> Vec<Leaf> {
        let mut leaves = Vec::new();
        for (t, tree) in (0..).zip(&self.trees) {
            let slices = 0..tree.slices.patch_count();
            slices.for_each(|patch| tree.push_leaves(t, patch, tree.slices.corners(patch), &mut leaves));
        }
        leaves
    }

    /// Whether this is still one.
    pub fn is_leaf(&self, leaf: &Leaf) -> bool {
        self.trees[leaf.triangle as usize].first[leaf.number as usize] == LEAF
    }

    /// The leaf at barycentric coordinates `uv` of `triangle`.
    pub fn leaf_at(&self, triangle: u32, uv: Vec2) -> Leaf {
        let tree = &self.trees[triangle as usize];
        let (mut number, mut within) = tree.slices.locate(uv);
        let mut corners = tree.slices.corners(number);
        while tree.first[number as usize] != LEAF {
            let part;
            (part, within) = cells::locate(within, 2);
            (number, corners) = (tree.first[number as usize] + part, part_corners(corners, part));
        }
        Leaf { triangle, number, corners }
    }

    /// Splits `leaf`, and gives its parts; `None` if it was split too often already.
    pub fn split(&mut self, leaf: &Leaf) -> Option<[Leaf; PARTS as usize]> {
        let tree = &mut self.trees[leaf.triangle as usize];
        let slice = tree.slices.area_share(tree.slices.locate(leaf.corners.iter().sum::<Vec2>() / 3.0).0);
        let smallest = slice * 0.25f64.powi(MOST_SPLITS as i32);
        if f64::from(leaf.area_share()) < 1.5 * smallest {
            return None;
        }
        let first = tree.split(leaf.number);
        Some(std::array::from_fn(|part| {
            let corners = part_corners(leaf.corners, part as u32);
            Leaf { number: first + part as u32, corners, ..*leaf }
        }))
    }

    /// How that cuts the scene. Four parts that are cut alike are one patch.
    pub fn cut(&self) -> Cut {
        let mut divisions = Vec::new();
        for tree in &self.trees {
            (0..tree.slices.patch_count()).for_each(|patch| tree.push_divisions(patch, &mut divisions));
        }
        Cut { slices: self.trees.iter().map(|tree| tree.slices).collect(), divisions, leaders: Vec::new() }
    }
}

impl Tree {
    fn grown(scene: &Scene, t: u32, samples: &[Sample], rule: &Rule) -> Tree {
        let corners = scene.corners(t);
        let known = Summary::of(samples);
        let square = known.map_or(0.0, |known| known.square);
        let edge = (rule.error / (EQUILATERAL * square)).sqrt().sqrt();
        let slices = slices(corners, edge);
        let mut tree = Tree { slices, first: vec![LEAF; slices.patch_count() as usize] };
        let mut located: Vec<(u32, Sample)> =
            samples.iter().map(|&sample| within(slices.locate(sample.uv), sample)).collect();
        located.sort_by_key(|(patch, _)| *patch);
        let area = surface_area(scene, t);
        let position = |uv: Vec2| corners[0] + uv.x * (corners[1] - corners[0]) + uv.y * (corners[2] - corners[0]);
        let mut rest = &mut located[..];
        for patch in 0..slices.patch_count() {
            let (own, others) = rest.split_at_mut(rest.partition_point(|(number, _)| *number == patch));
            rest = others;
            let mut own: Vec<Sample> = own.iter().map(|(_, sample)| *sample).collect();
            let size = Size {
                area: area * slices.area_share(patch),
                edges: edges_squared(slices.corners(patch).map(position)),
            };
            tree.grow(patch, size, 0, &mut own, known, rule);
        }
        tree
    }

    /// Splits `patch` and its parts as long as `rule` asks for it.
    fn grow(
        &mut self,
        patch: u32,
        size: Size,
        depth: usize,
        samples: &mut [Sample],
        around: Option<Summary>,
        rule: &Rule,
    ) {
        let below = around.map(|around| Summary { variance: 0.0, ..around });
        let known = Summary::of(samples).or(below);
        let Some(summary) = known else { return };
        let part = size.part();
        let is_large = part.area > rule.smallest && part.area > BELOW_PILOT * summary.area;
        if depth == MOST_SPLITS || !is_large || size.error(&summary) <= rule.error {
            return;
        }
        let first = self.split(patch);
        let mut located: Vec<(u32, Sample)> =
            samples.iter().map(|&sample| within(cells::locate(sample.uv, 2), sample)).collect();
        located.sort_by_key(|(part, _)| *part);
        samples.iter_mut().zip(&located).for_each(|(sample, (_, located))| *sample = *located);
        let (mut rest, mut begin) = (samples, 0);
        for number in 0..PARTS {
            let end = located.partition_point(|(part, _)| *part <= number);
            let (own, others) = rest.split_at_mut(end - begin);
            (rest, begin) = (others, end);
            self.grow(first + number, part, depth + 1, own, known, rule);
        }
    }

    /// Splits `patch`; number of its first part.
    fn split(&mut self, patch: u32) -> u32 {
        let first = self.first.len() as u32;
        self.first[patch as usize] = first;
        self.first.extend([LEAF; PARTS as usize]);
        first
    }

    fn leaf_count(&self) -> u64 {
        self.first.iter().filter(|&&first| first == LEAF).count() as u64
    }

    fn push_leaves(&self, triangle: u32, number: u32, corners: [Vec2; 3], leaves: &mut Vec<Leaf>) {
        match self.first[number as usize] {
            LEAF => leaves.push(Leaf { triangle, number, corners }),
            first => (0..PARTS)
                .for_each(|part| self.push_leaves(triangle, first + part, part_corners(corners, part), leaves)),
        }
    }

    fn push_divisions(&self, patch: u32, divisions: &mut Vec<u16>) {
        let first = self.first[patch as usize];
        if first == LEAF {
            return divisions.push(1);
        }
        let at = divisions.len();
        divisions.push(0);
        (first..first + PARTS).for_each(|part| self.push_divisions(part, divisions));
        if let [m, b, c, d] = divisions[at + 1..]
            && m == b
            && b == c
            && c == d
        {
            divisions.truncate(at);
            divisions.push(2 * m);
        }
    }
}

/// Area [m²] of a patch, and the sum of the squares of its edges [m²].
#[derive(Clone, Copy, Debug)]
struct Size {
    area: f64,
    edges: f64,
}

impl Size {
    fn part(self) -> Size {
        Size { area: 0.25 * self.area, edges: 0.25 * self.edges }
    }

    /// Error [lux² m²] of a single element: what the samples differ, and what light differs within each of them.
    fn error(self, known: &Summary) -> f64 {
        let within = known.square * self.edges / 72.0 * (known.area / self.area).min(1.0);
        self.area * (known.variance + within)
    }
}

fn edges_squared([a, b, c]: [Vec3; 3]) -> f64 {
    f64::from(a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a))
}

/// A sample at what was located.
fn within((patch, uv): (u32, Vec2), sample: Sample) -> (u32, Sample) {
    (patch, Sample { uv, ..sample })
}

fn part_corners([a, b, c]: [Vec2; 3], part: u32) -> [Vec2; 3] {
    cells::corners(part, 2).map(|uv| a + uv.x * (b - a) + uv.y * (c - a))
}

fn sides(problem: &Problem, triangle: u32) -> u64 {
    1 + u64::from(problem.mesh.is_two_sided(triangle))
}
