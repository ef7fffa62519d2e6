//! Where on an element its light lies, and so from where it leaves.
//!
//! An element has one radiosity. Where it reaches under a wall or behind a frame, only a part of it is lit; were light to leave
//! from all of it, some would leave on the wrong side: the classic leak of radiosity. So each element counts how many rays have
//! landed on each of its nine cells, and remembers of each cell the spot of one landing, each as likely as the others. Light
//! leaves from the cells in proportion, and from the remembered spots; in proportion the cells are bright to a line that meets
//! them.
//!
//! This is the continuous walk (Pattanaik & Mudur 1992: the next line starts where the last one ended) with the memory of the
//! discrete one. A spot is a 121st of a cell, so leaks shrink as if elements were 33 times shorter. Nine points are few for
//! many lines: where more than two leave from each, as close to a lamp, they leave from anywhere on the cell, and a solver had
//! better make more steps than longer ones.

use crate::math::hash::mix;
use crate::math::warp::square_to_triangle;
use crate::mesh::cells;
use glam::Vec2;

/// Divisions of an element's edges into cells, and of a cell's edges into spots.
const DIVISIONS: [u16; 2] = [3, 11];
const CELLS: u32 = 9;
/// Bits of a cell's count; the bits above all counts say how often the counts have been halved.
const COUNT_BITS: u32 = 6;
const LARGEST: u64 = (1 << COUNT_BITS) - 1;
const HALVING: u64 = 1 << (CELLS * COUNT_BITS);
/// Bits of the number of a spot.
const SPOT_BITS: u32 = 7;
const SPOT_MASK: u64 = (1 << SPOT_BITS) - 1;
/// In place of a spot: anywhere on the cell.
const ANYWHERE: u64 = SPOT_MASK;
/// Most lines that a spot stands for.
const LINES_OF_SPOT: u32 = 2;

/// The even and the odd ones of the cells' counts, which then have twice the room.
const EVEN: u64 = LARGEST * (1 | 1 << 12 | 1 << 24 | 1 << 36 | 1 << 48);
const ODD: u64 = LARGEST * (1 | 1 << 12 | 1 << 24 | 1 << 36);

/// From where light leaves an element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Leaving {
    /// From where light has landed.
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

/// A small part of an element: one of 121 in one of its nine cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Spot(u16);

impl Spot {
    /// At barycentric coordinates `uv` of the element.
    #[inline]
    pub fn at(uv: Vec2) -> Spot {
        let (cell, within) = cells::locate(uv, DIVISIONS[0]);
        Spot((cell << SPOT_BITS | cells::at(within, DIVISIONS[1])) as u16)
    }

    fn cell(self) -> u32 {
        u32::from(self.0) >> SPOT_BITS
    }

    fn on_cell(self) -> u64 {
        u64::from(self.0) & SPOT_MASK
    }
}

/// How light is spread over an element: counts of landings on its cells, halved together when one grows too large, and a
/// landing on each of them; 16 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Footprint {
    counts: u64,
    spots: u64,
}

impl Footprint {
    /// Nothing has landed, or nobody counted: light lies evenly on the whole element.
    pub const WHOLE: Footprint = Footprint { counts: 0, spots: 0 };

    /// Adds a landing. `noise` is any random number: counts that have been halved h times grow with every 2^h-th landing, on
    /// average.
    pub fn add(&mut self, spot: Spot, noise: u64) {
        if noise & ((1u64 << self.halvings().min(63)) - 1) != 0 {
            return;
        }
        if self.count(spot.cell()) == LARGEST {
            self.halve(noise.rotate_left(32));
        }
        self.counts += 1 << (COUNT_BITS * spot.cell());
        // As a mask: nobody could guess a branch.
        let is_remembered = u64::from(below(self.count(spot.cell()), mix(noise)) == 0);
        let shift = SPOT_BITS * spot.cell();
        let mask = (is_remembered * SPOT_MASK) << shift;
        self.spots = self.spots & !mask | spot.on_cell() << shift & mask;
    }

    /// Adds the landings of `other`. `noise` is any random number.
    pub fn join(&mut self, mut other: Footprint, mut noise: u64) {
        if self.counts == 0 || other.counts == 0 {
            self.counts |= other.counts;
            self.spots |= other.spots;
            return;
        }
        let too_many = |a: &Footprint, b: &Footprint| (0..CELLS).any(|cell| a.count(cell) + b.count(cell) > LARGEST);
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
        for cell in (0..CELLS).filter(|&cell| other.count(cell) > 0) {
            noise = mix(noise.wrapping_add(1));
            if below(self.count(cell) + other.count(cell), noise) < other.count(cell) {
                self.remember(cell, other.remembered(cell));
            }
        }
        self.counts += other.counts & (HALVING - 1);
    }

    /// The same for so many `lines` that leave together: if they are too many for the spots, from anywhere on the cells.
    pub fn for_lines(mut self, lines: u32) -> Footprint {
        let lit = || (0..CELLS).filter(|&cell| self.count(cell) > 0).count() as u32;
        if lines > LINES_OF_SPOT && lines > LINES_OF_SPOT * lit() {
            self.spots = u64::MAX;
        }
        self
    }

    /// How much brighter than the mean of the element the cell of `spot` is.
    pub fn density(self, spot: Spot) -> f32 {
        self.density_of_cell(spot.cell())
    }

    /// Mean square of the density over the element: 1 if light is spread evenly.
    pub fn mean_square(self) -> f64 {
        (0..CELLS).map(|cell| f64::from(self.density_of_cell(cell)).powi(2)).sum::<f64>() / f64::from(CELLS)
    }

    /// Barycentric coordinates on the element of the point that belongs to `s` in the unit square, with the density of
    /// the light.
    pub fn point(self, s: Vec2) -> Vec2 {
        let total = self.total();
        if total == 0 {
            return square_to_triangle(s);
        }
        let wanted = s.x * total as f32;
        let landing = (wanted as u64).min(total - 1);
        // The cell of that landing is the first up to which there are more. No branch, for nobody could guess it.
        let (mut cell, mut before, mut up_to) = (0, 0, 0);
        for k in 0..CELLS {
            up_to += self.count(k);
            let is_passed = up_to <= landing;
            cell += u32::from(is_passed);
            before = if is_passed { up_to } else { before };
        }
        let rest = ((wanted - before as f32) / self.count(cell) as f32).min(1.0);
        let anywhere = square_to_triangle(Vec2::new(rest, s.y));
        let on_cell = match self.remembered(cell) {
            ANYWHERE => anywhere,
            spot => inside(cells::frame(spot as u32, DIVISIONS[1]), anywhere),
        };
        inside(cells::frame(cell, DIVISIONS[0]), on_cell)
    }

    fn density_of_cell(self, cell: u32) -> f32 {
        let total = self.total();
        if total == 0 { 1.0 } else { (u64::from(CELLS) * self.count(cell)) as f32 / total as f32 }
    }

    fn count(self, cell: u32) -> u64 {
        self.counts >> (COUNT_BITS * cell) & LARGEST
    }

    fn total(self) -> u64 {
        let pairs = (self.counts & EVEN) + (self.counts >> COUNT_BITS & ODD);
        // The product's digit of 12 bits at 48 is the sum of all five.
        pairs.wrapping_mul(1 | 1 << 12 | 1 << 24 | 1 << 36 | 1 << 48) >> 48 & 0xfff
    }

    fn remembered(self, cell: u32) -> u64 {
        self.spots >> (SPOT_BITS * cell) & SPOT_MASK
    }

    fn remember(&mut self, cell: u32, spot: u64) {
        let shift = SPOT_BITS * cell;
        self.spots = self.spots & !(SPOT_MASK << shift) | spot << shift;
    }

    fn halvings(self) -> u64 {
        self.counts / HALVING
    }

    /// Halves all counts; odd ones are rounded up or down by the bits of `noise`.
    fn halve(&mut self, noise: u64) {
        let halved = |cell: u32| ((self.count(cell) + (noise >> cell & 1)) / 2) << (COUNT_BITS * cell);
        self.counts = (0..CELLS).map(halved).sum::<u64>() + (self.halvings() + 1).min(60) * HALVING;
    }
}

/// The point with barycentric coordinates `uv` in a cell with that frame.
fn inside((corner, length): (Vec2, f32), uv: Vec2) -> Vec2 {
    corner + length * uv
}

/// A whole number below `limit`, of at most 32 bits, each as likely as the others if `noise` is random.
fn below(limit: u64, noise: u64) -> u64 {
    ((noise >> 32) * limit) >> 32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first spot of a cell.
    fn corner_of(cell: u16) -> Spot {
        Spot(cell << SPOT_BITS)
    }

    /// Landings on two cells, nine in ten on the first.
    fn lopsided(landings: u64, seed: u64) -> Footprint {
        let mut footprint = Footprint::WHOLE;
        for k in 0..landings {
            footprint.add(corner_of(if k % 10 == 9 { 7 } else { 2 }), mix(seed + k));
        }
        footprint
    }

    #[test]
    fn points_have_the_density_of_the_landings() {
        let footprint = lopsided(50, 1);
        let mut counts = [0; 9];
        for k in 0..100 * 100 {
            let s = Vec2::new((k % 100) as f32 + 0.5, (k / 100) as f32 + 0.5) / 100.0;
            let spot = Spot::at(footprint.point(s));
            assert_eq!(spot.on_cell(), 0, "away from all landings");
            counts[spot.cell() as usize] += 1;
        }
        assert_eq!((counts[2], counts[7]), (9000, 1000), "{counts:?}");
        assert!((footprint.density(corner_of(2)) - 8.1).abs() < 1e-6 && footprint.density(corner_of(0)) == 0.0);
    }

    #[test]
    fn many_lines_leave_from_all_of_a_cell_and_few_from_the_spot() {
        let spots = |lines| {
            let footprint = lopsided(50, 1).for_lines(lines);
            let point = |k: u32| footprint.point(Vec2::new((k % 20) as f32 + 0.5, (k / 20) as f32 + 0.5) / 20.0);
            let mut spots: Vec<u64> = (0..400).map(|k| Spot::at(point(k)).on_cell()).collect();
            spots.sort_unstable();
            spots.dedup();
            spots.len()
        };
        assert_eq!(spots(4), 1);
        assert!(spots(5) > 100, "{}", spots(5));
    }

    #[test]
    fn every_landing_is_as_likely_to_be_remembered() {
        // 100 landings all over a cell, 30 of them on one spot, halved on the way; then joined with 50 on another.
        let remembered = |seed: u64| {
            let mut footprint = Footprint::WHOLE;
            (0..100).for_each(|k| footprint.add(Spot(if k % 10 < 3 { 5 } else { 20 + k }), mix(seed + u64::from(k))));
            let first = footprint.remembered(0);
            let mut other = Footprint::WHOLE;
            (0..50).for_each(|k| other.add(Spot(7), mix(seed + 1000 + k)));
            footprint.join(other, mix(seed));
            [f64::from(first == 5), f64::from(footprint.remembered(0) == 7)]
        };
        let runs: Vec<[f64; 2]> = (0..4000).map(|run| remembered(run << 40)).collect();
        let share = |k: usize| runs.iter().map(|run| run[k]).sum::<f64>() / 4000.0;
        // The deviation of each share is 0.007.
        assert!((share(0) - 0.3).abs() < 0.035, "{}", share(0));
        assert!((share(1) - 1.0 / 3.0).abs() < 0.035, "{}", share(1));
    }

    #[test]
    fn many_landings_and_joined_ones_keep_their_proportions() {
        let mean_share = |make: &dyn Fn(u64) -> Footprint| {
            (0..400).map(|s| make(s << 40).density(corner_of(7))).sum::<f32>() / 400.0 / 9.0
        };
        let many = mean_share(&|seed| lopsided(5000, seed));
        assert!((many - 0.1).abs() < 0.01, "{many}");
        // 5,000 landings of which a tenth are on cell 7, and 50 that are all on it.
        let joined = mean_share(&|seed| {
            let mut footprint = lopsided(5000, seed);
            let mut few = Footprint::WHOLE;
            (0..50).for_each(|k| few.add(corner_of(7), mix(seed + 9000 + k)));
            footprint.join(few, mix(seed));
            footprint
        });
        assert!((joined - 550.0 / 5050.0).abs() < 0.01, "{joined}");
    }

    #[test]
    fn spots_cover_the_element() {
        for k in 0..1000 {
            let u = (k as f32 * 0.618).fract();
            let uv = Vec2::new(u, (k as f32 * 0.414).fract() * (1.0 - u));
            let mut footprint = Footprint::WHOLE;
            footprint.add(Spot::at(uv), 0);
            assert!(footprint.point(Vec2::splat(0.5)).distance(uv) < 2.0 / 33.0, "{uv}");
        }
    }

    #[test]
    fn totals_are_the_sums_of_the_counts() {
        for seed in 0..100 {
            let mut footprint = lopsided(seed * seed, seed);
            (0..seed).for_each(|k| footprint.add(corner_of((mix(k) % 9) as u16), mix(seed + k)));
            assert_eq!(footprint.total(), (0..CELLS).map(|cell| footprint.count(cell)).sum::<u64>());
        }
        let full = Footprint { counts: u64::MAX, spots: 0 };
        assert_eq!(full.total(), 9 * LARGEST);
    }

    #[test]
    fn the_whole_is_even() {
        assert!((0..9).all(|cell| Footprint::WHOLE.density(corner_of(cell)) == 1.0));
        assert_eq!(Footprint::WHOLE.mean_square(), 1.0);
    }
}
