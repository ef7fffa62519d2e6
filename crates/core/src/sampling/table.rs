//! The table of all sequences, and how settings name one of them.

use super::{Sequence, faure, generalised_faure, halton, niederreiter, owen_sobol, random, scrambled_halton, sobol};
use crate::choice::{Choice, TableEntry};

/// A sequence that can be asked for by name.
#[derive(Debug)]
pub struct Entry {
    pub name: &'static str,
    /// A few words for people.
    pub what: &'static str,
    /// Where it was published.
    pub source: &'static str,
    /// The sequence randomised by a seed.
    pub make: fn(seed: u64) -> Box<dyn Sequence>,
}

/// All sequences; the first is the default.
pub const SEQUENCES: &[Entry] = &[
    owen_sobol::ENTRY,
    sobol::ENTRY,
    niederreiter::ENTRY,
    faure::ENTRY,
    generalised_faure::ENTRY,
    halton::ENTRY,
    scrambled_halton::ENTRY,
    random::ENTRY,
];

impl TableEntry for Entry {
    const KIND: &'static str = "sample sequence";
    const TABLE: &'static [Entry] = SEQUENCES;

    fn name(&self) -> &'static str {
        self.name
    }
}

/// A choice from [`SEQUENCES`].
pub type SequenceName = Choice<Entry>;

impl SequenceName {
    pub const OWEN_SOBOL: SequenceName = Choice(&owen_sobol::ENTRY);
    pub const HALTON: SequenceName = Choice(&halton::ENTRY);
    pub const RANDOM: SequenceName = Choice(&random::ENTRY);

    /// The sequence randomised by `seed`.
    pub fn make(self, seed: u64) -> Box<dyn Sequence> {
        (self.0.make)(seed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choice::tests::{assert_every_file_is_in_the_table, assert_named};
    use crate::sampling::Sample;
    use crate::sampling::construction::quality::is_net;

    fn points(entry: &Entry, seed: u64, stream: u64, first: u64, n: usize) -> Vec<Sample> {
        let mut points = vec![[f32::NAN; 4]; n];
        (entry.make)(seed).fill(stream, first, &mut points);
        points
    }

    #[test]
    fn every_file_is_in_the_table_and_has_its_name() {
        assert_every_file_is_in_the_table::<Entry>("sampling", &["mod", "table", "address"]);
        assert_named::<Entry>();
        assert_eq!(SequenceName::default(), SequenceName::OWEN_SOBOL);
    }

    #[test]
    fn any_point_can_be_drawn_first_and_any_number_alone() {
        for entry in SEQUENCES {
            let sequence = (entry.make)(7);
            for first in [0, 61, 3120, (1 << 32) - 3, (1 << 40) - 3, 5u64.pow(17) - 4, (1 << 62) - 5] {
                let block = points(entry, 7, 5, first, 9);
                for (index, point) in (first..).zip(&block) {
                    assert_eq!(points(entry, 7, 5, index, 1)[0], *point, "{} {index}", entry.name);
                    let numbers = std::array::from_fn(|d| sequence.number(5, index, d as u32));
                    assert_eq!(numbers, *point, "{} {index}", entry.name);
                }
            }
        }
    }

    #[test]
    fn numbers_of_any_dimension_are_at_least_0_and_below_1() {
        for entry in SEQUENCES {
            let sequence = (entry.make)(3);
            for dimension in (0..40).chain([100, 1000, u32::MAX]) {
                for index in (0..200).chain(u64::MAX - 3..=u64::MAX) {
                    let x = sequence.number(index % 3, index, dimension);
                    assert!((0.0..1.0).contains(&x), "{} {index} {dimension}: {x}", entry.name);
                }
            }
        }
    }

    #[test]
    fn streams_seeds_and_late_points_differ() {
        for entry in SEQUENCES {
            let all = [
                points(entry, 1, 0, 0, 8),
                points(entry, 2, 0, 0, 8),
                points(entry, 1, 1, 0, 8),
                points(entry, 1, 0, 1 << 32, 8),
                points(entry, 1, 0, 1 << 40, 8),
            ];
            for (k, a) in all.iter().enumerate() {
                assert!(all[..k].iter().all(|b| a != b), "{}: block {k}", entry.name);
            }
        }
    }

    #[test]
    fn randomised_blocks_remain_nets() {
        // (base, t in four dimensions, m) of the digital sequences.
        for (name, base, t, m) in [
            ("owen-sobol", 2u32, 3, 8),
            ("sobol", 2, 3, 8),
            ("niederreiter", 2, 3, 8),
            ("faure", 5, 0, 4),
            ("generalised-faure", 5, 0, 4),
        ] {
            let n = base.pow(m) as usize;
            for (seed, block) in [(1, 0), (2, 7), (3, 1 << 30)] {
                let net = points(name.parse::<SequenceName>().unwrap().entry(), seed, 4, (block * n) as u64, n);
                let leading =
                    |index: u64, d: usize, k| (f64::from(net[index as usize][d]) * f64::from(base.pow(k))) as u64;
                assert!(is_net(u64::from(base), t, m, 4, leading), "{name}, block {block}");
            }
        }
    }

    #[test]
    fn dimensions_of_copies_are_as_even_as_the_first() {
        // One number in each of 64 intervals, in every aligned block of 64 points.
        for name in ["owen-sobol", "sobol"] {
            let sequence = name.parse::<SequenceName>().unwrap().make(5);
            for (dimension, block) in
                [4, 9, 31, 32, 40, 1000].into_iter().flat_map(|d| [(d, 0u64), (d, 9), (d, 1 << 30)])
            {
                let place = |index: u64| (64.0 * sequence.number(8, 64 * block + index, dimension)) as u64;
                let mut places: Vec<u64> = (0..64).map(place).collect();
                places.sort_unstable();
                assert!(places.into_iter().eq(0..64), "{name}, dimension {dimension}, block {block}");
            }
        }
    }

    #[test]
    fn two_dimensions_of_a_point_are_never_the_same_up_to_a_shift() {
        // A padded dimension that used the points of its copy in their own order would differ by a constant from them.
        for entry in SEQUENCES {
            let sequence = (entry.make)(9);
            for (a, b) in [(0, 5), (1, 6), (0, 32), (3, 35), (4, 9), (4, 36), (0, 31)] {
                let differences = |index| {
                    let [x, y] = [a, b].map(|d| f64::from(sequence.number(2, index, d)));
                    (x - y).rem_euclid(1.0)
                };
                let mut found: Vec<f64> = (0..25).map(differences).collect();
                found.sort_by(f64::total_cmp);
                found.dedup_by(|x, y| (*x - *y).abs() < 1e-6);
                assert!(found.len() > 4, "{}: dimensions {a} and {b}: {found:?}", entry.name);
            }
        }
    }
}
