//! Builds the tree: a binary tree over the triangles (`binary.rs`) is turned into one of eight children a node (`plan.rs`).
//!
//! The builder sees the triangles scaled into the unit cube, so that areas neither overflow nor vanish, and gives the shape
//! of the tree only. The boxes are computed here from the triangles themselves.

use super::binary;
use super::node::{Child, Leaf, Node, Tree, WIDTH};
use super::plan::Plan;
use super::split::Item;
use glam::{DVec3, Vec3};
use obvhs::{aabb::Aabb, bvh2::Bvh2};

/// The tree over `triangles`, those with coordinates that are not finite left out.
pub fn tree(triangles: &[[Vec3; 3]]) -> Tree {
    let finite = |k: &u32| triangles[*k as usize].iter().all(|corner| corner.is_finite());
    let numbers: Vec<u32> = (0..triangles.len() as u32).filter(finite).collect();
    let bounds = numbers.iter().map(|&k| bounds(&triangles[k as usize])).fold(NOTHING, union);
    // In small scenes a chain does no harm, and chance would spoil the symmetry of rooms made of a few boxes.
    let size = if numbers.len() < 1000 { 0.0 } else { 4e-6 };
    let item = |k: u32| Item { bounds: unit_box(&triangles[k as usize], bounds, size * scatter(k)), number: k };
    let mut items: Vec<Item> = numbers.iter().map(|&k| item(k)).collect();
    let binary = binary::tree(&mut items);
    Collapse { triangles, plan: Plan::new(&binary), binary: &binary, pad: padding(bounds) }.run()
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
    binary: &'a Bvh2,
    plan: Plan<'a>,
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

    /// The children of a wide node. Whether anything is in the way is asked of the last ones first: leaves, because they answer
    /// at once, then what is met most often.
    fn children(&self, source: usize) -> Vec<usize> {
        let nodes = &self.binary.nodes;
        let mut children = self.plan.children(source);
        let area = |child: usize| nodes[child].aabb().half_area();
        let is_leaf = |child: usize| nodes[child].is_leaf();
        children.sort_by(|&a, &b| is_leaf(a).cmp(&is_leaf(b)).then(area(a).total_cmp(&area(b))));
        children
    }

    /// The triangles of a leaf of the binary tree, and the padded box around them.
    fn leaf(&self, source: usize) -> (Leaf, Bounds) {
        let node = &self.binary.nodes[source];
        let (mut leaf, mut around) = (Leaf::EMPTY, NOTHING);
        for lane in 0..node.prim_count as usize {
            let number = self.binary.primitive_indices[node.first_index as usize + lane];
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
