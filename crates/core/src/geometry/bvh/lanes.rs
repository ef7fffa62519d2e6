//! What the kernel asks of a machine: a few floats computed with together. Every operation is the IEEE one in each lane,
//! so all implementations give the same bits.

use super::node::{LEAF_SIZE, WIDTH};
use std::ops::{Add, Div, Mul, Sub};

/// `N` floats; the operators work lane by lane.
pub trait Lanes<const N: usize>:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    fn splat(value: f32) -> Self;

    fn load(values: &[f32; N]) -> Self;

    fn store(self) -> [f32; N];

    /// The lesser of each pair; `other` if one is NaN.
    fn min(self, other: Self) -> Self;

    /// The greater of each pair; `other` if one is NaN.
    fn max(self, other: Self) -> Self;

    /// Bit `k` tells whether lane `k` is at most that of `other`; NaN never is.
    fn at_most(self, other: Self) -> u32;
}

/// A set of instructions: one type for the boxes of a node, one for the triangles of a leaf.
pub trait Instructions {
    type Boxes: Lanes<WIDTH>;
    type Triangles: Lanes<LEAF_SIZE>;

    /// Asks for the memory of `value`, which is going to be used soon.
    fn prefetch<T>(value: &T);
}
