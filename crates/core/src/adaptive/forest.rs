//! The trees of all triangles, and the mesh that their leaves are.

use super::grow::{self, LEAF, Node, Rule};
use super::light::Light;
use super::samples::WHOLE;
use crate::Problem;
use crate::mesh::{Cut, Division, MOST_BISECTIONS, Slices, halved, halves, sides, surface_area};
use glam::Vec2;
use rayon::prelude::*;

/// The patches of every triangle: first the triangle, then two for each patch that is bisected.
#[derive(Clone, Debug)]
pub struct Forest {
    trees: Vec<Vec<Node>>,
}

/// A patch that is not bisected.
#[derive(Clone, Copy, Debug)]
pub struct Leaf {
    pub triangle: u32,
    number: u32,
    /// Barycentric coordinates of its corners on the triangle.
    pub corners: [Vec2; 3],
}

impl Leaf {
    pub fn new(triangle: u32, number: u32, corners: [Vec2; 3]) -> Leaf {
        Leaf { triangle, number, corners }
    }
}

impl Forest {
    /// Every triangle as one patch, of which `light` is known.
    pub fn new(light: &Light) -> Forest {
        let root = |t: u32| vec![Node { error: light.on(t).error, first: LEAF, from: 0 }];
        Forest { trees: (0..light.triangles()).map(root).collect() }
    }

    /// Grows all trees on as far as `rule` allows.
    pub fn grow(&mut self, problem: &Problem, light: &Light, rule: &Rule) {
        let scene = &problem.scene;
        // The tree of a wall is as large as those of thousands of small triangles.
        self.trees.par_iter_mut().enumerate().with_max_len(1).for_each(|(t, tree)| {
            let t = t as u32;
            grow::grow(tree, light, t, scene.corners(t), surface_area(scene, t), rule);
        });
    }

    /// Number of all patches.
    pub fn len(&self) -> usize {
        self.trees.iter().map(Vec::len).sum()
    }

    /// Errors [lux² m²] of all patches that are bisected, and how many elements each bisection adds.
    pub fn errors(&self, problem: &Problem) -> Vec<(f32, u64)> {
        let of_tree = |(t, tree): (u32, &Vec<Node>)| {
            let errors = tree.iter().filter(|node| node.first != LEAF).map(|node| node.error);
            errors.map(move |error| (error, sides(&problem.scene, t))).collect::<Vec<(f32, u64)>>()
        };
        (0..).zip(&self.trees).flat_map(of_tree).collect()
    }

    /// The error [lux² m²] that an element would have if there were so many `elements`: the error of a patch falls to a quarter if it is halved
    /// and light is linear.
    pub fn error_with(&self, elements: u64) -> f32 {
        let leaves = self.trees.iter().flatten().filter(|node| node.first == LEAF);
        (leaves.map(|node| f64::from(node.error).sqrt()).sum::<f64>() / elements as f64).powi(2) as f32
    }

    /// With those bisections only whose error is above `error`.
    pub fn pruned(&self, error: f32) -> Forest {
        let prune = |tree: &Vec<Node>| {
            let mut kept = vec![Node { first: LEAF, ..tree[0] }];
            let mut left = vec![(0, 0)];
            while let Some((old, new)) = left.pop() {
                let node: Node = tree[old as usize];
                if node.first != LEAF && node.error > error {
                    let first = kept.len() as u32;
                    kept[new as usize].first = first;
                    kept.extend([0, 1].map(|half| Node { first: LEAF, ..tree[(node.first + half) as usize] }));
                    left.extend([0, 1].map(|half| (node.first + half, first + half)));
                }
            }
            kept
        };
        Forest { trees: self.trees.par_iter().map(prune).collect() }
    }

    /// All leaves.
    pub fn leaves(&self) -> Vec<Leaf> {
        let mut leaves = Vec::new();
        for (t, tree) in (0..).zip(&self.trees) {
            push_leaves(tree, Leaf::new(t, 0, WHOLE), &mut leaves);
        }
        leaves
    }

    /// Whether this is still one.
    pub fn is_leaf(&self, leaf: &Leaf) -> bool {
        self.trees[leaf.triangle as usize][leaf.number as usize].first == LEAF
    }

    /// The leaf at barycentric coordinates `uv` of `triangle`, and the barycentric coordinates on it.
    pub fn leaf_at(&self, triangle: u32, mut uv: Vec2) -> (Leaf, Vec2) {
        let tree = &self.trees[triangle as usize];
        let (mut number, mut corners) = (0, WHOLE);
        loop {
            let Node { first, from, .. } = tree[number as usize];
            if first == LEAF {
                return (Leaf { triangle, number, corners }, uv);
            }
            let half;
            (half, uv) = halved(uv, from);
            (number, corners) = (first + half, halves(corners, from)[half as usize]);
        }
    }

    /// Bisects `leaf` from its corner `from`, and gives its halves; `None` if that was done too often already.
    pub fn bisect(&mut self, leaf: &Leaf, from: u8) -> Option<[Leaf; 2]> {
        let [a, b, c] = leaf.corners;
        if (b - a).perp_dot(c - a) < 1.5 * 0.5f32.powi(MOST_BISECTIONS as i32) {
            return None;
        }
        let tree = &mut self.trees[leaf.triangle as usize];
        let first = tree.len() as u32;
        let node = &mut tree[leaf.number as usize];
        (node.first, node.from) = (first, from);
        let half = Node { first: LEAF, ..*node };
        tree.extend([half; 2]);
        let [one, other] = halves(leaf.corners, from);
        Some([Leaf::new(leaf.triangle, first, one), Leaf::new(leaf.triangle, first + 1, other)])
    }

    /// How that cuts the scene, with the `leaders` of triangles that are put together.
    pub fn cut(&self, leaders: Vec<u32>) -> Cut {
        let mut divisions = Vec::new();
        self.trees.iter().for_each(|tree| push_divisions(tree, 0, &mut divisions));
        Cut { slices: vec![Slices::WHOLE; self.trees.len()], divisions, leaders }
    }
}

fn push_leaves(tree: &[Node], patch: Leaf, leaves: &mut Vec<Leaf>) {
    let Node { first, from, .. } = tree[patch.number as usize];
    if first == LEAF {
        return leaves.push(patch);
    }
    for (half, corners) in (0..).zip(halves(patch.corners, from)) {
        push_leaves(tree, Leaf::new(patch.triangle, first + half, corners), leaves);
    }
}

fn push_divisions(tree: &[Node], number: u32, divisions: &mut Vec<Division>) {
    let Node { first, from, .. } = tree[number as usize];
    if first == LEAF {
        return divisions.push(Division::Cells(1));
    }
    divisions.push(Division::Bisected { from, share: 0.5 });
    [first, first + 1].into_iter().for_each(|half| push_divisions(tree, half, divisions));
}
