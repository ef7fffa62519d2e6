//! How many elements there are if none is to be wrong by more than a given error.

use super::forest::Forest;
use super::merge::Merges;
use crate::Problem;
use crate::mesh::Resolution;

/// Elements for every error.
pub struct Counts {
    /// One for each side of a triangle.
    roots: u64,
    /// Errors [lux² m²] of what is bisected in ascending order, and how many elements all bisections from it on add.
    bisections: Vec<(f32, u64)>,
    /// Errors [lux² m²] of what is put together in ascending order, and how many elements are saved up to it.
    merges: Vec<(f32, u64)>,
}

impl Counts {
    pub fn of(problem: &Problem, merges: &Merges, forest: &Forest) -> Counts {
        let mut bisections = forest.errors(problem);
        bisections.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        bisections.iter_mut().rev().fold(0, |sum, (_, sides)| {
            *sides += sum;
            *sides
        });
        let mut merges: Vec<(f32, u64)> = merges.errors().collect();
        merges.iter_mut().fold(0, |sum, (_, sides)| {
            *sides += sum;
            *sides
        });
        Counts { roots: Resolution::least(&problem.scene), bisections, merges }
    }

    /// Elements if those above `error` [lux² m²] are bisected, and those up to it put together.
    fn at(&self, error: f32) -> u64 {
        let above = self.bisections.partition_point(|bisection| bisection.0 <= error);
        let more = self.bisections.get(above).map_or(0, |bisection| bisection.1);
        let fitting = self.merges.partition_point(|merge| merge.0 <= error);
        let fewer = fitting.checked_sub(1).map_or(0, |last| self.merges[last].1);
        self.roots + more - fewer
    }

    /// The least error [lux² m²] with at most `elements`, or the largest there is.
    pub fn error_of(&self, elements: u64) -> f32 {
        // The bits of numbers that are not negative are in the order of their values.
        let (mut few, mut many) = (f32::MAX.to_bits(), 0);
        while few - many > 1 {
            let middle = many + (few - many) / 2;
            *if self.at(f32::from_bits(middle)) <= elements { &mut few } else { &mut many } = middle;
        }
        f32::from_bits(few)
    }
}
