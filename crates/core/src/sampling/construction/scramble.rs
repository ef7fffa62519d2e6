//! Nested uniform scrambling by a hash (Laine & Karras, Stratified Sampling for Stochastic Transparency, EGSR 2011; Burley,
//! Practical Hash-based Owen Scrambling, JCGT 2020; constants by Vegdahl).

/// Owen's nested uniform scrambling of a 32-bit fraction: each bit is flipped by a hash of the bits above it.
pub fn scramble(x: u32, seed: u32) -> u32 {
    scramble_reversed(x.reverse_bits(), seed)
}

/// The same of a fraction whose bits come in reverse.
#[inline]
pub fn scramble_reversed(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::derive;

    #[test]
    fn leading_bits_are_permuted_among_themselves() {
        for seed in (0..20).map(|k| derive(4, k) as u32) {
            let low = derive(seed.into(), 1) as u32;
            for m in 1..10 {
                let mut seen = vec![false; 1 << m];
                for top in 0..1u32 << m {
                    let x = top << (32 - m);
                    let scrambled = scramble(x, seed) >> (32 - m);
                    assert_eq!(
                        scrambled,
                        scramble(x | low >> m, seed) >> (32 - m),
                        "they do not depend on those below"
                    );
                    seen[scrambled as usize] = true;
                }
                assert!(seen.iter().all(|&s| s));
            }
        }
    }
}
