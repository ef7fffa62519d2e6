use super::borders::Borders;
use super::*;
use crate::math::Rgb;
use crate::scene::builtin::builtin;
use crate::view::tests::solution;
use glam::{Vec2, Vec3};

/// A pilot of a built-in scene under made-up light [lux] at every place [m].
fn pilot(name: &str, elements: u64, light: impl Fn(Vec3) -> f32) -> (Problem, Solution) {
    let problem = Problem::new(builtin(name).unwrap(), Resolution::Elements(elements)).unwrap();
    let mean = |e: u32| {
        let at = problem.mesh.corners(e).iter().sum::<Vec2>() / 3.0;
        Rgb::grey(light(problem.geometry.surface(problem.mesh.triangle(e), at).0))
    };
    let solution = solution(problem.mesh.elements().map(mean).collect());
    (problem, solution)
}

/// Brighter and brighter towards the middle of the floor.
fn pool(p: Vec3) -> f32 {
    100.0 * (-p.distance_squared(Vec3::new(0.3, 0.0, -0.2))).exp()
}

#[test]
fn the_budget_is_used_and_never_exceeded() {
    for name in ["cornell-box", "cubes"] {
        let (problem, solution) = pilot(name, 5000, pool);
        for elements in [6000, 20_000] {
            let count = adapt(&problem, &solution, elements).unwrap().element_count(&problem.scene).unwrap() as u64;
            assert!(count <= elements && count as f64 > 0.9 * elements as f64, "{name}: {count} of {elements}");
        }
    }
    let (problem, solution) = pilot("cubes", 100, pool);
    let least = Resolution::least(&problem.scene);
    assert_eq!(adapt(&problem, &solution, 1).unwrap().element_count(&problem.scene).unwrap() as u64, least);
}

#[test]
fn neighbours_differ_by_one_level() {
    // A jump along a slanted line: the smallest elements beside the largest.
    let (problem, solution) = pilot("cubes", 4000, |p| if p.x + 0.3 * p.z > 0.4 { 100.0 } else { 1.0 });
    let cut = adapt(&problem, &solution, 16_000).unwrap();
    let problem = problem.cut_anew(&cut).unwrap();
    let borders = Borders::of(&problem.scene, problem.geometry.as_ref());
    let (mut met, mut largest) = (0, 0f32);
    for e in problem.mesh.elements() {
        let leaf = forest::Leaf { triangle: problem.mesh.triangle(e), number: 0, corners: problem.mesh.corners(e) };
        for (triangle, uv) in balance::probes(&problem, &borders, &leaf) {
            let neighbour = problem.mesh.at(triangle, uv, false).unwrap();
            met += usize::from(problem.mesh.triangle(neighbour) != leaf.triangle);
            largest = largest.max(problem.mesh.area(neighbour) / problem.mesh.area(e));
        }
    }
    assert!(met > 100 && largest > 3.9 && largest < 8.1, "{met} across edges, {largest}");
}

#[test]
fn elements_have_equal_errors_where_the_light_is_smooth() {
    let (problem, solution) = pilot("cubes", 20_000, pool);
    let cut = adapt(&problem, &solution, 20_000).unwrap();
    let steep = problem.cut_anew(&cut).unwrap();
    // The light on the floor and its gradient are known: errors are g² h⁴ in [1/16, 1] of the largest, but for the floor of g.
    let error = |e: u32| {
        let at = steep.mesh.corners(e).iter().sum::<Vec2>() / 3.0;
        let p = steep.geometry.surface(steep.mesh.triangle(e), at).0;
        let tangent = (p - Vec3::new(0.3, 0.0, -0.2)).reject_from_normalized(steep.mesh.normal(e));
        (2.0 * pool(p) * tangent.length()).powi(2) * steep.mesh.area(e).powi(2)
    };
    let mut errors: Vec<f32> = steep.mesh.elements().map(error).filter(|error| *error > 0.0).collect();
    errors.sort_by(f32::total_cmp);
    let quantile = |q: f64| errors[(q * (errors.len() - 1) as f64) as usize];
    assert!(quantile(0.9) < 32.0 * quantile(0.4), "{} {}", quantile(0.4), quantile(0.9));
}

#[test]
fn the_mesh_is_finer_where_light_changes_and_the_same_again() {
    let edge = |p: Vec3| if p.x > 0.1 { 100.0 } else { 10.0 };
    let (problem, solution) = pilot("cubes", 4000, edge);
    let cut = adapt(&problem, &solution, 16_000).unwrap();
    assert!(adapt(&problem, &solution, 16_000).unwrap() == cut);
    let uniform = problem.mesh.total_area() as f32 / 16_000.0;
    let problem = problem.cut_anew(&cut).unwrap();
    let (mut near, mut far) = (0.0f32, f32::INFINITY);
    for e in problem.mesh.elements() {
        let at = problem.mesh.corners(e).iter().sum::<Vec2>() / 3.0;
        let x = problem.geometry.surface(problem.mesh.triangle(e), at).0.x;
        if (x - 0.1).abs() < 0.02 && problem.mesh.normal(e).x.abs() < 0.5 {
            near = near.max(problem.mesh.area(e));
        } else if (x - 0.1).abs() > 1.0 {
            far = far.min(problem.mesh.area(e));
        }
    }
    assert!(near < uniform && near < far, "{near} {uniform} {far}");
}

#[test]
fn no_light_makes_no_mesh_finer_than_asked() {
    let (problem, dark) = pilot("box", 1000, |_| 0.0);
    let count = adapt(&problem, &dark, 4000).unwrap().element_count(&problem.scene).unwrap();
    assert!((1000..=4000).contains(&count), "{count}");
}

#[test]
fn without_a_pilot_the_mesh_is_uniform() {
    let scene = builtin("cubes").unwrap();
    let mut calls = 0;
    let problem = follow_light(scene.clone(), 16_000, |_, _| {
        calls += 1;
        Ok::<_, Error>(None)
    });
    let problem = problem.unwrap();
    let uniform = Problem::new(scene.clone(), Resolution::Elements(16_000)).unwrap();
    assert!(calls == 1 && problem.mesh.cut() == uniform.mesh.cut());
    let failed = follow_light(scene, 16_000, |_, _| Err(Error::NoSurface));
    assert!(failed.is_err());
}
