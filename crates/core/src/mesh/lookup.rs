//! The elements at many points: of one triangle in turn, or of many triangles in stages.
//!
//! What does not change over a triangle is looked up once; a point then costs a few multiplications, and one more access to
//! memory for its patch. In stages eight points are located at once, without a branch.

use super::slices::Slices;
use super::{ElementMesh, Surface, cells};
use glam::Vec2;
use std::array::from_fn;

/// Points that are looked up at once.
pub const LANES: usize = 8;

/// One triangle, ready to be asked for elements.
#[derive(Clone, Copy, Debug)]
pub struct Lookup<'a> {
    mesh: &'a ElementMesh,
    slices: Slices,
    first_patch: u32,
    two_sided: bool,
}

impl ElementMesh {
    /// The elements of `triangle`.
    #[inline(always)]
    pub fn lookup(&self, triangle: u32) -> Lookup<'_> {
        let Surface { first_patch, slices, two_sided, .. } = self.surfaces[triangle as usize];
        Lookup { mesh: self, slices, first_patch, two_sided }
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
        let (number, uv) = if self.slices == Slices::WHOLE { (0, uv) } else { self.slices.locate(uv) };
        let (patch, uv) = self.mesh.leaf_at(self.first_patch + number, uv);
        let patch = &self.mesh.patches[patch as usize];
        (patch.first + cells::at(uv, patch.divisions), cells::count(patch.divisions))
    }
}

/// Elements of many points, found in stages, each of which does the same for several points at once. All slices have the same
/// length, a multiple of [`LANES`].
impl ElementMesh {
    /// First stage, for points of `triangle` at barycentric coordinates `u`, `v`: the number of the patch of each, and the coordinates
    /// x, y on the patch.
    #[inline(always)]
    pub fn patches_at(&self, triangle: u32, [u, v]: [&[f32]; 2], patch: &mut [u32], [x, y]: [&mut [f32]; 2]) {
        let Surface { first_patch, slices, .. } = self.surfaces[triangle as usize];
        let within = x.as_chunks_mut::<LANES>().0.iter_mut().zip(y.as_chunks_mut::<LANES>().0);
        let points = u.as_chunks::<LANES>().0.iter().zip(v.as_chunks::<LANES>().0);
        for ((patch, (x, y)), (u, v)) in patch.as_chunks_mut::<LANES>().0.iter_mut().zip(within).zip(points) {
            if slices == Slices::WHOLE {
                // Here and not by slices: most triangles have a few points, for which calls to copy them are too long.
                (*patch, *x, *y) = ([first_patch; LANES], *u, *v);
                continue;
            }
            let [along, across] = slices.along_edges(*u, *v);
            let located = from_fn(|k| slices.patch_at(along[k], across[k]));
            *patch = located.map(|(patch, _)| first_patch + patch);
            (*x, *y) = (located.map(|(_, within)| within.x), located.map(|(_, within)| within.y));
        }
    }

    /// Second stage, for points of any triangles: into `front` the element on the front, and into `further` by how much the number
    /// of the one on the back, if there is any, is greater. Where a patch is divided it becomes its part, and x and y those on that.
    /// Patches without a meaning have some elements.
    #[inline(always)]
    pub fn fronts_at(&self, patch: &mut [u32], [x, y]: [&mut [f32]; 2], front: &mut [u32], further: &mut [u32]) {
        self.leaves_at(patch, [&mut *x, &mut *y], further);
        for ((front, further), &patch) in front.iter_mut().zip(&mut *further).zip(&*patch) {
            let found = self.patches.get(patch as usize);
            (*front, *further) = found.map_or((0, 1), |patch| (patch.first, u32::from(patch.divisions)));
        }
        let out = front.as_chunks_mut::<LANES>().0.iter_mut().zip(further.as_chunks_mut::<LANES>().0);
        for ((x, y), (front, further)) in x.as_chunks::<LANES>().0.iter().zip(y.as_chunks::<LANES>().0).zip(out) {
            let m: [u16; LANES] = further.map(|divisions| divisions as u16);
            let cell: [u32; LANES] = from_fn(|k| cells::at(Vec2::new(x[k], y[k]), m[k]));
            (*front, *further) = (from_fn(|k| front[k] + cell[k]), m.map(cells::count));
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::{ElementMesh, Resolution};
    use crate::scene::Scene;
    use crate::scene::builtin::builtin;
    use glam::Vec2;
    use std::array::from_fn;

    #[test]
    fn elements_are_those_of_the_mesh() {
        // Needles among its triangles, made two-sided by turns.
        let mut scene = builtin("office").unwrap();
        (0..).zip(&mut scene.materials).for_each(|(k, material)| material.two_sided = k % 2 == 0);
        let mesh = ElementMesh::new(&scene, Resolution::Elements(100_000)).unwrap();
        let (mut needles, mut backs) = (0, 0);
        for triangle in 0..scene.triangles.len() as u32 {
            let lookup = mesh.lookup(triangle);
            needles += usize::from(lookup.slices.patch_count() > 1);
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
        assert_eq!(staged(&mesh, &scene), 24 * scene.triangles.len());
        assert!(needles > 100 && backs > 10_000, "{needles} needles, {backs} backs");
    }

    /// Number of points, 24 of each triangle, whose elements are the same in stages.
    fn staged(mesh: &ElementMesh, scene: &Scene) -> usize {
        let mut same = 0;
        for triangle in 0..scene.triangles.len() as u32 {
            // Corners and edges among them.
            let u: [f32; 24] = from_fn(|k| (k % 5) as f32 / 4.0);
            let v: [f32; 24] = from_fn(|k| ((triangle as usize + k) as f32 * 0.414_214).fract() * (1.0 - u[k]));
            let ([mut patch, mut front, mut further], [mut x, mut y]) = ([[0; 24]; 3], [[0.0; 24]; 2]);
            mesh.patches_at(triangle, [&u, &v], &mut patch, [&mut x, &mut y]);
            mesh.fronts_at(&mut patch, [&mut x, &mut y], &mut front, &mut further);
            let lookup = mesh.lookup(triangle);
            same += (0..24).filter(|&k| lookup.front(Vec2::new(u[k], v[k])) == (front[k], further[k])).count();
        }
        same
    }
}
