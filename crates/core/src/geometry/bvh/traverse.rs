//! The way of a ray through the tree, for the closest hit, for all hits and for any hit.
//!
//! Everything is inlined into the three batch functions, so that an instruction set is entered once a batch.

use super::intersect::{LeafHits, Tracer};
use super::lanes::Instructions;
use super::node::{Child, Leaf, Node, Tree, WIDTH};
use crate::geometry::{Hit, HitLists, Ray};

/// First hit of every ray.
#[inline(always)]
pub fn closest<I: Instructions>(tree: &Tree, rays: &[Ray], hits: &mut [Hit]) {
    let mut stack = vec![Waiting { enter: 0.0, child: Child::ROOT }; tree.stack_size];
    for (ray, hit) in rays.iter().zip(hits) {
        *hit = if is_finite(ray) { closest_hit::<I>(tree, ray, &mut stack) } else { Hit::MISS };
    }
}

/// All hits of every ray.
#[inline(always)]
pub fn all<I: Instructions>(tree: &Tree, rays: &[Ray], lists: &mut HitLists) {
    let mut stack = vec![Child::ROOT; tree.stack_size];
    lists.clear();
    for ray in rays {
        if is_finite(ray) {
            all_hits::<I>(tree, ray, &mut stack, lists);
        }
        lists.finish();
    }
}

/// Whether anything lies within reach of every ray.
#[inline(always)]
pub fn any<I: Instructions>(tree: &Tree, rays: &[Ray], reach: &[f32], blocked: &mut [bool]) {
    let mut stack = vec![Child::ROOT; tree.stack_size];
    for ((ray, reach), blocked) in rays.iter().zip(reach).zip(blocked) {
        *blocked = is_finite(ray) && any_hit::<I>(tree, ray, *reach, &mut stack);
    }
}

/// Other rays hit nothing.
#[inline(always)]
fn is_finite(ray: &Ray) -> bool {
    ray.origin.is_finite() && ray.direction.is_finite()
}

/// A child whose box was hit, and the distance at which the ray enters it [m].
#[derive(Clone, Copy)]
struct Waiting {
    enter: f32,
    child: Child,
}

/// The numbers of the bits set in a mask, in rising order.
#[inline(always)]
fn bits(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = mask.trailing_zeros() as usize;
        (mask != 0).then(|| {
            mask &= mask - 1;
            bit
        })
    })
}

#[inline(always)]
fn closest_hit<I: Instructions>(tree: &Tree, ray: &Ray, stack: &mut [Waiting]) -> Hit {
    let tracer = Tracer::<I>::new(ray);
    let mut best = Hit { t: f32::MAX, ..Hit::MISS };
    let mut next = Some(Child::ROOT);
    let mut waiting = 0;
    while let Some(child) = next {
        next = if child.is_leaf() {
            let leaf = &tree.leaves[child.index()];
            if let Some(hits) = tracer.hit(leaf, best.t) {
                take_closest(&mut best, leaf, &hits, ray.from);
            }
            None
        } else {
            let node = &tree.nodes[child.index()];
            let (enter, mask) = tracer.enter(node, best.t);
            bits(mask).for_each(|k| prefetch::<I>(tree, node.children[k]));
            nearest(node, &enter, mask, stack, &mut waiting)
        };
        // Boxes entered at the distance of the best hit may hold an equal one of lower number.
        while next.is_none() && waiting > 0 {
            waiting -= 1;
            next = (stack[waiting].enter <= best.t).then_some(stack[waiting].child);
        }
    }
    if best.is_miss() { Hit::MISS } else { best }
}

/// The nearest of the children in `mask`. The others go on the stack, which holds `waiting`, the farthest first.
#[inline(always)]
fn nearest(node: &Node, enter: &[f32; WIDTH], mask: u32, stack: &mut [Waiting], waiting: &mut usize) -> Option<Child> {
    let mut children = bits(mask).map(|k| Waiting { enter: enter[k], child: node.children[k] });
    let mut nearest = children.next()?;
    let base = *waiting;
    for child in children {
        let (near, far) = if child.enter < nearest.enter { (child, nearest) } else { (nearest, child) };
        nearest = near;
        let mut place = *waiting;
        while place > base && stack[place - 1].enter < far.enter {
            stack[place] = stack[place - 1];
            place -= 1;
        }
        stack[place] = far;
        *waiting += 1;
    }
    Some(nearest.child)
}

/// Makes the closest hit of a leaf the best one if it is closer, or as close and of a lower number.
#[inline(always)]
fn take_closest(best: &mut Hit, leaf: &Leaf, hits: &LeafHits, from: u32) {
    for k in bits(hits.mask) {
        let (t, triangle) = (hits.t[k], leaf.triangles[k]);
        if triangle != from && (t < best.t || (t == best.t && triangle < best.triangle)) {
            *best = hits.hit(leaf, k);
        }
    }
}

#[inline(always)]
fn all_hits<I: Instructions>(tree: &Tree, ray: &Ray, stack: &mut [Child], lists: &mut HitLists) {
    visit::<I>(tree, ray, f32::MAX, stack, |leaf, hits| {
        bits(hits.mask).filter(|&k| leaf.triangles[k] != ray.from).for_each(|k| lists.push(hits.hit(leaf, k)));
        false
    });
}

#[inline(always)]
fn any_hit<I: Instructions>(tree: &Tree, ray: &Ray, reach: f32, stack: &mut [Child]) -> bool {
    visit::<I>(tree, ray, reach, stack, |leaf, hits| {
        bits(hits.mask).any(|k| hits.t[k] < reach && leaf.triangles[k] != ray.from)
    })
}

/// Shows the hits of `ray` within `reach`, leaf by leaf in any order, to `stop` until it is true; whether it ever was.
#[inline(always)]
fn visit<I: Instructions>(
    tree: &Tree,
    ray: &Ray,
    reach: f32,
    stack: &mut [Child],
    mut stop: impl FnMut(&Leaf, &LeafHits) -> bool,
) -> bool {
    let tracer = Tracer::<I>::new(ray);
    stack[0] = Child::ROOT;
    let mut waiting = 1;
    while waiting > 0 {
        waiting -= 1;
        let child = stack[waiting];
        if child.is_leaf() {
            let leaf = &tree.leaves[child.index()];
            if tracer.hit(leaf, reach).is_some_and(|hits| stop(leaf, &hits)) {
                return true;
            }
        } else {
            let node = &tree.nodes[child.index()];
            for k in bits(tracer.enter(node, reach).1) {
                prefetch::<I>(tree, node.children[k]);
                stack[waiting] = node.children[k];
                waiting += 1;
            }
        }
    }
    false
}

/// Asks for the memory of a child, which is going to be visited soon: fetching it takes longer than several nodes.
#[inline(always)]
fn prefetch<I: Instructions>(tree: &Tree, child: Child) {
    if child.is_leaf() {
        I::prefetch(&tree.leaves[child.index()]);
    } else {
        I::prefetch(&tree.nodes[child.index()]);
    }
}
