//! One ray against the eight boxes of a node and the four triangles of a leaf.
//!
//! No closures over lanes here: they would not be inlined into the function that is compiled for AVX2.

use super::lanes::{Instructions, Lanes};
use super::node::{LEAF_SIZE, Leaf, Node, WIDTH};
use crate::geometry::{Hit, Ray};
use glam::Vec2;

/// What both tests need of a ray, computed once.
pub struct Tracer<I: Instructions> {
    boxes: BoxRay<I::Boxes>,
    triangles: TriangleRay<I::Triangles>,
}

impl<I: Instructions> Tracer<I> {
    #[inline(always)]
    pub fn new(ray: &Ray) -> Self {
        Tracer { boxes: BoxRay::new(ray), triangles: TriangleRay::new(ray) }
    }

    /// Distance at which each box of `node` is entered, and which are hit within `reach` (one bit a box).
    #[inline(always)]
    pub fn enter(&self, node: &Node, reach: f32) -> ([f32; WIDTH], u32) {
        self.boxes.enter(node, reach)
    }

    /// Which triangles of `leaf` are hit within `reach`; nothing if none is.
    #[inline(always)]
    pub fn hit(&self, leaf: &Leaf, reach: f32) -> Option<LeafHits> {
        self.triangles.hit(leaf, reach)
    }
}

/// The hits in one leaf, a lane for each of its triangles. Only the lanes in `mask` mean anything.
pub struct LeafHits {
    pub mask: u32,
    /// Those seen from behind.
    pub back: u32,
    /// Distances [m].
    pub t: [f32; LEAF_SIZE],
    /// Barycentric weights of the corners b and c: at least zero, their sum at most one.
    pub u: [f32; LEAF_SIZE],
    pub v: [f32; LEAF_SIZE],
}

impl LeafHits {
    /// The hit in one lane of the mask.
    #[inline(always)]
    pub fn hit(&self, leaf: &Leaf, lane: usize) -> Hit {
        let (uv, back) = (Vec2::new(self.u[lane], self.v[lane]), self.back >> lane & 1 == 1);
        Hit { t: self.t[lane], triangle: leaf.triangles[lane], uv, back }
    }
}

/// A ray for the slab test.
struct BoxRay<L> {
    origin: [L; 3],
    reciprocal: [L; 3],
    /// The side of [`Node::planes`] through which a ray of this direction enters boxes: 0 or 1.
    near: [usize; 3],
}

impl<L: Lanes<WIDTH>> BoxRay<L> {
    #[inline(always)]
    fn new(ray: &Ray) -> Self {
        // Bounded so that zero times it is zero: an origin in the very plane of a box is inside, not NaN.
        let reciprocal = ray.direction.to_array().map(|d| 1.0 / if d.abs() < 1e-18 { 1e-18f32.copysign(d) } else { d });
        let near = reciprocal.map(|r| usize::from(r < 0.0));
        BoxRay { origin: splat(ray.origin.to_array()), reciprocal: splat(reciprocal), near }
    }

    /// Distances along the ray to the planes of every box that it meets first (`FAR` = 0) or last (1) on `axis`.
    #[inline(always)]
    fn distance<const FAR: usize>(&self, node: &Node, axis: usize) -> L {
        let side = (self.near[axis] & 1) ^ FAR;
        (L::load(&node.planes[axis][side]) - self.origin[axis]) * self.reciprocal[axis]
    }

    #[inline(always)]
    fn enter(&self, node: &Node, reach: f32) -> ([f32; WIDTH], u32) {
        let [x, y, z] = [self.distance::<0>(node, 0), self.distance::<0>(node, 1), self.distance::<0>(node, 2)];
        let enter = x.max(y).max(z.max(L::splat(0.0)));
        let [x, y, z] = [self.distance::<1>(node, 0), self.distance::<1>(node, 1), self.distance::<1>(node, 2)];
        let leave = x.min(y).min(z.min(L::splat(reach)));
        // Each distance is wrong by at most one and a half units in the last place; three cover both (Ize 2013).
        let mask = enter.at_most(leave * L::splat(1.0 + 3.0 * f32::EPSILON));
        (enter.store(), mask)
    }
}

/// A ray for the triangle test: the axes are renamed so that the ray runs mostly along the third one, and sheared so that
/// it runs along it exactly.
struct TriangleRay<L> {
    axes: [usize; 3],
    /// Along the renamed axes.
    origin: [L; 3],
    shear_x: L,
    shear_y: L,
    /// Distance along the ray for one metre along the third axis.
    stretch: L,
}

impl<L: Lanes<LEAF_SIZE>> TriangleRay<L> {
    #[inline(always)]
    fn new(ray: &Ray) -> Self {
        let (o, d) = (ray.origin.to_array(), ray.direction.to_array());
        let size = d.map(f32::abs);
        let longer = usize::from(size[1] > size[0]);
        let z = if size[2] > size[0].max(size[1]) { 2 } else { longer };
        // Looking against the axis mirrors the picture; exchanging the other two mirrors it back.
        const OTHERS: [[usize; 3]; 3] = [[1, 2, 1], [2, 0, 2], [0, 1, 0]];
        let mirrored = usize::from(d[z] < 0.0);
        let (x, y) = (OTHERS[z][mirrored], OTHERS[z][mirrored + 1]);
        let stretch = 1.0 / d[z];
        TriangleRay {
            axes: [x, y, z],
            origin: splat([o[x], o[y], o[z]]),
            shear_x: L::splat(d[x] * stretch),
            shear_y: L::splat(d[y] * stretch),
            stretch: L::splat(stretch),
        }
    }

    /// One corner of each triangle, relative to the origin, along the renamed axes.
    #[inline(always)]
    fn corner(&self, leaf: &Leaf, corner: usize) -> [L; 3] {
        let coordinates = &leaf.corners[corner];
        [
            L::load(&coordinates[self.axes[0]]) - self.origin[0],
            L::load(&coordinates[self.axes[1]]) - self.origin[1],
            L::load(&coordinates[self.axes[2]]) - self.origin[2],
        ]
    }

    /// Where that corner lies across the ray.
    #[inline(always)]
    fn across(&self, [x, y, z]: [L; 3]) -> [L; 2] {
        [x - self.shear_x * z, y - self.shear_y * z]
    }

    #[inline(always)]
    fn hit(&self, leaf: &Leaf, reach: f32) -> Option<LeafHits> {
        let (a, b, c) = (self.corner(leaf, 0), self.corner(leaf, 1), self.corner(leaf, 2));
        let (pa, pb, pc) = (self.across(a), self.across(b), self.across(c));
        let (wa, wb, wc) = (edge(pc, pb), edge(pa, pc), edge(pb, pa));

        // All edges pass on the same side; on both sides they do only where the triangle is seen edge-on.
        let zero = L::splat(0.0);
        let front = zero.at_most(wa.min(wb).min(wc));
        let back = wa.max(wb).max(wc).at_most(zero);
        let inside = front ^ back;
        if inside == 0 {
            return None;
        }

        let t = self.distance(a, b, c);
        let mask = inside & zero.at_most(t) & t.at_most(L::splat(reach));
        if mask == 0 {
            return None;
        }
        let (sum, one) = (wa + wb + wc, L::splat(1.0));
        let u = wb / sum;
        let v = (wc / sum).min(one - u);
        Some(LeafHits { mask, back, t: t.store(), u: u.store(), v: v.store() })
    }

    /// Distance to the planes of triangles [m]: `t = n·a / n·d`. It is bounded by the depths of the corners, which matters
    /// where the plane contains the ray but for rounding. (Interpolating the depths instead is worse for needles: there
    /// the weights are wrong by the rounding error times length over width.)
    #[inline(always)]
    fn distance(&self, a: [L; 3], b: [L; 3], c: [L; 3]) -> L {
        let normal = cross(subtract(b, a), subtract(c, a));
        let along = normal[0] * self.shear_x + normal[1] * self.shear_y + normal[2];
        let plane = (normal[0] * a[0] + normal[1] * a[1] + normal[2] * a[2]) / along * self.stretch;
        let (ta, tb, tc) = (a[2] * self.stretch, b[2] * self.stretch, c[2] * self.stretch);
        plane.max(ta.min(tb).min(tc)).min(ta.max(tb).max(tc))
    }
}

/// The edge function of the edge from `p` to `q`: twice the signed area of the triangle it forms with the ray.
#[inline(always)]
fn edge<L: Lanes<LEAF_SIZE>>(p: [L; 2], q: [L; 2]) -> L {
    p[0] * q[1] - p[1] * q[0]
}

#[inline(always)]
fn subtract<L: Lanes<LEAF_SIZE>>(p: [L; 3], q: [L; 3]) -> [L; 3] {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

#[inline(always)]
fn cross<L: Lanes<LEAF_SIZE>>(p: [L; 3], q: [L; 3]) -> [L; 3] {
    [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
}

#[inline(always)]
fn splat<const N: usize, L: Lanes<N>>([x, y, z]: [f32; 3]) -> [L; 3] {
    [L::splat(x), L::splat(y), L::splat(z)]
}
