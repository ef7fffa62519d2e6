//! Bundles: many parallel global lines at once (Sbert 1997; Szirmay-Kalos & Purgathofer 1998).
//!
//! The lines of a bundle have one direction, uniform over the sphere, and form a regular grid across it with cells of area a,
//! moved as a whole by a uniform offset. A bundle crosses an element of area A that it meets at an angle t about `A |cos t| /
//! a` times, `A / (2 a)` times in the mean over all directions. Each line alone is a global line, so all that is true of
//! those holds; but the lines of a bundle are not independent: errors fall with the number of bundles, not of lines.
//!
//! Per line the raster gives what a ray of all hits would: the crossings, with the elements on both sides (see
//! [`crossing`](super::crossing)); [`bundle_gather`](super::bundle_gather) is the fast way to use them.
//!
//! Unbiased, but for corners rounded to 1/65,536 of a cell. Cost: O(triangles) a bundle, and then O(crossings), by
//! rasterisation; the analytic sphere is traced by rays.

use super::Crossing;
use super::span::{Span, spans};
use crate::Error;
use crate::Problem;
use crate::geometry::HitLists;
use crate::geometry::raster::grid::{Grid, MOST_CELLS};
use crate::geometry::raster::{Raster, TileLists};
use crate::math::warp::square_to_sphere;
use crate::sampling::{Sample, Sequence};
use crate::scene::Shape;
use glam::{Vec2, Vec3};
use std::ops::Range;

/// The stream of a sequence that bundles draw, beyond those of all elements and lamps.
pub const STREAM: u64 = (1 << 32) + 1;

/// How many crossings of each square metre of plane surfaces are expected of a bundle with `cells` by `cells` lines, in the mean over
/// all directions: `1 / (2 a)` with `a = (2 R / cells)²` [1/m²].
pub fn crossings_per_area(problem: &Problem, cells: u32) -> f64 {
    (f64::from(cells) / f64::from(problem.geometry.bounding_sphere().1)).powi(2) / 8.0
}

/// A bundle of parallel lines, cut into tiles that can be evaluated independently.
#[derive(Clone, Debug)]
pub struct Bundle<'a> {
    problem: &'a Problem,
    grid: Grid,
    /// Nothing for curved surfaces.
    raster: Option<Raster>,
}

impl<'a> Bundle<'a> {
    /// The bundle that belongs to `sample`: two numbers choose the direction, the others the offset of the grid, which has
    /// `cells` by `cells` lines over the square around the bounding sphere.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless `cells` is from 1 to [`MOST_CELLS`].
    pub fn new(problem: &'a Problem, [x1, x2, x3, x4]: Sample, cells: u32) -> Result<Bundle<'a>, Error> {
        if !(1..=MOST_CELLS).contains(&cells) {
            return Err(Error::Parameter { name: "cells", value: cells.to_string(), allowed: "from 1 to 8192" });
        }
        let direction = square_to_sphere(Vec2::new(x1, x2)).normalize();
        let grid = Grid::new(problem.geometry.bounding_sphere(), direction, Vec2::new(x3, x4), cells);
        let scene = &problem.scene;
        let raster = (scene.shape == Shape::Triangles).then(|| Raster::of(scene, grid));
        Ok(Bundle { problem, grid, raster })
    }

    /// Bundle `number` of `sequence`.
    ///
    /// # Errors
    /// Those of [`Bundle::new`].
    pub fn nth(problem: &'a Problem, sequence: &dyn Sequence, number: u64, cells: u32) -> Result<Bundle<'a>, Error> {
        let mut sample = [[0.0; 4]];
        sequence.fill(STREAM, number, &mut sample);
        Bundle::new(problem, sample[0], cells)
    }

    /// The direction of its lines, a unit vector.
    pub fn direction(&self) -> Vec3 {
        self.grid.direction()
    }

    /// The problem whose surfaces its lines cross.
    pub fn problem(&self) -> &'a Problem {
        self.problem
    }

    /// Number of its tiles.
    pub fn tiles(&self) -> u32 {
        self.grid.tiles()
    }

    /// Hands the spans of the lines of `tiles` to `each`, line by line.
    pub fn spans(&self, tiles: Range<u32>, mut each: impl FnMut(Span)) {
        let lift = self.problem.geometry.lift();
        let mut found = TileLists::default();
        for tile in tiles {
            self.crossings(tile, &mut found);
            found.iter().for_each(|crossings| spans(lift, crossings, &mut each));
        }
    }

    /// Fills `found` with the crossings of the lines of `tile`, a list for each of its lines, row by row; no lists for a tile
    /// that does not exist.
    pub fn crossings(&self, tile: u32, found: &mut TileLists<Crossing>) {
        match &self.raster {
            Some(raster) => raster.crossings(tile, &self.problem.mesh, found),
            None => self.trace(tile, found),
        }
    }

    fn trace(&self, tile: u32, found: &mut TileLists<Crossing>) {
        let mut lists = HitLists::default();
        self.problem.geometry.all(&self.grid.lines(tile), &mut lists);
        found.fill(lists.iter().map(|hits| hits.iter().map(|hit| (hit.t, Crossing::of(self.problem, hit)))));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Resolution;
    use crate::scene::builtin::builtin;

    fn problem(name: &str) -> Problem {
        Problem::new(builtin(name).unwrap(), Resolution::Elements(1)).unwrap()
    }

    #[test]
    fn curved_surfaces_are_traced() {
        let problem = problem("sphere");
        let bundle = Bundle::new(&problem, [0.3, 0.6, 0.5, 0.5], 100).unwrap();
        let mut inside = 0;
        bundle.spans(0..bundle.tiles(), |_| inside += 1);
        // Every line through the disc has one span: a disc in its square.
        assert!((f64::from(inside) / 1e4 - std::f64::consts::FRAC_PI_4).abs() < 0.01, "{inside}");
    }

    #[test]
    fn senseless_grids_are_refused() {
        let problem = problem("box");
        for cells in [0, MOST_CELLS + 1] {
            assert!(matches!(Bundle::new(&problem, [0.5; 4], cells), Err(Error::Parameter { name: "cells", .. })));
        }
    }
}
