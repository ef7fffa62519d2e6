//! Halton's points with permuted digits and a Cranley-Patterson rotation.
//!
//! The permutations are those of Faure, Good permutations for extreme discrepancy, J. Number Theory 42, 1992, made from the
//! identity in base 2: for an even base b, `pi_b` is twice `pi_(b/2)`, followed by the same plus one; for an odd base
//! `b = 2c + 1` it is `pi_(b-1)` with c put into the middle and one added to what was c or more. In bases 2 and 3 it is the
//! identity. They break up the diagonals of points that large bases have in common. Rotated independently for each
//! stream and dimension: unbiased. 32 dimensions of its own. Cost: as Halton's points, and one table access a digit.

use super::construction::radical_inverse::{PRIMES, radical_inverse, rotate};
use super::construction::stream_key::StreamKey;
use super::{Entry, Sample, Sequence};

pub(super) const ENTRY: Entry = Entry {
    name: "scrambled-halton",
    what: "Halton points with permuted digits, rotated",
    source: "Faure 1992",
    make: |seed| Box::new(ScrambledHalton { seed }),
};

struct ScrambledHalton {
    seed: u64,
}

impl Sequence for ScrambledHalton {
    fn fill(&self, stream: u64, first: u64, points: &mut [Sample]) {
        let key = StreamKey::new(self.seed, stream);
        let shifts: [u64; 4] = std::array::from_fn(|d| key.shift(d as u32));
        for (index, point) in (first..).zip(points) {
            let x = [inverse(index, 2, 0), inverse(index, 3, 1), inverse(index, 5, 2), inverse(index, 7, 3)];
            *point = std::array::from_fn(|d| rotate(x[d], shifts[d]));
        }
    }

    fn number(&self, stream: u64, index: u64, dimension: u32) -> f32 {
        let key = StreamKey::new(self.seed, stream);
        let (index, d) = key.padded(index, dimension, PRIMES.len());
        rotate(inverse(index, PRIMES[d], d), key.shift(dimension))
    }
}

/// The radical inverse of `index` in `base`, the one of dimension `d`.
#[inline(always)]
fn inverse(index: u64, base: u64, d: usize) -> f64 {
    radical_inverse(index, base, |digit| u64::from(PERMUTATIONS[d][digit as usize]))
}

/// Row d permutes the digits of the d-th prime base.
static PERMUTATIONS: [[u8; 131]; 32] = permutations();

const fn permutations() -> [[u8; 131]; 32] {
    let mut table = [[0; 131]; 32];
    let mut d = 0;
    while d < 32 {
        let mut digit = 0;
        while digit < PRIMES[d] {
            table[d][digit as usize] = permuted(PRIMES[d], digit) as u8;
            digit += 1;
        }
        d += 1;
    }
    table
}

/// Faure's permutation of the digits of `base`, at `digit`.
const fn permuted(base: u64, digit: u64) -> u64 {
    if base < 3 {
        return digit;
    }
    let half = base / 2;
    if base.is_multiple_of(2) {
        return if digit < half { 2 * permuted(half, digit) } else { 2 * permuted(half, digit - half) + 1 };
    }
    if digit == half {
        return half;
    }
    let image = permuted(base - 1, if digit < half { digit } else { digit - 1 });
    if image < half { image } else { image + 1 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::construction::quality::assert_l2_star;

    #[test]
    fn permutations_are_those_of_faure() {
        for (d, expected) in [
            (0, &[0, 1][..]),
            (1, &[0, 1, 2]),
            (2, &[0, 3, 2, 1, 4]),
            (3, &[0, 2, 5, 3, 1, 4, 6]),
            (4, &[0, 7, 4, 2, 9, 5, 1, 8, 6, 3, 10]),
        ] {
            assert_eq!(PERMUTATIONS[d][..expected.len()], *expected);
        }
        for (base, row) in PRIMES.iter().zip(&PERMUTATIONS) {
            let mut digits = row[..*base as usize].to_vec();
            assert_eq!(digits[0], 0);
            digits.sort_unstable();
            assert!(digits.iter().enumerate().all(|(k, &digit)| k == usize::from(digit)), "base {base}");
        }
    }

    #[test]
    fn first_points_have_permuted_digits() {
        // 8 is 13 in base 5, so 0.31 before and 0.13 after; 11 in base 7, so the digits 1, 1 become 2, 2.
        assert!((inverse(8, 5, 2) - (1.0 / 5.0 + 3.0 / 25.0)).abs() < 1e-15);
        assert!((inverse(8, 7, 3) - (2.0 / 7.0 + 2.0 / 49.0)).abs() < 1e-15);
    }

    #[test]
    fn the_discrepancy_is_the_known_one() {
        let known = [(64, 0.020_920_620_933_319_18), (256, 0.006_965_377_758_368_08), (1024, 0.001_782_851_207_909_73)];
        assert_l2_star(|index, d| inverse(index, PRIMES[d], d), &known);
    }

    #[test]
    fn large_bases_are_not_correlated_at_the_start() {
        // The first 29 points of bases 29 and 31 are on the diagonal without permutations: correlation 1.
        let correlation = |x: &dyn Fn(u64, usize) -> f64| {
            let pairs: Vec<[f64; 2]> = (0..29).map(|index| [x(index, 9) - 0.5, x(index, 10) - 0.5]).collect();
            let sum = |f: fn(&[f64; 2]) -> f64| pairs.iter().map(f).sum::<f64>();
            sum(|p| p[0] * p[1]) / (sum(|p| p[0] * p[0]) * sum(|p| p[1] * p[1])).sqrt()
        };
        assert!(correlation(&|index, d| radical_inverse(index, PRIMES[d], |digit| digit)) > 0.99);
        assert!(correlation(&|index, d| inverse(index, PRIMES[d], d)).abs() < 0.5);
    }
}
