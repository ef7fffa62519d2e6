//! Owen-scrambled Sobol' points: the default sequence.
//!
//! Sobol' 1967 with the direction numbers of Joe & Kuo 2008, randomised by a hash-based nested uniform scrambling
//! (Burley, Practical Hash-based Owen Scrambling, JCGT 2020, with Vegdahl's constants for the Laine-Karras hash). Every stream is
//! scrambled independently, so each point is uniform (estimates are unbiased), streams are independent (replicates give
//! standard errors), and the first 2^m points of a stream are a (t,m,4)-net. Cost: one shift and exclusive-or for
//! each set bit of the index and dimension, and one hash for each dimension. 32 dimensions of its own.

use super::construction::base2::DIMENSIONS;
use super::construction::scramble::{scramble, scramble_reversed};
use super::construction::stream_key::StreamKey;
use super::construction::to_unit;
use super::sobol::MATRICES;
use super::{Entry, Sample, Sequence};
use crate::math::hash::derive;

pub(super) const ENTRY: Entry = Entry {
    name: "owen-sobol",
    what: "Sobol' points with Owen's nested uniform scrambling",
    source: "Burley 2020",
    make: |seed| Box::new(OwenSobol::new(seed)),
};

/// What changes in the first four coordinates, their bits in reverse, from a point to the next, by the trailing ones of its index;
/// 32 of them end a block.
static REVERSED_CARRIES: [[u32; 4]; 33] = MATRICES.reversed_carries();

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
        // Every 2^32 points a new, independent scrambling begins.
        let mut block = first >> 32;
        let mut seeds = seeds_of(stream_key, block);
        let mut reversed: [u32; 4] = std::array::from_fn(|d| sobol(first as u32, d).reverse_bits());
        for (index, point) in (first..).zip(points) {
            if index >> 32 != block {
                block = index >> 32;
                seeds = seeds_of(stream_key, block);
            }
            *point = std::array::from_fn(|d| to_unit(scramble_reversed(reversed[d], seeds[d])));
            let carry = &REVERSED_CARRIES[(index as u32).trailing_ones() as usize];
            (0..4).for_each(|d| reversed[d] ^= carry[d]);
        }
    }

    fn number(&self, stream: u64, index: u64, dimension: u32) -> f32 {
        let stream_key = derive(self.seed, stream);
        let (index, d) = StreamKey::new(self.seed, stream).padded(index, dimension, DIMENSIONS);
        let seed = match seeds_of(stream_key, index >> 32).get(dimension as usize) {
            Some(&seed) => seed,
            None => derive(derive(stream_key, 2 * (index >> 32)), u64::from(dimension)) as u32,
        };
        to_unit(scramble(sobol(index as u32, d), seed))
    }
}

/// Seeds of the first four dimensions in a block of 2^32 points.
fn seeds_of(stream_key: u64, block: u64) -> [u32; 4] {
    let (a, b) = (derive(stream_key, 2 * block), derive(stream_key, 2 * block + 1));
    [a as u32, (a >> 32) as u32, b as u32, (b >> 32) as u32]
}

/// Component `d` of Sobol' point `index`, as a 32-bit fraction.
fn sobol(index: u32, d: usize) -> u32 {
    if d == 0 { index.reverse_bits() } else { MATRICES.fraction(u64::from(index), d) }
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
    fn points_are_those_that_published_results_were_made_with() {
        let published =
            [[12_798_262, 12_932_646, 11_866_319, 10_689_849], [10_539_833, 13_750_925, 15_735_163, 12_776_166]];
        let found = points(3, (1 << 32) - 1, 2);
        assert_eq!(found, published.map(|point: [u32; 4]| point.map(|x| x as f32 / (1 << 24) as f32)));
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
