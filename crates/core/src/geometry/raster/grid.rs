//! A regular grid of parallel lines around a scene.
//!
//! The lines pass through the points `((i + x) h - R, (j + y) h - R)` of the plane through the centre of the bounding sphere
//! across their direction, `h = 2 R / cells`, one for every cell (i, j) of a square. The offset (x, y) in [0, 1)² moves the
//! grid as a whole, so every point of the plane over the sphere is as likely to lie on a line as any other, and there are `1
//! / h²` lines a square metre.

use super::cover::{Point, SUBCELLS};
use crate::geometry::Ray;
use crate::math::Frame;
use glam::{Vec2, Vec3};
use std::ops::Range;

/// Most cells along an edge of the grid: beyond it the exact arithmetic of [`super::cover`] would overflow.
pub const MOST_CELLS: u32 = 8192;
/// Cells along an edge of a tile: its lists stay in the second level of cache.
const TILE: u32 = 64;

/// Parallel lines, one a cell of a square of cells.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    frame: Frame,
    center: Vec3,
    radius: f32,
    cells: u32,
    offset: Vec2,
}

impl Grid {
    /// `cells` by `cells` lines along the unit vector `direction` around a sphere (centre, radius [m]); 1 to [`MOST_CELLS`],
    /// others are taken as the nearest of these.
    pub fn new((center, radius): (Vec3, f32), direction: Vec3, offset: Vec2, cells: u32) -> Grid {
        Grid { frame: Frame::about(direction), center, radius, cells: cells.clamp(1, MOST_CELLS), offset }
    }

    /// Area of a cell, the plane's area for each line [m²].
    pub fn cell_area(&self) -> f64 {
        (2.0 * f64::from(self.radius) / f64::from(self.cells)).powi(2)
    }

    /// Cells along an edge.
    pub fn cells(&self) -> u32 {
        self.cells
    }

    pub fn direction(&self) -> Vec3 {
        self.frame.z
    }

    /// The line of a cell.
    pub fn line(&self, column: u32, row: u32) -> Ray {
        let size = 2.0 * self.radius / self.cells as f32;
        let across = (Vec2::new(column as f32, row as f32) + self.offset) * size - self.radius;
        let point = self.center + self.frame.x * across.x + self.frame.y * across.y;
        Ray::whole_line(point, self.direction(), self.radius)
    }

    /// The map to points as the grid sees them: in subcells across the lines, in metres from their origins along them.
    pub fn projection(&self) -> impl Fn(Vec3) -> Point + use<> {
        let radius = f64::from(self.radius);
        let subcells = f64::from(self.cells) * SUBCELLS as f64 / (2.0 * radius);
        let [x, y, z] = [self.frame.x, self.frame.y, self.frame.z].map(|axis| axis.as_dvec3());
        let (x, y) = (x * subcells, y * subcells);
        let first = radius * subcells - self.offset.as_dvec2() * SUBCELLS as f64;
        let (center, lead) = (self.center.as_dvec3(), radius * f64::from(Ray::LEAD));
        // What lies beyond the grid is moved closer, so that the arithmetic of its edges cannot overflow.
        let beyond = (2 * SUBCELLS) as f64;
        let least_greatest = [-beyond, f64::from(MOST_CELLS) * SUBCELLS as f64 + beyond];
        // A cast cuts off what is behind the point, towards zero: rounding needs a number that is positive.
        let round = move |position: f64| {
            let [least, greatest] = least_greatest;
            (position.clamp(least, greatest) + (beyond + 0.5)) as i32 - (2 * SUBCELLS) as i32
        };
        move |point| {
            let relative = point.as_dvec3() - center;
            Point {
                x: round(relative.dot(x) + first.x),
                y: round(relative.dot(y) + first.y),
                depth: (relative.dot(z) + lead) as f32,
            }
        }
    }

    /// Number of tiles.
    pub fn tiles(&self) -> u32 {
        self.tiles_along_edge().pow(2)
    }

    /// Columns and rows of the cells of `tile`; no rows for a tile that does not exist.
    pub fn cells_of(&self, tile: u32) -> [Range<u32>; 2] {
        let along = self.tiles_along_edge();
        let border = |k: u32| k.saturating_mul(TILE).min(self.cells);
        [tile % along, tile / along].map(|k| border(k)..border(k.saturating_add(1)))
    }

    /// The lines of `tile`, row by row.
    pub fn lines(&self, tile: u32) -> Vec<Ray> {
        let [columns, rows] = self.cells_of(tile);
        rows.flat_map(|row| columns.clone().map(move |column| self.line(column, row))).collect()
    }

    /// The tiles that some of these cells belong to.
    #[inline]
    pub fn tiles_of(&self, [columns, rows]: [Range<u32>; 2]) -> impl Iterator<Item = u32> + use<> {
        let along = self.tiles_along_edge();
        let first = columns.start / TILE + rows.start / TILE * along;
        let extent = |cells: &Range<u32>| cells.end.div_ceil(TILE).saturating_sub(cells.start / TILE);
        let (width, height) = (extent(&columns), extent(&rows));
        let none = columns.is_empty() || rows.is_empty();
        (0..if none { 0 } else { width * height }).map(move |k| first + k % width + k / width * along)
    }

    fn tiles_along_edge(&self) -> u32 {
        self.cells.div_ceil(TILE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_share_out_the_cells() {
        for cells in [1, 63, 64, 65, 200] {
            let grid = Grid::new((Vec3::ZERO, 1.0), Vec3::Z, Vec2::ZERO, cells);
            let mut seen = vec![0; (cells * cells) as usize];
            for tile in 0..grid.tiles() {
                let [columns, rows] = grid.cells_of(tile);
                for (column, row) in rows.flat_map(|row| columns.clone().map(move |column| (column, row))) {
                    seen[(row * cells + column) as usize] += 1;
                    let found: Vec<u32> = grid.tiles_of([column..column + 1, row..row + 1]).collect();
                    assert_eq!(found, [tile]);
                }
            }
            assert!(seen.iter().all(|&times| times == 1), "{cells}");
        }
    }

    #[test]
    fn lines_pass_through_the_points_that_project_to_their_cells() {
        let direction = Vec3::new(0.6, 0.0, -0.8);
        let grid = Grid::new((Vec3::new(1.0, 2.0, 3.0), 2.0), direction, Vec2::new(0.25, 0.75), 10);
        let line = grid.line(3, 8);
        for t in [0.0, 1.0, 4.0] {
            let point = grid.projection()(line.origin + t * direction);
            assert!((i64::from(point.x) - 3 * SUBCELLS).abs() <= 1, "{point:?}");
            assert!((i64::from(point.y) - 8 * SUBCELLS).abs() <= 1, "{point:?}");
            assert!((point.depth - t).abs() < 1e-5, "{point:?}");
        }
        assert!((grid.cell_area() - 0.16).abs() < 1e-9);
    }
}
