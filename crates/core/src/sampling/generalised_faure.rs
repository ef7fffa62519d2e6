//! Generalised Faure points in base 5 with a digital shift.
//!
//! Tezuka, Uniform Random Numbers: Theory and Practice, 1995, pages 179-180; Tezuka & Tokuyama, A note on polynomial
//! arithmetic analogue of Halton sequences, ACM TOMACS 4, 1994. The generator matrix of dimension d, from 0, is
//! `(P^T)^d P^d` modulo 5, P the upper triangular Pascal matrix. A non-singular lower triangular factor only mixes the
//! strips of a coordinate among themselves, so every block of 5^m points is a (0, m, 5)-net as with Faure's points, but the
//! points of short blocks no longer lie along the diagonal. Unbiased. Five dimensions of its own.

use super::Entry;
use super::construction::base5::{COLUMNS, DIMENSIONS, Matrices, Matrix, ROWS, Shifted};
use super::faure::PASCAL_POWERS;

pub(super) const ENTRY: Entry = Entry {
    name: "generalised-faure",
    what: "generalised Faure points in base 5, digitally shifted",
    source: "Tezuka 1995",
    make: |seed| Box::new(Shifted { matrices: &MATRICES, seed }),
};

static MATRICES: Matrices = Matrices::new(&matrices());

const fn matrices() -> [Matrix; DIMENSIONS] {
    let mut products = [[[0; COLUMNS]; ROWS]; DIMENSIONS];
    let mut d = 0;
    while d < DIMENSIONS {
        products[d] = transpose_times_itself(&PASCAL_POWERS[d]);
        d += 1;
    }
    products
}

/// The first rows of `U^T U` modulo 5 for an upper triangular matrix U.
const fn transpose_times_itself(upper: &Matrix) -> Matrix {
    let mut product = [[0; COLUMNS]; ROWS];
    let mut j = 0;
    while j < ROWS {
        let mut k = 0;
        while k < COLUMNS {
            let (mut sum, mut i) = (0, 0);
            while i <= j {
                sum += upper[i][j] as u32 * upper[i][k] as u32;
                i += 1;
            }
            product[j][k] = (sum % 5) as u8;
            k += 1;
        }
        j += 1;
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::construction::base5::tests::assert_sequence_of_nets;
    use crate::sampling::construction::quality::assert_l2_star;

    #[test]
    fn first_points_are_those_of_tezuka() {
        // Times 125, worked by hand: the upper left corner of the matrix of dimension d is
        // 1 d d², d 1 + d² 2d + d³, d² 2d + d³ 1 + 4d² + d⁴.
        for d in 0..5u64 {
            let columns =
                [[1, d, d * d], [d, 1 + d * d, 2 * d + d.pow(3)], [d * d, 2 * d + d.pow(3), 1 + 4 * d * d + d.pow(4)]];
            for (index, column) in [1, 5, 25].into_iter().zip(columns) {
                let expected = column.iter().fold(0, |x, digit| 5 * x + digit % 5);
                assert_eq!(
                    MATRICES.numerator(index, d as usize) / 5u64.pow(13),
                    expected,
                    "point {index}, dimension {d}"
                );
            }
        }
    }

    #[test]
    fn every_block_is_a_net_without_defect() {
        assert_sequence_of_nets(&MATRICES);
    }

    #[test]
    fn the_discrepancy_is_the_known_one() {
        let unit = |index, d| MATRICES.numerator(index, d) as f64 / 5f64.powi(16);
        assert_l2_star(unit, &[(125, 0.008_389_004_415_018_05), (625, 0.002_047_308_347_021_90)]);
    }
}
