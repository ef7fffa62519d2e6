//! Patches that are split where the light asks for smaller elements: into four congruent parts, and these again.
//!
//! The parts are the [`cells`] of two divisions, so a part is its patch at half the size, the second one turned by 180°. What a
//! point is in the barycentric coordinates of a part is exact, and every lookup goes down the same way: O(depth), and not a step on a
//! patch that is not split.

use super::{ElementMesh, Patch, cells};
use glam::Vec2;

/// Parts of a patch that is split.
pub const PARTS: u32 = 4;
/// A patch is split so often at most: a part of the part is then a 4096th as long.
pub const MOST_SPLITS: usize = 12;

/// Where a part lies on the patch that is split first, its root.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    root: u32,
    /// Barycentric coordinates on the root of its first corner.
    corner: Vec2,
    /// Signed length of its edges along those of the root, of length 1.
    length: f32,
}

impl Patch {
    /// Whether it has parts instead of elements.
    #[inline(always)]
    pub(super) fn is_split(&self) -> bool {
        self.divisions == 0
    }

    /// The part at the point `uv` of a patch that is split, and the barycentric coordinates on the part.
    #[inline(always)]
    pub(super) fn part_at(&self, uv: Vec2) -> (u32, Vec2) {
        let (part, within) = cells::locate(uv, 2);
        (self.first + part, within)
    }
}

impl ElementMesh {
    /// The patch with elements at the point `uv` of `patch`, and the barycentric coordinates on it.
    #[inline(always)]
    pub(super) fn leaf_at(&self, mut patch: u32, mut uv: Vec2) -> (u32, Vec2) {
        while let Some(split) = self.patches.get(patch as usize).filter(|patch| patch.is_split()) {
            (patch, uv) = split.part_at(uv);
        }
        (patch, uv)
    }

    /// The first corner of `patch` in barycentric coordinates on its triangle, and the edges that leave it.
    pub(super) fn frame(&self, patch: u32) -> [Vec2; 3] {
        let roots = (self.patches.len() - self.parts.len()) as u32;
        let part = patch.checked_sub(roots).map(|number| self.parts[number as usize]);
        let root = part.map_or(patch, |part| part.root);
        let surface = &self.surfaces[self.triangle_of_patch(root) as usize];
        let [a, b, c] = surface.slices.corners(root - surface.first_patch);
        let (along, across) = (b - a, c - a);
        match part {
            None => [a, along, across],
            Some(Part { corner, length, .. }) => {
                [a + corner.x * along + corner.y * across, length * along, length * across]
            }
        }
    }

    /// Gives `patch` and its `area` [m²] the divisions that come next; if these are none it is split, and its parts get those after
    /// them.
    pub(super) fn divide(&mut self, patch: u32, area: f64, divisions: &mut impl Iterator<Item = u16>) {
        let Some(m) = divisions.next() else { return };
        let whole = &mut self.patches[patch as usize];
        whole.divisions = m;
        if m > 0 {
            whole.element_area = (area / f64::from(cells::count(m))) as f32;
            return;
        }
        let (first, triangle) = (self.patches.len() as u32, self.triangle_of_patch(patch));
        self.patches[patch as usize].first = first;
        let whole = self.part(patch);
        for cell in 0..PARTS {
            let (corner, length) = cells::frame(cell, 2);
            let (corner, length) = (whole.corner + whole.length * corner, whole.length * length);
            self.patches.push(Patch { triangle, ..Patch::NONE });
            self.parts.push(Part { corner, length, ..whole });
        }
        (first..first + PARTS).for_each(|part| self.divide(part, area / f64::from(PARTS), divisions));
    }

    /// The divisions of `patch`, and if it has none those of its parts, as [`ElementMesh::divide`] takes them.
    pub(super) fn divisions_below(&self, patch: u32, divisions: &mut Vec<u16>) {
        let Patch { first, divisions: m, .. } = self.patches[patch as usize];
        divisions.push(m);
        if m == 0 {
            (first..first + PARTS).for_each(|part| self.divisions_below(part, divisions));
        }
    }

    /// `patch` as a part, be it of itself.
    fn part(&self, patch: u32) -> Part {
        let roots = self.patches.len() - self.parts.len();
        let whole = Part { root: patch, corner: Vec2::ZERO, length: 1.0 };
        (patch as usize).checked_sub(roots).map_or(whole, |number| self.parts[number])
    }
}

#[cfg(test)]
mod tests {
    use crate::math::hash;
    use crate::mesh::{Cut, ElementMesh, Point, Resolution, TOGETHER};
    use crate::scene::Scene;
    use crate::scene::builtin::builtin;
    use glam::{Vec2, Vec3};

    /// Needles among its triangles, two-sided by turns, deeply and unevenly split.
    fn split() -> (Scene, Cut) {
        let mut scene = builtin("office").unwrap();
        (0..).zip(&mut scene.materials).for_each(|(k, material)| material.two_sided = k % 2 == 0);
        let Cut { slices, divisions, leaders } = Resolution::Elements(2000).cut(&scene).unwrap();
        let mut state = 1;
        let roots = divisions.len();
        let split = (0..roots).flat_map(|root| tree(if root % 50 == 0 { 9 } else { 2 }, &mut state)).collect();
        (scene, Cut { slices, divisions: split, leaders })
    }

    /// Divisions of a patch that is split at random, `depth` times at most.
    fn tree(depth: usize, state: &mut u64) -> Vec<u16> {
        *state = hash::mix(*state);
        let random = *state % 16;
        if depth == 0 || random < 9 {
            return vec![1 + (random % 3) as u16];
        }
        let parts: Vec<u16> = (0..4).flat_map(|_| tree(depth - 1, state)).collect();
        [vec![0], parts].concat()
    }

    fn points() -> impl Iterator<Item = Vec2> {
        let edges = [Vec2::X, Vec2::Y, Vec2::ZERO, Vec2::splat(0.5), Vec2::splat(0.25), Vec2::new(-1e-3, 1.001)];
        let inner = (0..40).map(|k| {
            let u = (k as f32 * 0.618_034).fract();
            Vec2::new(u, (k as f32 * 0.414_214).fract() * (1.0 - u))
        });
        edges.into_iter().chain(inner)
    }

    #[test]
    fn points_lead_to_the_element_they_lie_on_and_back() {
        let (scene, cut) = split();
        let mesh = ElementMesh::with_cut(&scene, &cut).unwrap();
        assert!(mesh.parts.len() > 10_000, "{}", mesh.parts.len());
        for triangle in 0..scene.triangles.len() as u32 {
            for uv in points().skip(6) {
                let (e, within) = mesh.locate(triangle, uv, false).unwrap();
                let [a, b, c] = mesh.corners(e);
                let back = a + within.x * (b - a) + within.y * (c - a);
                assert!(back.distance(uv) < 1e-5 && mesh.triangle(e) == triangle, "{triangle} {uv} is {back}");
                let (patch, on_patch) = mesh.patch_at(triangle, uv);
                assert!(patch == mesh.place(e).patch && mesh.on_triangle(patch, on_patch).distance(uv) < 1e-5);
            }
        }
        for e in mesh.elements() {
            let place = mesh.place(e);
            let centroid = mesh.corners(e).iter().sum::<Vec2>() / 3.0;
            assert_eq!(mesh.at(place.triangle, centroid, place.back), Some(e));
            let (same, [corner, along, across]) = mesh.place_and_edges(e);
            let [a, b, c] = mesh.corners(e);
            let close = |p: Vec2, q: Vec2| p.abs_diff_eq(q, 1e-6);
            assert!(same == place && close(a, corner) && close(b - a, along) && close(c - a, across));
        }
    }

    #[test]
    fn areas_are_exact_and_add_up() {
        let (scene, cut) = split();
        let mesh = ElementMesh::with_cut(&scene, &cut).unwrap();
        let whole = ElementMesh::new(&scene, Resolution::Elements(1)).unwrap();
        assert_eq!(mesh.len(), cut.element_count(&scene).unwrap());
        assert!((mesh.total_area() / whole.total_area() - 1.0).abs() < 1e-6);
        let counted: u32 = mesh.areas().map(|(_, count)| count).sum();
        assert!(counted as usize == mesh.len() && mesh.areas().all(|(area, _)| area >= 0.0));
        for e in mesh.elements() {
            let [a, b, c] = mesh.corners(e).map(|uv| {
                let [p, q, r] = scene.corners(mesh.triangle(e)).map(Vec3::as_dvec3);
                p + (q - p) * f64::from(uv.x) + (r - p) * f64::from(uv.y)
            });
            let area = 0.5 * (b - a).cross(c - a).length();
            let close = 1e-3 * area + 1e-12;
            assert!((f64::from(mesh.area(e)) - area).abs() < close, "{e}: {} {area}", mesh.area(e));
        }
    }

    #[test]
    fn cuts_come_back() {
        let (scene, cut) = split();
        assert!(ElementMesh::with_cut(&scene, &cut).unwrap().cut() == cut);
    }

    #[test]
    fn only_patches_with_elements_are_counted_and_together_they_are_the_mesh() {
        let (scene, cut) = split();
        let mesh = ElementMesh::with_cut(&scene, &cut).unwrap();
        let of_patch = |patch| {
            let sides = 1 + u32::from(mesh.is_two_sided(mesh.triangle_of_patch(patch)));
            sides * u32::from(mesh.divisions(patch)).pow(2)
        };
        assert_eq!(mesh.patches().map(of_patch).sum::<u32>() as usize, mesh.len());
    }

    #[test]
    fn all_lookups_agree() {
        let (scene, cut) = split();
        let mesh = ElementMesh::with_cut(&scene, &cut).unwrap();
        let all: Vec<Vec2> = points().chain(points()).take(40).collect();
        for triangle in 0..scene.triangles.len() as u32 {
            let lookup = mesh.lookup(triangle);
            let [u, v]: [Vec<f32>; 2] = [all.iter().map(|p| p.x).collect(), all.iter().map(|p| p.y).collect()];
            let ([mut patch, mut front, mut further], [mut x, mut y]) = ([[0; 40]; 3], [[0.0; 40]; 2]);
            mesh.patches_at(triangle, [&u, &v], &mut patch, [&mut x, &mut y]);
            mesh.fronts_at(&patch, [&mut x, &mut y], &mut front, &mut further);
            for (k, &uv) in all.iter().enumerate() {
                let (first, more) = lookup.front(uv);
                assert_eq!((front[k], further[k]), (first, more));
                assert_eq!(Some(first), mesh.at(triangle, uv, false));
                assert_eq!(mesh.is_two_sided(triangle).then_some(first + more), mesh.at(triangle, uv, true));
            }
            let point = |k: usize| Point { triangle, uv: all[k], back: k.is_multiple_of(3) };
            mesh.locate_together(all.len().min(TOGETHER), point, |k, found| {
                assert_eq!(found, mesh.locate(triangle, all[k], point(k).back));
            });
        }
    }

    #[test]
    fn bad_trees_are_refused() {
        let (scene, cut) = split();
        let divisions = |divisions: Vec<u16>| Cut { divisions, ..cut.clone() };
        let endless = divisions(vec![0; 1_000_000]);
        let short = divisions(cut.divisions[..cut.divisions.len() - 1].to_vec());
        let long = divisions([&cut.divisions[..], &[1]].concat());
        for bad in [endless, short, long, divisions(Vec::new())] {
            assert!(ElementMesh::with_cut(&scene, &bad).unwrap_err().to_string().contains("cut"));
        }
    }
}
