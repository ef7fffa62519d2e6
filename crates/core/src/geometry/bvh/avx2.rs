//! Lanes as AVX registers, on machines that have AVX2. Here and in the raster's is the only unsafe code of the crate.
#![allow(unsafe_code)]

use super::lanes::{Instructions, Lanes};
use super::node::Tree;
use super::traverse;
use crate::geometry::{Hit, HitLists, Ray};
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Sub};

/// Proof that this machine has AVX2: there is no other way to one than [`Avx2::detect`].
#[derive(Clone, Copy, Debug)]
pub struct Avx2(());

impl Instructions for Avx2 {
    type Boxes = F32x8;
    type Triangles = F32x4;

    #[inline(always)]
    fn prefetch<T>(value: &T) {
        let lines = std::ptr::from_ref(value).cast::<[i8; 64]>();
        for line in 0..size_of::<T>().div_ceil(64) {
            // SAFETY: a prefetch reads nothing, whatever the address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(lines.wrapping_add(line).cast()) };
        }
    }
}

impl Avx2 {
    pub fn detect() -> Option<Avx2> {
        is_x86_feature_detected!("avx2").then_some(Avx2(()))
    }

    pub fn closest(self, tree: &Tree, rays: &[Ray], hits: &mut [Hit]) {
        // SAFETY: `self` exists, so this machine has AVX2.
        unsafe { closest(tree, rays, hits) }
    }

    pub fn all(self, tree: &Tree, rays: &[Ray], lists: &mut HitLists) {
        // SAFETY: `self` exists, so this machine has AVX2.
        unsafe { all(tree, rays, lists) }
    }

    pub fn any(self, tree: &Tree, rays: &[Ray], reach: &[f32], blocked: &mut [bool]) {
        // SAFETY: `self` exists, so this machine has AVX2.
        unsafe { any(tree, rays, reach, blocked) }
    }
}

// The whole traversal is inlined into these three functions and compiled for AVX2 there.

#[target_feature(enable = "avx2")]
fn closest(tree: &Tree, rays: &[Ray], hits: &mut [Hit]) {
    traverse::closest::<Avx2>(tree, rays, hits);
}

#[target_feature(enable = "avx2")]
fn all(tree: &Tree, rays: &[Ray], lists: &mut HitLists) {
    traverse::all::<Avx2>(tree, rays, lists);
}

#[target_feature(enable = "avx2")]
fn any(tree: &Tree, rays: &[Ray], reach: &[f32], blocked: &mut [bool]) {
    traverse::any::<Avx2>(tree, rays, reach, blocked);
}

/// An operator by the intrinsic of the same name.
macro_rules! operator {
    ($lanes:ident, $operator:ident, $name:ident, $intrinsic:ident) => {
        impl $operator for $lanes {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                // SAFETY: lanes are computed with inside the three functions above only, on a machine that has AVX2.
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    };
}

/// A register of `$n` floats by its intrinsics.
macro_rules! lanes {
    ($lanes:ident, $register:ident, $n:literal, $splat:ident, $load:ident, $store:ident, $min:ident, $max:ident,
     $add:ident, $sub:ident, $mul:ident, $div:ident, |$a:ident, $b:ident| $at_most:expr) => {
        #[derive(Clone, Copy)]
        pub struct $lanes($register);

        // SAFETY (all blocks): lanes are computed with inside the three functions above only, on a machine that has AVX2.
        // Loads and stores take any alignment and stay inside an array of the register's size.
        impl Lanes<$n> for $lanes {
            #[inline(always)]
            fn splat(value: f32) -> Self {
                // SAFETY: as above.
                Self(unsafe { $splat(value) })
            }

            #[inline(always)]
            fn load(values: &[f32; $n]) -> Self {
                // SAFETY: as above.
                Self(unsafe { $load(values.as_ptr()) })
            }

            #[inline(always)]
            fn store(self) -> [f32; $n] {
                let mut values = [0.0; $n];
                // SAFETY: as above.
                unsafe { $store(values.as_mut_ptr(), self.0) };
                values
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $min(self.0, other.0) })
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $max(self.0, other.0) })
            }

            #[inline(always)]
            fn at_most(self, other: Self) -> u32 {
                let ($a, $b) = (self.0, other.0);
                // SAFETY: as above.
                (unsafe { $at_most }) as u32
            }
        }

        operator!($lanes, Add, add, $add);
        operator!($lanes, Sub, sub, $sub);
        operator!($lanes, Mul, mul, $mul);
        operator!($lanes, Div, div, $div);
    };
}

lanes!(
    F32x8,
    __m256,
    8,
    _mm256_set1_ps,
    _mm256_loadu_ps,
    _mm256_storeu_ps,
    _mm256_min_ps,
    _mm256_max_ps,
    _mm256_add_ps,
    _mm256_sub_ps,
    _mm256_mul_ps,
    _mm256_div_ps,
    |a, b| _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b))
);
lanes!(
    F32x4,
    __m128,
    4,
    _mm_set1_ps,
    _mm_loadu_ps,
    _mm_storeu_ps,
    _mm_min_ps,
    _mm_max_ps,
    _mm_add_ps,
    _mm_sub_ps,
    _mm_mul_ps,
    _mm_div_ps,
    |a, b| _mm_movemask_ps(_mm_cmple_ps(a, b))
);
