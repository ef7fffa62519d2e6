//! Patches that are bisected where the light asks for smaller elements: from a corner to the middle of the edge opposite, and the halves again.
//!
//! Which corner is free: so elements can be long where light changes in one direction only, along the edge of a shadow or a wall. What a point
//! is in the barycentric coordinates of a half is exact, and every lookup goes down the same way: O(depth), and not a step on a patch that
//! is not bisected.

use super::{ElementMesh, Patch, cells};
use glam::Vec2;
use std::ops::{Add, Mul};

/// A patch is bisected so often at most: a part of it has then a 2^24th of its area.
pub const MOST_BISECTIONS: usize = 24;

/// What a patch is cut into.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Division {
    /// m² congruent elements a side, for m divisions along each edge (see [`cells`]).
    Cells(u16),
    /// Two halves, from corner 0, 1 or 2 to the middle of the edge opposite.
    Bisected(u8),
}

/// The halves of a triangle that is bisected from its corner `from`, in its orientation: first the one with the corner after `from`. Both begin
/// with `from` itself.
pub fn halves<T: Copy + Add<Output = T> + Mul<f32, Output = T>>(corners: [T; 3], from: u8) -> [[T; 3]; 2] {
    let [apex, after, before] = [0, 1, 2].map(|k| corners[(usize::from(from) + k) % 3]);
    let middle = (after + before) * 0.5;
    [[apex, after, middle], [apex, middle, before]]
}

/// The half, first or second, in which the barycentric coordinates `uv` lie, and the barycentric coordinates on it.
#[inline(always)]
pub fn halved(uv: Vec2, from: u8) -> (u32, Vec2) {
    let apex = 1.0 - uv.x - uv.y;
    let (after, before) = match from {
        0 => (uv.x, uv.y),
        1 => (uv.y, apex),
        _ => (apex, uv.x),
    };
    // No branch, for it would be guessed wrong half the time.
    let second = before > after;
    let within = if second { [2.0 * after, before - after] } else { [after - before, 2.0 * before] };
    (u32::from(second), Vec2::from(within))
}

/// Where a part lies on the patch that is bisected first, its root.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    root: u32,
    /// Barycentric coordinates of its corners on the root.
    corners: [Vec2; 3],
}

impl Patch {
    /// Whether it has halves instead of elements.
    #[inline(always)]
    pub(super) fn is_bisected(&self) -> bool {
        self.divisions == 0
    }

    /// The half at the point `uv` of a patch that is bisected, and the barycentric coordinates on the half.
    #[inline(always)]
    pub(super) fn half_at(&self, uv: Vec2) -> (u32, Vec2) {
        let (half, within) = halved(uv, self.from);
        (self.first + half, within)
    }
}

impl ElementMesh {
    /// The patch with elements at the point `uv` of `patch`, and the barycentric coordinates on it.
    #[inline(always)]
    pub(super) fn leaf_at(&self, mut patch: u32, mut uv: Vec2) -> (u32, Vec2) {
        while let Some(bisected) = self.patches.get(patch as usize).filter(|patch| patch.is_bisected()) {
            (patch, uv) = bisected.half_at(uv);
        }
        (patch, uv)
    }

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

    /// Gives `patch` and its `area` [m²] the division that comes next; if it is bisected, its halves get those after it.
    pub(super) fn divide(&mut self, patch: u32, area: f64, divisions: &mut impl Iterator<Item = Division>) {
        let whole = &mut self.patches[patch as usize];
        let from = match divisions.next() {
            None => return,
            Some(Division::Cells(m)) => {
                whole.divisions = m;
                whole.element_area = (area / f64::from(cells::count(m))) as f32;
                return;
            }
            Some(Division::Bisected(from)) => from,
        };
        let (first, triangle) = (self.patches.len() as u32, self.triangle_of_patch(patch));
        self.patches[patch as usize] = Patch { triangle, first, divisions: 0, from, element_area: 0.0 };
        let Part { root, corners } = self.part(patch);
        for corners in halves(corners, from) {
            self.patches.push(Patch { triangle, ..Patch::NONE });
            self.parts.push(Part { root, corners });
        }
        [first, first + 1].into_iter().for_each(|half| self.divide(half, 0.5 * area, divisions));
    }

    /// The division of `patch`, and if it is bisected those of its halves, as [`ElementMesh::divide`] takes them.
    pub(super) fn divisions_below(&self, patch: u32, divisions: &mut Vec<Division>) {
        let Patch { first, divisions: m, from, .. } = self.patches[patch as usize];
        if m > 0 {
            return divisions.push(Division::Cells(m));
        }
        divisions.push(Division::Bisected(from));
        [first, first + 1].into_iter().for_each(|half| self.divisions_below(half, divisions));
    }

    /// `patch` as a part, be it of itself.
    fn part(&self, patch: u32) -> Part {
        let roots = self.patches.len() - self.parts.len();
        let whole = Part { root: patch, corners: [Vec2::ZERO, Vec2::X, Vec2::Y] };
        (patch as usize).checked_sub(roots).map_or(whole, |number| self.parts[number])
    }
}

#[cfg(test)]
mod tests {
    use super::{Division, halved, halves};
    use crate::math::hash;
    use crate::mesh::{Cut, ElementMesh, Point, Resolution, TOGETHER};
    use crate::scene::Scene;
    use crate::scene::builtin::builtin;
    use glam::{Vec2, Vec3};

    /// Needles among its triangles, two-sided by turns, deeply and unevenly bisected.
    fn bisected() -> (Scene, Cut) {
        let mut scene = builtin("office").unwrap();
        (0..).zip(&mut scene.materials).for_each(|(k, material)| material.two_sided = k % 2 == 0);
        let Cut { slices, divisions, leaders } = Resolution::Elements(2000).cut(&scene).unwrap();
        let mut state = 1;
        let roots = 0..divisions.len();
        let divisions = roots.flat_map(|root| tree(if root % 50 == 0 { 16 } else { 4 }, &mut state)).collect();
        (scene, Cut { slices, divisions, leaders })
    }

    /// Divisions of a patch that is bisected at random, `depth` times at most.
    fn tree(depth: usize, state: &mut u64) -> Vec<Division> {
        *state = hash::mix(*state);
        let random = *state % 16;
        if depth == 0 || random < 4 {
            return vec![Division::Cells(1 + (random % 3) as u16)];
        }
        let halves: Vec<Division> = (0..2).flat_map(|_| tree(depth - 1, state)).collect();
        [vec![Division::Bisected((random % 3) as u8)], halves].concat()
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
    fn halves_make_the_whole() {
        let whole = [Vec2::ZERO, Vec2::X, Vec2::Y];
        for from in 0..3 {
            for uv in points().skip(6) {
                let (half, within) = halved(uv, from);
                let [a, b, c] = halves(whole, from)[half as usize];
                assert!((a + within.x * (b - a) + within.y * (c - a)).abs_diff_eq(uv, 1e-6), "{from} {uv}");
                assert!(within.min_element() >= 0.0 && within.element_sum() < 1.0 + 1e-6, "{from} {uv} {within}");
                assert!(a == whole[usize::from(from)] && ((b - a).perp_dot(c - a) - 0.5).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn points_lead_to_the_element_they_lie_on_and_back() {
        let (scene, cut) = bisected();
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
        let (scene, cut) = bisected();
        let mesh = ElementMesh::with_cut(&scene, &cut).unwrap();
        let whole = ElementMesh::new(&scene, Resolution::Elements(1)).unwrap();
        assert_eq!(mesh.len(), cut.element_count(&scene).unwrap());
        assert!((mesh.total_area() / whole.total_area() - 1.0).abs() < 1e-6);
        let counted: u32 = mesh.areas().map(|(_, count)| count).sum();
        assert!(counted as usize == mesh.len() && mesh.areas().all(|(area, _)| area >= 0.0));
        for e in mesh.elements() {
            let [p, q, r] = scene.corners(mesh.triangle(e)).map(Vec3::as_dvec3);
            let at = |uv: Vec2| p + (q - p) * f64::from(uv.x) + (r - p) * f64::from(uv.y);
            let [a, b, c] = mesh.corners(e).map(at);
            let area = 0.5 * (b - a).cross(c - a).length();
            // Corners are rounded to the digits of their coordinates on the triangle.
            let rounding = f64::from(f32::EPSILON) * (q.distance(p) + r.distance(p));
            let close = 1e-3 * area + rounding * (b.distance(a) + c.distance(a)) + 1e-12;
            assert!((f64::from(mesh.area(e)) - area).abs() < close, "{e}: {} {area}", mesh.area(e));
        }
    }

    #[test]
    fn cuts_come_back() {
        let (scene, cut) = bisected();
        assert!(ElementMesh::with_cut(&scene, &cut).unwrap().cut() == cut);
    }

    #[test]
    fn only_patches_with_elements_are_counted_and_together_they_are_the_mesh() {
        let (scene, cut) = bisected();
        let mesh = ElementMesh::with_cut(&scene, &cut).unwrap();
        let of_patch = |patch| {
            let sides = 1 + u32::from(mesh.is_two_sided(mesh.triangle_of_patch(patch)));
            sides * u32::from(mesh.divisions(patch)).pow(2)
        };
        assert_eq!(mesh.patches().map(of_patch).sum::<u32>() as usize, mesh.len());
    }

    #[test]
    fn all_lookups_agree() {
        let (scene, cut) = bisected();
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
        let (scene, cut) = bisected();
        let divisions = |divisions: Vec<Division>| Cut { divisions, ..cut.clone() };
        let endless = divisions(vec![Division::Bisected(0); 1_000_000]);
        let short = divisions(cut.divisions[..cut.divisions.len() - 1].to_vec());
        let long = divisions([&cut.divisions[..], &[Division::Cells(1)]].concat());
        let mut of_no_corner = cut.divisions.clone();
        of_no_corner.iter_mut().for_each(|division| {
            if matches!(division, Division::Bisected(_)) {
                *division = Division::Bisected(3);
            }
        });
        let empty = cut.divisions.iter().map(|division| match division {
            Division::Cells(_) => Division::Cells(0),
            bisected => *bisected,
        });
        for bad in [endless, short, long, divisions(of_no_corner), divisions(empty.collect()), divisions(Vec::new())] {
            assert!(ElementMesh::with_cut(&scene, &bad).unwrap_err().to_string().contains("cut"));
        }
    }
}
