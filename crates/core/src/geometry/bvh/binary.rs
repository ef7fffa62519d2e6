//! The binary tree that the kernel's tree is made of.
//!
//! Large scenes are cut from the top by the surface area heuristic (`split.rs`), which sees far; the parts are clustered from
//! below, side by side on all cores: parallel locally ordered clustering (Meister & Bittner 2018) improved by reinsertion
//! (Meister & Bittner 2018b), both by the crate `obvhs`, which look closely. Each part is built serially, because the
//! library's parallel sorts leave equal keys in an order that depends on the number of threads; so the tree is always the same.

use super::node::LEAF_SIZE;
use super::split::{Item, halves, split};
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, builder::build_bvh2, node::Bvh2Node},
    ploc::{PlocSearchDistance, SortPrecision},
};

/// Triangles that are clustered together, at most.
const CLUSTERED: usize = 1 << 16;
/// Below this level triangles are cut into halves, so that no scene takes long for nothing.
const DEEP: usize = 32;

/// A million triangles take 1.3 seconds of processor time, most of it for the reinsertion; seven times as much gains a tenth of
/// the ray rate.
const SETTINGS: BvhBuildParams = BvhBuildParams {
    pre_split: false,
    ploc_search_distance: PlocSearchDistance::Medium,
    search_depth_threshold: 3,
    reinsertion_batch_ratio: 0.1,
    post_collapse_reinsertion_batch_ratio_multiplier: 2.0,
    sort_precision: SortPrecision::U64,
    max_prims_per_leaf: LEAF_SIZE as u32,
    // In units of a triangle test: four triangles cost as much as one, so leaves had better be full.
    collapse_traversal_cost: 3.0,
};

/// The tree over `items`, whose root is node 0; without nodes if there are no items. The items end up in another order.
pub fn tree(items: &mut [Item]) -> Bvh2 {
    subtree(items, 0)
}

fn subtree(items: &mut [Item], level: usize) -> Bvh2 {
    if items.len() <= CLUSTERED {
        return cluster(items);
    }
    let first = if level < DEEP { split(items) } else { halves(items) };
    let (first, second) = items.split_at_mut(first);
    let (first, second) = rayon::join(|| subtree(first, level + 1), || subtree(second, level + 1));
    joined(first, second)
}

fn cluster(items: &[Item]) -> Bvh2 {
    let boxes: Vec<Aabb> = items.iter().map(|item| item.bounds).collect();
    let mut tree = build_bvh2(&boxes, SETTINGS, &mut Default::default());
    for index in &mut tree.primitive_indices {
        *index = items[*index as usize].number;
    }
    tree
}

/// The tree whose root has these two as children.
fn joined(first: Bvh2, second: Bvh2) -> Bvh2 {
    let mut tree = Bvh2::default();
    let (a, b) = (first.nodes[0], second.nodes[0]);
    tree.nodes.reserve(first.nodes.len() + second.nodes.len() + 1);
    tree.nodes.push(Bvh2Node::new(a.aabb().union(b.aabb()), 0, 1));
    let shift = first.nodes.len() as u32 + 1;
    let indices = first.primitive_indices.len() as u32;
    // Both roots come first, then what is below them; node k of a tree is found at k + 2 or k + shift from then on.
    let moved = |node: &Bvh2Node, by: u32, indices: u32| {
        let by = if node.is_leaf() { indices } else { by };
        Bvh2Node { first_index: node.first_index + by, ..*node }
    };
    tree.nodes.extend([moved(&a, 2, 0), moved(&b, shift, indices)]);
    tree.nodes.extend(first.nodes[1..].iter().map(|node| moved(node, 2, 0)));
    tree.nodes.extend(second.nodes[1..].iter().map(|node| moved(node, shift, indices)));
    tree.primitive_indices = first.primitive_indices;
    tree.primitive_indices.extend(second.primitive_indices);
    tree
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3A;

    /// Boxes on a winding path, more than are clustered together.
    fn items() -> Vec<Item> {
        let place = |k: u32| {
            let x = k as f32 * 1e-3;
            let low = Vec3A::new(x.sin(), (1.7 * x).cos(), (0.3 * x).sin());
            Item { bounds: Aabb::new(low, low + 0.01 + 0.001 * (k % 7) as f32), number: k }
        };
        (0..3 * CLUSTERED as u32).map(place).collect()
    }

    #[test]
    fn every_item_is_in_one_leaf_and_in_its_box() {
        let items = items();
        let tree = tree(&mut items.clone());
        let mut found = vec![0; items.len()];
        let mut open = vec![0];
        while let Some(node) = open.pop().map(|k| &tree.nodes[k]) {
            let first = node.first_index as usize;
            let inside =
                |inner: &Aabb| inner.min.cmpge(node.aabb().min).all() && inner.max.cmple(node.aabb().max).all();
            if node.is_leaf() {
                for &number in &tree.primitive_indices[first..first + node.prim_count as usize] {
                    found[number as usize] += 1;
                    assert!(inside(&items[number as usize].bounds));
                }
            } else {
                assert!(inside(tree.nodes[first].aabb()) && inside(tree.nodes[first + 1].aabb()));
                open.extend([first, first + 1]);
            }
        }
        assert!(found.iter().all(|&times| times == 1));
    }

    #[test]
    fn the_tree_does_not_depend_on_the_number_of_threads() {
        let grown = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let tree = pool.install(|| tree(&mut items()));
            let node = |node: &Bvh2Node| (node.aabb().min, node.aabb().max, node.prim_count, node.first_index);
            (tree.nodes.iter().map(node).collect::<Vec<_>>(), tree.primitive_indices)
        };
        let (one, three) = (grown(1), grown(3));
        assert!(one == three);
    }
}
