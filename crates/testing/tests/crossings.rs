//! The crossings of global lines and of bundles, one by one, against rays. Where they differ, a line passes within rounding
//! of an edge.

use glam::{Vec2, Vec3};
use isolux_core::Problem;
use isolux_core::geometry::raster::{Raster, grid::Grid};
use isolux_core::geometry::{Hit, HitLists, Ray};
use isolux_core::math::warp::square_to_sphere;
use isolux_core::transport::global_line;
use isolux_testing::random::Random;
use isolux_testing::scenes::problem;

/// Distance [m] of the line of `ray` from the border of a triangle.
fn distance_from_border(problem: &Problem, ray: &Ray, triangle: u32) -> f32 {
    let across = problem.scene.corners(triangle).map(|corner| {
        let relative = corner - ray.origin;
        relative - relative.dot(ray.direction) * ray.direction
    });
    let distance = |k: usize| {
        let (a, edge) = (across[k], across[(k + 1) % 3] - across[k]);
        let nearest = (-a.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
        (a + nearest * edge).length()
    };
    distance(0).min(distance(1)).min(distance(2))
}

/// How many times farther hits are off along the line than across it.
fn slope(problem: &Problem, ray: &Ray, hit: &Hit) -> f32 {
    1.0 / problem.geometry.surface(hit.triangle, hit.uv).1.dot(ray.direction).abs().max(1e-6)
}

/// A ray from one crossing towards another, and what it should hit.
fn look(problem: &Problem, here: Hit, there: Hit, direction: Vec3, forwards: bool) -> (Ray, Hit) {
    let (point, front) = problem.geometry.surface(here.triangle, here.uv);
    let normal = if front.dot(direction) < 0.0 { -front } else { front };
    let ray = Ray { origin: point + normal * problem.geometry.lift(), direction, from: here.triangle };
    (ray, Hit { t: (there.t - here.t).abs(), back: there.back == forwards, ..there })
}

#[test]
fn consecutive_crossings_are_what_rays_from_either_of_them_hit() {
    for name in ["box", "cornell-box", "cubes", "office", "sphere"] {
        let problem = problem(name, 1);
        let sphere = problem.geometry.bounding_sphere();
        let mut random = Random::new(1);
        let lines: Vec<Ray> = (0..20_000).map(|_| global_line::ray([0; 4].map(|_| random.uniform()), sphere)).collect();
        let mut lists = HitLists::default();
        problem.geometry.all(&lines, &mut lists);
        let (mut rays, mut expected) = (Vec::new(), Vec::new());
        for (line, crossings) in lines.iter().zip(lists.iter()) {
            for pair in crossings.windows(2) {
                for (ray, hit) in [
                    look(&problem, pair[0], pair[1], line.direction, true),
                    look(&problem, pair[1], pair[0], -line.direction, false),
                ] {
                    rays.push(ray);
                    expected.push(hit);
                }
            }
        }
        let mut hits = vec![Hit::MISS; rays.len()];
        problem.geometry.closest(&rays, &mut hits);
        let mut different = 0;
        for ((ray, hit), expected) in rays.iter().zip(&hits).zip(&expected) {
            if hit.triangle == expected.triangle {
                let tolerance = 4.0 * problem.geometry.lift() * slope(&problem, ray, hit);
                assert!(hit.back == expected.back && (hit.t - expected.t).abs() < tolerance, "{hit:?} {expected:?}");
            } else {
                let border = |triangle| distance_from_border(&problem, ray, triangle);
                assert!(!hit.is_miss(), "{name}: {ray:?} {expected:?}");
                let nearest = border(hit.triangle).min(border(expected.triangle));
                assert!(nearest < 2.0 * problem.geometry.lift(), "{name}: {nearest} {ray:?} {hit:?} {expected:?}");
                different += 1;
            }
        }
        assert!(rays.len() > 20_000 && different * 1000 < rays.len(), "{name}: {different} of {}", rays.len());
    }
}

/// Holds `hits` of `line` against `others`; the number of those that are missing there.
fn missing(problem: &Problem, line: &Ray, hits: &[Hit], others: &[Hit]) -> usize {
    let rounding = 4e-6 * problem.geometry.bounding_sphere().1;
    let mut missing = 0;
    for hit in hits {
        if let Some(other) = others.iter().find(|other| other.triangle == hit.triangle) {
            let slope = slope(problem, line, hit);
            let point = |hit: &Hit| problem.geometry.surface(hit.triangle, hit.uv).0;
            let apart = point(hit).distance(point(other)).max((hit.t - other.t).abs());
            assert!(apart < rounding * slope && (hit.back == other.back || slope > 1e4), "{hit:?} {other:?}");
        } else {
            let border = distance_from_border(problem, line, hit.triangle);
            assert!(border < rounding, "{border} {line:?} {hit:?}");
            missing += 1;
        }
    }
    missing
}

#[test]
fn rasterised_crossings_are_those_of_rays() {
    for name in ["box", "cornell-box", "cubes", "office"] {
        let problem = problem(name, 1);
        let mut random = Random::new(2);
        let (mut crossings, mut different) = (0, 0);
        for _ in 0..6 {
            let (direction, offset) = (square_to_sphere(random.square()).normalize(), random.square());
            let grid = Grid::new(problem.geometry.bounding_sphere(), direction, offset, 150);
            let raster = Raster::of(&problem.scene, grid);
            for tile in 0..grid.tiles() {
                let lines = grid.lines(tile);
                let (rasterised, mut traced) = (raster.hits(tile), HitLists::default());
                problem.geometry.all(&lines, &mut traced);
                assert_eq!((rasterised.len(), traced.len()), (lines.len(), lines.len()));
                for ((a, b), line) in rasterised.iter().zip(traced.iter()).zip(&lines) {
                    let a = &a.collect::<Vec<Hit>>();
                    crossings += b.len();
                    different += missing(&problem, line, a, b) + missing(&problem, line, b, a);
                }
            }
        }
        assert!(crossings > 50_000 && different * 1000 < crossings, "{name}: {different} of {crossings}");
    }
}

/// A room whose walls meet the lines head-on, with corners on the very points of the grid.
#[test]
fn lines_through_shared_edges_cross_once() {
    let problem = problem("box:width=4,height=4,depth=4", 1);
    let (center, _) = problem.geometry.bounding_sphere();
    let grid = Grid::new((center, 4.0), Vec3::Z, Vec2::ZERO, 8);
    let raster = Raster::of(&problem.scene, grid);
    let crossed: Vec<usize> = raster.hits(0).iter().map(|hits| hits.len()).collect();
    // Lines a metre apart: four by four of them in a room of four metres, some through diagonals, edges and corners.
    assert_eq!(crossed.iter().filter(|&&crossings| crossings == 2).count(), 16);
    assert_eq!(crossed.iter().sum::<usize>(), 32);
}
