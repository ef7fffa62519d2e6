//! The table of all sequences, and how settings name one of them.

use super::{Sequence, faure, generalised_faure, halton, niederreiter, owen_sobol, random, scrambled_halton, sobol};
use crate::Error;
use std::fmt;
use std::str::FromStr;

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

/// A choice from [`SEQUENCES`]. It is written, parsed and stored as the name.
#[derive(Clone, Copy, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct SequenceName(&'static Entry);

impl SequenceName {
    pub const OWEN_SOBOL: SequenceName = SequenceName(&owen_sobol::ENTRY);
    pub const HALTON: SequenceName = SequenceName(&halton::ENTRY);
    pub const RANDOM: SequenceName = SequenceName(&random::ENTRY);

    /// All choices, in the order of the table.
    pub fn all() -> impl Iterator<Item = SequenceName> {
        SEQUENCES.iter().map(SequenceName)
    }

    /// The line of the table.
    pub fn entry(self) -> &'static Entry {
        self.0
    }

    /// The sequence randomised by `seed`.
    pub fn make(self, seed: u64) -> Box<dyn Sequence> {
        (self.0.make)(seed)
    }
}

impl Default for SequenceName {
    fn default() -> SequenceName {
        SequenceName(&SEQUENCES[0])
    }
}

impl FromStr for SequenceName {
    type Err = Error;

    /// # Errors
    /// [`Error::UnknownName`] with the nearest name of the table.
    fn from_str(name: &str) -> Result<SequenceName, Error> {
        let found = SequenceName::all().find(|choice| choice.0.name == name);
        found.ok_or_else(|| Error::unknown_name("sample sequence", name, SEQUENCES.iter().map(|entry| entry.name)))
    }
}

impl TryFrom<String> for SequenceName {
    type Error = Error;

    fn try_from(name: String) -> Result<SequenceName, Error> {
        name.parse()
    }
}

impl From<SequenceName> for String {
    fn from(choice: SequenceName) -> String {
        choice.0.name.to_owned()
    }
}

impl fmt::Display for SequenceName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.0.name)
    }
}

impl fmt::Debug for SequenceName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0.name)
    }
}

impl PartialEq for SequenceName {
    fn eq(&self, other: &SequenceName) -> bool {
        self.0.name == other.0.name
    }
}

impl Eq for SequenceName {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::Sample;
    use crate::sampling::construction::quality::is_net;
    use serde::Deserialize;
    use serde::de::IntoDeserializer;
    use std::path::Path;

    fn points(entry: &Entry, seed: u64, stream: u64, first: u64, n: usize) -> Vec<Sample> {
        let mut points = vec![[f32::NAN; 4]; n];
        (entry.make)(seed).fill(stream, first, &mut points);
        points
    }

    #[test]
    fn every_file_is_in_the_table() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/sampling");
        let files = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap());
        let mut members: Vec<String> = files
            .filter_map(|file| file.strip_suffix(".rs").map(|stem| stem.replace('_', "-")))
            .filter(|stem| !["mod", "table", "address"].contains(&stem.as_str()))
            .collect();
        let mut names: Vec<&str> = SEQUENCES.iter().map(|entry| entry.name).collect();
        members.sort_unstable();
        names.sort_unstable();
        assert_eq!(members, names);
    }

    #[test]
    fn names_are_parsed_stored_and_helped_with() {
        let stored = |name: &'static str| {
            SequenceName::deserialize(IntoDeserializer::<serde::de::value::Error>::into_deserializer(name))
        };
        for choice in SequenceName::all() {
            let name = choice.entry().name;
            assert_eq!((name.parse(), stored(name), String::from(choice)), (Ok(choice), Ok(choice), name.to_owned()));
        }
        assert_eq!(SequenceName::default().to_string(), "owen-sobol");
        let error = "fauer".parse::<SequenceName>().unwrap_err().to_string();
        assert!(error.contains("'fauer'; did you mean 'faure'?"), "{error}");
        assert!(stored("halt").unwrap_err().to_string().contains("did you mean 'halton'?"));
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
