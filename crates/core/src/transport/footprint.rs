//! Where on an element its light lies, and so from where it leaves.
//!
//! An element has one radiosity. Where it reaches under a wall or behind a frame, only a part of it is lit; were light to leave
//! from all of it, some would leave on the wrong side: the classic leak of radiosity. So each element counts, in 64 bits, how many
//! rays have landed on each of its nine cells. Light leaves from the cells in proportion, and in proportion they are bright to a
//! line that meets the element.
//!
//! This is the continuous walk (Pattanaik & Mudur 1992: the next line starts where the last one ended) to within a cell, with
//! the memory of the discrete one. Leaks shrink as if elements were three times shorter.

use crate::math::hash::mix;
use crate::math::warp::square_to_triangle;
use crate::mesh::cells;
use glam::Vec2;

/// Divisions of an element's edges.
const DIVISIONS: u16 = 3;
const CELLS: u32 = 9;
/// Bits of a cell's count; the bits above all counts say how often the counts have been halved.
const BITS: u32 = 6;
const LARGEST: u64 = (1 << BITS) - 1;
const HALVING: u64 = 1 << (CELLS * BITS);

/// From where light leaves an element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Leaving {
    /// From the cells on which light has landed, in proportion.
    #[default]
    WhereLanded,
    /// From anywhere on it: the radiosity system with constant elements, to the letter.
    WholeElement,
}

impl Leaving {
    pub const ALL: [Leaving; 2] = [Leaving::WhereLanded, Leaving::WholeElement];

    pub fn name(self) -> &'static str {
        match self {
            Leaving::WhereLanded => "where-landed",
            Leaving::WholeElement => "whole-element",
        }
    }
}

/// How light is spread over the nine cells of an element: counts of landings, halved together when one grows too large.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Footprint(u64);

impl Footprint {
    /// Nothing has landed yet; counts as the whole.
    pub const EMPTY: Footprint = Footprint(0);
    /// Spread evenly over the element.
    pub const WHOLE: Footprint = Footprint(HALVING / LARGEST);

    /// The cell at barycentric coordinates `uv` of the element.
    pub fn cell_at(uv: Vec2) -> u8 {
        cells::at(uv, DIVISIONS) as u8
    }

    /// Adds a landing on `cell`. `noise` is any random number: counts that have been halved h times grow with every
    /// 2^h-th landing, on average.
    pub fn add(&mut self, cell: u8, noise: u64) {
        if noise & ((1u64 << self.halvings().min(63)) - 1) != 0 {
            return;
        }
        if self.count(u32::from(cell)) == LARGEST {
            self.halve(noise.rotate_left(32));
        }
        self.0 += 1 << (BITS * u32::from(cell));
    }

    /// Adds the landings of `other`. `noise` is any random number.
    pub fn join(&mut self, mut other: Footprint, mut noise: u64) {
        let too_many = |a: &Footprint, b: &Footprint| (0..CELLS).any(|cell| a.count(cell) + b.count(cell) > LARGEST);
        if self.0 == 0 || other.0 == 0 {
            self.0 |= other.0;
            return;
        }
        while self.halvings() != other.halvings() || too_many(self, &other) {
            noise = mix(noise.wrapping_add(1));
            let (mine, its) = (self.halvings(), other.halvings());
            if mine <= its {
                self.halve(noise);
            }
            if its <= mine {
                other.halve(noise.rotate_left(32));
            }
        }
        self.0 += other.0 & (HALVING - 1);
    }

    /// How much brighter than the mean of the element `cell` is.
    pub fn density(self, cell: u8) -> f32 {
        let total = self.total();
        if total == 0 { 1.0 } else { (u64::from(CELLS) * self.count(u32::from(cell))) as f32 / total as f32 }
    }

    /// Mean square of the density over the element: 1 if light is spread evenly.
    pub fn mean_square(self) -> f64 {
        let square = |cell| f64::from(self.density(cell)).powi(2);
        (0..CELLS as u8).map(square).sum::<f64>() / f64::from(CELLS)
    }

    /// Barycentric coordinates on the element of the point that belongs to `s` in the unit square, with the density of
    /// the light; strata of `s` stay strata.
    pub fn point(self, s: Vec2) -> Vec2 {
        let total = self.total();
        if total == 0 || self == Footprint::WHOLE {
            return square_to_triangle(s);
        }
        let mut left = s.x * total as f32;
        let mut last = (0, 0.0);
        for (cell, count) in (0..CELLS).map(|cell| (cell, self.count(cell) as f32)).filter(|&(_, count)| count > 0.0) {
            last = (cell, (left / count).min(1.0));
            if left < count {
                break;
            }
            left -= count;
        }
        let [a, b, c] = cells::corners(last.0, DIVISIONS);
        let uv = square_to_triangle(Vec2::new(last.1, s.y));
        a + uv.x * (b - a) + uv.y * (c - a)
    }

    fn count(self, cell: u32) -> u64 {
        self.0 >> (BITS * cell) & LARGEST
    }

    fn total(self) -> u64 {
        (0..CELLS).map(|cell| self.count(cell)).sum()
    }

    fn halvings(self) -> u64 {
        self.0 / HALVING
    }

    /// Halves all counts; odd ones are rounded up or down by the bits of `noise`.
    fn halve(&mut self, noise: u64) {
        let halved = |cell: u32| ((self.count(cell) + (noise >> cell & 1)) / 2) << (BITS * cell);
        self.0 = (0..CELLS).map(halved).sum::<u64>() + (self.halvings() + 1).min(60) * HALVING;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Landings on two cells, nine in ten on the first.
    fn lopsided(landings: u64, seed: u64) -> Footprint {
        let mut footprint = Footprint::EMPTY;
        for k in 0..landings {
            footprint.add(if k % 10 == 9 { 7 } else { 2 }, mix(seed + k));
        }
        footprint
    }

    #[test]
    fn points_have_the_density_of_the_landings() {
        let footprint = lopsided(50, 1);
        let mut counts = [0; 9];
        for k in 0..100 * 100 {
            let s = Vec2::new((k % 100) as f32 + 0.5, (k / 100) as f32 + 0.5) / 100.0;
            counts[usize::from(Footprint::cell_at(footprint.point(s)))] += 1;
        }
        assert_eq!((counts[2], counts[7]), (9000, 1000), "{counts:?}");
        assert!((footprint.density(2) - 8.1).abs() < 1e-6 && footprint.density(0) == 0.0);
    }

    #[test]
    fn many_landings_and_joined_ones_keep_their_proportions() {
        let mean_share =
            |make: &dyn Fn(u64) -> Footprint| (0..400).map(|s| make(s << 40).density(7)).sum::<f32>() / 400.0 / 9.0;
        let many = mean_share(&|seed| lopsided(5000, seed));
        assert!((many - 0.1).abs() < 0.01, "{many}");
        // 5,000 landings of which a tenth are on cell 7, and 50 that are all on it.
        let joined = mean_share(&|seed| {
            let mut footprint = lopsided(5000, seed);
            let mut few = Footprint::EMPTY;
            (0..50).for_each(|k| few.add(7, mix(seed + 9000 + k)));
            footprint.join(few, mix(seed));
            footprint
        });
        assert!((joined - 550.0 / 5050.0).abs() < 0.01, "{joined}");
    }

    #[test]
    fn the_whole_is_even() {
        assert!((0..9).all(|cell| Footprint::WHOLE.density(cell) == 1.0 && Footprint::EMPTY.density(cell) == 1.0));
        assert_eq!(Footprint::WHOLE.mean_square(), 1.0);
    }
}
