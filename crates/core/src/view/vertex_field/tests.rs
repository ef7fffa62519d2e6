use super::super::plastic;
use super::*;
use crate::mesh::{Cut, Division, Slices};
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
fn a_flat_wall_has_no_seam_where_patches_are_bisected() {
    // Each triangle bisected unevenly; beside whole parts that are cut finer and coarser.
    let (bisected, cells) = (|from| Division::Bisected { from, share: 0.5 }, Division::Cells);
    let first = [bisected(0), bisected(1), cells(1), bisected(2), cells(2), cells(1), bisected(0), cells(4), cells(1)];
    let second = [bisected(1), cells(1), bisected(0), cells(2), bisected(1), bisected(2), cells(1), cells(1), cells(8)];
    let cut = Cut { slices: vec![Slices::WHOLE; 2], divisions: [first, second].concat(), leaders: Vec::new() };
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
fn a_gradient_runs_straight_where_elements_of_different_lengths_meet() {
    let bisected = |from| Division::Bisected { from, share: 0.5 };
    let tree = [bisected(0), bisected(1), Division::Cells(4), Division::Cells(4), Division::Cells(4)];
    let divisions = tree.repeat(2);
    let cut = Cut { slices: vec![Slices::WHOLE; 2], divisions, leaders: Vec::new() };
    let light = |p: Vec3| 10.0 + 3.0 * p.x - p.y;
    let (_, field) = field_of_cut(square(), &cut, light);
    let off = |v: u32| (field.irradiance(v).g - light(field.position(v))).abs();
    let inside = |v: &u32| {
        let p = field.position(*v).truncate();
        p.min_element().min(1.0 - p.max_element()) > 0.1
    };
    let worst = (0..field.len() as u32).filter(inside).map(off).fold(0.0, f32::max);
    // By area alone it is 0.14. What is left is at vertices in the middle of a neighbour's edge, which touch elements on one side only.
    assert!(worst < 0.1, "{worst}");
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
    let draft =
        VertexField::draft(&problem, &light.irradiance, Some(VertexField::draft(&problem, &dark.irradiance, None)));
    assert!(field.len() == draft.len() && (0..field.len() as u32).all(|v| field.irradiance(v) == draft.irradiance(v)));
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
        assert!(field.vertices_at(&problem, problem.mesh.place(e)).iter().all(|&v| field.irradiance(v) == expected));
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
    let [a, b, c, d] = [corner(low, low, 0.2), corner(high, low, 0.2), corner(high, high, 0.2), corner(low, high, 0.2)];
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
    let light =
        problem.mesh.elements().map(|e| Rgb::grey(if problem.mesh.triangle(e) < 2 { 5.0 * share_lit(e) } else { 5.0 }));
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
