//! Which points are the same place: positions closer than a tolerance share a number.
//!
//! Files give every triangle its own copy of a corner, instances move the copies by different matrices, and the grid
//! points along a shared edge are computed from either side: equal up to rounding, and only up to rounding.

use glam::{IVec3, Vec3};
use rustc_hash::FxHashMap;

/// Cells are this much wider than the tolerance, so that most points need to look into one cell only.
const CELL: f32 = 32.0;

/// Points of a scene that are closer than this share of its radius are one: some ten times the rounding of a coordinate.
pub const TOLERANCE: f32 = 4e-6;

/// Points met so far, in a grid of cells; each cell is a chain of points.
pub struct Weld {
    tolerance: f32,
    heads: FxHashMap<IVec3, u32>,
    next: Vec<u32>,
    positions: Vec<Vec3>,
}

impl Weld {
    /// `tolerance` [m] is the distance within which two points are one.
    pub fn new(tolerance: f32) -> Weld {
        Weld { tolerance, heads: FxHashMap::default(), next: Vec::new(), positions: Vec::new() }
    }

    /// Number of the point at `position` [m]: that of an earlier one within the tolerance, or a new one.
    pub fn number(&mut self, position: Vec3) -> u32 {
        let (low, high) = (self.cell(position - self.tolerance), self.cell(position + self.tolerance));
        for x in low.x..=high.x {
            for y in low.y..=high.y {
                for z in low.z..=high.z {
                    if let Some(found) = self.search(IVec3::new(x, y, z), position) {
                        return found;
                    }
                }
            }
        }
        let number = self.positions.len() as u32;
        let head = self.heads.insert(self.cell(position), number);
        self.next.push(head.unwrap_or(u32::MAX));
        self.positions.push(position);
        number
    }

    /// Positions [m] of the points, by number.
    pub fn into_positions(self) -> Vec<Vec3> {
        self.positions
    }

    fn search(&self, cell: IVec3, position: Vec3) -> Option<u32> {
        let mut candidate = *self.heads.get(&cell)?;
        while candidate != u32::MAX {
            if self.positions[candidate as usize].distance_squared(position) <= self.tolerance * self.tolerance {
                return Some(candidate);
            }
            candidate = self.next[candidate as usize];
        }
        None
    }

    fn cell(&self, position: Vec3) -> IVec3 {
        // The cast saturates, so a far point shares the outermost cell instead of wrapping round.
        (position / (CELL * self.tolerance)).floor().as_ivec3()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_within_the_tolerance_are_one_even_across_cells() {
        let mut weld = Weld::new(1e-3);
        for k in 0..200 {
            let p = Vec3::new(k as f32 * 0.032, -0.032, 1.0);
            let first = weld.number(p - 2e-4);
            assert_eq!(weld.number(p + 2e-4), first);
            assert_ne!(weld.number(p + Vec3::X * 0.01), first);
        }
        assert_eq!(weld.into_positions().len(), 400);
    }
}
