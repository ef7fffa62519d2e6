//! Digital sequences in base 2 (Niederreiter 1987), randomised by a digital shift.
//!
//! Coordinate d of point n has the bits `x = C_d n` over the field of two elements, where `C_d` is the generator matrix of
//! the dimension. Column k of `C_d` is what bit k of n adds, so `x` is the exclusive-or of the columns at the set bits of n.
//! From n to n + 1, the trailing ones and the zero above them flip: one exclusive-or with a sum of columns, which is tabulated.
//!
//! The shift flips the bits of all points of a stream alike, differently in each dimension: a (t, m, s)-net remains one
//! (L'Ecuyer & Lemieux, Recent Advances in Randomized Quasi-Monte Carlo Methods, 2002). Unbiased. Cost: four exclusive-ors a
//! point in `fill`.

use super::stream_key::StreamKey;
use super::to_unit;
use crate::sampling::{Sample, Sequence};

/// Dimensions of a digital sequence in base 2.
pub const DIMENSIONS: usize = 32;

/// Columns of a generator matrix, each with its first row in the highest bit: those of all bits of an index.
pub type Columns = [u32; 64];

/// The generator matrices of a digital sequence.
pub struct Matrices {
    columns: [Columns; DIMENSIONS],
    /// For the first four dimensions: the sum of columns 0 to k.
    carries: [[u32; 4]; 64],
}

impl Matrices {
    pub const fn new(columns: [Columns; DIMENSIONS]) -> Matrices {
        let mut carries = [[0; 4]; 64];
        let mut d = 0;
        while d < 4 {
            let (mut sum, mut k) = (0, 0);
            while k < 64 {
                sum ^= columns[d][k];
                carries[k][d] = sum;
                k += 1;
            }
            d += 1;
        }
        Matrices { columns, carries }
    }

    /// For the first four dimensions: the sum of columns 0 to k, each fraction with its bits in reverse; and for k = 32, where 32
    /// bits of an index are all ones, the sum of columns 0 to 31, which leads back to point 0.
    pub const fn reversed_carries(&self) -> [[u32; 4]; 33] {
        let mut reversed = [[0; 4]; 33];
        let mut k = 0;
        while k < 33 {
            let column = if k < 32 { k } else { 31 };
            let mut d = 0;
            while d < 4 {
                reversed[k][d] = self.carries[column][d].reverse_bits();
                d += 1;
            }
            k += 1;
        }
        reversed
    }

    /// Coordinate `d` of point `index` before any randomisation, as a 32-bit fraction.
    pub fn fraction(&self, index: u64, d: usize) -> u32 {
        let (mut bits, mut x) = (index, 0);
        while bits != 0 {
            x ^= self.columns[d][bits.trailing_zeros() as usize];
            bits &= bits - 1;
        }
        x
    }
}

/// A digital sequence, shifted independently for each stream and dimension.
pub struct Shifted {
    pub matrices: &'static Matrices,
    pub seed: u64,
}

impl Sequence for Shifted {
    fn fill(&self, stream: u64, first: u64, points: &mut [Sample]) {
        let key = StreamKey::new(self.seed, stream);
        let mut x: [u32; 4] =
            std::array::from_fn(|d| self.matrices.fraction(first, d) ^ (key.shift(d as u32) >> 32) as u32);
        for (index, point) in (first..).zip(points) {
            *point = x.map(to_unit);
            let carry = &self.matrices.carries[(index.trailing_ones() & 63) as usize];
            for d in 0..4 {
                x[d] ^= carry[d];
            }
        }
    }

    fn number(&self, stream: u64, index: u64, dimension: u32) -> f32 {
        let key = StreamKey::new(self.seed, stream);
        let (index, d) = key.padded(index, dimension, DIMENSIONS);
        to_unit(self.matrices.fraction(index, d) ^ (key.shift(dimension) >> 32) as u32)
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::sampling::construction::quality::is_net;

    /// Asserts that every block of `2^m` points is a (t, m, s)-net, for the t of `known`, from one dimension on, and that no point
    /// comes twice.
    pub fn assert_sequence_of_nets(matrices: &Matrices, known: &[u32]) {
        for (s, &t) in (1..).zip(known) {
            for m in t..=t + 5 {
                for block in [0, 1, 5, (1 << 40) + 3] {
                    let leading = |index, d, k| u64::from(matrices.fraction((block << m) + index, d)) >> (32 - k);
                    assert!(is_net(2, t, m, s, leading), "block {block} of 2^{m} points in {s} dimensions");
                }
            }
        }
        let leading = |index, d, k| u64::from(matrices.fraction(index, d)) >> (32 - k);
        assert!(!is_net(2, 0, 4, 3, leading), "there is no (0, 3)-sequence in base 2");
        assert_points_differ(matrices);
    }

    /// Asserts that no two of the first 2^40 points are the same in single precision: the columns that the bits of the
    /// index add, 24 rows of four dimensions, are linearly independent.
    fn assert_points_differ(matrices: &Matrices) {
        let mut basis: Vec<u128> = Vec::new();
        for k in 0..40 {
            let column = (0..4).fold(0, |x, d| x << 24 | u128::from(matrices.columns[d][k] >> 8));
            let reduced = basis.iter().fold(column, |x, b| x.min(x ^ b));
            assert!(reduced != 0, "column {k} is a sum of earlier ones");
            basis.push(reduced);
        }
    }

    /// Asserts that in each dimension, blocks of `2^bits(d)` points hold one point in each interval of that many.
    pub fn assert_every_dimension_is_even(matrices: &Matrices, bits: impl Fn(usize) -> u32) {
        for d in 0..DIMENSIONS {
            for block in [0, 3, 1 << 40] {
                let leading = |index, _, k| u64::from(matrices.fraction((block << bits(d)) + index, d)) >> (32 - k);
                assert!(is_net(2, 0, bits(d), 1, leading), "dimension {d}, block {block}");
            }
        }
    }
}
