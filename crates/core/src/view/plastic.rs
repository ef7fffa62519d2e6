//! Evenly spread points of the unit square: the additive recurrence on the plastic number (Roberts 2018, "R2").

use glam::Vec2;

/// Point `k` of the sequence, the whole of it shifted round the square by an amount that belongs to `shift`.
pub fn point(shift: u32, k: u32) -> Vec2 {
    const STEP: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];
    let at = |axis: usize| (f64::from(shift) * STEP[1 - axis] + (f64::from(k) + 0.5) * STEP[axis]).fract() as f32;
    Vec2::new(at(0), at(1)).min(Vec2::splat(1.0 - f32::EPSILON))
}
