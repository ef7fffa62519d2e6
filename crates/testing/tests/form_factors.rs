//! Form factors as probabilities of local lines, against exact answers. Each test also sees its own planted fault.

use glam::{Vec2, Vec3};
use isolux_core::Problem;
use isolux_core::geometry::{Geometry, Hit, Ray};
use isolux_core::math::Frame;
use isolux_core::math::warp::{square_to_cosine_hemisphere, square_to_triangle};
use isolux_core::mesh::Resolution;
use isolux_core::scene::Scene;
use isolux_core::scene::builtin::builtin;
use isolux_testing::budget::{assert_chi2, assert_z, refutes};
use isolux_testing::exact::{BLOCKED_SQUARES, parallel_rectangles, perpendicular_rectangles};
use isolux_testing::random::Random;
use isolux_testing::scenes::rectangles;
use isolux_testing::statistics::{chi_square, p_of_chi2, p_of_z, z_of_count};

/// What a line from a uniform point `uv` of a triangle in direction `local` about its normal hits.
fn line(geometry: &dyn Geometry, from: u32, uv: Vec2, local: Vec3) -> Hit {
    let (position, normal) = geometry.surface(from, uv);
    let origin = position + normal * geometry.lift();
    let mut hit = [Hit::MISS];
    geometry.closest(&[Ray { origin, direction: Frame::about(normal).to_world(local), from }], &mut hit);
    hit[0]
}

/// Chi-square of where lines from element `e` of the sphere land, against equal shares of all elements.
fn landing(problem: &Problem, e: u32, direction: impl Fn(Vec2) -> Vec3) -> (f64, f64) {
    const LINES: u64 = 40_000;
    let mut random = Random::new(u64::from(e));
    let mut landed = vec![0; problem.mesh.len()];
    for _ in 0..LINES {
        let (triangle, uv) = problem.mesh.point(e, random.square());
        let hit = line(&*problem.geometry, triangle, uv, direction(random.square()));
        let on = problem.mesh.at(hit.triangle, hit.uv, hit.back).expect("a line inside a sphere ends on its front");
        landed[on as usize] += 1;
    }
    let expected = LINES as f64 / landed.len() as f64;
    chi_square(&landed, &vec![expected; landed.len()])
}

#[test]
fn inside_a_sphere_every_element_sees_every_other_by_its_area() {
    let problem = Problem::new(builtin("sphere").unwrap(), Resolution::Elements(8 * 49)).unwrap();
    assert_eq!(problem.mesh.len(), 8 * 49);
    for e in (0..8).map(|k| k * 49 + 6 * k) {
        let (chi2, dof) = landing(&problem, e, square_to_cosine_hemisphere);
        assert_chi2("form factors of the sphere by local lines", chi2, dof);
    }
    // The fault: directions uniform over the hemisphere, the cosine forgotten.
    let uniform = |u: Vec2| {
        let (radius, angle) = ((1.0 - u.x * u.x).sqrt(), std::f32::consts::TAU * u.y);
        Vec3::new(radius * angle.cos(), radius * angle.sin(), u.x.max(1e-4))
    };
    let (chi2, dof) = landing(&problem, 0, uniform);
    assert!(refutes(p_of_chi2(chi2, dof)));
}

/// Uniform points of an octant, sorted into 6 x 6 cells of equal area made of longitude and height.
#[test]
fn uniform_points_of_an_octant_are_uniform_on_the_sphere() {
    const POINTS: u64 = 36_000;
    let problem = Problem::new(builtin("sphere").unwrap(), Resolution::Elements(8)).unwrap();
    let count = |map: &dyn Fn(Vec2) -> Vec2| {
        let mut random = Random::new(3);
        let mut counts = [0; 36];
        for _ in 0..POINTS {
            let (position, _) = problem.geometry.surface(0, map(random.square()));
            let longitude = position.y.atan2(position.x) / std::f32::consts::FRAC_PI_2;
            let cell = |share: f32| ((6.0 * share) as usize).min(5);
            counts[6 * cell(position.z) + cell(longitude)] += 1;
        }
        chi_square(&counts, &[POINTS as f64 / 36.0; 36])
    };
    let (chi2, dof) = count(&square_to_triangle);
    assert_chi2("uniform points of a sphere's element", chi2, dof);
    // The fault: a map of the square to the triangle that is not uniform.
    let (chi2, dof) = count(&|s| Vec2::new(s.x, (1.0 - s.x) * s.y));
    assert!(refutes(p_of_chi2(chi2, dof)));
}

/// Deviation of the share of lines from the first rectangle that reach the front of the second.
fn share_reaching(scene: Scene, exact: f64, scale: f32) -> f64 {
    const LINES: u64 = 400_000;
    let problem = Problem::new(scene, Resolution::Elements(1)).expect("rectangles can be cut");
    let mut random = Random::new(5);
    let reaches = |k: &u64| {
        let uv = square_to_triangle(random.square());
        let local = square_to_cosine_hemisphere(random.square()) * Vec3::new(scale, scale, 1.0);
        let hit = line(&*problem.geometry, (*k % 2) as u32, uv, local.normalize());
        (2..4).contains(&hit.triangle) && !hit.back
    };
    z_of_count((0..LINES).filter(reaches).count() as u64, LINES, exact)
}

#[test]
fn lines_between_rectangles_have_the_exact_form_factors() {
    const TEST: &str = "form factors of rectangles by local lines";
    let floor = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let above = [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0]];
    let beside = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 2.0], [0.0, 0.0, 2.0]];
    let blocker = [[0.0, 0.0, 0.5], [0.0, 0.5, 0.5], [0.5, 0.5, 0.5], [0.5, 0.0, 0.5]];
    let parallel = parallel_rectangles(1.0, 1.0, 1.0);
    assert_z(TEST, share_reaching(rectangles(&[floor, above]), parallel, 1.0));
    assert_z(TEST, share_reaching(rectangles(&[floor, beside]), perpendicular_rectangles(1.0, 1.0, 2.0), 1.0));
    assert_z(TEST, share_reaching(rectangles(&[floor, above, blocker]), BLOCKED_SQUARES, 1.0));
    // The fault: a lobe two hundredths narrower than the cosine's.
    assert!(refutes(p_of_z(share_reaching(rectangles(&[floor, above]), parallel, 0.98))));
}
