//! Faure's points in base 5 with a digital shift.
//!
//! Faure, Discrépance de suites associées à un système de numération (en dimension s), Acta Arithmetica 41, 1982. The
//! generator matrix of dimension d, from 0, is the d-th power of the Pascal matrix modulo 5: `c_jk = binomial(k, j) d^(k - j)`.
//! Five is the least prime that has a (0, s)-sequence for a line's four numbers: every block of 5^m points is a (0, m, 5)-net.
//! Unbiased. Five dimensions of its own.

use super::Entry;
use super::construction::base5::{COLUMNS, DIMENSIONS, Matrices, Matrix, ROWS, Shifted};

pub(super) const ENTRY: Entry = Entry {
    name: "faure",
    what: "Faure points in base 5, digitally shifted",
    source: "Faure 1982",
    make: |seed| Box::new(Shifted { matrices: &MATRICES, seed }),
};

static MATRICES: Matrices = Matrices::new(&PASCAL_POWERS);

/// The powers 0 to 4 of the upper triangular Pascal matrix, modulo 5.
pub(super) const PASCAL_POWERS: [Matrix; DIMENSIONS] = pascal_powers();

const fn pascal_powers() -> [Matrix; DIMENSIONS] {
    let mut powers = [[[0; COLUMNS]; ROWS]; DIMENSIONS];
    let mut d = 0;
    while d < DIMENSIONS {
        powers[d][0][0] = 1;
        let mut k = 1;
        while k < COLUMNS {
            // binomial(k, j) = binomial(k - 1, j - 1) + binomial(k - 1, j), with the powers of d.
            let mut j = 0;
            while j < ROWS {
                let left_above = if j > 0 { powers[d][j - 1][k - 1] } else { 0 };
                powers[d][j][k] = (left_above + d as u8 * powers[d][j][k - 1]) % 5;
                j += 1;
            }
            k += 1;
        }
        d += 1;
    }
    powers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::construction::base5::tests::assert_sequence_of_nets;
    use crate::sampling::construction::quality::assert_l2_star;

    #[test]
    fn first_points_are_those_of_faure() {
        // Times 125, worked by hand: 5 has the digits 0, 1, and 25 has 0, 0, 1.
        let expected = [
            (0, [0, 0, 0, 0, 0]),
            (1, [25, 25, 25, 25, 25]),
            (4, [100, 100, 100, 100, 100]),
            (5, [5, 30, 55, 80, 105]),
            (6, [30, 55, 80, 105, 5]),
            (9, [105, 5, 30, 55, 80]),
            (10, [10, 60, 110, 35, 85]),
            (25, [1, 36, 121, 106, 41]),
            (31, [31, 91, 51, 86, 46]),
        ];
        for (index, numerators) in expected {
            let found = std::array::from_fn(|d| MATRICES.numerator(index, d) / 5u64.pow(13));
            assert_eq!(found, numerators, "point {index}");
        }
    }

    #[test]
    fn every_block_is_a_net_without_defect() {
        assert_sequence_of_nets(&MATRICES);
    }

    #[test]
    fn the_discrepancy_is_the_known_one() {
        let unit = |index, d| MATRICES.numerator(index, d) as f64 / 5f64.powi(16);
        assert_l2_star(unit, &[(125, 0.010_897_471_873_903_45), (625, 0.001_995_976_332_298_61)]);
    }
}
