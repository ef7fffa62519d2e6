//! Halton's points with a Cranley-Patterson rotation.
//!
//! Halton, On the efficiency of certain quasi-random sequences of points in evaluating multi-dimensional integrals, Numerische
//! Mathematik 2, 1960: coordinate d of point n is the radical inverse of n in the d-th prime base. Rotated independently
//! for each stream and dimension (Cranley & Patterson 1976): unbiased. 32 dimensions of its own; the large bases of the late
//! ones need many points to be even. Cost: one multiplication for each digit of the index in each base.

use super::construction::radical_inverse::{PRIMES, radical_inverse, rotate};
use super::construction::stream_key::StreamKey;
use super::{Entry, Sample, Sequence};

pub(super) const ENTRY: Entry = Entry {
    name: "halton",
    what: "Halton points, rotated",
    source: "Halton 1960",
    make: |seed| Box::new(Halton { seed }),
};

struct Halton {
    seed: u64,
}

impl Sequence for Halton {
    fn fill(&self, stream: u64, first: u64, points: &mut [Sample]) {
        let key = StreamKey::new(self.seed, stream);
        let shifts: [u64; 4] = std::array::from_fn(|d| key.shift(d as u32));
        for (index, point) in (first..).zip(points) {
            let x = [inverse(index, 2), inverse(index, 3), inverse(index, 5), inverse(index, 7)];
            *point = std::array::from_fn(|d| rotate(x[d], shifts[d]));
        }
    }

    fn number(&self, stream: u64, index: u64, dimension: u32) -> f32 {
        let key = StreamKey::new(self.seed, stream);
        let (index, d) = key.padded(index, dimension, PRIMES.len());
        rotate(inverse(index, PRIMES[d]), key.shift(dimension))
    }
}

#[inline(always)]
fn inverse(index: u64, base: u64) -> f64 {
    radical_inverse(index, base, |digit| digit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::construction::quality::{assert_l2_star, l2_star_squared};

    #[test]
    fn first_points_are_those_of_halton() {
        // Points 1 to 8 as fractions over 16, 9, 25, 49 and 11.
        let expected = [
            [8, 3, 5, 7, 1],
            [4, 6, 10, 14, 2],
            [12, 1, 15, 21, 3],
            [2, 4, 20, 28, 4],
            [10, 7, 1, 35, 5],
            [6, 2, 6, 42, 6],
            [14, 5, 11, 1, 7],
            [1, 8, 16, 8, 8],
        ];
        for (index, numerators) in (1..).zip(&expected) {
            for (d, (numerator, denominator)) in numerators.iter().zip([16.0, 9.0, 25.0, 49.0, 11.0]).enumerate() {
                let x = inverse(index, PRIMES[d]);
                assert!((x - f64::from(*numerator) / denominator).abs() < 1e-15, "point {index}, dimension {d}");
            }
        }
    }

    #[test]
    fn boxes_that_fit_the_bases_hold_one_point_of_each_period() {
        // 2^3 * 3^2 * 5 * 7 consecutive points: one in each box of that many along the axes.
        let counts = [8u64, 9, 5, 7];
        let period: u64 = counts.iter().product();
        for first in [0, 12_345, 1 << 40] {
            let mut seen = vec![false; period as usize];
            for index in first..first + period {
                let place = |cell, d: usize| {
                    // A point on a border must not be rounded to below it; 2^-40 is the nearest that others come.
                    cell * counts[d] + ((inverse(index, PRIMES[d]) + 1e-14) * counts[d] as f64) as u64
                };
                seen[(0..4).fold(0, place) as usize] = true;
            }
            assert!(seen.iter().all(|&s| s), "from {first}");
        }
    }

    #[test]
    fn the_discrepancy_of_hammersley_points_is_the_exact_one() {
        // (k / 2^m, radical inverse of k in base 2): n² T² is known in closed form (Halton & Zaremba 1969; White 1975).
        for m in 0..9 {
            let n = 1u64 << m;
            let points: Vec<[f64; 2]> = (0..n).map(|k| [k as f64 / n as f64, inverse(k, 2)]).collect();
            let (k, n) = (f64::from(m), n as f64);
            let exact =
                k * k / 64.0 + 29.0 * k / 192.0 + 3.0 / 8.0 - k / (16.0 * n) + 1.0 / (4.0 * n) - 1.0 / (72.0 * n * n);
            assert!((l2_star_squared(&points) * n * n - exact).abs() < 1e-9, "m = {m}");
        }
    }

    #[test]
    fn the_discrepancy_is_the_known_one() {
        let known = [(64, 0.023_588_354_415_097_26), (256, 0.007_416_063_727_727_15), (1024, 0.001_926_249_899_860_74)];
        assert_l2_star(|index, d| inverse(index, PRIMES[d]), &known);
    }
}
