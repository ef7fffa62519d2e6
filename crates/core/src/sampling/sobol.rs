//! Sobol' points with a digital shift.
//!
//! Sobol', Distribution of points in a cube, 1967, with the direction numbers of Joe & Kuo, Constructing Sobol sequences with
//! better two-dimensional projections, SIAM J. Sci. Comput. 30, 2008. With the primitive polynomial
//! `x^s + a_1 x^(s-1) + ... + 1` of a dimension, column k of its generator matrix is
//! `v_k = a_1 v_(k-1) + ... + a_(s-1) v_(k-s+1) + v_(k-s) + v_(k-s) / 2^s` (sums without carry), from s given numbers on.
//!
//! A (t, s)-sequence with t the sum of the degrees less one, from the second dimension on: t = 0, 0, 1, 3, 5 in one to five
//! dimensions. Points are taken in the order of the index, not of its Gray code. Unbiased. 32 dimensions of its own.

use super::Entry;
use super::construction::base2::{Columns, DIMENSIONS, Matrices, Shifted};

pub(super) const ENTRY: Entry = Entry {
    name: "sobol",
    what: "Sobol' points, digitally shifted",
    source: "Joe & Kuo 2008",
    make: |seed| Box::new(Shifted { matrices: &MATRICES, seed }),
};

pub(super) static MATRICES: Matrices = Matrices::new(columns());

/// Primitive polynomials, bit i the coefficient of x^i, and initial numbers of dimensions 2 to 32 (new-joe-kuo-6).
const JOE_KUO: [(u32, &[u32]); DIMENSIONS - 1] = [
    (0b11, &[1]),
    (0b111, &[1, 3]),
    (0b1011, &[1, 3, 1]),
    (0b1101, &[1, 1, 1]),
    (0b10011, &[1, 1, 3, 3]),
    (0b11001, &[1, 3, 5, 13]),
    (0b100101, &[1, 1, 5, 5, 17]),
    (0b101001, &[1, 1, 5, 5, 5]),
    (0b101111, &[1, 1, 7, 11, 19]),
    (0b110111, &[1, 1, 5, 1, 1]),
    (0b111011, &[1, 1, 1, 3, 11]),
    (0b111101, &[1, 3, 5, 5, 31]),
    (0b1000011, &[1, 3, 3, 9, 7, 49]),
    (0b1011011, &[1, 1, 1, 15, 21, 21]),
    (0b1100001, &[1, 3, 1, 13, 27, 49]),
    (0b1100111, &[1, 1, 1, 15, 7, 5]),
    (0b1101101, &[1, 3, 1, 15, 13, 25]),
    (0b1110011, &[1, 1, 5, 5, 19, 61]),
    (0b10000011, &[1, 3, 7, 11, 23, 15, 103]),
    (0b10001001, &[1, 3, 7, 13, 13, 15, 69]),
    (0b10001111, &[1, 1, 3, 13, 7, 35, 63]),
    (0b10010001, &[1, 3, 5, 9, 1, 25, 53]),
    (0b10011101, &[1, 3, 1, 13, 9, 35, 107]),
    (0b10100111, &[1, 3, 1, 5, 27, 61, 31]),
    (0b10101011, &[1, 1, 5, 11, 19, 41, 61]),
    (0b10111001, &[1, 3, 5, 3, 3, 13, 69]),
    (0b10111111, &[1, 1, 7, 13, 1, 19, 1]),
    (0b11000001, &[1, 3, 7, 5, 13, 19, 59]),
    (0b11001011, &[1, 1, 3, 9, 25, 29, 41]),
    (0b11010011, &[1, 3, 5, 13, 23, 1, 55]),
    (0b11010101, &[1, 3, 7, 3, 13, 59, 17]),
];

const fn columns() -> [Columns; DIMENSIONS] {
    let mut v = [[0u32; 64]; DIMENSIONS];
    let mut k = 0;
    while k < 32 {
        v[0][k] = 1 << (31 - k);
        k += 1;
    }
    let mut d = 1;
    while d < DIMENSIONS {
        let (polynomial, initial) = JOE_KUO[d - 1];
        let s = initial.len();
        let mut k = 0;
        while k < 64 {
            v[d][k] = if k < s {
                initial[k] << (31 - k)
            } else {
                let mut value = v[d][k - s] ^ (v[d][k - s] >> s);
                let mut j = 1;
                while j < s {
                    if (polynomial >> (s - j)) & 1 == 1 {
                        value ^= v[d][k - j];
                    }
                    j += 1;
                }
                value
            };
            k += 1;
        }
        d += 1;
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::construction::base2::tests::*;
    use crate::sampling::construction::quality::assert_l2_star;

    #[test]
    fn points_are_those_of_joe_and_kuo() {
        let fraction = |index, d| f64::from(MATRICES.fraction(index, d)) / 2f64.powi(32);
        // Points 1 to 7 in binary (not Gray code) order, from the recurrence worked by hand.
        let expected = [
            [0.5, 0.5, 0.5, 0.5],
            [0.25, 0.75, 0.75, 0.75],
            [0.75, 0.25, 0.25, 0.25],
            [0.125, 0.625, 0.375, 0.125],
            [0.625, 0.125, 0.875, 0.625],
            [0.375, 0.375, 0.625, 0.875],
            [0.875, 0.875, 0.125, 0.375],
        ];
        for (index, point) in (1..).zip(&expected) {
            assert_eq!(std::array::from_fn(|d| fraction(index, d)), *point, "point {index}");
        }
    }

    #[test]
    fn initial_numbers_are_admissible() {
        for (d, (polynomial, initial)) in (2..).zip(JOE_KUO) {
            assert_eq!(polynomial.ilog2() as usize, initial.len(), "dimension {d}");
            assert!(initial.iter().enumerate().all(|(k, m)| m % 2 == 1 && m >> (k + 1) == 0), "dimension {d}");
        }
        assert!(JOE_KUO.windows(2).all(|w| w[0].0 < w[1].0), "each polynomial once");
    }

    #[test]
    fn every_block_is_a_net_of_the_published_quality() {
        assert_sequence_of_nets(&MATRICES, &[0, 0, 1, 3, 5]);
        assert_every_dimension_is_even(&MATRICES, |_| 10);
    }

    #[test]
    fn the_discrepancy_is_the_known_one() {
        let unit = |index, d| f64::from(MATRICES.fraction(index, d)) / 2f64.powi(32);
        assert_l2_star(
            unit,
            &[(64, 0.014_896_763_517_805_48), (256, 0.005_123_310_002_770_82), (1024, 0.001_409_194_316_448_65)],
        );
    }
}
