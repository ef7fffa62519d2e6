//! Which triangles are near a box: a tree over their boxes, by the crate `obvhs`.

use crate::scene::Scene;
use glam::Vec3A;
use obvhs::{BvhBuildParams, aabb::Aabb, bvh2::Bvh2, bvh2::builder::build_bvh2};

pub struct Near {
    tree: Bvh2,
    /// Box of each triangle, a little larger.
    boxes: Vec<Aabb>,
}

impl Near {
    /// The triangles of `scene`, whose boxes reach further than they by `margin` [m].
    pub fn new(scene: &Scene, margin: f32) -> Near {
        let around = |t: u32| {
            let [a, b, c] = scene.corners(t);
            Aabb::new(Vec3A::from(a.min(b).min(c) - margin), Vec3A::from(a.max(b).max(c) + margin))
        };
        let boxes: Vec<Aabb> = (0..scene.triangles.len() as u32).map(around).collect();
        let tree = if boxes.is_empty() {
            Bvh2::default()
        } else {
            build_bvh2(&boxes, BvhBuildParams::very_fast_build(), &mut Default::default())
        };
        Near { tree, boxes }
    }

    /// Triangles whose boxes meet that of triangle `t`, in ascending order, without itself.
    pub fn of(&self, t: u32) -> Vec<u32> {
        let asked = self.boxes[t as usize];
        let meets = |other: &Aabb| other.min.cmple(asked.max).all() && other.max.cmpge(asked.min).all();
        let mut found = Vec::new();
        let mut open = vec![0];
        while let Some(node) = open.pop().and_then(|k: usize| self.tree.nodes.get(k)) {
            let first = node.first_index as usize;
            if !meets(node.aabb()) {
                continue;
            }
            if node.is_leaf() {
                let leaf = &self.tree.primitive_indices[first..first + node.prim_count as usize];
                found.extend(leaf.iter().filter(|&&other| other != t && meets(&self.boxes[other as usize])));
            } else {
                open.extend([first, first + 1]);
            }
        }
        found.sort_unstable();
        found
    }
}
