//! Radical inverses (van der Corput 1935; Halton 1960) and their rotation (Cranley & Patterson 1976).
//!
//! `phi_b(n) = sum_k pi(a_k) b^(-k-1)`, where `a_k` are the digits of n in base b, the lowest first, and pi is a permutation of
//! digits that leaves 0 where it is. A rotation adds a random number modulo 1: unbiased, and the points keep their evenness
//! up to intervals that are cut by the border.

use super::to_unit;

/// The dimensions of a Halton sequence: one prime base each.
pub const PRIMES: [u64; 32] = [
    2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71, 73, 79, 83, 89, 97, 101, 103, 107, 109,
    113, 127, 131,
];

/// The radical inverse of `index` in `base`, in [0, 1] (1 by rounding only), with `permuted` digits.
///
/// Inlined, so that divisions by a constant base become multiplications.
#[inline(always)]
pub fn radical_inverse(index: u64, base: u64, permuted: impl Fn(u64) -> u64) -> f64 {
    let step = 1.0 / base as f64;
    let (mut rest, mut weight, mut sum) = (index, step, 0.0);
    while rest > 0 {
        sum += permuted(rest % base) as f64 * weight;
        weight *= step;
        rest /= base;
    }
    sum
}

/// `x + shift / 2^64` modulo 1, in [0, 1).
pub fn rotate(x: f64, shift: u64) -> f32 {
    let fraction = (x * 2f64.powi(32)) as u32;
    to_unit(fraction.wrapping_add((shift >> 32) as u32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bases_are_the_first_primes() {
        assert!((2..=131).filter(|n| (2..*n).all(|k| n % k != 0)).eq(PRIMES));
    }

    #[test]
    fn digits_are_reflected_at_the_point() {
        // 1234 in base 10 becomes 0.4321, with 9 - digit 0.5678.
        assert!((radical_inverse(1234, 10, |digit| digit) - 0.4321).abs() < 1e-15);
        assert!((radical_inverse(1234, 10, |digit| 9 - digit) - 0.5678).abs() < 1e-15);
        assert_eq!(radical_inverse(0b1011, 2, |digit| digit), 13.0 / 16.0);
    }

    #[test]
    fn rotated_numbers_stay_below_1() {
        assert_eq!(rotate(0.75, 1 << 63), 0.25);
        assert_eq!(rotate(1.0, 0), 1.0 - 2f32.powi(-24));
        assert!(rotate(radical_inverse(u64::MAX, 2, |digit| digit), 0) < 1.0);
    }
}
