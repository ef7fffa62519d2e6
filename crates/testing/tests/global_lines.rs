//! Global lines and bundles: how often they cross, and who they say sees whom, against exact answers. Each test also sees its
//! own planted fault.

use glam::Vec3;
use isolux_core::Problem;
use isolux_core::geometry::{HitLists, Ray};
use isolux_core::math::moments::Moments;
use isolux_core::math::warp::square_to_sphere;
use isolux_core::math::{Frame, Rgb};
use isolux_core::sampling::{Sample, Sequence, SequenceName};
use isolux_core::scene::builtin::shapes::Builder;
use isolux_core::scene::{Material, Scene};
use isolux_core::transport::bundle::crossings_per_area;
use isolux_core::transport::{Bundle, Crossing, Span, global_line, spans};
use isolux_testing::budget::{assert_chi2, assert_t, assert_z, refutes};
use isolux_testing::exact::{BLOCKED_SQUARES, parallel_rectangles, perpendicular_rectangles};
use isolux_testing::random::Random;
use isolux_testing::scenes::{cut, problem};
use isolux_testing::statistics::{chi_square, p_of_chi2, p_of_t, p_of_z, z_of_count};

/// Independent random numbers: lines that draw them are independent.
fn independent() -> Box<dyn Sequence> {
    let name: SequenceName = "random".parse().expect("a sequence of the table");
    name.make(1)
}

/// The fault: lines through uniform points of the ball in uniform directions. They prefer its middle.
fn lines_through_the_ball(problem: &Problem, lines: u64, mut each: impl FnMut(Vec3, Span)) {
    let (center, radius) = problem.geometry.bounding_sphere();
    let (mut random, mut lists) = (Random::new(2), HitLists::default());
    for _ in 0..lines {
        let point = center + radius * random.uniform().cbrt() * square_to_sphere(random.square());
        let direction = square_to_sphere(random.square());
        problem.geometry.all(&[Ray::whole_line(point, direction, 2.0 * radius)], &mut lists);
        let crossings = lists.iter().flatten().map(|hit| Crossing::of(problem, hit));
        spans(problem.geometry.lift(), crossings, |span| each(direction, span));
    }
}

/// The elements at the ends of a span.
fn elements(span: Span) -> [Option<u32>; 2] {
    [span.from, span.to].map(|end| end.element())
}

/// Deviation of the number of lines that cross each element from `N A / (2 pi R²)`.
fn crossings(problem: &Problem, lines: u64, draw: impl FnOnce(&mut dyn FnMut(Span))) -> Vec<f64> {
    let mut crossings = vec![0; problem.mesh.len()];
    draw(&mut |span| elements(span).into_iter().flatten().for_each(|e| crossings[e as usize] += 1));
    let probability =
        |e| global_line::expected_crossings(1, problem.mesh.area(e), problem.geometry.bounding_sphere().1);
    problem.mesh.elements().map(|e| z_of_count(crossings[e as usize], lines, probability(e))).collect()
}

#[test]
fn lines_cross_elements_in_proportion_to_their_areas() {
    const LINES: u64 = 400_000;
    let room = problem("box", 12);
    for z in crossings(&room, LINES, |each| global_line::trace(&room, independent().as_ref(), 0..LINES, each)) {
        assert_z("crossings of global lines", z);
    }
    // Two-sided faces have an element on each side, and each line meets both.
    let mut scene = room.scene.clone();
    scene.materials.iter_mut().for_each(|material| material.two_sided = true);
    let two_sided = cut(scene, 24);
    assert_eq!(two_sided.mesh.len(), 24);
    let sides =
        crossings(&two_sided, LINES, |each| global_line::trace(&two_sided, independent().as_ref(), 0..LINES, each));
    let one_side = two_sided.mesh.elements().filter(|&e| !two_sided.mesh.place(e).back);
    one_side.for_each(|e| assert_z("crossings of global lines", sides[e as usize]));

    let faulty = crossings(&room, LINES, |each| lines_through_the_ball(&room, LINES, |_, span| each(span)));
    assert!(faulty.into_iter().all(|z| refutes(p_of_z(z))));
}

/// Rectangles given by their corners, counter-clockwise from the front, one object each.
fn rectangles(corners: &[[[f32; 3]; 4]]) -> Problem {
    let mut builder = Builder::new("rectangles");
    let white = builder.material(Material::diffuse("white", Rgb::grey(0.5)));
    for quad in corners {
        builder.object("rectangle", white);
        builder.polygon(&quad.map(Vec3::from));
    }
    let scene: Scene = builder.finish();
    cut(scene, 1)
}

/// Pairs of rectangles with the form factor from the first to the second; the first has an area of 1 m².
fn pairs() -> [(Problem, f64); 3] {
    let floor = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let above = [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0]];
    let beside = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 2.0], [0.0, 0.0, 2.0]];
    let blocker = [[0.0, 0.0, 0.5], [0.0, 0.5, 0.5], [0.5, 0.5, 0.5], [0.5, 0.0, 0.5]];
    [
        (rectangles(&[floor, above]), parallel_rectangles(1.0, 1.0, 1.0)),
        (rectangles(&[floor, beside]), perpendicular_rectangles(1.0, 1.0, 2.0)),
        (rectangles(&[floor, above, blocker]), BLOCKED_SQUARES),
    ]
}

/// Numbers of spans with an end on the first rectangle, and of those whose other end is on the second.
#[derive(Default)]
struct Seen {
    first: u64,
    both: u64,
}

impl Seen {
    fn count(&mut self, problem: &Problem, span: Span) {
        let object = |e: u32| problem.object(e);
        let ends = elements(span).map(|end| end.map(object));
        self.first += u64::from(ends.contains(&Some(0)));
        self.both += u64::from(ends.contains(&Some(0)) && ends.contains(&Some(1)));
    }
}

#[test]
fn shares_of_spans_are_form_factors() {
    const LINES: u64 = 1_000_000;
    for (problem, exact) in pairs() {
        let mut seen = Seen::default();
        global_line::trace(&problem, independent().as_ref(), 0..LINES, |span| seen.count(&problem, span));
        assert_z("form factors of rectangles by global lines", z_of_count(seen.both, seen.first, exact));
    }
    let [(parallel, exact), ..] = pairs();
    let mut faulty = Seen::default();
    lines_through_the_ball(&parallel, LINES, |_, span| faulty.count(&parallel, span));
    assert!(refutes(p_of_z(z_of_count(faulty.both, faulty.first, exact))));
}

const BUNDLES: u64 = 3000;

/// Deviations of the mean numbers of spans of a bundle at the first rectangle, and between both, from `A / (2 a)` and
/// `A F / (2 a)`; `draw` may spoil the sample numbers.
fn bundle_deviations(problem: &Problem, exact: f64, draw: impl Fn(Sample) -> Sample) -> [f64; 2] {
    let (mut first, mut both, mut expected) = (Moments::default(), Moments::default(), 0.0);
    for number in 0..BUNDLES {
        let mut sample = [[0.0; 4]];
        independent().fill(0, number, &mut sample);
        let bundle = Bundle::new(problem, draw(sample[0]), 40).expect("a number of cells that is allowed");
        let mut seen = Seen::default();
        bundle.spans(0..bundle.tiles(), |span| seen.count(problem, span));
        first.push(seen.first as f64);
        both.push(seen.both as f64);
        expected = crossings_per_area(problem, 40);
    }
    [(first.mean - expected) / first.std_error(), (both.mean - expected * exact) / both.std_error()]
}

#[test]
fn bundles_cross_and_see_what_lines_do() {
    let dof = (BUNDLES - 1) as f64;
    for (problem, exact) in pairs() {
        for t in bundle_deviations(&problem, exact, |sample| sample) {
            assert_t("form factors of rectangles by bundles", t, dof);
        }
    }
    // The fault: directions crowded at the poles.
    let [(parallel, exact), ..] = pairs();
    let polar = |[x1, x2, x3, x4]: Sample| [0.5 - 0.5 * (std::f32::consts::PI * x1).cos(), x2, x3, x4];
    assert!(bundle_deviations(&parallel, exact, polar).into_iter().all(|t| refutes(p_of_t(t, dof))));
}

/// Chi-square of the pairs of octants that spans join, against equal shares.
fn pairs_of_octants(draw: impl FnOnce(&mut dyn FnMut(Span))) -> (f64, f64) {
    let mut pairs = [0; 64];
    draw(&mut |span| {
        let [from, to] = elements(span).map(|end| end.expect("a line inside a sphere joins two fronts"));
        pairs[(8 * from + to) as usize] += 1;
    });
    chi_square(&pairs, &[pairs.iter().sum::<u64>() as f64 / 64.0; 64])
}

#[test]
fn inside_a_sphere_lines_join_every_pair_of_octants_alike() {
    const LINES: u64 = 100_000;
    let sphere = problem("sphere", 8);
    let (chi2, dof) = pairs_of_octants(|each| global_line::trace(&sphere, independent().as_ref(), 0..LINES, each));
    assert_chi2("form factors of the sphere by global lines", chi2, dof);
    let (chi2, dof) = pairs_of_octants(|each| lines_through_the_ball(&sphere, LINES, |_, span| each(span)));
    assert!(refutes(p_of_chi2(chi2, dof)));
}

/// Chi-square of the directions at element `e`, in cells of equal probability for the cosine's lobe.
fn directions_at(problem: &Problem, e: u32, draw: impl FnOnce(&mut dyn FnMut(Vec3, Span))) -> (f64, f64) {
    let frame = Frame::about(problem.mesh.normal(e));
    let mut counts = [0; 80];
    draw(&mut |direction, span| {
        if elements(span).contains(&Some(e)) {
            // The line has no direction: as it leaves the front. The square of its cosine is uniform.
            let cosine = direction.dot(frame.z);
            let leaving = direction * cosine.signum();
            let turn = leaving.dot(frame.y).atan2(leaving.dot(frame.x)) / std::f32::consts::TAU + 0.5;
            let cell = |share: f32, cells: usize| ((share * cells as f32) as usize).min(cells - 1);
            counts[8 * cell(cosine * cosine, 10) + cell(turn, 8)] += 1;
        }
    });
    let total: u64 = counts.iter().sum();
    chi_square(&counts, &[total as f64 / 80.0; 80])
}

#[test]
fn directions_at_an_element_are_cosine_distributed() {
    const LINES: u64 = 300_000;
    let room = problem("box", 12);
    for e in [0, 7] {
        let (chi2, dof) = directions_at(&room, e, |each| {
            for k in 0..LINES {
                let mut sample = [[0.0; 4]];
                independent().fill(global_line::STREAM, k, &mut sample);
                let direction = global_line::ray(sample[0], room.geometry.bounding_sphere()).direction;
                global_line::trace(&room, independent().as_ref(), k..k + 1, |span| each(direction, span));
            }
        });
        assert_chi2("directions of global lines at an element", chi2, dof);
        let (chi2, dof) = directions_at(&room, e, |each| lines_through_the_ball(&room, LINES, each));
        assert!(refutes(p_of_chi2(chi2, dof)));
    }
}
