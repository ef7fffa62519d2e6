//! Counter-based random numbers: a good mixing function and what is made of it. No state, so any number can be drawn
//! first.

/// Mixes 64 bits (the finaliser of SplitMix64; Steele, Lea & Flood 2014, with Stafford's variant 13 constants).
pub fn mix(value: u64) -> u64 {
    let z = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A key for what belongs to `key` and `index`: seeds of replicates, of streams, of steps.
pub fn derive(key: u64, index: u64) -> u64 {
    mix(mix(key.wrapping_add(0x9e37_79b9_7f4a_7c15)) ^ mix(index.wrapping_mul(0xd1b5_4a32_d192_ed03).wrapping_add(1)))
}

/// A number in [0, 1) with 53 random bits.
pub fn unit_f64(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::moments::Moments;

    #[test]
    fn derived_keys_look_uniform_and_do_not_collide() {
        let mut keys: Vec<u64> = (0..300).flat_map(|key| (0..300).map(move |index| derive(key, index))).collect();
        let mean = keys.iter().map(|&k| unit_f64(k)).collect::<Moments>();
        // The mean of 90,000 uniform numbers has a standard deviation of 1 / sqrt(12 * 90,000): allow five.
        assert!((mean.mean - 0.5).abs() < 5.0 / (12.0f64 * 90_000.0).sqrt());
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), 90_000);
    }
}
