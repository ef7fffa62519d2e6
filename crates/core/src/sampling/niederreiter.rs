//! Niederreiter's points in base 2 with a digital shift.
//!
//! Niederreiter, Low-discrepancy and low-dispersion sequences, J. Number Theory 30, 1988, as implemented by Bratley, Fox &
//! Niederreiter, Implementation and tests of low-discrepancy sequences, ACM TOMACS 2, 1992, section 3.3. Let p be the
//! irreducible polynomial of a dimension and e its degree. Row j of the generator matrix, counted from 0, is
//! `c_r = v_(r + u)`, `u = j mod e`, where the sequence v obeys the linear recurrence of `p^q`, `q = j div e + 1`, and
//! starts with `e (q - 1)` zeros and e ones.
//!
//! A (t, s)-sequence with t the sum of e - 1: t = 0, 0, 1, 3, 5 in one to five dimensions. Points are taken in the order of
//! the index, not of its Gray code. Unbiased. 32 dimensions of its own.

use super::Entry;
use super::construction::base2::{Columns, DIMENSIONS, Matrices, Shifted};

pub(super) const ENTRY: Entry = Entry {
    name: "niederreiter",
    what: "Niederreiter points in base 2, digitally shifted",
    source: "Bratley, Fox & Niederreiter 1992",
    make: |seed| Box::new(Shifted { matrices: &MATRICES, seed }),
};

static MATRICES: Matrices = Matrices::new(columns());

/// The irreducible polynomials over the field of two elements, by degree; bit i is the coefficient of x^i.
const IRREDUCIBLE: [u64; DIMENSIONS] = [
    2, 3, 7, 11, 13, 19, 25, 31, 37, 41, 47, 55, 59, 61, 67, 73, 87, 91, 97, 103, 109, 115, 117, 131, 137, 143, 145,
    157, 167, 171, 185, 191,
];

const fn columns() -> [Columns; DIMENSIONS] {
    let mut columns = [[0u32; 64]; DIMENSIONS];
    let mut d = 0;
    while d < DIMENSIONS {
        let p = IRREDUCIBLE[d];
        let e = p.ilog2();
        let (mut power, mut v) = (1, 0);
        let mut j = 0;
        while j < 32 {
            let u = j % e;
            if u == 0 {
                power = product(power, p);
                v = recurrence(power, e);
            }
            let mut r = 0;
            while r < 64 {
                columns[d][r] |= (((v >> (r as u32 + u)) & 1) as u32) << (31 - j);
                r += 1;
            }
            j += 1;
        }
        d += 1;
    }
    columns
}

/// Product of two polynomials.
const fn product(a: u64, b: u64) -> u64 {
    let (mut sum, mut i) = (0, 0);
    while i <= b.ilog2() {
        if (b >> i) & 1 == 1 {
            sum ^= a << i;
        }
        i += 1;
    }
    sum
}

/// The sequence with the characteristic polynomial `b` of degree m that starts with m - e zeros and e ones; bit i is `v_i`.
const fn recurrence(b: u64, e: u32) -> u128 {
    let m = b.ilog2();
    let below = b ^ (1 << m);
    let mut v = ((1u128 << e) - 1) << (m - e);
    let mut i = m;
    while i < 128 {
        let sum = ((v >> (i - m)) as u64 & below).count_ones() & 1;
        v |= (sum as u128) << i;
        i += 1;
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::construction::base2::tests::*;
    use crate::sampling::construction::quality::assert_l2_star;

    #[test]
    fn polynomials_are_all_the_irreducible_ones_of_least_degree() {
        let is_irreducible =
            |n: u64| (2..n).all(|a| (2..n).all(|b| a.ilog2() + b.ilog2() != n.ilog2() || product(a, b) != n));
        assert!((2..192).filter(|&n| is_irreducible(n)).eq(IRREDUCIBLE));
    }

    #[test]
    fn points_are_those_of_bratley_fox_and_niederreiter() {
        // The upper left corners of the first five generator matrices, from the definition: columns as 6-bit numbers.
        let expected = [
            [32, 16, 8, 4, 2, 1],
            [32, 48, 40, 60, 34, 51],
            [48, 36, 28, 61, 47, 27],
            [56, 49, 35, 15, 22, 45],
            [56, 49, 43, 23, 39, 15],
        ];
        for (d, columns) in expected.iter().enumerate() {
            for (k, &column) in columns.iter().enumerate() {
                assert_eq!(MATRICES.fraction(1 << k, d) >> 26, column, "dimension {d}, column {k}");
            }
        }
    }

    #[test]
    fn every_block_is_a_net_of_the_published_quality() {
        assert_sequence_of_nets(&MATRICES, &[0, 0, 1, 3, 5]);
        // A single dimension is even after each power of 2^e.
        assert_every_dimension_is_even(&MATRICES, |d| IRREDUCIBLE[d].ilog2() * (10 / IRREDUCIBLE[d].ilog2()));
    }

    #[test]
    fn the_discrepancy_is_the_known_one() {
        let unit = |index, d| f64::from(MATRICES.fraction(index, d)) / 2f64.powi(32);
        assert_l2_star(
            unit,
            &[(64, 0.014_683_479_416_136_15), (256, 0.004_591_569_426_374_87), (1024, 0.001_359_607_834_415_55)],
        );
    }
}
