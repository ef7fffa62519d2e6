//! Which nodes of the binary tree become nodes of the wide one, so that rays visit as few as possible (Ylitie, Karras & Laine,
//! Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs, 2017).
//!
//! A ray visits a node in proportion to its surface `A`. The least surface that a subtree costs if it becomes at most `i` children,
//! `C(n, i) = min(A(n) + D(n, 8), D(n, i))` with `D(n, i) = min_k C(left, k) + C(right, i - k)`, is computed from below; a leaf
//! costs the same wherever it is. Linear.

use super::node::WIDTH;
use obvhs::bvh2::Bvh2;

/// What is best for one node of the binary tree.
#[derive(Clone, Copy, Default)]
struct Choice {
    /// `C(n, i)`, i from 1.
    cost: [f32; WIDTH],
    /// With i children to share: how many of them the left one gets; 0 if this node is better one child itself.
    left: [u8; WIDTH],
    /// The same if it is a node of the wide tree and shares out its eight children.
    left_of_node: u8,
}

pub struct Plan<'a> {
    binary: &'a Bvh2,
    choices: Vec<Choice>,
}

impl Plan<'_> {
    pub fn new(binary: &Bvh2) -> Plan<'_> {
        let mut plan = Plan { binary, choices: vec![Choice::default(); binary.nodes.len()] };
        let mut order = if binary.nodes.is_empty() { Vec::new() } else { vec![0] };
        let mut next = 0;
        while let Some(&node) = order.get(next) {
            order.extend(plan.below(node).into_iter().flatten());
            next += 1;
        }
        for node in order.into_iter().rev() {
            if let Some([left, right]) = plan.below(node) {
                plan.choices[node] = plan.choose(node, &plan.choices[left], &plan.choices[right]);
            }
        }
        plan
    }

    /// Nodes of the binary tree that are the children of `node` in the wide one: at most eight.
    pub fn children(&self, node: usize) -> Vec<usize> {
        let mut children = Vec::with_capacity(WIDTH);
        match self.below(node) {
            None => children.push(node),
            Some([left, right]) => {
                let share = self.choices[node].left_of_node as usize;
                self.share(left, share, &mut children);
                self.share(right, WIDTH - share, &mut children);
            }
        }
        children
    }

    fn share(&self, node: usize, count: usize, children: &mut Vec<usize>) {
        match (self.below(node), self.choices[node].left[count - 1] as usize) {
            (None, _) | (_, 0) => children.push(node),
            (Some([left, right]), share) => {
                self.share(left, share, children);
                self.share(right, count - share, children);
            }
        }
    }

    /// The two nodes below an inner node.
    fn below(&self, node: usize) -> Option<[usize; 2]> {
        let node = &self.binary.nodes[node];
        let first = node.first_index as usize;
        (!node.is_leaf()).then_some([first, first + 1])
    }

    fn choose(&self, node: usize, left: &Choice, right: &Choice) -> Choice {
        let mut choice = Choice::default();
        let mut shared = [f32::INFINITY; WIDTH];
        for count in 2..=WIDTH {
            for share in 1..count {
                let cost = left.cost[share - 1] + right.cost[count - share - 1];
                if cost < shared[count - 1] {
                    shared[count - 1] = cost;
                    choice.left[count - 1] = share as u8;
                }
            }
        }
        choice.left_of_node = choice.left[WIDTH - 1].max(1);
        let alone = self.binary.nodes[node].aabb().half_area() + shared[WIDTH - 1];
        for (k, shared) in shared.into_iter().enumerate() {
            choice.cost[k] = shared.min(alone);
            if alone <= shared {
                choice.left[k] = 0;
            }
        }
        choice
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3A;
    use obvhs::{BvhBuildParams, aabb::Aabb, bvh2::builder::build_bvh2};

    /// A binary tree over boxes of all sizes, one box a leaf.
    fn binary(seed: u32, count: u32) -> Bvh2 {
        let number =
            |k: u32| (k.wrapping_mul(0x9e37_79b9) ^ seed.wrapping_mul(0x85eb_ca6b)).wrapping_mul(0xc2b2_ae35) >> 8;
        let unit = |k: u32| number(k) as f32 / (1 << 24) as f32;
        let around = |k: u32| {
            let center = Vec3A::new(unit(4 * k), unit(4 * k + 1), unit(4 * k + 2));
            Aabb::new(center, center + unit(4 * k + 3).powi(3))
        };
        let boxes: Vec<Aabb> = (0..count).map(around).collect();
        build_bvh2(&boxes, BvhBuildParams::fastest_build(), &mut Default::default())
    }

    fn area(tree: &Bvh2, node: usize) -> f32 {
        tree.nodes[node].aabb().half_area()
    }

    /// Surface of all nodes of the wide tree below `node`, itself included.
    fn total(tree: &Bvh2, node: usize, children: &impl Fn(usize) -> Vec<usize>) -> f32 {
        if tree.nodes[node].is_leaf() {
            return 0.0;
        }
        let below = children(node);
        assert!(below.len() <= WIDTH);
        area(tree, node) + below.into_iter().map(|child| total(tree, child, children)).sum::<f32>()
    }

    /// All ways to cut the tree below `node` into wide ones: number of children, and their total surface.
    fn ways(tree: &Bvh2, node: usize) -> Vec<(usize, f32)> {
        if tree.nodes[node].is_leaf() {
            return vec![(1, 0.0)];
        }
        let first = tree.nodes[node].first_index as usize;
        let (left, right) = (ways(tree, first), ways(tree, first + 1));
        let pair = |a: &(usize, f32), b: &(usize, f32)| (a.0 + b.0, a.1 + b.1);
        let pairs = left.iter().flat_map(|a| right.iter().map(move |b| pair(a, b)));
        let mut ways: Vec<(usize, f32)> = pairs.filter(|(count, _)| *count <= WIDTH).collect();
        let least = ways.iter().map(|way| way.1).fold(f32::INFINITY, f32::min);
        ways.push((1, area(tree, node) + least));
        ways
    }

    #[test]
    fn no_other_tree_has_less_surface() {
        let mut greedy_is_worse = 0;
        for seed in 0..20 {
            let tree = binary(seed, 16);
            let plan = Plan::new(&tree);
            let planned = total(&tree, 0, &|node| plan.children(node));
            let least =
                ways(&tree, 0).into_iter().filter(|way| way.0 == 1).map(|way| way.1).fold(f32::INFINITY, f32::min);
            assert!((planned - least).abs() < 1e-5 * least, "{planned} against {least}");
            // The usual way, opening the largest child first, is what the test must be able to tell from the best.
            let greedy = |node: usize| {
                let mut children = vec![node];
                while children.len() < WIDTH {
                    let inner = (0..children.len()).filter(|&k| !tree.nodes[children[k]].is_leaf());
                    let largest = inner.max_by(|&a, &b| area(&tree, children[a]).total_cmp(&area(&tree, children[b])));
                    let Some(largest) = largest else { break };
                    let first = tree.nodes[children.swap_remove(largest)].first_index as usize;
                    children.extend([first, first + 1]);
                }
                children
            };
            greedy_is_worse += usize::from(total(&tree, 0, &greedy) > 1.001 * least);
        }
        assert!(greedy_is_worse > 0);
    }

    #[test]
    fn small_trees_are_one_node() {
        assert_eq!(Plan::new(&binary(1, 1)).children(0), [0]);
        assert_eq!(Plan::new(&binary(1, 8)).children(0).len(), 8);
        assert!(Plan::new(&Bvh2::default()).choices.is_empty());
    }
}
