//! Digital sequences in base 5 (Niederreiter 1987), randomised by a digital shift.
//!
//! Coordinate d of point n has the digits `x = C_d a mod 5`, where a are the digits of n, the lowest first, and `C_d` is the
//! generator matrix of the dimension. From n to n + 1, the trailing fours become zeros and the digit above them grows by one:
//! all of them grow by one modulo 5, so a sum of columns is added to x, which is tabulated.
//!
//! Sixteen digits are kept in the sixteen four-bit places of a word, the first digit highest, and are added at once. 5^16 is
//! above 2^37, finer than single precision. The shift adds the same random digits to all points of a stream, different ones
//! in each dimension: a (t, m, s)-net remains one. Unbiased. Cost: four such sums and conversions a point in `fill`.

use super::stream_key::StreamKey;
use crate::sampling::{Sample, Sequence};

/// Dimensions of a digital sequence in base 5 with t = 0.
pub const DIMENSIONS: usize = 5;
/// Digits of a coordinate.
pub const ROWS: usize = 16;
/// Digits of an index of 64 bits.
pub const COLUMNS: usize = 28;

/// A generator matrix; entries are 0 to 4.
pub type Matrix = [[u8; COLUMNS]; ROWS];

/// Sixteen digits, the first in the four highest bits.
type Digits = u64;

/// The generator matrices of a digital sequence.
pub struct Matrices {
    columns: [[Digits; COLUMNS]; DIMENSIONS],
    /// For the first four dimensions: the sum of columns 0 to k.
    carries: [[Digits; 4]; COLUMNS],
}

impl Matrices {
    pub const fn new(entries: &[Matrix; DIMENSIONS]) -> Matrices {
        let mut matrices = Matrices { columns: [[0; COLUMNS]; DIMENSIONS], carries: [[0; 4]; COLUMNS] };
        let mut d = 0;
        while d < DIMENSIONS {
            let (mut sum, mut k) = (0, 0);
            while k < COLUMNS {
                let mut j = 0;
                while j < ROWS {
                    matrices.columns[d][k] |= (entries[d][j][k] as u64) << (60 - 4 * j);
                    j += 1;
                }
                sum = add(sum, matrices.columns[d][k]);
                if d < 4 {
                    matrices.carries[k][d] = sum;
                }
                k += 1;
            }
            d += 1;
        }
        matrices
    }

    /// Coordinate `d` of point `index` before any randomisation.
    fn digits(&self, index: u64, d: usize) -> Digits {
        let (mut rest, mut x) = (index, 0);
        for column in &self.columns[d] {
            for _ in 0..rest % 5 {
                x = add(x, *column);
            }
            rest /= 5;
        }
        x
    }

    /// Coordinate `d` of point `index` before any randomisation, times 5^16.
    #[cfg(test)]
    pub fn numerator(&self, index: u64, d: usize) -> u64 {
        numerator(self.digits(index, d))
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
        let mut x: [Digits; 4] =
            std::array::from_fn(|d| add(self.matrices.digits(first, d), digits_of(key.shift(d as u32))));
        for (index, point) in (first..).zip(points) {
            *point = x.map(to_unit);
            let carry = &self.matrices.carries[trailing_fours(index)];
            for d in 0..4 {
                x[d] = add(x[d], carry[d]);
            }
        }
    }

    fn number(&self, stream: u64, index: u64, dimension: u32) -> f32 {
        let key = StreamKey::new(self.seed, stream);
        let (index, d) = key.padded(index, dimension, DIMENSIONS);
        to_unit(add(self.matrices.digits(index, d), digits_of(key.shift(dimension))))
    }
}

/// The sum of digits, each modulo 5.
const fn add(a: Digits, b: Digits) -> Digits {
    let sum = a + b;
    // Three more sets the highest bit of the digits that are 5 to 8.
    let over = ((sum + 0x3333_3333_3333_3333) >> 3) & 0x1111_1111_1111_1111;
    sum - 5 * over
}

/// The leading digits of the fraction `bits / 2^64`.
fn digits_of(bits: u64) -> Digits {
    let (mut fraction, mut digits) = (bits, 0);
    for _ in 0..ROWS {
        let wide = 5 * u128::from(fraction);
        digits = digits << 4 | (wide >> 64) as u64;
        fraction = wide as u64;
    }
    digits
}

/// The fraction with these digits, times 5^16: neighbours are joined to numbers of 2, 4, 8 and 16 digits.
fn numerator(digits: Digits) -> u64 {
    let low_halves = [0x0f0f_0f0f_0f0f_0f0f, 0x00ff_00ff_00ff_00ff, 0x0000_ffff_0000_ffff, 0x0000_0000_ffff_ffff];
    let joined = |x: u64, k: usize| ((x >> (4 << k)) & low_halves[k]) * 5u64.pow(1 << k) + (x & low_halves[k]);
    (0..4).fold(digits, joined)
}

/// The leading 24 bits of the fraction with these digits.
fn to_unit(digits: Digits) -> f32 {
    let leading = (numerator(digits) as f64 * (2f64.powi(24) / 5f64.powi(16))) as u32;
    leading as f32 * (1.0 / (1 << 24) as f32)
}

/// How many digits of `index`, from the lowest, are four.
fn trailing_fours(index: u64) -> usize {
    let (mut rest, mut count) = (index, 0);
    while rest % 5 == 4 {
        rest /= 5;
        count += 1;
    }
    count
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::sampling::construction::quality::is_net;

    /// Asserts that every block of 5^m points is a (0, m, 5)-net in base 5.
    pub fn assert_sequence_of_nets(matrices: &Matrices) {
        for m in 1..5 {
            for block in [0, 1, 7, 5u64.pow(17) + 3] {
                let leading = |index, d, k| matrices.numerator(block * 5u64.pow(m) + index, d) / 5u64.pow(16 - k);
                assert!(is_net(5, 0, m, DIMENSIONS, leading), "block {block} of 5^{m} points");
            }
        }
    }

    #[test]
    fn digits_are_added_and_read() {
        let all = |digit: u64| (0..16).fold(0, |x, _| x << 4 | digit);
        for (a, b) in (0..5).flat_map(|a| (0..5).map(move |b| (a, b))) {
            assert_eq!(add(all(a), all(b)), all((a + b) % 5));
        }
        assert_eq!(numerator(0x1000_0000_0000_0032), 5u64.pow(15) + 17);
        assert_eq!(numerator(all(4)), 5u64.pow(16) - 1);
        assert_eq!(to_unit(all(4)), 1.0 - 2f32.powi(-24));
        assert_eq!((digits_of(u64::MAX), digits_of(0), digits_of(1 << 63)), (all(4), 0, all(2)));
        assert_eq!((trailing_fours(0), trailing_fours(124), trailing_fours(u64::MAX)), (0, 3, 0));
    }
}
