//! Patches that consist of others: bisected where the light asks for smaller elements or something stands on them, from a corner to a point of
//! the edge opposite, and the two again; or split into cells, each of which is a patch.
//!
//! Which corner is free: so elements can be long where light changes in one direction only, along the edge of a shadow or a wall. Which point is
//! free, too: the middle where the light asks, and that where a contact meets the edge ([`super::contacts`]). What a point
//! is in the barycentric coordinates of a part is exact, and every lookup goes down the same way: O(depth), and not a step on a patch that
//! is not divided.

use super::{ElementMesh, Patch, cells};
use glam::Vec2;
use std::ops::{Add, Mul};

/// A patch is bisected so often at most for the light: a part of it has then a 2^24th of its area.
pub const MOST_BISECTIONS: usize = 24;
/// Patches lie so deep in one another at most.
pub const MOST_DEPTH: usize = 64;

/// What a patch is cut into.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Division {
    /// m² congruent elements a side, for m divisions along each edge (see [`cells`]).
    Cells(u16),
    /// Two patches, from corner 0, 1 or 2 to the point that lies at this `share` of the edge opposite, from the corner after `from`.
    Bisected { from: u8, share: f32 },
    /// m² congruent patches, where the elements would be.
    Split(u16),
    /// Something stands on some edges of the patch: a bit for each, from corner k to the next. What it is cut into comes after.
    Beside(u8),
}

/// The parts of a triangle that is bisected from its corner `from`, in its orientation: first the one with the corner after `from`. Both begin
/// with `from` itself.
pub fn bisected<T: Copy + Add<Output = T> + Mul<f32, Output = T>>(
    corners: [T; 3],
    from: u8,
    share: f32,
) -> [[T; 3]; 2] {
    let [apex, after, before] = [0, 1, 2].map(|k| corners[(usize::from(from) + k) % 3]);
    let foot = after * (1.0 - share) + before * share;
    [[apex, after, foot], [apex, foot, before]]
}

/// The part, first or second, in which the barycentric coordinates `uv` lie, and the barycentric coordinates on it.
#[inline(always)]
pub fn bisected_at(uv: Vec2, from: u8, share: f32) -> (u32, Vec2) {
    let apex = 1.0 - uv.x - uv.y;
    let (after, before) = match from {
        0 => (uv.x, uv.y),
        1 => (uv.y, apex),
        _ => (apex, uv.x),
    };
    let rest = 1.0 - share;
    // No branch, for it would be guessed wrong half the time.
    let second = before * rest > after * share;
    let (near, far, own) = if second { (after, before, rest) } else { (before, after, share) };
    let at_foot = near / own;
    let at_far = far - at_foot * (1.0 - own);
    let within = if second { [at_foot, at_far] } else { [at_far, at_foot] };
    (u32::from(second), Vec2::from(within))
}

/// [`bisected`] in the middle.
pub fn halves<T: Copy + Add<Output = T> + Mul<f32, Output = T>>(corners: [T; 3], from: u8) -> [[T; 3]; 2] {
    bisected(corners, from, 0.5)
}

/// [`bisected_at`], in the middle.
pub fn halved(uv: Vec2, from: u8) -> (u32, Vec2) {
    bisected_at(uv, from, 0.5)
}

/// What a patch consists of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Content {
    /// Elements; something stands on some of its edges, a bit each.
    Elements { beside: u8 },
    /// Two patches.
    Bisected { from: u8 },
    /// Patches as regular as elements.
    Split,
}

/// Where a part lies on the patch that is divided first, its root.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    root: u32,
    /// Barycentric coordinates of its corners on the root.
    corners: [Vec2; 3],
}

impl Patch {
    /// Whether it has patches instead of elements.
    #[inline(always)]
    pub(super) fn is_divided(&self) -> bool {
        !matches!(self.content, Content::Elements { .. })
    }

    /// The patch at the point `uv` of one that is divided, and the barycentric coordinates on that.
    #[inline(always)]
    pub(super) fn part_at(&self, uv: Vec2) -> (u32, Vec2) {
        let (part, within) = match self.content {
            Content::Bisected { from } => bisected_at(uv, from, self.measure),
            _ => cells::locate(uv, self.divisions),
        };
        (self.first + part, within)
    }

    /// Numbers of the patches of one that is divided.
    pub(super) fn parts(&self) -> std::ops::Range<u32> {
        let count = match self.content {
            Content::Elements { .. } => 0,
            Content::Bisected { .. } => 2,
            Content::Split => cells::count(self.divisions),
        };
        self.first..self.first + count
    }
}

impl ElementMesh {
    /// The first corner of `patch` in barycentric coordinates on its triangle, and the edges that leave it.
    pub(super) fn frame(&self, patch: u32) -> [Vec2; 3] {
        let part = self.part(patch);
        let surface = &self.surfaces[self.triangle_of_patch(part.root) as usize];
        let [a, b, c] = surface.slices.corners(part.root - surface.first_patch);
        let (along, across) = (b - a, c - a);
        if patch == part.root {
            return [a, along, across];
        }
        let [p, q, r] = part.corners.map(|uv| a + uv.x * along + uv.y * across);
        [p, q - p, r - p]
    }

    /// Gives `patch` and its `area` [m²] the division that comes next; if it is divided, its parts get those after it.
    pub(super) fn divide(&mut self, patch: u32, area: f64, divisions: &mut impl Iterator<Item = Division>) {
        let (first, triangle) = (self.patches.len() as u32, self.triangle_of_patch(patch));
        let Part { root, corners } = self.part(patch);
        let whole = &mut self.patches[patch as usize];
        match divisions.next() {
            None => {}
            Some(Division::Cells(m)) => {
                whole.divisions = m;
                whole.measure = (area / f64::from(cells::count(m))) as f32;
            }
            Some(Division::Beside(beside)) => {
                whole.content = Content::Elements { beside };
                self.divide(patch, area, divisions);
            }
            Some(Division::Bisected { from, share }) => {
                *whole = Patch { triangle, first, divisions: 0, content: Content::Bisected { from }, measure: share };
                self.push_parts(triangle, root, bisected(corners, from, share));
                let areas = [share, 1.0 - share].map(|share| area * f64::from(share));
                (first..).zip(areas).for_each(|(part, area)| self.divide(part, area, divisions));
            }
            Some(Division::Split(m)) => {
                *whole = Patch { triangle, first, divisions: m, content: Content::Split, measure: 0.0 };
                let [a, b, c] = corners;
                let on_root = |uv: Vec2| a + uv.x * (b - a) + uv.y * (c - a);
                let count = cells::count(m);
                self.push_parts(triangle, root, (0..count).map(|cell| cells::corners(cell, m).map(on_root)));
                (first..first + count).for_each(|part| self.divide(part, area / f64::from(count), divisions));
            }
        }
    }

    fn push_parts(&mut self, triangle: u32, root: u32, parts: impl IntoIterator<Item = [Vec2; 3]>) {
        for corners in parts {
            self.patches.push(Patch { triangle, ..Patch::NONE });
            self.parts.push(Part { root, corners });
        }
    }

    /// The division of `patch`, and if it is divided those of its parts, as [`ElementMesh::divide`] takes them.
    pub(super) fn divisions_below(&self, patch: u32, divisions: &mut Vec<Division>) {
        let whole = self.patches[patch as usize];
        match whole.content {
            Content::Elements { beside } => {
                divisions.extend((beside != 0).then_some(Division::Beside(beside)));
                divisions.push(Division::Cells(whole.divisions));
            }
            Content::Bisected { from } => divisions.push(Division::Bisected { from, share: whole.measure }),
            Content::Split => divisions.push(Division::Split(whole.divisions)),
        }
        whole.parts().for_each(|part| self.divisions_below(part, divisions));
    }

    /// `patch` as a part, be it of itself.
    fn part(&self, patch: u32) -> Part {
        let roots = self.patches.len() - self.parts.len();
        let whole = Part { root: patch, corners: [Vec2::ZERO, Vec2::X, Vec2::Y] };
        (patch as usize).checked_sub(roots).map_or(whole, |number| self.parts[number])
    }
}

#[cfg(test)]
mod tests;
