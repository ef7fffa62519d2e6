//! The raster on machines that have AVX2: the same operations, more of them at once, so the same bits.
#![allow(unsafe_code)]

use super::{Cross, Raster, TileLists};

/// [`Raster::crossings`], if this machine has AVX2; otherwise does nothing and returns `false`.
pub fn crossings<C: Cross>(raster: &Raster, tile: u32, cross: &C, found: &mut TileLists<C::Crossing>) -> bool {
    let here = is_x86_feature_detected!("avx2");
    if here {
        // SAFETY: this machine has AVX2, as was just asked.
        unsafe { fill(raster, tile, cross, found) };
    }
    here
}

#[target_feature(enable = "avx2")]
fn fill<C: Cross>(raster: &Raster, tile: u32, cross: &C, found: &mut TileLists<C::Crossing>) {
    raster.fill(tile, cross, found);
}
