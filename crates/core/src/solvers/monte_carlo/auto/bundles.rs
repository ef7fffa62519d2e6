//! What elements gather along bundles of global lines ([`bundle_gather`](crate::transport::bundle_gather)), merged with what was shot.
//!
//! With n crossings of an element by each of D bundles the variance is `V (1 / (D n) + 2 / D)`, for an element that sees one place along
//! a direction sees the same from everywhere on it, mostly. So grids are as coarse as n = 1/3 allows: measured in four scenes of 40
//! to 140,000 triangles, the time of a bundle times `1 / n + 2` is least between n = 0.2 and 0.7, and n = 3 takes twice as long.
//!
//! Memory while bundles gather: 48 bytes an element, and 32 more for each piece in flight, of which there are four at most.

use super::indirect::Precision;
use crate::Problem;
use crate::sampling::Sequence;
use crate::solvers::Part;
use crate::solvers::monte_carlo::light::Light;
use crate::solvers::monte_carlo::relaxation::Relaxation;
use crate::transport::Bundle;
use crate::transport::bundle::crossings_per_area;
use crate::transport::bundle_gather::{Source, Sums, gather, grid_cells, samples_of_bundle};
use std::ops::Range;

/// A crossing costs as much as this share of a ray, and counts as that.
pub const COST: f64 = 1.0 / 8.0;
/// Crossings of an element by a bundle, in the mean. A triangle has one at least, or most of the time would go into those that are not
/// crossed.
const CROSSINGS_OF_ELEMENT: f64 = 1.0 / 3.0;
/// Least cells along the edge of a grid, if there are enough directions.
const LEAST_CELLS: f64 = 128.0;
/// Complete solutions that have enough directions together.
const COMPLETE_SOLUTIONS: f64 = 8.0;
/// Most pieces of all bundles, and pieces in flight: every piece has sums of its own.
const MOST_PIECES: u64 = 16;
const IN_FLIGHT: u64 = 4;

#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Bundles {
    count: u64,
    cells: u32,
    pieces: u64,
    absorbed: u64,
    source: Source,
    sums: Sums,
    precision: Precision,
}

/// Bundles that cost as much as `rays` rays, and cells along the edges of their grids.
pub fn bundles_of(problem: &Problem, rays: f64) -> (u64, u32) {
    let samples = rays / COST;
    let (elements, triangles) = (problem.mesh.len() as f64, problem.scene.triangles.len() as f64);
    let of_bundle = triangles.max(CROSSINGS_OF_ELEMENT * elements);
    let enough = (of_bundle / samples_of_bundle(problem, 1)).sqrt().max(LEAST_CELLS) as u32;
    // Others follow, with other directions.
    let cells = grid_cells(problem, (COMPLETE_SOLUTIONS * samples) as u64).min(enough);
    ((samples / samples_of_bundle(problem, cells)).ceil() as u64, cells)
}

impl Bundles {
    /// Begins anew: elements reflect the light that was shot, and shall have about as many crossings together as `rays` rays cost.
    /// `known(bundles, crossings)` is how well so many bundles and crossings [1/m²] will tell it, and up to which level they do.
    pub fn begin(&mut self, problem: &Problem, rays: u64, known: impl Fn(f64, f64) -> Precision, light: &Light) {
        (self.count, self.cells) = bundles_of(problem, rays as f64);
        self.absorbed = 0;
        let crossings = self.count as f64 * crossings_per_area(problem, self.cells);
        // Adding up sums costs time for each element and piece.
        let crossings_of_element = crossings * problem.mesh.total_area() / problem.mesh.len() as f64;
        self.pieces = (crossings_of_element as u64).clamp(1, MOST_PIECES);
        self.precision = known(self.count as f64, crossings);
        if self.count > 0 {
            let level = self.precision.level();
            self.source = Source::new(problem, |e| {
                let radiosity = light.reflected_radiosity(&problem.mesh, e);
                let luminance = radiosity.luminance_f64();
                if luminance > level { radiosity * (level / luminance) as f32 } else { radiosity }
            });
            self.sums = Sums::new(problem);
        }
    }

    pub fn fits(&self, problem: &Problem) -> bool {
        self.source.fits(problem) && self.sums.fits(problem)
    }

    pub fn pieces(&self) -> Range<u64> {
        self.absorbed..self.all_pieces().min(self.absorbed + IN_FLIGHT)
    }

    fn all_pieces(&self) -> u64 {
        self.count.min(self.pieces)
    }

    /// Gathers along the bundles of `piece`.
    pub fn part(&self, problem: &Problem, sequence: &dyn Sequence, piece: u64) -> Part {
        let mut sums = Sums::new(problem);
        let first = |piece: u64| piece * self.count / self.all_pieces();
        for number in first(piece)..first(piece + 1) {
            // The number of cells is within the limits by the way it was chosen.
            if let Ok(bundle) = Bundle::nth(problem, sequence, number, self.cells) {
                gather(&bundle, &self.source, &mut sums);
            }
        }
        let crossings: f64 = problem.mesh.elements().map(|e| sums.crossings(e)).sum();
        Part { sums: Some(sums), rays: (crossings * COST) as u64, ..Part::default() }
    }

    /// Takes in the next piece in order; whether it was the last.
    pub fn absorb(&mut self, part: &Part) -> bool {
        if let Some(sums) = &part.sums {
            self.sums.add(sums);
        }
        self.absorbed += 1;
        self.absorbed == self.all_pieces()
    }

    /// Merges what was gathered, with the surplus that has landed, with what was `shot` before, and forgets it.
    pub fn merge(&mut self, problem: &Problem, shot: &mut Relaxation) {
        if self.count == 0 {
            return;
        }
        for e in problem.mesh.elements() {
            let surplus = shot.light_mut().take_landed(e);
            let area = problem.mesh.area(e);
            let gathered = match self.precision.crossings_of_rarely_crossed(area.into()) {
                Some(expected) => Some(self.sums.irradiance_by_expected(e, expected)),
                None => self.sums.irradiance(e),
            };
            if let Some(irradiance) = gathered {
                let weight = self.precision.weight_of_bundles(area.into());
                shot.light_mut().merge_indirect(e, irradiance * area + surplus, weight);
            }
        }
        (self.source, self.sums) = (Source::default(), Sums::default());
    }

    pub fn precision(&self) -> Precision {
        self.precision
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Resolution;
    use crate::scene::builtin::builtin;

    /// Rays enough for thousands of directions.
    const MANY: f64 = 1e9;

    fn crossings_of_bundle(name: &str, elements: u64) -> [f64; 2] {
        let problem = Problem::new(builtin(name).unwrap(), Resolution::Elements(elements)).unwrap();
        let samples = samples_of_bundle(&problem, bundles_of(&problem, MANY).1);
        [samples / problem.mesh.len() as f64, samples / problem.scene.triangles.len() as f64]
    }

    #[test]
    fn a_bundle_crosses_an_element_a_third_of_a_time_and_a_triangle_once() {
        for (name, elements) in [("cornell-box", 200_000), ("office", 200_000)] {
            let [of_element, _] = crossings_of_bundle(name, elements);
            assert!((of_element - 1.0 / 3.0).abs() < 0.01, "{name}: {of_element}");
        }
        let [_, of_triangle] = crossings_of_bundle("office", 60_000);
        assert!((of_triangle - 1.0).abs() < 0.02, "{of_triangle}");
    }

    #[test]
    fn few_crossings_are_shared_out_to_enough_directions() {
        let problem = Problem::new(builtin("office").unwrap(), Resolution::Elements(60_000)).unwrap();
        let directions = |rays| bundles_of(&problem, rays).0 as f64 * COMPLETE_SOLUTIONS;
        assert!((290.0..330.0).contains(&directions(1e4)), "{}", directions(1e4));
        assert!(directions(1e6) > 1000.0);
    }
}
