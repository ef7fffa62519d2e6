//! What stands on a surface divides it: nothing is interpolated across its foot.
//!
//! A surface is smooth across the line on which a wall stands, but its light is not. So grid points on such a line
//! ([`Scene::contacts`](crate::scene::Scene::contacts)) are one vertex only if a way leads around their place from one to the other, across edges on which
//! nothing stands: at the free end of a wall both its sides meet again. Cost: a look at the triangles with such edges.

use super::grid::{self, Grid, Side};
use super::vertices::group_by;
use crate::Problem;
use glam::{Vec2, Vec3};
use std::collections::HashMap;

/// Barycentric coordinates this close to a border lie on it.
const ON_BORDER: f32 = 1e-5;
/// Cosine between directions that are the same but for rounding.
const SAME: f32 = 1.0 - 1e-6;

/// Triangles with edges on which something stands.
pub struct Contacts {
    /// Whether something stands on the edge from corner k to the next.
    edges: HashMap<u32, [bool; 3]>,
}

/// A grid point on the border of a triangle.
struct Member {
    grid_point: usize,
    side: Side,
    triangle: u32,
    /// Unit vectors along the edges that leave it, and whether something stands on each.
    ways: Vec<(Vec3, bool)>,
}

impl Contacts {
    pub fn new(problem: &Problem) -> Contacts {
        let scene = &problem.scene;
        let stands_on = |a: u32, b: u32| scene.contacts.binary_search(&[a.min(b), a.max(b)]).is_ok();
        let of_triangle = |t: u32| {
            let [a, b, c] = scene.triangles[t as usize].vertices;
            let edges = [stands_on(a, b), stands_on(b, c), stands_on(c, a)];
            edges.contains(&true).then_some((t, edges))
        };
        let all = if scene.contacts.is_empty() { 0 } else { scene.triangles.len() as u32 };
        Contacts { edges: (0..all).filter_map(of_triangle).collect() }
    }

    /// Whether something stands where both points lie, in barycentric coordinates of `triangle`.
    pub fn divide_along(&self, triangle: u32, [p, q]: [Vec2; 2]) -> bool {
        let Some(edges) = self.edges.get(&triangle) else { return false };
        (0..3).any(|k| edges[k] && is_on(k, p) && is_on(k, q))
    }

    /// Gives grid points at the same place vertices of their own, where something stands between them. `places` are those of all grid
    /// points, `place_of_vertex` gets those of new vertices.
    pub fn divide(
        &self,
        problem: &Problem,
        grid: &Grid,
        places: &[u32],
        vertex: &mut [u32],
        place_of_vertex: &mut Vec<u32>,
    ) {
        if self.edges.is_empty() {
            return;
        }
        let mut is_divided = vec![false; places.iter().max().map_or(0, |last| *last as usize + 1)];
        self.visit(problem, grid, |g, side, uv| {
            let edges = self.edges.get(&side.triangle(&problem.mesh));
            is_divided[places[g] as usize] |= edges.is_some_and(|edges| (0..3).any(|k| edges[k] && is_on(k, uv)));
        });
        let mut members: Vec<Member> = Vec::new();
        self.visit(problem, grid, |g, side, uv| {
            if is_divided[places[g] as usize] {
                let triangle = side.triangle(&problem.mesh);
                members.push(Member { grid_point: g, side, triangle, ways: self.ways(problem, triangle, uv) });
            }
        });
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

    /// Shows all grid points with their barycentric coordinates on the triangle.
    fn visit(&self, problem: &Problem, grid: &Grid, mut see: impl FnMut(usize, Side, Vec2)) {
        let mesh = &problem.mesh;
        let mut number = 0;
        for side in grid.sides(mesh) {
            for point in grid::points(mesh.divisions(side.patch)) {
                see(number, side, grid::on_triangle(mesh, side.patch, point));
                number += 1;
            }
        }
    }

    /// The edges of `triangle` that leave the point `uv` of its border.
    fn ways(&self, problem: &Problem, triangle: u32, uv: Vec2) -> Vec<(Vec3, bool)> {
        let corners = problem.scene.corners(triangle);
        let edges = self.edges.get(&triangle).copied().unwrap_or_default();
        let here = corners[0] + uv.x * (corners[1] - corners[0]) + uv.y * (corners[2] - corners[0]);
        let mut ways = Vec::new();
        for k in (0..3).filter(|&k| is_on(k, uv)) {
            for (end, other) in [(k, (k + 2) % 3), ((k + 1) % 3, (k + 1) % 3)] {
                // From a corner no edge leads to itself.
                if !(is_on(k, uv) && is_on(other, uv)) {
                    ways.push(((corners[end] - here).normalize_or_zero(), edges[k]));
                }
            }
        }
        ways
    }
}

/// Whether `uv` lies on edge `k`.
fn is_on(k: usize, uv: Vec2) -> bool {
    [uv.y, 1.0 - uv.x - uv.y, uv.x][k].abs() < ON_BORDER
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

/// Whether two members lie on the same triangle, or on both sides of an edge on which nothing stands.
fn is_open_between(a: &Member, b: &Member) -> bool {
    if a.triangle == b.triangle {
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
    use crate::mesh::Resolution;
    use crate::scene::builtin::shapes::Builder;
    use crate::scene::{Material, Scene, cut_at_contacts};
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
        cut_at_contacts(builder.finish(), 0.02)
    }

    fn beside_wall(p: Vec3) -> f32 {
        if p.x < 0.4 { 1.0 } else { 9.0 }
    }

    /// Values of the field at the floor's vertices, where the light on elements is given by their middles.
    fn at_vertices(scene: Scene, light: impl Fn(Vec3) -> f32) -> Vec<(Vec3, f32)> {
        let problem = Problem::new(scene, Resolution::Elements(3000)).unwrap();
        let middle = |e: u32| {
            let corners = problem.mesh.corners(e).map(|uv| problem.geometry.surface(problem.mesh.triangle(e), uv).0);
            corners.iter().sum::<Vec3>() / 3.0
        };
        let light = |e: u32| Rgb::grey(light(middle(e)));
        let field = VertexField::new(&problem, &solution(problem.mesh.elements().map(light).collect()));
        let of_element = |e: u32| field.vertices_at(&problem, problem.mesh.place(e));
        let floor = problem.mesh.elements().filter(|&e| problem.object(e) == 0);
        floor.flat_map(of_element).map(|v| (field.position(v), field.irradiance(v).g)).collect()
    }

    #[test]
    fn light_is_not_mixed_across_a_wall() {
        let mixed = |(_, light): &&(Vec3, f32)| *light > 1.001 && *light < 8.999;
        let divided = at_vertices(scene(1.0), beside_wall);
        assert_eq!(divided.iter().filter(mixed).count(), 0);
        let both = |at: &dyn Fn(f32) -> bool| {
            divided.iter().filter(|(p, light)| (p.x - 0.4).abs() < 1e-5 && at(*light)).count()
        };
        assert!(both(&|light| light < 2.0) > 10 && both(&|light| light > 8.0) > 10);
        // What is remembered of the contacts does it.
        let forgotten = Scene { contacts: Vec::new(), ..scene(1.0) };
        assert!(at_vertices(forgotten, beside_wall).iter().filter(mixed).count() > 10);
    }

    #[test]
    fn a_box_on_a_floor_hides_what_is_below() {
        let mut builder = Builder::new("divided");
        let white = builder.material(Material::diffuse("white", Rgb::grey(0.5)));
        builder.object("floor", white);
        builder.polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0)));
        builder.object("box", white);
        builder.cuboid(Vec3::new(0.31, 0.33, 0.0), Vec3::new(0.72, 0.69, 0.4));
        let scene = cut_at_contacts(builder.finish(), 0.03);
        let is_below = |p: Vec3| p.x > 0.31 && p.x < 0.72 && p.y > 0.33 && p.y < 0.69;
        let all = at_vertices(scene, |p| if is_below(p) { 0.0 } else { 1.0 });
        let mixed = all.iter().filter(|(_, light)| *light > 1e-3 && *light < 0.999);
        assert_eq!(mixed.collect::<Vec<_>>(), Vec::<&(Vec3, f32)>::new());
        let seen = |p: &Vec3| p.x < 0.3 || p.x > 0.73 || p.y < 0.32 || p.y > 0.7;
        assert!(all.iter().all(|(p, light)| *light == 1.0 || !seen(p)));
    }

    #[test]
    fn nothing_dark_shows_beside_the_boxes_of_a_room() {
        let scene = cut_at_contacts(crate::scene::builtin::builtin("cornell-box").unwrap(), 0.004);
        let problem = Problem::new(scene, Resolution::Elements(20_000)).unwrap();
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
        let light = at_vertices(scene(0.5), beside_wall);
        let is_mixed = |light: f32| light > 1.001 && light < 8.999;
        assert!(light.iter().any(|&(p, light)| p.y > 0.55 && (p.x - 0.4).abs() < 0.1 && is_mixed(light)));
        // Elements beyond the end may reach a little back.
        assert!(light.iter().all(|&(p, light)| p.y > 0.4 || !is_mixed(light)));
    }
}
