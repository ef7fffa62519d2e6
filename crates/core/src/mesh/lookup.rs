//! The elements of one triangle, found for many points of it in turn.
//!
//! What does not change over the triangle is looked up once; a point then costs a few multiplications, and one more access to
//! memory if the triangle is a needle of several patches.

use super::slices::Slices;
use super::{ElementMesh, Patch, cells};
use glam::Vec2;

/// One triangle, ready to be asked for elements.
#[derive(Clone, Copy, Debug)]
pub struct Lookup<'a> {
    slices: Slices,
    patches: &'a [Patch],
    two_sided: bool,
}

impl ElementMesh {
    /// The elements of `triangle`.
    #[inline]
    pub fn lookup(&self, triangle: u32) -> Lookup<'_> {
        let surface = &self.surfaces[triangle as usize];
        let first = surface.first_patch as usize;
        let patches = &self.patches[first..first + surface.slices.patch_count() as usize];
        Lookup { slices: surface.slices, patches, two_sided: surface.two_sided }
    }
}

impl Lookup<'_> {
    /// Whether its back has elements too.
    pub fn is_two_sided(&self) -> bool {
        self.two_sided
    }

    /// The element on the front at barycentric coordinates `uv`, the one of [`ElementMesh::at`]. The one on the back, if there
    /// is any, has a number that is greater by the second result.
    #[inline]
    pub fn front(&self, uv: Vec2) -> (u32, u32) {
        let (patch, uv) = if let [patch] = self.patches {
            (patch, uv)
        } else {
            let (patch, uv) = self.slices.locate(uv);
            (&self.patches[patch as usize], uv)
        };
        (patch.first_element + cells::at(uv, patch.divisions), cells::count(patch.divisions))
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::{ElementMesh, Resolution};
    use crate::scene::builtin::builtin;
    use glam::Vec2;

    #[test]
    fn elements_are_those_of_the_mesh() {
        // Needles among its triangles, made two-sided by turns.
        let mut scene = builtin("office").unwrap();
        (0..).zip(&mut scene.materials).for_each(|(k, material)| material.two_sided = k % 2 == 0);
        let mesh = ElementMesh::new(&scene, Resolution::Elements(100_000)).unwrap();
        let (mut needles, mut backs) = (0, 0);
        for triangle in 0..scene.triangles.len() as u32 {
            let lookup = mesh.lookup(triangle);
            needles += usize::from(lookup.patches.len() > 1);
            for k in 0..20u32 {
                let u = ((triangle + k) as f32 * 0.618_034).fract();
                let uv = Vec2::new(u, (k as f32 * 0.414_214).fract() * (1.0 - u));
                let (front, further) = lookup.front(uv);
                assert_eq!(Some(front), mesh.at(triangle, uv, false));
                let back = lookup.is_two_sided().then_some(front + further);
                assert_eq!(back, mesh.at(triangle, uv, true));
                backs += usize::from(back.is_some());
            }
        }
        assert!(needles > 100 && backs > 10_000, "{needles} needles, {backs} backs");
    }
}
