//! Random numbers from a counter: Philox4x32-10.
//!
//! Salmon, Moraes, Dror & Shaw, Parallel random numbers: as easy as 1, 2, 3, SC 2011. Ten rounds of multiplication,
//! exclusive-or and exchange turn a counter of 128 bits, here index and stream, into 128 random bits under a key, here the
//! seed. So four numbers cost one call, whichever come first; numbers 4 to 7 come from the next key, and so on. Unbiased.

use super::construction::to_unit;
use super::{Entry, Sample, Sequence};
use crate::math::hash::derive;

pub(super) const ENTRY: Entry = Entry {
    name: "random",
    what: "independent random numbers from a counter",
    source: "Philox4x32-10, Salmon et al. 2011",
    make: |seed| Box::new(Random { seed }),
};

struct Random {
    seed: u64,
}

impl Sequence for Random {
    fn fill(&self, stream: u64, first: u64, points: &mut [Sample]) {
        let key = derive(self.seed, 0);
        for (index, point) in (first..).zip(points) {
            *point = philox([index, stream], key).map(to_unit);
        }
    }

    fn number(&self, stream: u64, index: u64, dimension: u32) -> f32 {
        let key = derive(self.seed, u64::from(dimension / 4));
        to_unit(philox([index, stream], key)[dimension as usize % 4])
    }
}

/// Four words of random bits for a counter and a key, both with their low words first.
fn philox(counter: [u64; 2], key: u64) -> [u32; 4] {
    let [mut a, mut b, mut c, mut d] = words(counter);
    let (mut k, mut l) = (key as u32, (key >> 32) as u32);
    for _ in 0..10 {
        let (p, q) = (0xd251_1f53 * u64::from(a), 0xcd9e_8d57 * u64::from(c));
        [a, b, c, d] = [(q >> 32) as u32 ^ b ^ k, q as u32, (p >> 32) as u32 ^ d ^ l, p as u32];
        k = k.wrapping_add(0x9e37_79b9);
        l = l.wrapping_add(0xbb67_ae85);
    }
    [a, b, c, d]
}

fn words([a, b]: [u64; 2]) -> [u32; 4] {
    [a as u32, (a >> 32) as u32, b as u32, (b >> 32) as u32]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_the_published_ones() {
        // The known-answer vectors of the authors' library Random123: zeros, ones, and digits of pi.
        let ones = u64::MAX;
        assert_eq!(philox([0, 0], 0), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(philox([ones, ones], ones), [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]);
        assert_eq!(
            philox([0x85a3_08d3_243f_6a88, 0x0370_7344_1319_8a2e], 0x299f_31d0_a409_3822),
            [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]
        );
    }
}
