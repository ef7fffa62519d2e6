//! The corners of elements, numbered: the grid points of every side of every patch.
//!
//! A side with m divisions has (m + 1)(m + 2) / 2 grid points. Point (i, j) lies at the barycentric coordinates
//! (i / m, j / m) of the patch; row i holds the points (i, 0) ... (i, m - i). A point on an edge that two patches share is counted
//! once for each of them: which of these are the same place on the same surface is for [`crate::math::weld`] and
//! [`super::crease`] to say.

use crate::mesh::{ElementMesh, Place, cells};
use glam::Vec2;

/// Numbers of grid points: side by side, row by row.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Number of the first grid point of each patch's front, which those of the back follow; then the number in all.
    first: Vec<usize>,
}

/// One side of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Side {
    pub patch: u32,
    pub back: bool,
}

impl Side {
    pub fn triangle(self, mesh: &ElementMesh) -> u32 {
        mesh.triangle_of_patch(self.patch)
    }
}

impl Grid {
    pub fn new(mesh: &ElementMesh) -> Grid {
        let (mut first, mut total) = (Vec::new(), 0);
        for patch in mesh.patches() {
            // Those in between are split, and have no points.
            first.resize(patch as usize + 1, total);
            total += points_on_side(mesh.divisions(patch)) * backs(mesh, patch).len();
        }
        first.push(total);
        Grid { first }
    }

    /// Number of grid points in all.
    pub fn len(&self) -> usize {
        self.first.last().copied().unwrap_or(0)
    }

    /// Number of the grid point (i, j) of `side`.
    pub fn number(&self, mesh: &ElementMesh, side: Side, [i, j]: [u32; 2]) -> usize {
        let m = mesh.divisions(side.patch);
        let row = i as usize * (2 * usize::from(m) + 3 - i as usize) / 2;
        let back = if side.back { points_on_side(m) } else { 0 };
        self.first[side.patch as usize] + back + row + j as usize
    }

    /// Numbers of the three corners of a place where an element lies, in the orientation of the triangle's front.
    pub fn corners_at(&self, mesh: &ElementMesh, Place { patch, back, cell, .. }: Place) -> [usize; 3] {
        let corners = cells::grid_corners(cell, mesh.divisions(patch));
        corners.map(|ij| self.number(mesh, Side { patch, back }, ij))
    }

    /// All sides, in the order of their grid points.
    pub fn sides<'a>(&self, mesh: &'a ElementMesh) -> impl Iterator<Item = Side> + use<'a> {
        mesh.patches().flat_map(|patch| backs(mesh, patch).iter().map(move |&back| Side { patch, back }))
    }
}

/// The sides that `patch` has: front, and perhaps back.
fn backs(mesh: &ElementMesh, patch: u32) -> &'static [bool] {
    if mesh.is_two_sided(mesh.triangle_of_patch(patch)) { &[false, true] } else { &[false] }
}

/// Number of grid points of a side with `m` divisions.
pub fn points_on_side(m: u16) -> usize {
    let m = usize::from(m);
    (m + 1) * (m + 2) / 2
}

/// Grid points (i, j) of a side with `m` divisions, in the order of their numbers.
pub fn points(m: u16) -> impl Iterator<Item = [u32; 2]> {
    let m = u32::from(m);
    (0..=m).flat_map(move |i| (0..=m - i).map(move |j| [i, j]))
}

/// The pieces into which `m` divisions cut the three edges of a patch, each from grid point to grid point.
pub fn border(m: u16) -> impl Iterator<Item = [[u32; 2]; 2]> {
    let m = u32::from(m);
    (0..m).flat_map(move |k| {
        let sloped = [[k, m - k], [k + 1, m - k - 1]];
        [[[k, 0], [k + 1, 0]], [[0, k], [0, k + 1]], sloped]
    })
}

/// Barycentric coordinates on its patch of a grid point.
pub fn barycentric([i, j]: [u32; 2], m: u16) -> Vec2 {
    Vec2::new(i as f32, j as f32) / f32::from(m)
}

/// Barycentric coordinates on its triangle of a grid point of `patch`.
pub fn on_triangle(mesh: &ElementMesh, patch: u32, point: [u32; 2]) -> Vec2 {
    mesh.on_triangle(patch, barycentric(point, mesh.divisions(patch)))
}
