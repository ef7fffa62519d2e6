//! What stands on a surface divides it: nothing is interpolated across its foot.
//!
//! A surface is smooth across the line on which a wall stands, but its light is not. So grid points on such a line
//! ([`ElementMesh::beside`]) are one vertex only if a way leads around their place from one to the other, across edges on which
//! nothing stands: at the free end of a wall both its sides meet again. Cost: a look at the patches with such edges.

use super::grid::{self, Grid, Side};
use super::vertices::{Vertices, group_by};
use crate::Problem;
use crate::mesh::ElementMesh;
use glam::Vec3;

/// Cosine between directions that are the same but for rounding.
const SAME: f32 = 1.0 - 1e-6;

/// A grid point on the border of a patch.
struct Member {
    grid_point: usize,
    side: Side,
    /// Unit vectors along the edges that leave it, and whether something stands on each.
    ways: Vec<(Vec3, bool)>,
}

/// Whether something stands where both grid points of `patch` lie.
pub fn divide_along(mesh: &ElementMesh, patch: u32, [p, q]: [[u32; 2]; 2]) -> bool {
    let (beside, m) = (mesh.beside(patch), mesh.divisions(patch));
    (0..3).any(|k| beside[k] && is_on(k, p, m) && is_on(k, q, m))
}

/// Whether something stands at each vertex.
pub fn at_foot(problem: &Problem, vertices: &Vertices) -> Vec<bool> {
    let mut at_foot = vec![false; vertices.len()];
    for side in vertices.grid.sides(&problem.mesh) {
        for point in foot(&problem.mesh, side.patch) {
            at_foot[vertices.of_grid_point(vertices.grid.number(&problem.mesh, side, point)) as usize] = true;
        }
    }
    at_foot
}

/// The grid points of `patch` on edges on which something stands.
fn foot(mesh: &ElementMesh, patch: u32) -> impl Iterator<Item = [u32; 2]> {
    let (beside, m) = (mesh.beside(patch), mesh.divisions(patch));
    let all = (beside != [false; 3]).then(|| grid::points(m)).into_iter().flatten();
    all.filter(move |&point| (0..3).any(|k| beside[k] && is_on(k, point, m)))
}

/// Gives grid points at the same place vertices of their own, where something stands between them. `places` are those of all grid
/// points, `place_of_vertex` gets those of new vertices.
pub fn divide(problem: &Problem, grid: &Grid, places: &[u32], vertex: &mut [u32], place_of_vertex: &mut Vec<u32>) {
    let mesh = &problem.mesh;
    let mut is_divided = vec![false; places.iter().max().map_or(0, |last| *last as usize + 1)];
    for side in grid.sides(mesh) {
        let foot = foot(mesh, side.patch);
        foot.for_each(|point| is_divided[places[grid.number(mesh, side, point)] as usize] = true);
    }
    if !is_divided.contains(&true) {
        return;
    }
    let mut members: Vec<Member> = Vec::new();
    for side in grid.sides(mesh) {
        for point in grid::points(mesh.divisions(side.patch)) {
            let grid_point = grid.number(mesh, side, point);
            if is_divided[places[grid_point] as usize] {
                members.push(Member { grid_point, side, ways: ways(problem, side.patch, point) });
            }
        }
    }
    let (first, sorted) = group_by(place_of_vertex.len(), members.len(), |k| vertex[members[k].grid_point]);
    for range in first.windows(2).filter(|range| range[1] > range[0] + 1) {
        let here: Vec<&Member> = sorted[range[0]..range[1]].iter().map(|&k| &members[k]).collect();
        let parts = parts(&here);
        let (old, place) = (vertex[here[0].grid_point], places[here[0].grid_point]);
        let next = place_of_vertex.len() as u32;
        let count = parts.iter().max().map_or(0, |last| *last);
        place_of_vertex.extend((0..count).map(|_| place));
        for (member, part) in here.iter().zip(parts) {
            vertex[member.grid_point] = if part == 0 { old } else { next + part - 1 };
        }
    }
}

/// The edges of `patch` that leave a grid point on its border.
fn ways(problem: &Problem, patch: u32, point: [u32; 2]) -> Vec<(Vec3, bool)> {
    let mesh = &problem.mesh;
    let (beside, m) = (mesh.beside(patch), mesh.divisions(patch));
    let position = |[i, j]: [u32; 2]| {
        let uv = grid::on_triangle(mesh, patch, [i, j]);
        problem.geometry.surface(mesh.triangle_of_patch(patch), uv).0
    };
    let (here, m32) = (position(point), u32::from(m));
    let corners = [[0, 0], [m32, 0], [0, m32]];
    let mut ways = Vec::new();
    for k in (0..3).filter(|&k| is_on(k, point, m)) {
        let ends = [corners[k], corners[(k + 1) % 3]].into_iter().filter(|&end| end != point);
        ways.extend(ends.map(|end| ((position(end) - here).normalize_or_zero(), beside[k])));
    }
    ways
}

/// Whether a grid point lies on edge `k` of a patch with `m` divisions.
fn is_on(k: usize, [i, j]: [u32; 2], m: u16) -> bool {
    match k {
        0 => j == 0,
        1 => i + j == u32::from(m),
        _ => i == 0,
    }
}

/// For each of the members at one place, the number of the part it belongs to, from 0.
fn parts(members: &[&Member]) -> Vec<u32> {
    let mut part: Vec<usize> = (0..members.len()).collect();
    for k in 0..members.len() {
        for other in 0..k {
            if is_open_between(members[k], members[other]) {
                let (from, to) = (part[k].max(part[other]), part[k].min(part[other]));
                part.iter_mut().filter(|part| **part == from).for_each(|part| *part = to);
            }
        }
    }
    let mut known = part.clone();
    known.sort_unstable();
    known.dedup();
    part.iter().map(|part| known.binary_search(part).unwrap_or(0) as u32).collect()
}

/// Whether two members lie on the same patch, or on both sides of an edge on which nothing stands.
fn is_open_between(a: &Member, b: &Member) -> bool {
    if a.side.patch == b.side.patch {
        return a.side.back == b.side.back;
    }
    let is_open = |&(way, stands): &(Vec3, bool)| {
        !stands && b.ways.iter().any(|&(other, stands)| !stands && way.dot(other) > SAME)
    };
    a.ways.iter().any(is_open)
}

#[cfg(test)]
mod tests {
    use crate::Problem;
    use crate::geometry::{Hit, Ray};
    use crate::math::Rgb;
    use crate::mesh::{Division, Resolution};
    use crate::scene::builtin::shapes::Builder;
    use crate::scene::{Material, Scene};
    use crate::view::VertexField;
    use crate::view::tests::solution;
    use glam::{Vec2, Vec3};

    /// A square floor, and a wall on it over the line x = 0.4 from y = 0 `to` y.
    fn scene(to: f32) -> Scene {
        let mut builder = Builder::new("divided");
        let floor = builder.material(Material::diffuse("floor", Rgb::grey(0.5)));
        let wall = builder.material(Material { two_sided: true, ..Material::diffuse("wall", Rgb::grey(0.5)) });
        builder.object("floor", floor);
        builder.polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0)));
        builder.object("wall", wall);
        builder.polygon(&[[0.0, 0.0], [to, 0.0], [to, 1.0], [0.0, 1.0]].map(|[y, z]| Vec3::new(0.4, y, z)));
        builder.finish()
    }

    /// Cut along contacts into 3000 elements.
    fn cut(scene: Scene) -> Problem {
        Problem::cut_along_contacts(scene, Resolution::Elements(3000), 0.02).unwrap()
    }

    fn beside_wall(p: Vec3) -> f32 {
        if p.x < 0.4 { 1.0 } else { 9.0 }
    }

    /// Values of the field at the floor's vertices, where the light on elements is given by their middles.
    fn at_vertices(problem: &Problem, light: impl Fn(Vec3) -> f32) -> Vec<(Vec3, f32)> {
        let middle = |e: u32| {
            let corners = problem.mesh.corners(e).map(|uv| problem.geometry.surface(problem.mesh.triangle(e), uv).0);
            corners.iter().sum::<Vec3>() / 3.0
        };
        let light = |e: u32| Rgb::grey(light(middle(e)));
        let field = VertexField::new(problem, &solution(problem.mesh.elements().map(light).collect()));
        let of_element = |e: u32| field.vertices_at(problem, problem.mesh.place(e));
        let floor = problem.mesh.elements().filter(|&e| problem.object(e) == 0);
        floor.flat_map(of_element).map(|v| (field.position(v), field.irradiance(v).g)).collect()
    }

    #[test]
    fn light_is_not_mixed_across_a_wall() {
        let mixed = |(_, light): &&(Vec3, f32)| *light > 1.001 && *light < 8.999;
        let divided = at_vertices(&cut(scene(1.0)), beside_wall);
        assert_eq!(divided.iter().filter(mixed).count(), 0);
        let both = |at: &dyn Fn(f32) -> bool| {
            divided.iter().filter(|(p, light)| (p.x - 0.4).abs() < 1e-5 && at(*light)).count()
        };
        assert!(both(&|light| light < 2.0) > 10 && both(&|light| light > 8.0) > 10);
        // What is remembered of the contacts does it.
        let mut forgotten = cut(scene(1.0)).mesh.cut();
        forgotten.divisions.retain(|division| !matches!(division, Division::Beside(_)));
        let forgotten = Problem::with_cut(scene(1.0), &forgotten).unwrap();
        assert!(at_vertices(&forgotten, beside_wall).iter().filter(mixed).count() > 10);
    }

    #[test]
    fn a_box_on_a_floor_hides_what_is_below() {
        let mut builder = Builder::new("divided");
        let white = builder.material(Material::diffuse("white", Rgb::grey(0.5)));
        builder.object("floor", white);
        builder.polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0)));
        builder.object("box", white);
        builder.cuboid(Vec3::new(0.31, 0.33, 0.0), Vec3::new(0.72, 0.69, 0.4));
        let problem = cut(builder.finish());
        let is_below = |p: Vec3| p.x > 0.31 && p.x < 0.72 && p.y > 0.33 && p.y < 0.69;
        let all = at_vertices(&problem, |p| if is_below(p) { 0.0 } else { 1.0 });
        let mixed = all.iter().filter(|(_, light)| *light > 1e-3 && *light < 0.999);
        assert_eq!(mixed.collect::<Vec<_>>(), Vec::<&(Vec3, f32)>::new());
        let seen = |p: &Vec3| p.x < 0.3 || p.x > 0.73 || p.y < 0.32 || p.y > 0.7;
        assert!(all.iter().all(|(p, light)| *light == 1.0 || !seen(p)));
    }

    #[test]
    fn nothing_dark_shows_beside_the_boxes_of_a_room() {
        let scene = crate::scene::builtin::builtin("cornell-box").unwrap();
        let problem = Problem::cut_along_contacts(scene, Resolution::Elements(20_000), 0.004).unwrap();
        let looks_up = |e: u32| {
            let middle = problem.mesh.corners(e).iter().sum::<Vec2>() / 3.0;
            let (from, normal) = problem.geometry.surface(problem.mesh.triangle(e), middle);
            let ray = Ray { origin: from + 1e-4 * normal, direction: normal, from: problem.mesh.triangle(e) };
            let mut hit = [Hit::MISS];
            problem.geometry.closest(&[ray], &mut hit);
            hit[0].is_miss() || !hit[0].back
        };
        let light = |e: u32| Rgb::grey(if looks_up(e) { 1.0 } else { 0.0 });
        let light: Vec<Rgb> = problem.mesh.elements().map(light).collect();
        let field = VertexField::new(&problem, &solution(light.clone()));
        let is_lit = |&e: &u32| light[e as usize].g > 0.5 && problem.object(e) == 0;
        for e in problem.mesh.elements().filter(is_lit) {
            let vertices = field.vertices_at(&problem, problem.mesh.place(e));
            assert!(
                vertices.iter().all(|&v| field.irradiance(v).g == 1.0),
                "{:?}",
                vertices.map(|v| field.position(v))
            );
        }
    }

    #[test]
    fn both_sides_meet_at_the_free_end_of_a_wall() {
        let light = at_vertices(&cut(scene(0.5)), beside_wall);
        let is_mixed = |light: f32| light > 1.001 && light < 8.999;
        assert!(light.iter().any(|&(p, light)| p.y > 0.55 && (p.x - 0.4).abs() < 0.1 && is_mixed(light)));
        // Elements beyond the end may reach a little back.
        assert!(light.iter().all(|&(p, light)| p.y > 0.4 || !is_mixed(light)));
    }
}
