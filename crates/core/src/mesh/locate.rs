//! The elements at many points, found together.
//!
//! A point leads to its triangle, which leads to its patch: two tables, and with rays that end here and there both are read in
//! no order. One point after the other, each reading waits for memory. So each table is read for all points before anything is
//! computed: then the processor waits for many readings at once. Patches that are divided are gone down together, too.

use super::bisection::Content;
use super::{ElementMesh, Patch, Surface, cells};
use glam::{Vec2, Vec3};

/// Most points that are found together: their entries of both tables stay in the nearest cache.
pub const TOGETHER: usize = 64;

/// A point on a side of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub triangle: u32,
    /// Barycentric coordinates.
    pub uv: Vec2,
    pub back: bool,
}

impl ElementMesh {
    /// As [`ElementMesh::locate`] for `count` points, at most [`TOGETHER`]: hands the number of each to `each`, in order, with what
    /// was found. A triangle that is not there is taken for the last one.
    pub fn locate_together(
        &self,
        count: usize,
        point: impl Fn(usize) -> Point,
        mut each: impl FnMut(usize, Option<(u32, Vec2)>),
    ) {
        let mut surfaces = [Surface::NONE; TOGETHER];
        let ([mut numbers, mut waiting], [mut x, mut y]) = ([[0; TOGETHER]; 2], [[0.0; TOGETHER]; 2]);
        let mut patches = [Patch::NONE; TOGETHER];
        let last = self.surfaces.len() - 1;
        for (k, surface) in surfaces[..count].iter_mut().enumerate() {
            *surface = self.surfaces[(point(k).triangle as usize).min(last)];
        }
        for (k, surface) in surfaces[..count].iter().enumerate() {
            let (number, uv) = surface.slices.locate(point(k).uv);
            (numbers[k], x[k], y[k]) = (surface.first_patch + number, uv.x, uv.y);
        }
        self.leaves_at(&mut numbers[..count], [&mut x[..count], &mut y[..count]], &mut waiting);
        for (patch, &number) in patches.iter_mut().zip(&numbers[..count]) {
            *patch = self.patches[number as usize];
        }
        for (k, (surface, patch)) in surfaces[..count].iter().zip(&patches).enumerate() {
            let (uv, back) = (Vec2::new(x[k], y[k]), point(k).back);
            let (cell, within) = cells::locate(uv, patch.divisions);
            let within = self.clusters.piece(point(k).triangle).map_or(within, |piece| piece.within(within));
            let offset = if back { cells::count(patch.divisions) } else { 0 };
            each(k, (surface.two_sided || !back).then_some((patch.first + offset + cell, within)));
        }
    }
}

impl Surface {
    const NONE: Surface =
        Surface { first_patch: 0, slices: super::Slices::WHOLE, two_sided: false, normal: Vec3::ZERO };
}

impl Patch {
    pub(super) const NONE: Patch =
        Patch { triangle: 0, first: 0, divisions: 1, content: Content::Elements { beside: 0 }, measure: 0.0 };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Resolution;
    use crate::scene::builtin::builtin;

    #[test]
    fn together_are_found_the_same_as_one_by_one() {
        let mut scene = builtin("office").unwrap();
        (0..).zip(&mut scene.materials).for_each(|(k, material)| material.two_sided = k % 2 == 0);
        let triangles = scene.triangles.len() as u32;
        let mesh = ElementMesh::new(&scene, Resolution::Elements(100_000)).unwrap();
        for first in (0..50_000u32).step_by(TOGETHER) {
            let point = |k: usize| {
                let k = first + k as u32;
                let u = (k as f32 * 0.618_034).fract();
                let uv = Vec2::new(u, (k as f32 * 0.414_214).fract() * (1.0 - u));
                Point { triangle: k.wrapping_mul(2_654_435_761) % triangles, uv, back: k.is_multiple_of(3) }
            };
            let mut count = 0;
            mesh.locate_together(TOGETHER, point, |k, found| {
                let Point { triangle, uv, back } = point(k);
                assert_eq!(found, mesh.locate(triangle, uv, back));
                count += 1;
            });
            assert_eq!(count, TOGETHER);
        }
        mesh.locate_together(1, |_| Point { triangle: u32::MAX, uv: Vec2::ZERO, back: false }, |_, _| {});
    }
}
