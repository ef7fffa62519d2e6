//! What sequences are built of: digital sequences in bases 2 and 5, radical inverses, and their randomisations.

pub mod base2;
pub mod base5;
#[cfg(test)]
pub mod quality;
pub mod radical_inverse;
pub mod scramble;
pub mod stream_key;

/// The 24 leading bits of a 32-bit fraction, as a number in [0, 1): more would round up to 1.
pub fn to_unit(fraction: u32) -> f32 {
    (fraction >> 8) as f32 * (1.0 / (1 << 24) as f32)
}
