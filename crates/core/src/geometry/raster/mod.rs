//! All crossings of a bundle of parallel lines, by orthographic rasterisation into a list for every line.
//!
//! The lines form a regular grid (see [`grid`]), so a triangle need not be searched for: the lines that cross it are the points of the
//! grid that its projection covers (see [`cover`]). The crossings of a tile of lines are collected triangle by triangle, sorted
//! into lists by counting, and each list is sorted by depth (the A-buffer of Carpenter 1984, without its masks). Neighbouring
//! lines cross the same triangles: this coherence makes a crossing several times cheaper than by rays (Szirmay-Kalos &
//! Purgathofer, Global ray-bundle tracing with hardware acceleration, EGWR 1998).
//!
//! Corners are rounded to 1/65,536 of a cell, so a crossing is where the ray of [`grid::Grid::line`] has it but for that. Depths are
//! interpolated between the corners' and never lie beyond them.
//!
//! Cost: O(triangles) to project and to sort into tiles, once for a direction, 36 bytes a triangle; then O(crossings).

pub mod cover;
pub mod grid;

use super::HitLists;
use cover::Projected;
use glam::Vec3;
use grid::Grid;

/// Triangles, projected onto a grid and sorted into its tiles.
#[derive(Clone, Debug)]
pub struct Raster {
    grid: Grid,
    triangles: Vec<Projected>,
    /// Numbers of the triangles that may cover points of a tile, tile by tile, and where those of each tile end.
    numbers: Vec<u32>,
    ends: Vec<usize>,
}

impl Raster {
    /// Projects triangles, given by their corners [m]. Those with a coordinate that is not finite are never crossed.
    pub fn new(grid: Grid, triangles: impl Iterator<Item = [Vec3; 3]>) -> Raster {
        let finite = |corners: &[Vec3; 3]| corners.iter().all(|corner| corner.is_finite());
        let project = |corners: [Vec3; 3]| if finite(&corners) { grid.project(corners) } else { Projected::NOTHING };
        let triangles: Vec<Projected> = triangles.map(project).collect();
        // A counting sort, as in HitLists::grouped.
        let tiles_of = |triangle: &Projected| grid.tiles_of(triangle.bounds(grid.cells()));
        let mut ends = vec![0; grid.tiles() as usize];
        triangles.iter().flat_map(tiles_of).for_each(|tile| ends[tile as usize] += 1);
        let mut total = 0;
        for end in &mut ends {
            (*end, total) = (total, total + *end);
        }
        let mut numbers = vec![0; total];
        for (number, triangle) in (0..).zip(&triangles) {
            for tile in tiles_of(triangle) {
                numbers[ends[tile as usize]] = number;
                ends[tile as usize] += 1;
            }
        }
        Raster { grid, triangles, numbers, ends }
    }

    /// The crossings of the lines of `tile`, a list for each of its cells, row by row.
    pub fn crossings(&self, tile: u32) -> HitLists {
        let [columns, rows] = self.grid.cells_of(tile);
        let width = columns.end - columns.start;
        let mut fragments = Vec::new();
        for &number in self.numbers_of(tile) {
            let triangle = &self.triangles[number as usize];
            let [across, up] = triangle.bounds(self.grid.cells());
            let common = |a: std::ops::Range<u32>, b: &std::ops::Range<u32>| a.start.max(b.start)..a.end.min(b.end);
            triangle.cover(number, [common(across, &columns), common(up, &rows)], |column, row, hit| {
                fragments.push(((row - rows.start) * width + column - columns.start, hit));
            });
        }
        HitLists::grouped((width * (rows.end - rows.start)) as usize, &fragments)
    }

    fn numbers_of(&self, tile: u32) -> &[u32] {
        let tile = tile as usize;
        let begin = if tile == 0 { 0 } else { self.ends[tile - 1] };
        &self.numbers[begin..self.ends[tile]]
    }
}
