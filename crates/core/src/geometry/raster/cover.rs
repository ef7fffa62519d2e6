//! Which points of a grid a triangle covers, exactly.
//!
//! Corners are rounded to 1/65,536 of a cell. The edge function of the edge from p to q,
//!
//! ```text
//! E(x, y) = (qx - px) (y - py) - (qy - py) (x - px)        (Pineda, A Parallel Algorithm for Polygon Rasterization, 1988)
//! ```
//!
//! is then an integer below 2^62 and tells without any rounding on which side of the edge a point lies. A point *on* an edge
//! belongs to the triangle if the edge is a left one, or a horizontal one with the triangle above it. For the triangle on the
//! other side the same edge is a right one, or has it below: of two neighbours exactly one covers the point, and of all
//! triangles around a corner exactly one covers the corner. So a line meets a closed surface neither twice at one place nor
//! never.
//!
//! Each edge bounds the covered points of a row on one side, by an integer division. Cost: three divisions a row. Depth and
//! barycentric coordinates are interpolated along the row.

use glam::Vec2;
use std::ops::Range;

/// Subcells along the edge of a cell; the points of the grid have whole cells as coordinates.
pub const SUBCELLS: i64 = 1 << 16;

/// A point in the space of a grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Across the lines [subcells].
    pub x: i32,
    pub y: i32,
    /// Along the lines [m]; what is not finite belongs to a point that nothing can be made of.
    pub depth: f32,
}

/// A triangle in the space of a grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected {
    x: [i32; 3],
    y: [i32; 3],
    depth: [f32; 3],
}

impl Projected {
    /// What no point of a grid lies in.
    const NOTHING: Projected = Projected { x: [1; 3], y: [1; 3], depth: [0.0; 3] };

    /// The triangle with these corners, or nothing if one of them is not finite.
    #[inline]
    pub fn new(corners: [Point; 3]) -> Projected {
        let depth = corners.map(|corner| corner.depth);
        if !depth.iter().all(|depth| depth.is_finite()) {
            return Projected::NOTHING;
        }
        Projected { x: corners.map(|corner| corner.x), y: corners.map(|corner| corner.y), depth }
    }

    /// Columns and rows, of a grid of `cells` by `cells`, of the box around the triangle.
    #[inline]
    pub fn bounds(&self, cells: u32) -> [Range<u32>; 2] {
        let range = |corners: [i32; 3]| {
            let [a, b, c] = corners.map(i64::from);
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            let column = |k: i64| k.clamp(0, i64::from(cells)) as u32;
            column(-(-low).div_euclid(SUBCELLS))..column(high.div_euclid(SUBCELLS) + 1)
        };
        [range(self.x), range(self.y)]
    }

    /// Which points it covers; `None` if it is seen edge-on and covers none.
    #[inline]
    pub fn coverage(&self) -> Option<Coverage> {
        let [a, b, c] = [0, 1, 2].map(|k| [i64::from(self.x[k]), i64::from(self.y[k])]);
        // Counter-clockwise in a frame that looks along the lines: they leave through the front.
        let area = Edge::new(a, b).at_subcell(c);
        let back = area > 0;
        let edges = |ends: [[[i64; 2]; 2]; 3]| ends.map(|[p, q]| Edge::new(p, q));
        let [first, second, third] = self.depth;
        (area != 0).then(|| Coverage {
            back,
            edges: edges(if back { [[b, c], [c, a], [a, b]] } else { [[c, b], [a, c], [b, a]] }),
            share: 1.0 / area.abs() as f32,
            depth: [first, second - first, third - first],
        })
    }
}

/// The points of a grid that a triangle covers.
#[derive(Clone, Copy, Debug)]
pub struct Coverage {
    /// Whether lines meet its back.
    pub back: bool,
    /// The edges opposite its corners, with the triangle on the left.
    edges: [Edge; 3],
    /// One over twice its area, the greatest value of each edge function [1/subcells²].
    share: f32,
    /// Depth [m] of the first corner, and what the others lie beyond it.
    depth: [f32; 3],
}

impl Coverage {
    /// What it covers of `row`, within these columns, if it is anything.
    #[inline]
    pub fn row(&self, row: u32, columns: &Range<u32>) -> Option<Row> {
        let all = i64::from(columns.start)..i64::from(columns.end);
        let covered = self.edges.iter().fold(all, |columns, edge| edge.clip(row, columns));
        if covered.is_empty() {
            return None;
        }
        let [_, of_u, of_v] = &self.edges;
        let weight = |edge: &Edge| edge.at(covered.start, row) as f32 * self.share;
        let growth = |edge: &Edge| edge.per_column as f32 * self.share;
        Some(Row {
            first: covered.start as u32,
            length: (covered.end - covered.start) as u32,
            start: [weight(of_u), weight(of_v)],
            growth: [growth(of_u), growth(of_v)],
            depth: self.depth,
        })
    }
}

/// Neighbouring points of a row that a triangle covers.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Column of the first, and how many there are.
    pub first: u32,
    pub length: u32,
    /// Barycentric coordinates of the first, and what they grow from one to the next.
    start: [f32; 2],
    growth: [f32; 2],
    depth: [f32; 3],
}

impl Row {
    /// Distance [m] at which the line of the k-th of the points meets the triangle, and the barycentric coordinates there.
    #[inline(always)]
    pub fn at(&self, k: u32) -> (f32, Vec2) {
        let weight = |coordinate: usize| self.start[coordinate] + k as f32 * self.growth[coordinate];
        // Rounding must not lead out of the triangle.
        let u = weight(0).clamp(0.0, 1.0);
        let v = weight(1).max(0.0).min(1.0 - u);
        (self.depth[0] + u * self.depth[1] + v * self.depth[2], Vec2::new(u, v))
    }
}

/// The edge function of a directed edge at the points of the grid; positive to the left of it.
#[derive(Clone, Copy, Debug)]
struct Edge {
    at_zero: i64,
    per_column: i64,
    per_row: i64,
    /// Least value of the points that belong to the triangle on the left: 0 if it owns the edge, or else 1.
    least: i64,
}

impl Edge {
    #[inline(always)]
    fn new([px, py]: [i64; 2], [qx, qy]: [i64; 2]) -> Edge {
        let (dx, dy) = (qx - px, qy - py);
        let owned = dy < 0 || (dy == 0 && dx > 0);
        Edge {
            at_zero: dy * px - dx * py,
            per_column: -dy * SUBCELLS,
            per_row: dx * SUBCELLS,
            least: i64::from(!owned),
        }
    }

    #[inline(always)]
    fn at(&self, column: i64, row: u32) -> i64 {
        self.at_zero + self.per_column * column + self.per_row * i64::from(row)
    }

    #[inline(always)]
    fn at_subcell(&self, [x, y]: [i64; 2]) -> i64 {
        self.at_zero + self.per_column / SUBCELLS * x + self.per_row / SUBCELLS * y
    }

    /// Those of the `columns` of `row` that lie on the left of the edge, or on it if it is owned.
    #[inline(always)]
    fn clip(&self, row: u32, Range { start, end }: Range<i64>) -> Range<i64> {
        // The condition is per_column * column >= lacking.
        let lacking = self.least - self.at(0, row);
        match self.per_column {
            0 if lacking > 0 => start..start,
            0 => start..end,
            growth if growth > 0 => start.max(-(-lacking).div_euclid(growth))..end,
            growth => start..end.min((-lacking).div_euclid(-growth) + 1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Hit;
    use crate::math::hash::mix;

    const CELLS: u32 = 16;

    fn triangle(corners: [[i64; 2]; 3]) -> Projected {
        Projected { x: corners.map(|p| p[0] as i32), y: corners.map(|p| p[1] as i32), depth: [1.0, 2.0, 4.0] }
    }

    /// The points in these ranges that a triangle covers, and the hits of their lines.
    fn hits(triangle: &Projected, [columns, rows]: [Range<u32>; 2]) -> Vec<(u32, u32, Hit)> {
        let Some(coverage) = triangle.coverage() else { return Vec::new() };
        let hits = |row| {
            let hit = move |(t, uv)| Hit { t, triangle: 0, uv, back: coverage.back };
            let covered = coverage.row(row, &columns).into_iter();
            covered
                .flat_map(move |covered| (0..covered.length).map(move |k| (covered.first + k, row, hit(covered.at(k)))))
        };
        rows.flat_map(hits).collect()
    }

    /// How often each point of the grid is covered.
    fn covered(triangles: &[Projected]) -> Vec<u32> {
        let mut times = vec![0; (CELLS * CELLS) as usize];
        for (column, row, _) in triangles.iter().flat_map(|triangle| hits(triangle, triangle.bounds(CELLS))) {
            times[(row * CELLS + column) as usize] += 1;
        }
        times
    }

    /// A square cut into triangles, whose corners inside are moved about: on points of the grid, or anywhere.
    fn square(seed: u64, on_points: bool) -> Vec<Projected> {
        const N: u64 = 6;
        let corner = |i: u64, j: u64| {
            let inside = |k: u64| (1..N).contains(&k);
            let moved = |k: u64, salt: u64| {
                let random = mix(seed ^ mix(N * i + j + 100 * salt)) % 65_536;
                let shift = if on_points { random % 2 * 65_536 } else { random } as i64;
                2 * k as i64 * SUBCELLS + SUBCELLS + if inside(i) && inside(j) { shift } else { 0 }
            };
            [moved(i, 1), moved(j, 2)]
        };
        let quads = (0..N).flat_map(|i| (0..N).map(move |j| (i, j)));
        let halves = |(i, j)| {
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            if mix(seed + i + N * j).is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, d, b], [c, d, b]] }
        };
        quads.flat_map(halves).map(triangle).collect()
    }

    #[test]
    fn every_point_belongs_to_exactly_one_of_the_triangles_that_share_it() {
        for seed in 0..200 {
            for on_points in [true, false] {
                let times = covered(&square(seed, on_points));
                for (k, times) in (0..).zip(times) {
                    // The square reaches from point 1 to point 13; its left and lower borders belong to it.
                    let inside = (1..13).contains(&(k % CELLS)) && (1..13).contains(&(k / CELLS));
                    assert_eq!(times, u32::from(inside), "seed {seed}, column {}, row {}", k % CELLS, k / CELLS);
                }
            }
        }
    }

    #[test]
    fn hits_are_interpolated_and_know_their_side() {
        let [a, b, c] = [[0, 0], [8 * SUBCELLS, 0], [0, 8 * SUBCELLS]];
        let hit = |uv: Vec2, back| Hit { t: 1.0 + uv.x + 3.0 * uv.y, triangle: 0, uv, back };
        let uv = |row: u32| Vec2::new(0.25, row as f32 / 8.0);
        let expected: Vec<_> = (0..6).map(|row| (2, row, hit(uv(row), true))).collect();
        assert_eq!(hits(&triangle([a, b, c]), [2..3, 0..CELLS]), expected);
        let turned_over = hits(&triangle([a, c, b]), [2..3, 1..2]);
        assert_eq!(turned_over, [(2, 1, hit(Vec2::new(0.125, 0.25), false))]);
    }

    #[test]
    fn what_has_no_area_covers_nothing() {
        let line = triangle([[0, 0], [4 * SUBCELLS, 4 * SUBCELLS], [8 * SUBCELLS, 8 * SUBCELLS]]);
        assert!(covered(&[line, Projected::NOTHING]).iter().all(|&times| times == 0));
    }
}
