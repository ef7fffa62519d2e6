//! The key of a stream: whence all that randomises it comes.

use super::scramble::scramble;
use crate::math::hash::derive;

/// The key of one stream of a sequence with some seed.
#[derive(Clone, Copy, Debug)]
pub struct StreamKey(u64);

impl StreamKey {
    pub fn new(seed: u64, stream: u64) -> StreamKey {
        StreamKey(derive(seed, stream))
    }

    /// 64 random bits that shift the numbers of one dimension.
    pub fn shift(self, dimension: u32) -> u64 {
        derive(self.0, u64::from(dimension))
    }

    /// Which point, and which of its `native` coordinates, gives number `dimension` of point `index`.
    ///
    /// A sequence has `native` dimensions of its own. Those beyond come from copies of it in another order: nested uniform
    /// scrambling of the index, which leaves together what stands together in blocks of powers of two ("padding";
    /// Burley, Practical Hash-based Owen Scrambling, JCGT 2020, section 5). With a shift for each dimension, the copies are
    /// as even as the first dimensions in themselves, and at random with respect to them.
    pub fn padded(self, index: u64, dimension: u32, native: usize) -> (u64, usize) {
        let (copy, coordinate) = (dimension / native as u32, dimension as usize % native);
        if copy == 0 {
            return (index, coordinate);
        }
        let (high, low) = (index >> 32, index as u32);
        let seed = derive(derive(!self.0, u64::from(copy)), high) as u32;
        (high << 32 | u64::from(scramble(low, seed)), coordinate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_has_the_same_points_in_another_order() {
        let key = StreamKey::new(1, 2);
        assert_eq!((key.padded(77, 0, 5), key.padded(77, 4, 5)), ((77, 0), (77, 4)));
        for (dimension, coordinate) in [(5, 0), (9, 4), (10, 0)] {
            let order: Vec<u64> = (0..64).map(|index| key.padded(index, dimension, 5).0).collect();
            let block = order[0] / 64;
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (64 * block..64 * (block + 1)).collect::<Vec<_>>());
            assert!(order.windows(2).any(|w| w[1] != w[0] + 1));
            assert_eq!(key.padded(0, dimension, 5).1, coordinate);
        }
        assert_eq!(key.padded(1 << 40, 5, 5).0 >> 32, 1 << 8);
    }
}
