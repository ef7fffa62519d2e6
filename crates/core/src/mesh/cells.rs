//! The regular subdivision of a triangle into m² congruent cells.
//!
//! In barycentric coordinates (u, v), row i holds the cells with `floor(u m) = i`: first an upright cell, then a
//! reversed one, and so on, `2 (m - i) - 1` in all. Cell numbers run row by row: `i (2 m - i) + 2 j + reversed`.

use crate::math::whole::{number, smaller, whole};
use glam::Vec2;

/// Number of cells of a triangle with `m` divisions.
pub fn count(m: u16) -> u32 {
    u32::from(m) * u32::from(m)
}

/// The cell at barycentric coordinates `uv`; coordinates on or slightly outside the border belong to the nearest cell.
#[inline]
pub fn at(uv: Vec2, m: u16) -> u32 {
    locate(uv, m).0
}

/// As [`at`], with the barycentric coordinates within the cell, in the order of its [`corners`].
#[inline(always)]
pub fn locate(uv: Vec2, m: u16) -> (u32, Vec2) {
    let size = f32::from(m);
    let (x, y) = (uv.x * size, uv.y * size);
    let i = smaller(whole(x), size - 1.0);
    let j = smaller(whole(y), size - 1.0 - i);
    let within = Vec2::new(x - i, y - j);
    // Half the points lie in reversed cells, in no order: a branch would be guessed wrong at every second one.
    let reversed = (within.x + within.y > 1.0) & (i + j + 2.0 <= size);
    let mirrored = if reversed { 1.0 } else { 0.0 };
    let (i, odd) = (number(i), number(2.0 * j + mirrored));
    (i * (2 * u32::from(m) - i) + odd, mirrored + (1.0 - 2.0 * mirrored) * within)
}

/// Barycentric coordinates of the corners of `cell`, in the orientation of the triangle.
pub fn corners(cell: u32, m: u16) -> [Vec2; 3] {
    grid_corners(cell, m).map(|[i, j]| Vec2::new(i as f32, j as f32) / f32::from(m))
}

/// Barycentric coordinates of the first corner of `cell`, and the signed length of the edges from it along u and v.
pub fn frame(cell: u32, m: u16) -> (Vec2, f32) {
    let (i, j, reversed) = row(cell, u32::from(m));
    let (beyond, length) = if reversed { (1, -1.0) } else { (0, 1.0) };
    let m = f32::from(m);
    (Vec2::new((i + beyond) as f32, (j + beyond) as f32) / m, length / m)
}

/// Grid coordinates (u m, v m) of the corners of `cell`, in the orientation of the triangle.
pub fn grid_corners(cell: u32, m: u16) -> [[u32; 2]; 3] {
    let (i, j, reversed) = row(cell, u32::from(m));
    if reversed { [[i + 1, j + 1], [i, j + 1], [i + 1, j]] } else { [[i, j], [i + 1, j], [i, j + 1]] }
}

/// Row, place in the row, and whether the cell is reversed.
fn row(cell: u32, m: u32) -> (u32, u32, bool) {
    // Row i starts at i (2m - i), so m - 1 - i is the root of m² - 1 - cell, rounded down: exact in double precision, for the
    // number is below 2^32.
    let i = m - 1 - f64::from(m * m - 1 - cell).sqrt() as u32;
    let k = cell - i * (2 * m - i);
    (i, k / 2, k % 2 == 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn centroids_lead_back_to_their_cells() {
        for m in [1, 2, 3, 7, 64, 255, 1000] {
            for cell in 0..count(m) {
                let [a, b, c] = corners(cell, m);
                assert_eq!(at((a + b + c) / 3.0, m), cell, "m = {m}");
            }
        }
    }

    #[test]
    fn frames_are_those_of_the_corners() {
        for m in [1, 2, 7, 255, u16::MAX] {
            for cell in (0..count(m)).step_by(usize::from(m / 16).max(1).pow(2)).chain([count(m) - 1]) {
                let (corner, length) = frame(cell, m);
                let [a, b, c] = corners(cell, m);
                let close = |p: Vec2, q: Vec2| p.abs_diff_eq(q, 1e-6);
                assert!(a == corner && close(b, a + length * Vec2::X) && close(c, a + length * Vec2::Y), "{m} {cell}");
            }
        }
    }

    #[test]
    fn coordinates_within_a_cell_lead_back_to_the_point() {
        for m in [1, 2, 5, 32] {
            for k in 0..200 {
                let u = (k as f32 * 0.618).fract();
                let uv = Vec2::new(u, (k as f32 * 0.414).fract() * (1.0 - u));
                let (cell, local) = locate(uv, m);
                let [a, b, c] = corners(cell, m);
                assert!((a + local.x * (b - a) + local.y * (c - a) - uv).length() < 1e-5, "m = {m}, {uv}");
            }
        }
    }

    #[test]
    fn cells_cover_the_triangle_once_in_its_orientation() {
        for m in [1, 2, 5, 32] {
            let double_area = |[a, b, c]: [Vec2; 3]| (b - a).perp_dot(c - a);
            let areas: Vec<f32> = (0..count(m)).map(|cell| double_area(corners(cell, m))).collect();
            assert!(areas.iter().all(|a| (a * count(m) as f32 - 1.0).abs() < 1e-3), "m = {m}");
        }
    }

    #[test]
    fn points_on_and_beyond_the_border_have_a_cell() {
        for uv in [Vec2::X, Vec2::Y, Vec2::ZERO, Vec2::splat(0.5), Vec2::new(-0.001, 1.001), Vec2::new(1.001, 0.001)] {
            for m in [1, 2, 3, 100] {
                assert!(at(uv, m) < count(m), "{uv} m = {m}");
            }
        }
    }
}
