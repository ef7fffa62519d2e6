//! All crossings of a bundle of parallel lines, by orthographic rasterisation into a list for every line.
//!
//! The lines form a regular grid (see [`grid`]), so a triangle need not be searched for: the lines that cross it are the
//! points of the grid that its projection covers (see [`cover`]). The crossings of a tile of lines are collected triangle by
//! triangle, in stages that do the same for eight of them at once, and sorted into lists (see [`tile`]). Neighbouring lines cross the same triangles: this coherence makes a crossing several times cheaper than by rays
//! (Szirmay-Kalos & Purgathofer, Global ray-bundle tracing with hardware acceleration, EGWR 1998).
//!
//! Corners are rounded to 1/65,536 of a cell, so a crossing is where the ray of [`grid::Grid::line`] has it but for that.
//! Depths are interpolated between the corners' and never lie beyond them.
//!
//! Cost: O(triangles) to project and to sort into tiles, once for a direction, about 50 bytes a triangle and 12 a vertex; then
//! O(crossings).

#[cfg(target_arch = "x86_64")]
mod avx2;
pub mod cover;
pub mod grid;
mod tile;

pub use tile::{MetTriangle, Points, TileLists};

use super::{Hit, Lists};
use crate::scene::Scene;
use cover::{Point, Projected};
use glam::{Vec2, Vec3};
use grid::Grid;

/// Triangles, projected onto a grid and sorted into its tiles.
#[derive(Clone, Debug)]
pub struct Raster {
    grid: Grid,
    triangles: Vec<Projected>,
    /// Numbers of the triangles that may cover points of each tile.
    tiles: Lists<u32>,
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

    /// Fills `found` with the crossings of the lines of `tile`, as `cross` makes them: a list for each of its cells, row by row;
    /// no lists for a tile that does not exist.
    pub fn crossings<C: Cross>(&self, tile: u32, cross: &C, found: &mut TileLists<C::Crossing>) {
        #[cfg(target_arch = "x86_64")]
        if avx2::crossings(self, tile, cross, found) {
            return;
        }
        self.fill(tile, cross, found);
    }

    /// Does what [`Raster::crossings`] says, on the registers that the function has into which this is inlined.
    #[inline(always)]
    fn fill<C: Cross>(&self, tile: u32, cross: &C, found: &mut TileLists<C::Crossing>) {
        let [columns, rows] = self.grid.cells_of(tile).map(|cells| cells.start as i32..cells.end as i32);
        let width = columns.end - columns.start;
        let cells = (width * (rows.end - rows.start)) as usize;
        found.clear();
        for &number in self.tiles.get(tile as usize) {
            let Some(coverage) = self.triangles[number as usize].coverage() else { continue };
            found.reserve(cells, C::NONE);
            for half in &coverage.halves {
                for row in half.rows.start.max(rows.start)..half.rows.end.min(rows.end) {
                    let row = coverage.row(half, row, &columns);
                    found.push((row.row - rows.start) * width + row.first - columns.start, &row);
                }
            }
            found.finish(number, coverage.back);
        }
        found.cross(cross);
        found.sort(cells);
    }

    /// The hits of the lines of `tile`, as rays would have them.
    pub fn hits(&self, tile: u32) -> TileLists<Hit> {
        let mut found = TileLists::default();
        self.crossings(tile, &Hits, &mut found);
        found
    }
}

/// What makes crossings of points where lines meet triangles.
pub trait Cross {
    type Crossing: Copy;
    /// Any crossing, to fill memory with.
    const NONE: Self::Crossing;

    /// Makes a crossing of each of the `points`. To be inlined always: callers are compiled for several kinds of machines.
    fn cross(&self, points: &mut Points, crossings: &mut [Self::Crossing]);
}

/// Makes the hits that rays would have.
struct Hits;

impl Cross for Hits {
    type Crossing = Hit;
    const NONE: Hit = Hit::MISS;

    #[inline(always)]
    fn cross(&self, Points { triangles, t, u, v, .. }: &mut Points, hits: &mut [Hit]) {
        for met in *triangles {
            for k in met.points.clone() {
                hits[k] = Hit { t: t[k], triangle: met.triangle, uv: Vec2::new(u[k], v[k]), back: met.back };
            }
        }
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
        (0..grid.tiles()).map(|tile| raster.hits(tile).iter().map(|list| list.len()).sum::<usize>()).sum()
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

    /// Triangles of all shapes, from specks to needles as long as the grid.
    fn soup() -> Vec<[Vec3; 3]> {
        let random = |k: u64| (crate::math::hash::mix(k) % (1 << 20)) as f32 / (1 << 19) as f32 - 1.0;
        let point = |k: u64| Vec3::new(random(3 * k), random(3 * k + 1), random(3 * k + 2)) * 0.5;
        let triangle = |k: u64| {
            let (size, thin) = (0.5f32.powi(k as i32 % 8), 0.5f32.powi(k as i32 / 8 % 10));
            let a = point(3 * k);
            [a, a + size * point(3 * k + 1), a + size * thin * point(3 * k + 2)]
        };
        (0..800).map(triangle).collect()
    }

    #[test]
    fn any_registers_give_the_same_bits() {
        let grid = Grid::new((Vec3::ZERO, 1.0), Vec3::new(0.6, 0.0, 0.8), Vec2::splat(0.3), 150);
        let (raster, mut crossings) = (raster(grid, &soup()), 0);
        for tile in 0..grid.tiles() {
            let (here, mut plain) = (raster.hits(tile), TileLists::default());
            raster.fill(tile, &Hits, &mut plain);
            let lists = |found: &TileLists<Hit>| found.iter().map(|list| list.collect()).collect::<Vec<Vec<Hit>>>();
            assert_eq!(lists(&here), lists(&plain));
            assert!(here.iter().all(|list| list.map(|hit| hit.t).collect::<Vec<f32>>().is_sorted()));
            crossings += here.iter().flatten().count();
        }
        assert!(crossings > 5_000, "{crossings}");
    }
}
