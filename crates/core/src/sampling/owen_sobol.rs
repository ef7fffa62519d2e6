//! Owen-scrambled Sobol' points: the default sequence.
//!
//! Sobol' 1967 with the direction numbers of Joe & Kuo 2008, randomised by a hash-based nested uniform scrambling
//! (Burley, Practical Hash-based Owen Scrambling, JCGT 2020, with Vegdahl's constants for the Laine-Karras hash). Every stream is
//! scrambled independently, so each point is uniform (estimates are unbiased), streams are independent (replicates give
//! standard errors), and the first 2^m points of a stream are a (t,m,4)-net. Cost: one shift and exclusive-or for
//! each set bit of the index and dimension, and one hash for each dimension.

use super::{Sample, Sequence};
use crate::math::hash::derive;

/// Independent scramblings of the same Sobol' sequence, one for each stream.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct OwenSobol {
    seed: u64,
}

impl OwenSobol {
    pub fn new(seed: u64) -> OwenSobol {
        OwenSobol { seed }
    }
}

impl Sequence for OwenSobol {
    fn fill(&self, stream: u64, first: u64, points: &mut [Sample]) {
        let stream_key = derive(self.seed, stream);
        for (index, point) in (first..).zip(points) {
            // Every 2^32 points a new, independent scrambling begins.
            let (block, low) = (index >> 32, index as u32);
            let (a, b) = (derive(stream_key, 2 * block), derive(stream_key, 2 * block + 1));
            let seeds = [a as u32, (a >> 32) as u32, b as u32, (b >> 32) as u32];
            *point = std::array::from_fn(|d| to_unit(scramble(sobol(low, d), seeds[d])));
        }
    }
}

/// Primitive polynomials (degree, coefficients) and initial numbers of dimensions 2 to 4 (Joe & Kuo's new-joe-kuo-6).
const JOE_KUO: [(u32, u32, [u32; 3]); 3] = [(1, 0, [1, 0, 0]), (2, 1, [1, 3, 0]), (3, 1, [1, 3, 1])];

static DIRECTIONS: [[u32; 32]; 4] = direction_numbers();

const fn direction_numbers() -> [[u32; 32]; 4] {
    let mut v = [[0u32; 32]; 4];
    let mut k = 0;
    while k < 32 {
        v[0][k] = 1 << (31 - k);
        k += 1;
    }
    let mut d = 1;
    while d < 4 {
        let (degree, coefficients, initial) = JOE_KUO[d - 1];
        let s = degree as usize;
        let mut k = 0;
        while k < 32 {
            v[d][k] = if k < s {
                initial[k] << (31 - k)
            } else {
                let mut value = v[d][k - s] ^ (v[d][k - s] >> s);
                let mut j = 1;
                while j < s {
                    if (coefficients >> (s - 1 - j)) & 1 == 1 {
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

/// Component `d` of Sobol' point `index`, as a 32-bit fraction.
fn sobol(index: u32, d: usize) -> u32 {
    if d == 0 {
        return index.reverse_bits();
    }
    let (mut bits, mut x) = (index, 0);
    while bits != 0 {
        x ^= DIRECTIONS[d][bits.trailing_zeros() as usize];
        bits &= bits - 1;
    }
    x
}

/// Owen's nested uniform scrambling: each bit is flipped by a hash of the bits above it.
fn scramble(x: u32, seed: u32) -> u32 {
    let mut x = x.reverse_bits();
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

fn to_unit(x: u32) -> f32 {
    (x >> 8) as f32 * (1.0 / (1 << 24) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(stream: u64, first: u64, n: usize) -> Vec<Sample> {
        let mut points = vec![[0.0; 4]; n];
        OwenSobol::new(7).fill(stream, first, &mut points);
        points
    }

    #[test]
    fn unscrambled_points_are_those_of_joe_and_kuo() {
        let fraction = |index, d| f64::from(sobol(index, d)) / 2f64.powi(32);
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
        for (k, point) in expected.iter().enumerate() {
            assert_eq!(std::array::from_fn(|d| fraction(k as u32 + 1, d)), *point, "point {}", k + 1);
        }
    }

    #[test]
    fn every_dimension_is_stratified_at_every_power_of_two() {
        for stream in 0..20 {
            for m in 0..10 {
                let n = 1usize << m;
                for block in 0..3 {
                    for d in 0..4 {
                        let mut seen = vec![false; n];
                        points(stream, (block * n) as u64, n)
                            .iter()
                            .for_each(|p| seen[(p[d] * n as f32) as usize] = true);
                        assert!(seen.iter().all(|&s| s), "stream {stream}, block {block} of {n}, dimension {d}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_first_two_dimensions_are_a_net() {
        // (0, m, 2)-net: every elementary interval of area 2^-m holds exactly one point.
        for m in 1..9u32 {
            let net = points(3, 0, 1 << m);
            for k in 0..=m {
                let mut seen = vec![0; 1 << m];
                for p in &net {
                    let (x, y) = ((p[0] * (1 << k) as f32) as usize, (p[1] * (1 << (m - k)) as f32) as usize);
                    seen[(x << (m - k)) | y] += 1;
                }
                assert!(seen.iter().all(|&c| c == 1), "m = {m}, k = {k}");
            }
        }
    }

    #[test]
    fn any_index_can_be_drawn_first_even_beyond_2_to_the_40() {
        let first = (1 << 40) - 3;
        let all = points(5, first, 8);
        for (k, p) in all.iter().enumerate() {
            assert_eq!(points(5, first + k as u64, 1)[0], *p);
        }
        assert_ne!(points(5, 0, 4), points(5, 1 << 32, 4), "the sequence does not repeat after 2^32 points");
    }

    #[test]
    fn streams_are_uncorrelated() {
        // Covariance of the first coordinates of 4,096 streams with their neighbours': the mean product of two
        // independent centred uniforms has standard deviation 1 / (12 sqrt(n)).
        let n = 4096;
        let x: Vec<f64> = (0..=n).map(|s| f64::from(points(s, 0, 1)[0][0]) - 0.5).collect();
        let covariance = x.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / n as f64;
        assert!(covariance.abs() < 5.0 / (12.0 * (n as f64).sqrt()), "{covariance}");
    }
}
