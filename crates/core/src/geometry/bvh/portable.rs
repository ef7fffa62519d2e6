//! Lanes as plain arrays, for every machine.

use super::lanes::{Instructions, Lanes};
use std::array::from_fn;
use std::ops::{Add, Div, Mul, Sub};

/// No instructions beyond those of the language.
pub struct Portable;

impl Instructions for Portable {
    type Boxes = Array<8>;
    type Triangles = Array<4>;

    #[inline(always)]
    fn prefetch<T>(_: &T) {}
}

#[derive(Clone, Copy)]
pub struct Array<const N: usize>([f32; N]);

impl<const N: usize> Array<N> {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Array(from_fn(|k| f(self.0[k], other.0[k])))
    }
}

impl<const N: usize> Lanes<N> for Array<N> {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Array([value; N])
    }

    #[inline(always)]
    fn load(values: &[f32; N]) -> Self {
        Array(*values)
    }

    #[inline(always)]
    fn store(self) -> [f32; N] {
        self.0
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        (0..N).fold(0, |mask, k| mask | u32::from(self.0[k] <= other.0[k]) << k)
    }
}

impl<const N: usize> Add for Array<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, f32::add)
    }
}

impl<const N: usize> Sub for Array<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, f32::sub)
    }
}

impl<const N: usize> Mul for Array<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, f32::mul)
    }
}

impl<const N: usize> Div for Array<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, f32::div)
    }
}
