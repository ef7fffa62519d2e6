//! Gathering by bundles: each element sums up what its crossings see.
//!
//! ```text
//! E_i = sum of B_j over the crossings of element i / N_i
//! ```
//!
//! N_i is the number of crossings of i that were *counted*: a ratio of two sums, which errs less than one over the expected
//! number would, for both feel alike how the lines happen to fall. What lies at the other end of a crossing is an element of
//! radiosity B_j, or black: the open, or the back of a one-sided surface. Between bundles everything is a sum, so bundles may
//! be gathered in any groups; a caller that keeps the sums of some groups apart can measure the variance.
//!
//! Consistent; its bias is that of a ratio, of order 1 / N_i. Small elements are crossed by few lines, some by none: they need
//! rays of their own. Cost: O(triangles) a bundle, then O(crossings), each a few additions to two rows of sums.
//!
//! Source: Szirmay-Kalos & Purgathofer, Global ray-bundle tracing with hardware acceleration, EGWR 1998; the counted crossings are
//! those of Sbert, EGWR 1993.

use super::bundle::crossings_per_area;
use super::{Bundle, Span, spans};
use crate::geometry::raster::TileLists;
use crate::math::Rgb;
use crate::sampling::Sequence;
use crate::{Error, Problem};
use rayon::prelude::*;
use std::ops::Range;

/// Bundles that one thread gathers at a time.
const BUNDLES_OF_PIECE: u64 = 4;
/// Directions that are better than a finer grid.
const LEAST_DIRECTIONS: f64 = 300.0;
/// Crossings of a triangle by a bundle, in the mean.
const CROSSINGS_OF_TRIANGLE: f64 = 10.0;
/// Least and most cells along the edge of a grid, if there are enough directions.
const CELLS: [f64; 2] = [256.0, 1024.0];

/// What crossings see: red, green and blue of the radiosity [lm/m²] of each element, and 1 to count them; last what lies at ends
/// without element.
#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Source(Vec<[f32; 4]>);

impl Source {
    /// Elements whose radiosity [lm/m²] is `radiosity(e)`.
    pub fn new(problem: &Problem, radiosity: impl Fn(u32) -> Rgb) -> Source {
        let seen = |Rgb { r, g, b }| [r, g, b, 1.0];
        let elements = problem.mesh.elements().map(|e| seen(radiosity(e)));
        Source(elements.chain([seen(Rgb::BLACK)]).collect())
    }

    /// Whether it is of the elements of `problem`, or of none.
    pub fn fits(&self, problem: &Problem) -> bool {
        [0, problem.mesh.len() + 1].contains(&self.0.len())
    }
}

/// What the crossings of each element have seen, 32 bytes an element: sums of radiosities [lm/m²], and their number.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sums(Vec<Sum>);

/// Red, green, blue and the number of crossings, side by side in one line of the cache.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[repr(align(32))]
struct Sum([f64; 4]);

impl Sums {
    /// Nothing yet.
    pub fn new(problem: &Problem) -> Sums {
        Sums(vec![Sum::default(); problem.mesh.len() + 1])
    }

    /// Whether they are of the elements of `problem`, or of none.
    pub fn fits(&self, problem: &Problem) -> bool {
        [0, problem.mesh.len() + 1].contains(&self.0.len())
    }

    /// Forgets everything and keeps the memory.
    pub fn clear(&mut self) {
        self.0.fill(Sum::default());
    }

    /// Adds other sums of the same problem.
    pub fn add(&mut self, other: &Sums) {
        for (Sum(sum), Sum(other)) in self.0.iter_mut().zip(&other.0) {
            sum.iter_mut().zip(other).for_each(|(sum, other)| *sum += other);
        }
    }

    /// How often element `e` has been crossed.
    pub fn crossings(&self, e: u32) -> f64 {
        self.0[e as usize].0[3]
    }

    /// Irradiance [lm/m²] of element `e`, which so many crossings were `expected` to tell: without bias, but it feels how often
    /// the element happened to be crossed.
    pub fn irradiance_by_expected(&self, e: u32, expected: f64) -> Rgb {
        let Sum([r, g, b, _]) = self.0[e as usize];
        let mean = |sum: f64| (sum / expected) as f32;
        Rgb::new(mean(r), mean(g), mean(b))
    }

    /// Irradiance [lm/m²] of element `e`; `None` if no line has crossed it.
    pub fn irradiance(&self, e: u32) -> Option<Rgb> {
        let Sum([r, g, b, crossings]) = self.0[e as usize];
        let mean = |sum: f64| (sum / crossings) as f32;
        (crossings > 0.0).then(|| Rgb::new(mean(r), mean(g), mean(b)))
    }
}

/// Adds what the crossings of `bundle` see of `source` to `sums`; all of one problem.
pub fn gather(bundle: &Bundle, source: &Source, sums: &mut Sums) {
    let (source, sums) = (&source.0[..], &mut sums.0[..]);
    // Ends without element have a row too, so that no crossing needs to be asked what it is.
    let nobody = source.len().min(sums.len()) as u32 - 1;
    let lift = bundle.problem().geometry.lift();
    let (mut found, mut seen) = (TileLists::default(), Vec::new());
    for tile in 0..bundle.tiles() {
        bundle.crossings(tile, &mut found);
        // All pairs first, then all sums: the processor then waits for the memory of many elements at once.
        seen.clear();
        for crossings in found.iter() {
            spans(lift, crossings, |Span { from, to }| seen.push([from.or(nobody), to.or(nobody)]));
        }
        for [from, to] in seen.iter().map(|ends| ends.map(|end| end as usize)) {
            see(&mut sums[from], source[to]);
            see(&mut sums[to], source[from]);
        }
    }
}

/// Adds what one crossing sees.
#[inline]
fn see(Sum(sum): &mut Sum, seen: [f32; 4]) {
    sum.iter_mut().zip(seen).for_each(|(sum, seen)| *sum += f64::from(seen));
}

/// Gathers `bundles` of `sequence`, each a grid of `cells` by `cells` lines, with as many threads as there are. The result
/// has the same bits for any number of them: every piece, a few bundles, has sums of its own, and they are added in order.
/// Memory: 32 bytes an element for each thread.
///
/// # Errors
/// Those of [`Bundle::new`].
pub fn gather_all(
    problem: &Problem,
    sequence: &dyn Sequence,
    bundles: Range<u64>,
    cells: u32,
    source: &Source,
) -> Result<Sums, Error> {
    let pieces: Vec<u64> = bundles.clone().step_by(BUNDLES_OF_PIECE as usize).collect();
    let mut of_pieces = vec![Sums::new(problem); rayon::current_num_threads().min(pieces.len())];
    let mut total = Sums::new(problem);
    for at_once in pieces.chunks(of_pieces.len().max(1)) {
        let gather_piece = |(sums, &first): (&mut Sums, &u64)| {
            sums.clear();
            (first..(first + BUNDLES_OF_PIECE).min(bundles.end)).try_for_each(|number| {
                gather(&Bundle::nth(problem, sequence, number, cells)?, source, sums);
                Ok(())
            })
        };
        of_pieces.par_iter_mut().zip(at_once).try_for_each(gather_piece)?;
        of_pieces.iter().zip(at_once).for_each(|(sums, _)| total.add(sums));
    }
    Ok(total)
}

/// Expected samples of a bundle with `cells` by `cells` lines: crossings of all elements, in the mean over all directions.
pub fn samples_of_bundle(problem: &Problem, cells: u32) -> f64 {
    problem.mesh.total_area() * crossings_per_area(problem, cells)
}

/// Cells along the edge of the grids of bundles that shall have `samples` samples together: so many that a triangle is crossed
/// ten times, from 256 to 1024; but rather coarser than fewer than 300 directions.
pub fn grid_cells(problem: &Problem, samples: u64) -> u32 {
    let cells_for = |of_bundle: f64| (of_bundle / samples_of_bundle(problem, 1)).sqrt();
    let fine = cells_for(CROSSINGS_OF_TRIANGLE * problem.scene.triangles.len() as f64);
    let affordable = cells_for(samples as f64 / LEAST_DIRECTIONS);
    fine.clamp(CELLS[0], CELLS[1]).min(affordable).max(1.0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Resolution;
    use crate::scene::builtin::builtin;

    fn problem(name: &str) -> Problem {
        Problem::new(builtin(name).unwrap(), Resolution::Elements(2000)).unwrap()
    }

    #[test]
    fn grids_follow_directions_first_and_triangles_then() {
        let (simple, furnished) = (problem("box"), problem("office"));
        let many = 1 << 40;
        assert_eq!(grid_cells(&simple, many), 256);
        let fine = grid_cells(&furnished, many);
        assert!((257..=1024).contains(&fine));
        let triangles = furnished.scene.triangles.len() as f64;
        assert!(fine == 1024 || (samples_of_bundle(&furnished, fine) / triangles - 10.0).abs() < 0.1);
        for problem in [&simple, &furnished] {
            let coarse = grid_cells(problem, 1_000_000);
            assert!((1_000_000.0 / samples_of_bundle(problem, coarse) / 300.0 - 1.0).abs() < 0.1, "{coarse}");
            assert_eq!(grid_cells(problem, 0), 1);
        }
    }

    #[test]
    fn a_bundle_has_its_expected_samples() {
        let problem = problem("cubes");
        let (sequence, source) = (crate::sampling::OwenSobol::new(1), Source::new(&problem, |_| Rgb::WHITE));
        let sums = gather_all(&problem, &sequence, 0..256, 40, &source).unwrap();
        let samples: f64 = problem.mesh.elements().map(|e| sums.crossings(e)).sum();
        // Of a net of 256 directions not much is left to chance.
        assert!((samples / 256.0 / samples_of_bundle(&problem, 40) - 1.0).abs() < 0.02, "{samples}");
    }

    #[test]
    fn senseless_grids_are_refused() {
        let (problem, sequence) = (problem("box"), crate::sampling::OwenSobol::new(1));
        let source = Source::new(&problem, |_| Rgb::WHITE);
        assert!(matches!(
            gather_all(&problem, &sequence, 0..9, 0, &source),
            Err(Error::Parameter { name: "cells", .. })
        ));
        assert_eq!(gather_all(&problem, &sequence, 5..5, 8, &source).unwrap(), Sums::new(&problem));
    }
}
