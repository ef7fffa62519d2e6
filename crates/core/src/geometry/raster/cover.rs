//! Which points of a grid a triangle covers, exactly.
//!
//! Corners are rounded to 1/65,536 of a cell. A row of the grid at height y lies between two edges of a triangle; the edge from
//! p to q meets it at
//!
//! ```text
//! x(y) = px + (y - py) (qx - px) / (qy - py)
//! ```
//!
//! The triangle covers the columns from `ceil(x_left)` to before `ceil(x_right)`, in the rows from `ceil(y_lowest)` to before
//! `ceil(y_highest)`. So a point *on* an edge belongs to the triangle if the edge is its left or lower one; for the triangle on
//! the other side the same edge is a right or an upper one. Of two neighbours exactly one covers the point, and of all triangles
//! around a corner exactly one covers the corner: a line meets a closed surface neither twice at one place nor never.
//!
//! In double precision x is right but for 2⁻³⁶ of a cell. Only where it is as near as that to a whole column, which is hardly ever
//! but where corners lie on the points of the grid, an integer division decides. Cost: three divisions a triangle, then two
//! multiplications a row for its ends. Depth and barycentric coordinates are interpolated along the row, for several points at
//! once.

use crate::mesh::LANES;
use std::ops::Range;

/// Subcells along the edge of a cell; the points of the grid have whole cells as coordinates.
pub const SUBCELLS: i64 = 1 << 16;
/// Where edges meet rows is known to better than this [cells].
const ROUNDING: f64 = 1.0 / (1u64 << 34) as f64;
/// Added to a number, it leaves no bits behind the point, and a small number's integer in the last bits.
const WHOLE: f64 = 1.5 * (1u64 << 52) as f64;

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

    /// Columns and rows, of a grid of `cells` by `cells`, outside of which it covers nothing.
    #[inline]
    pub fn bounds(&self, cells: u32) -> [Range<u32>; 2] {
        let range = |[a, b, c]: [i32; 3]| {
            let whole = |k: i32| ceil(k).clamp(0, cells as i32) as u32;
            whole(a.min(b).min(c))..whole(a.max(b).max(c))
        };
        [range(self.x), range(self.y)]
    }

    /// Which points it covers; `None` if it is seen edge-on and covers none.
    #[inline(always)]
    pub fn coverage(&self) -> Option<Coverage> {
        let corners = [0, 1, 2].map(|k| [i64::from(self.x[k]), i64::from(self.y[k])]);
        let [a, b, c] = corners;
        let (ab, ac) = (from(a, b), from(a, c));
        // Counter-clockwise in a frame that looks along the lines: they leave through the front.
        let area = cross(ab, ac);
        if area == 0 {
            return None;
        }
        let share = 1.0 / area as f32;
        let weight =
            |[dx, dy]: [i64; 2]| Weight { at_zero: cross([dx, dy], a), dx: dx * SUBCELLS, dy: dy * SUBCELLS, share };
        let [first, second, third] = self.depth;
        Some(Coverage {
            back: area > 0,
            halves: halves(corners),
            weights: [weight([-ac[0], -ac[1]]), weight(ab)],
            depth: [first, second - first, third - first],
        })
    }
}

/// Whole cells at or after so many subcells.
#[inline(always)]
fn ceil(subcells: i32) -> i32 {
    (subcells + (SUBCELLS as i32 - 1)) >> SUBCELLS.trailing_zeros()
}

#[inline(always)]
fn from([px, py]: [i64; 2], [qx, qy]: [i64; 2]) -> [i64; 2] {
    [qx - px, qy - py]
}

#[inline(always)]
fn cross([ax, ay]: [i64; 2], [bx, by]: [i64; 2]) -> i64 {
    ax * by - ay * bx
}

/// The points of a grid that a triangle covers.
#[derive(Clone, Debug)]
pub struct Coverage {
    /// Whether lines meet its back.
    pub back: bool,
    /// Below and above the middle corner.
    pub halves: [Half; 2],
    /// Of the second and the third corner.
    weights: [Weight; 2],
    /// Depth [m] of the first corner, and what the others lie beyond it.
    depth: [f32; 3],
}

impl Coverage {
    /// What it covers of `row`, one of those of `half`, within these columns; it may be nothing.
    #[inline(always)]
    pub fn row(&self, half: &Half, row: i32, columns: &Range<i32>) -> Row {
        let first = half.left.column(row).max(columns.start);
        let end = half.right.column(row).min(columns.end);
        Row {
            row,
            first,
            length: (end - first).max(0) as u32,
            start: self.weights.map(|weight| weight.at(first, row)),
            growth: self.weights.map(|weight| weight.growth()),
            depth: self.depth,
        }
    }
}

/// Neighbouring points of a row that a triangle covers.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub row: i32,
    /// Column of the first, and how many there are.
    pub first: i32,
    pub length: u32,
    /// Barycentric coordinates of the first, and what they grow from one to the next.
    start: [f32; 2],
    growth: [f32; 2],
    depth: [f32; 3],
}

impl Row {
    /// Where the lines of [`LANES`] points from the k-th on meet the triangle: distances [m], and barycentric coordinates u and v.
    /// Beyond the end of the row they mean nothing, but lie on the triangle too.
    #[inline(always)]
    pub fn points(&self, k: i32) -> [[f32; LANES]; 3] {
        let [mut t, mut u, mut v] = [[0.0; LANES]; 3];
        for lane in 0..LANES {
            let column = (k + lane as i32) as f32;
            let weight = |corner: usize| self.start[corner] + column * self.growth[corner];
            // Rounding must not lead out of the triangle.
            u[lane] = between(weight(0), 1.0);
            v[lane] = between(weight(1), 1.0 - u[lane]);
            t[lane] = self.depth[0] + u[lane] * self.depth[1] + v[lane] * self.depth[2];
        }
        [t, u, v]
    }
}

/// The nearest number from zero to `most`.
#[inline(always)]
fn between(x: f32, most: f32) -> f32 {
    let x = if x > 0.0 { x } else { 0.0 };
    if x < most { x } else { most }
}

/// The part of a triangle above its lowest corner, or that below its highest one.
#[derive(Clone, Debug)]
pub struct Half {
    pub rows: Range<i32>,
    left: Border,
    right: Border,
}

/// Both halves of the triangle with these corners, the lower one first.
#[inline(always)]
fn halves(corners: [[i64; 2]; 3]) -> [Half; 2] {
    // Corners in the order of their heights: numbers are chosen, for branches would be guessed wrong.
    let [a, b, c] = [0, 1, 2].map(|k| corners[k as usize][1] << 2 | k);
    let (lowest, highest) = (a.min(b).min(c), a.max(b).max(c));
    let [low, middle, high] = [lowest, a + b + c - lowest - highest, highest].map(|key| corners[(key & 3) as usize]);
    let (long, lower, upper) = (Border::new(low, high), Border::new(low, middle), Border::new(middle, high));
    let long_is_left = cross(from(low, high), from(low, middle)) < 0;
    let half = |short, rows| {
        let (left, right) = if long_is_left { (long, short) } else { (short, long) };
        Half { rows, left, right }
    };
    let [first, between, end] = [low, middle, high].map(|corner| ceil(corner[1] as i32));
    [half(lower, first..between), half(upper, between..end)]
}

/// An edge that bounds what is covered of a row.
#[derive(Clone, Copy, Debug)]
struct Border {
    /// The lower end, and the way to the upper one [subcells].
    start: [i64; 2],
    way: [i64; 2],
    /// Columns for each row.
    slope: f64,
}

impl Border {
    #[inline(always)]
    fn new(low: [i64; 2], high: [i64; 2]) -> Border {
        let way = from(low, high);
        Border { start: low, way, slope: way[0] as f64 / way[1] as f64 }
    }

    /// The first column at or after the edge in `row`, one of those between its ends.
    #[inline(always)]
    fn column(&self, row: i32) -> i32 {
        const CELL: f64 = 1.0 / SUBCELLS as f64;
        let [x, y] = self.start.map(|subcells| subcells as i32 as f64 * CELL);
        // Half a cell on, the nearest column is the one at or after x.
        let x = x + (f64::from(row) - y) * self.slope + 0.5;
        let rounded = x + WHOLE;
        let beyond = x - (rounded - WHOLE);
        if beyond.abs() < 0.5 - ROUNDING { rounded.to_bits() as i32 } else { self.exact_column(row) }
    }

    #[cold]
    fn exact_column(&self, row: i32) -> i32 {
        let ([px, py], [dx, dy]) = (self.start, self.way);
        let across = px * dy + (i64::from(row) * SUBCELLS - py) * dx;
        -(-across).div_euclid(dy * SUBCELLS) as i32
    }
}

/// The barycentric coordinate of a corner: the edge function of the edge opposite to it over that of the corner itself (Pineda,
/// A Parallel Algorithm for Polygon Rasterization, 1988).
#[derive(Clone, Copy, Debug)]
struct Weight {
    at_zero: i64,
    /// The edge [subcells / cell].
    dx: i64,
    dy: i64,
    /// One over twice the area of the triangle [1/subcells²].
    share: f32,
}

impl Weight {
    #[inline(always)]
    fn at(&self, column: i32, row: i32) -> f32 {
        (self.dx * i64::from(row) - self.dy * i64::from(column) - self.at_zero) as f32 * self.share
    }

    /// From one column to the next.
    #[inline(always)]
    fn growth(&self) -> f32 {
        -self.dy as f32 * self.share
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Hit;
    use crate::math::hash::mix;
    use glam::Vec2;

    const CELLS: u32 = 16;

    fn triangle(corners: [[i64; 2]; 3]) -> Projected {
        Projected { x: corners.map(|p| p[0] as i32), y: corners.map(|p| p[1] as i32), depth: [1.0, 2.0, 4.0] }
    }

    /// The points in these ranges that a triangle covers, and the hits of their lines.
    fn hits(triangle: &Projected, [columns, rows]: [Range<u32>; 2]) -> Vec<(u32, u32, Hit)> {
        let Some(coverage) = triangle.coverage() else { return Vec::new() };
        let mut hits = Vec::new();
        let [columns, rows] = [columns, rows].map(|range| range.start as i32..range.end as i32);
        for half in &coverage.halves {
            for row in half.rows.clone().filter(|row| rows.contains(row)) {
                let row = coverage.row(half, row, &columns);
                for k in 0..row.length {
                    let [t, u, v] = row.points((k / LANES as u32 * LANES as u32) as i32);
                    let (lane, back) = (k as usize % LANES, coverage.back);
                    let hit = Hit { t: t[lane], triangle: 0, uv: Vec2::new(u[lane], v[lane]), back };
                    hits.push((row.first as u32 + k, row.row as u32, hit));
                }
            }
        }
        hits
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
