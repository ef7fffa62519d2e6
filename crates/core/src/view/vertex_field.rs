//! Irradiance as people look at it: one value for every vertex, linear between them.
//!
//! A solution has one value for every element and noise in it. The field's value at a vertex is the mean of the elements
//! that touch it, weighted with their open areas ([`super::cover`]), after differences that the error bars cannot tell from
//! noise were taken out ([`super::smooth`]). Vertices are shared where surfaces meet smoothly ([`super::crease`]), so
//! furniture looks round and edges between walls stay sharp, light runs on inside elements of many triangles
//! ([`super::pycnophylactic`]), and T-vertices follow the edge they lie on
//! ([`super::seams`]). Area weights, not the inverse variances of the elements: a value that is low by chance has a small
//! error bar as well, and would be believed too much.

use super::grid::Side;
use super::seams::EdgePoints;
use super::vertices::Vertices;
use super::{cover, pycnophylactic, seams, smooth};
use crate::math::Rgb;
use crate::mesh::{Place, cells};
use crate::{Problem, Solution};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// Irradiance [lux] interpolated over the surface, and how sure it is. Memory grows with the number of element corners, 50 to 70 bytes
/// each.
///
/// The standard error at a vertex is the mean of those of the elements that touch it, with the same weights: what it is if neighbours
/// err together, and at most that. What smoothing takes away is not taken off.
#[derive(Clone, Debug)]
pub struct VertexField {
    vertices: Vertices,
    irradiance: Vec<Rgb>,
    /// Empty if nobody knows how sure the light is.
    std_error: Vec<Rgb>,
}

impl VertexField {
    /// With the noise of `solution` taken out as far as its error bars allow ([`super::smooth`]).
    pub fn new(problem: &Problem, solution: &Solution) -> VertexField {
        let vertices = Vertices::new(problem);
        let open = cover::open_shares(problem, solution, &vertices);
        let values = smooth::of_open_parts(problem, solution, &vertices, &open);
        VertexField::without_seams(problem, vertices, solution, &values, &open)
    }

    /// With all the noise of `solution`.
    pub fn as_computed(problem: &Problem, solution: &Solution) -> VertexField {
        let vertices = Vertices::new(problem);
        let open = cover::open_shares(problem, solution, &vertices);
        VertexField::without_seams(problem, vertices, solution, &smooth::as_computed(solution, &open), &open)
    }

    /// Of `values` [lux], those of the open parts of the elements of `solution`.
    fn without_seams(
        problem: &Problem,
        vertices: Vertices,
        solution: &Solution,
        values: &[Rgb],
        open: &[f32],
    ) -> VertexField {
        let mut field = VertexField::of_values(problem, vertices, values, open);
        if let Some(errors) = smooth::errors_of_open_parts(solution, open) {
            field.std_error = means(problem, &field.vertices, &errors, open);
        }
        for seam in seams::t_vertices(problem, &field.vertices) {
            let (from, to) = (field.irradiance(seam.from), field.irradiance(seam.to));
            field.irradiance[seam.vertex as usize] = from + (to - from) * seam.t;
        }
        field
    }

    /// A first look at a solution that is still being computed: means at the vertices, no noise taken out and no seam closed. On
    /// the vertices of `earlier`, a field of the same problem, if there is one.
    pub fn draft(problem: &Problem, solution: &Solution, earlier: Option<VertexField>) -> VertexField {
        let vertices = earlier.map_or_else(|| Vertices::new(problem), |field| field.vertices);
        VertexField::of_values(problem, vertices, &solution.irradiance, &vec![1.0; problem.mesh.len()])
    }

    /// Means at the vertices of `values` [lux] of the elements, of whose areas the shares `open` count.
    fn of_values(problem: &Problem, vertices: Vertices, values: &[Rgb], open: &[f32]) -> VertexField {
        let mut irradiance = means(problem, &vertices, values, open);
        pycnophylactic::interpolate(problem, &vertices, values, &mut irradiance);
        VertexField { vertices, irradiance, std_error: Vec::new() }
    }

    /// Irradiance [lux] at barycentric coordinates `uv` of `triangle`, on its front or its back; black for the back of a
    /// one-sided surface, which has none.
    pub fn irradiance_at(&self, problem: &Problem, triangle: u32, uv: Vec2, back: bool) -> Rgb {
        self.interpolated(&self.irradiance, problem, triangle, uv, back)
    }

    /// Standard error [lux] there; NaN if it is not known.
    pub fn std_error_at(&self, problem: &Problem, triangle: u32, uv: Vec2, back: bool) -> Rgb {
        if !self.is_error_known() {
            return Rgb::grey(f32::NAN);
        }
        self.interpolated(&self.std_error, problem, triangle, uv, back)
    }

    /// Whether somebody knows how sure the light is: not of drafts, and not after deterministic methods.
    pub fn is_error_known(&self) -> bool {
        !self.std_error.is_empty()
    }

    /// `values` of the vertices, linear between them.
    fn interpolated(&self, values: &[Rgb], problem: &Problem, triangle: u32, uv: Vec2, back: bool) -> Rgb {
        if back && !problem.mesh.is_two_sided(triangle) {
            return Rgb::BLACK;
        }
        let (patch, uv) = problem.mesh.patch_at(triangle, uv);
        let m = problem.mesh.divisions(patch);
        let (cell, within) = cells::locate(uv, m);
        let side = Side { patch, back };
        let value = |ij| {
            let number = self.vertices.grid.number(&problem.mesh, side, ij);
            values[self.vertices.of_grid_point(number) as usize]
        };
        let [a, b, c] = cells::grid_corners(cell, m).map(value);
        let s = within.x.clamp(0.0, 1.0);
        let t = within.y.clamp(0.0, 1.0 - s);
        a + (b - a) * s + (c - a) * t
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.vertices.len()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Vertices at the corners of a place where an element lies, in the orientation of the triangle's front.
    pub fn vertices_at(&self, problem: &Problem, place: Place) -> [u32; 3] {
        self.vertices.at(problem, place)
    }

    /// Irradiance [lux] at vertex `v`.
    pub fn irradiance(&self, v: u32) -> Rgb {
        self.irradiance[v as usize]
    }

    /// Standard error [lux] at vertex `v`; NaN if it is not known.
    pub fn std_error(&self, v: u32) -> Rgb {
        self.std_error.get(v as usize).copied().unwrap_or(Rgb::grey(f32::NAN))
    }

    /// Where elements' edges have vertices of their neighbours on them; for programs that draw triangles.
    pub fn edge_points(&self, problem: &Problem) -> EdgePoints {
        EdgePoints::new(problem, &self.vertices)
    }

    /// Number of the place of vertex `v`: vertices on both sides of a sharp edge have the same.
    pub fn place(&self, v: u32) -> u32 {
        self.vertices.place(v)
    }

    /// World position [m] of a place.
    pub fn position_of_place(&self, place: u32) -> Vec3 {
        self.vertices.positions()[place as usize]
    }

    /// World position [m] of vertex `v`.
    pub fn position(&self, v: u32) -> Vec3 {
        self.vertices.position(v)
    }
}

/// Means at `vertices` of `values` of the elements, of whose areas the shares `open` count.
fn means(problem: &Problem, vertices: &Vertices, values: &[Rgb], open: &[f32]) -> Vec<Rgb> {
    let weight = |e: u32| problem.mesh.area(e) * open[e as usize];
    (0..vertices.len() as u32).into_par_iter().map(|v| vertex_mean(vertices.touching(v), values, weight)).collect()
}

/// Weighted mean of the values of `elements`; the plain mean if none has a weight. Summed as deviations from the first, so
/// that equal values have exactly that value as their mean.
fn vertex_mean(elements: &[u32], values: &[Rgb], weight: impl Fn(u32) -> f32) -> Rgb {
    let Some(&first) = elements.first() else { return Rgb::BLACK };
    let base = values[first as usize];
    let (mut deviation, mut total) = (Rgb::BLACK, 0.0);
    let covered = elements.iter().all(|&e| weight(e) <= 0.0);
    for &e in elements {
        let w = if covered { 1.0 } else { weight(e) };
        deviation += (values[e as usize] - base) * w;
        total += w;
    }
    base + deviation / total
}

#[cfg(test)]
mod tests {
    use super::super::plastic;
    use super::*;
    use crate::mesh::{Cut, Slices};
    use crate::scene::{Material, Object, Scene, Triangle, Vertex};
    use crate::view::tests::solution;

    /// One-sided, white; each polygon a fan of triangles with vertices of its own.
    fn scene(polygons: &[&[Vec3]]) -> Scene {
        let mut scene = Scene::default();
        scene.materials.push(Material::diffuse("", Rgb::grey(0.5)));
        scene.objects.push(Object { name: String::new(), material: 0 });
        for polygon in polygons {
            let base = scene.vertices.len() as u32;
            scene.vertices.extend(polygon.iter().map(|p| Vertex::at(*p)));
            for k in 1..polygon.len() as u32 - 1 {
                let source = scene.triangles.len() as u32;
                scene.triangles.push(Triangle { vertices: [base, base + k, base + k + 1], object: 0, source });
            }
        }
        scene
    }

    fn field(scene: Scene, divisions: &[u16], irradiance: impl Fn(Vec3) -> f32) -> (Problem, VertexField) {
        field_of_cut(scene, &Cut::regular(divisions), irradiance)
    }

    fn field_of_cut(scene: Scene, cut: &Cut, irradiance: impl Fn(Vec3) -> f32) -> (Problem, VertexField) {
        let problem = Problem::with_cut(scene, cut).unwrap();
        let mean = |e: u32| {
            let at = problem.mesh.corners(e).iter().sum::<Vec2>() / 3.0;
            Rgb::grey(irradiance(problem.geometry.surface(problem.mesh.triangle(e), at).0))
        };
        let solution = solution(problem.mesh.elements().map(mean).collect());
        let field = VertexField::new(&problem, &solution);
        (problem, field)
    }

    /// A square in the plane z = 0, halved; both halves have the edge from (0, 0) to (1, 1).
    fn square() -> Scene {
        let [a, b, c, d] = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
        scene(&[&[a, b, c], &[a, c, d]])
    }

    #[test]
    fn a_flat_wall_has_no_seam_where_divisions_differ() {
        for (fine, coarse) in [(6, 3), (7, 4), (12, 5), (9, 1), (8, 8)] {
            let (problem, field) = field(square(), &[fine, coarse], |p| 10.0 + 3.0 * p.x - p.y);
            for k in 0..=1000 {
                let s = k as f32 / 1000.0;
                let one = field.irradiance_at(&problem, 0, Vec2::new(0.0, s), false).g;
                let other = field.irradiance_at(&problem, 1, Vec2::new(s, 0.0), false).g;
                let step = 4.0 / f32::from(coarse);
                let bend = if fine % coarse == 0 { 1e-5 } else { 0.1 * step };
                assert!((one - other).abs() < bend, "{fine} {coarse} at {s}: {one} {other}");
            }
        }
    }

    #[test]
    fn a_flat_wall_has_no_seam_where_patches_are_split() {
        // Each half split unevenly, twice and three times; beside whole parts that are cut finer and coarser.
        let split = vec![0, 0, 1, 0, 2, 1, 4, 1, 1, 2, 4, 1, 1, 0, 0, 1, 1, 1, 2, 1, 1, 8];
        let cut = Cut { slices: vec![Slices::WHOLE; 2], divisions: split, leaders: Vec::new() };
        let (problem, field) = field_of_cut(square(), &cut, |p| 10.0 + 3.0 * p.x - p.y + 2.0 * (9.0 * p.x * p.y).sin());
        let mesh = &problem.mesh;
        let light = |triangle, uv| field.irradiance_at(&problem, triangle, uv, false).g;
        let (mut inside, mut between) = (0, 0);
        for e in mesh.elements() {
            let (triangle, corners) = (mesh.triangle(e), mesh.corners(e));
            let middle = corners.iter().sum::<Vec2>() / 3.0;
            for (k, j) in (0..3).flat_map(|k| (1..16).map(move |j| (k, j as f32 / 16.0))) {
                let on_edge = corners[k].lerp(corners[(k + 1) % 3], j);
                let away = (on_edge - middle) * 1e-4;
                let [near, beyond] = [on_edge - away, on_edge + away];
                if beyond.min_element() > 0.0 && beyond.x + beyond.y < 1.0 {
                    inside += 1;
                    let jump = (light(triangle, near) - light(triangle, beyond)).abs();
                    assert!(jump < 5e-3, "{e} {on_edge}: {jump}");
                }
            }
        }
        for k in 0..=1000 {
            let s = k as f32 / 1000.0;
            between += 1;
            let jump = (light(0, Vec2::new(0.0, s)) - light(1, Vec2::new(s, 0.0))).abs();
            assert!(jump < 1e-3, "{s}: {jump}");
        }
        assert!(inside > 1000 && between > 1000);
    }

    #[test]
    fn a_linear_field_is_followed_inside_a_wall() {
        let (problem, field) = field(square(), &[16, 16], |p| 10.0 + 3.0 * p.x - p.y);
        for uv in [Vec2::new(0.3, 0.4), Vec2::new(0.51, 0.22), Vec2::splat(0.333)] {
            let p = problem.geometry.surface(0, uv).0;
            assert!((field.irradiance_at(&problem, 0, uv, false).g - (10.0 + 3.0 * p.x - p.y)).abs() < 1e-3);
        }
    }

    #[test]
    fn a_draft_of_light_without_noise_is_the_field_whoever_had_its_vertices_before() {
        let (problem, field) = field(square(), &[7, 7], |p| 10.0 + p.x);
        let dark = solution(vec![Rgb::BLACK; problem.mesh.len()]);
        let mean = |e: u32| {
            let at = problem.mesh.corners(e).iter().sum::<Vec2>() / 3.0;
            Rgb::grey(10.0 + problem.geometry.surface(problem.mesh.triangle(e), at).0.x)
        };
        let light = solution(problem.mesh.elements().map(mean).collect());
        let draft = VertexField::draft(&problem, &light, Some(VertexField::draft(&problem, &dark, None)));
        assert!(
            field.len() == draft.len() && (0..field.len() as u32).all(|v| field.irradiance(v) == draft.irradiance(v))
        );
    }

    #[test]
    fn a_constant_field_stays_exactly_constant() {
        let (_, field) = field(square(), &[7, 4], |_| 0.1);
        assert!((0..field.len() as u32).all(|v| field.irradiance(v) == Rgb::grey(0.1)));
    }

    #[test]
    fn a_cube_keeps_its_edges_sharp() {
        let corner = |k: u32| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32);
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let faces = faces.map(|face| face.map(corner));
        let polygons: Vec<&[Vec3]> = faces.iter().map(|face| face.as_slice()).collect();
        // Light that is different on each face: 1 to 6, as its centre says.
        let light = |p: Vec3| (0..6).find(|&f| (p - 0.5).dot(faces[f].iter().sum::<Vec3>() / 4.0 - 0.5) > 0.249);
        let (problem, field) = field(scene(&polygons), &[1; 12], |p| light(p).map_or(0.0, |f| f as f32 + 1.0));
        assert_eq!(field.len(), 24);
        for e in problem.mesh.elements() {
            let expected = Rgb::grey((problem.mesh.triangle(e) / 2 + 1) as f32);
            assert!(
                field.vertices_at(&problem, problem.mesh.place(e)).iter().all(|&v| field.irradiance(v) == expected)
            );
        }
    }

    #[test]
    fn a_finely_cut_ball_is_smooth_all_over() {
        let at = |i: usize, j: usize| {
            let (theta, phi) = (i as f32 / 12.0 * std::f32::consts::PI, (j % 24) as f32 / 12.0 * std::f32::consts::PI);
            Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
        };
        let quad = |i, j| {
            if i == 0 {
                vec![at(0, 0), at(1, j), at(1, j + 1)]
            } else {
                vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
            }
        };
        let polygons: Vec<Vec<Vec3>> = (0..11).flat_map(|i| (0..24).map(move |j| quad(i, j))).collect();
        let cap: Vec<Vec<Vec3>> = (0..24).map(|j| vec![at(11, j), at(12, 0), at(11, j + 1)]).collect();
        let all: Vec<&[Vec3]> = polygons.iter().chain(&cap).map(Vec::as_slice).collect();
        let scene = scene(&all);
        let divisions = vec![1; scene.triangles.len()];
        let (_, field) = field(scene, &divisions, |p| 2.0 + p.z);
        assert_eq!(field.len(), 11 * 24 + 2);
    }

    #[test]
    fn darkness_under_a_lid_does_not_reach_the_open_floor() {
        // A floor, dark where a closed lid stands on it; the lid's border runs through the middle of elements.
        let (low, high) = (0.3125, 0.6875);
        let corner = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
        let [a, b, c, d] =
            [corner(low, low, 0.2), corner(high, low, 0.2), corner(high, high, 0.2), corner(low, high, 0.2)];
        let foot = |p: Vec3| p.with_z(0.0);
        let top = [a, b, c, d];
        let floor = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
        let sides = [[a, b], [b, c], [c, d], [d, a]].map(|[p, q]| [foot(p), foot(q), q, p]);
        let mut polygons: Vec<&[Vec3]> = vec![&floor];
        polygons.push(&top);
        polygons.extend(sides.iter().map(|s| s.as_slice()));
        let inside = |p: Vec3| p.x > low && p.x < high && p.y > low && p.y < high && p.z < 0.1;
        let scene = scene(&polygons);
        let problem = Problem::with_cut(scene, &Cut::regular(&[&[16u16, 16][..], &[1; 10][..]].concat())).unwrap();
        let share_lit = |e: u32| {
            let at = |k| {
                let (triangle, uv) = problem.mesh.point(e, plastic::point(9, k));
                problem.geometry.surface(triangle, uv).0
            };
            (0..400).filter(|&k| !inside(at(k))).count() as f32 / 400.0
        };
        let light = problem
            .mesh
            .elements()
            .map(|e| Rgb::grey(if problem.mesh.triangle(e) < 2 { 5.0 * share_lit(e) } else { 5.0 }));
        let field = VertexField::new(&problem, &solution(light.collect()));
        for k in 0..100u32 {
            for l in 0..100u32 {
                let uv = Vec2::new(k as f32, l as f32) / 100.0;
                let p = problem.geometry.surface(0, uv).0;
                if uv.x + uv.y < 1.0 && !inside(p) {
                    assert!((field.irradiance_at(&problem, 0, uv, false).g - 5.0).abs() < 0.6, "{p}");
                }
            }
        }
    }
}
