//! All crossings of a bundle of parallel lines, by orthographic rasterisation into a list for every line.
//!
//! The lines form a regular grid (see [`grid`]), so a triangle need not be searched for: the lines that cross it are the
//! points of the grid that its projection covers (see [`cover`]). The crossings of a tile of lines are collected triangle by
//! triangle, sorted into lists by counting, and each list is sorted by depth (the A-buffer of Carpenter 1984, without its
//! masks). Neighbouring lines cross the same triangles: this coherence makes a crossing several times cheaper than by rays
//! (Szirmay-Kalos & Purgathofer, Global ray-bundle tracing with hardware acceleration, EGWR 1998).
//!
//! Corners are rounded to 1/65,536 of a cell, so a crossing is where the ray of [`grid::Grid::line`] has it but for that.
//! Depths are interpolated between the corners' and never lie beyond them.
//!
//! Cost: O(triangles) to project and to sort into tiles, once for a direction, about 50 bytes a triangle and 12 a vertex; then
//! O(crossings).

pub mod cover;
pub mod grid;

use super::{Along, Hit, HitLists, Lists};
use crate::scene::Scene;
use cover::{Point, Projected};
use glam::{Vec2, Vec3};
use grid::Grid;
use std::ops::Range;

/// Triangles, projected onto a grid and sorted into its tiles.
#[derive(Clone, Debug)]
pub struct Raster {
    grid: Grid,
    triangles: Vec<Projected>,
    /// Numbers of the triangles that may cover points of each tile.
    tiles: Lists<u32>,
}

/// The crossings of one tile: a list for each of its lines, row by row, and the working memory to make them.
#[derive(Clone, Debug)]
pub struct TileLists<T> {
    /// Crossings in the order of triangles, each with the number of its line, and beyond them what was there before.
    fragments: Vec<(u32, T)>,
    pub lists: Lists<T>,
}

impl Raster {
    /// Projects triangles, given by the numbers of their corners among `vertices` [m]. Those with a coordinate that is not
    /// finite are never crossed.
    pub fn new(grid: Grid, vertices: impl Iterator<Item = Vec3>, triangles: impl Iterator<Item = [u32; 3]>) -> Raster {
        let points: Vec<Point> = vertices.map(grid.projection()).collect();
        let mut projected = Vec::with_capacity(triangles.size_hint().0);
        let (mut in_tiles, mut tiles) = (Vec::with_capacity(projected.capacity()), Lists::default());
        for (number, vertices) in (0..).zip(triangles) {
            let triangle = Projected::new(vertices.map(|vertex| points[vertex as usize]));
            in_tiles.extend(grid.tiles_of(triangle.bounds(grid.cells())).map(|tile| (tile, number)));
            projected.push(triangle);
        }
        tiles.group(grid.tiles() as usize, &in_tiles);
        Raster { grid, triangles: projected, tiles }
    }

    /// The triangles of `scene`.
    pub fn of(scene: &Scene, grid: Grid) -> Raster {
        let vertices = scene.vertices.iter().map(|vertex| vertex.position);
        Raster::new(grid, vertices, scene.triangles.iter().map(|triangle| triangle.vertices))
    }

    /// Fills `lists` with the crossings of the lines of `tile`, a list for each of its cells, row by row; no lists for a tile
    /// that does not exist.
    ///
    /// `meet(k, back)` is asked once for triangle k, which lines meet from behind or not, and gives a function that makes a
    /// crossing of it, from its distance [m] and barycentric coordinates.
    pub fn crossings<T: Along, M: Fn(f32, Vec2) -> T>(
        &self,
        tile: u32,
        meet: impl Fn(u32, bool) -> M,
        TileLists { fragments, lists }: &mut TileLists<T>,
    ) {
        let [columns, rows] = self.grid.cells_of(tile);
        let width = columns.end - columns.start;
        let common = |a: Range<u32>, b: &Range<u32>| a.start.max(b.start)..a.end.min(b.end);
        let mut count = 0;
        for &number in self.tiles.get(tile as usize) {
            let triangle = &self.triangles[number as usize];
            let Some(coverage) = triangle.coverage() else { continue };
            let crossing = meet(number, coverage.back);
            let [across, up] = triangle.bounds(self.grid.cells());
            let across = common(across, &columns);
            for row in common(up, &rows) {
                let Some(covered) = coverage.row(row, &across) else { continue };
                let line = (row - rows.start) * width + covered.first - columns.start;
                let (begin, end) = (count, count + covered.length as usize);
                if end > fragments.len() {
                    let (t, uv) = covered.at(0);
                    fragments.resize(2 * end, (line, crossing(t, uv)));
                }
                for (k, fragment) in (0..).zip(&mut fragments[begin..end]) {
                    let (t, uv) = covered.at(k);
                    *fragment = (line + k, crossing(t, uv));
                }
                count = end;
            }
        }
        lists.group((width * (rows.end - rows.start)) as usize, &fragments[..count]);
    }

    /// The hits of the lines of `tile`, as rays would have them.
    pub fn hits(&self, tile: u32) -> HitLists {
        let mut found = TileLists::default();
        self.crossings(tile, |triangle, back| move |t, uv| Hit { t, triangle, uv, back }, &mut found);
        found.lists
    }
}

impl<T> Default for TileLists<T> {
    fn default() -> TileLists<T> {
        TileLists { fragments: Vec::new(), lists: Lists::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: u32 = 100;

    fn raster(grid: Grid, triangles: &[[Vec3; 3]]) -> Raster {
        let number = |k: usize| [0, 1, 2].map(|corner| 3 * k as u32 + corner);
        Raster::new(grid, triangles.iter().copied().flatten(), (0..triangles.len()).map(number))
    }

    /// Crossings of all lines along z with triangles in the ball of radius 1 m about the origin.
    fn crossings(triangles: &[[Vec3; 3]]) -> usize {
        let grid = Grid::new((Vec3::ZERO, 1.0), Vec3::Z, Vec2::splat(0.5), GRID);
        let raster = raster(grid, triangles);
        (0..grid.tiles()).map(|tile| raster.hits(tile).iter().map(<[_]>::len).sum::<usize>()).sum()
    }

    #[test]
    fn a_triangle_is_crossed_by_its_share_of_the_lines() {
        // Half of the square [-0.6, 0.6]², over several tiles: 60² cells, half of those on the diagonal.
        let [a, b, c] = [Vec3::new(-0.6, -0.6, 0.0), Vec3::new(0.6, -0.6, 0.1), Vec3::new(0.6, 0.6, 0.2)];
        let d = Vec3::new(-0.6, 0.6, 0.0);
        assert_eq!(crossings(&[[a, b, c], [a, c, d]]), 3600);
        assert_eq!(crossings(&[[a, b, c]]) + crossings(&[[d, a, c]]), 3600);
        assert!(crossings(&[[a, b, c]]).abs_diff(1800) <= 30);
    }

    #[test]
    fn what_is_not_finite_or_not_there_is_not_crossed() {
        assert_eq!(crossings(&[[Vec3::NAN, Vec3::X, Vec3::Y], [Vec3::X, Vec3::Y, Vec3::INFINITY]]), 0);
        assert_eq!(crossings(&[]), 0);
        for radius in [f32::NAN, f32::INFINITY] {
            let grid = Grid::new((Vec3::ZERO, radius), Vec3::Z, Vec2::ZERO, 3);
            let raster = raster(grid, &[[Vec3::X, Vec3::Y, Vec3::Z]]);
            assert_eq!(raster.hits(0).iter().flatten().count(), 0);
        }
        let grid = Grid::new((Vec3::ZERO, 1.0), Vec3::Z, Vec2::ZERO, 3);
        let raster = raster(grid, &[[Vec3::X, Vec3::Y, Vec3::ZERO]]);
        assert!([1, 2, u32::MAX].into_iter().all(|tile| raster.hits(tile).is_empty()), "there is one tile");
    }
}
