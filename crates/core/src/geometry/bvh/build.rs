//! Builds the tree: parallel locally ordered clustering into a binary tree (Meister & Bittner 2018) improved by
//! reinsertion (Meister & Bittner 2018b), both by the crate `obvhs`; then nodes are merged until each has eight children,
//! opening the child of largest surface first (Wald, Benthin & Boulos 2008).
//!
//! The builder sees the triangles scaled into the unit cube, so that areas neither overflow nor vanish, and gives the shape
//! of the tree only. It runs serially, because its parallel sorts leave equal keys in an order that depends on the number of
//! threads. The boxes are computed here from the triangles themselves.

use super::node::{Child, LEAF_SIZE, Leaf, Node, Tree, WIDTH};
use glam::{DVec3, Vec3};
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, builder::build_bvh2},
    ploc::{PlocSearchDistance, SortPrecision},
};

/// A million triangles take one to two seconds; the slowest settings take seven and gain a few percent of the ray rate.
const SETTINGS: BvhBuildParams = BvhBuildParams {
    pre_split: false,
    ploc_search_distance: PlocSearchDistance::Medium,
    search_depth_threshold: 3,
    reinsertion_batch_ratio: 0.05,
    post_collapse_reinsertion_batch_ratio_multiplier: 2.0,
    sort_precision: SortPrecision::U64,
    max_prims_per_leaf: LEAF_SIZE as u32,
    // In units of a triangle test: four triangles cost as much as one, so leaves had better be full.
    collapse_traversal_cost: 3.0,
};

/// The tree over `triangles`, those with coordinates that are not finite left out.
pub fn tree(triangles: &[[Vec3; 3]]) -> Tree {
    let finite = |k: &u32| triangles[*k as usize].iter().all(|corner| corner.is_finite());
    let numbers: Vec<u32> = (0..triangles.len() as u32).filter(finite).collect();
    let bounds = numbers.iter().map(|&k| bounds(&triangles[k as usize])).fold(NOTHING, union);
    // In small scenes a chain does no harm, and chance would spoil the symmetry of rooms made of a few boxes.
    let size = if numbers.len() < 1000 { 0.0 } else { 4e-6 };
    let unit = |&k: &u32| unit_box(&triangles[k as usize], bounds, size * scatter(k));
    let boxes: Vec<Aabb> = numbers.iter().map(unit).collect();
    let binary = build_bvh2(&boxes, SETTINGS, &mut Default::default());
    Collapse { triangles, numbers: &numbers, binary: &binary, pad: padding(bounds) }.run()
}

type Bounds = (Vec3, Vec3);

const NOTHING: Bounds = (Vec3::INFINITY, Vec3::NEG_INFINITY);

fn union(a: Bounds, b: Bounds) -> Bounds {
    (a.0.min(b.0), a.1.max(b.1))
}

fn bounds([a, b, c]: &[Vec3; 3]) -> Bounds {
    (a.min(*b).min(*c), a.max(*b).max(*c))
}

/// A point of the unit cube, different for each triangle. Boxes are shifted by a little of it: without that, coincident
/// triangles, all as good neighbours as any, would be clustered one by one into a chain.
fn scatter(number: u32) -> DVec3 {
    let golden = |k: u32| f64::from(number.wrapping_mul(k)) / f64::from(u32::MAX);
    DVec3::from_array([0x9e37_79b9, 0xc13f_a9a9, 0x91e1_0da5].map(golden))
}

/// The box of a triangle, scaled so that `around` fits the unit cube, and shifted there.
fn unit_box(triangle: &[Vec3; 3], around: Bounds, shift: DVec3) -> Aabb {
    let low = around.0.as_dvec3();
    let scale = 1.0 / (around.1.as_dvec3() - low).max_element().max(f64::MIN_POSITIVE);
    let unit = |v: Vec3| ((v.as_dvec3() - low) * scale + shift).as_vec3a();
    let (low, high) = bounds(triangle);
    Aabb::new(unit(low), unit(high))
}

/// How far boxes reach beyond their triangles [m], so that no ray misses the box of a triangle which its own rounding lets
/// it hit. In the ray's space corners are off by at most two roundings of their distance from the origin, which is at most
/// the diagonal for origins inside the scene; twice as much serves origins as far outside.
fn padding((low, high): Bounds) -> f32 {
    4.0 * f32::EPSILON * (high - low).max(Vec3::ZERO).length()
}

/// A binary tree on its way to a wide one.
struct Collapse<'a> {
    triangles: &'a [[Vec3; 3]],
    /// Triangle of each primitive of the binary tree.
    numbers: &'a [u32],
    binary: &'a Bvh2,
    pad: f32,
}

impl Collapse<'_> {
    fn run(&self) -> Tree {
        let mut tree = Tree { nodes: vec![Node::EMPTY], leaves: Vec::new(), stack_size: 0 };
        let mut levels = vec![1];
        let mut open = if self.binary.nodes.is_empty() { Vec::new() } else { vec![(0, 0)] };
        while let Some((source, target)) = open.pop() {
            for (k, source) in self.children(source).into_iter().enumerate() {
                let child = if self.binary.nodes[source].is_leaf() {
                    let (leaf, bounds) = self.leaf(source);
                    tree.nodes[target].set_box(k, bounds);
                    tree.leaves.push(leaf);
                    Child::leaf(tree.leaves.len() - 1)
                } else {
                    tree.nodes.push(Node::EMPTY);
                    levels.push(levels[target] + 1);
                    open.push((source, tree.nodes.len() - 1));
                    Child::node(tree.nodes.len() - 1)
                };
                tree.nodes[target].children[k] = child;
            }
        }
        fit_boxes(&mut tree.nodes);
        // A traversal leaves at most seven children behind on each level, and puts eight more on top on the last one.
        tree.stack_size = (WIDTH - 1) * levels.into_iter().max().unwrap_or(1) + 1;
        tree
    }

    /// Descendants of a node of the binary tree that become the children of one wide node: at most eight.
    fn children(&self, source: usize) -> Vec<usize> {
        let nodes = &self.binary.nodes;
        let mut children = vec![source];
        while children.len() < WIDTH {
            let inner = (0..children.len()).filter(|&k| !nodes[children[k]].is_leaf());
            let area = |k: usize| nodes[children[k]].aabb().half_area();
            let Some(largest) = inner.max_by(|&a, &b| area(a).total_cmp(&area(b))) else { break };
            let first = nodes[children.swap_remove(largest)].first_index as usize;
            children.extend([first, first + 1]);
        }
        children
    }

    /// The triangles of a leaf of the binary tree, and the padded box around them.
    fn leaf(&self, source: usize) -> (Leaf, Bounds) {
        let node = &self.binary.nodes[source];
        let (mut leaf, mut around) = (Leaf::EMPTY, NOTHING);
        for lane in 0..node.prim_count as usize {
            let primitive = self.binary.primitive_indices[node.first_index as usize + lane];
            let number = self.numbers[primitive as usize];
            let corners = self.triangles[number as usize];
            leaf.set_triangle(lane, number, corners);
            around = union(around, bounds(&corners));
        }
        let grow = |v: Vec3, by: f32, next: fn(f32) -> f32| Vec3::from_array((v + by).to_array().map(next));
        (leaf, (grow(around.0, -self.pad, f32::next_down), grow(around.1, self.pad, f32::next_up)))
    }
}

/// Sets the boxes of inner children from below: children come after their parents.
fn fit_boxes(nodes: &mut [Node]) {
    for parent in (0..nodes.len()).rev() {
        for k in 0..WIDTH {
            let child = nodes[parent].children[k];
            if child != Child::ROOT && !child.is_leaf() {
                let bounds = nodes[child.index()].bounds();
                nodes[parent].set_box(k, bounds);
            }
        }
    }
}
