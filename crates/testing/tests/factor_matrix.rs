//! The matrices of form factors, by every way, against exact answers. Each test also sees its own planted fault.

#![allow(clippy::unwrap_used)]

use isolux_core::Problem;
use isolux_core::form_factors::{Correction, FormFactors, Settings, WAYS, compute, way};
use isolux_core::mesh::Resolution;
use isolux_testing::budget::{assert_z, refutes};
use isolux_testing::contour;
use isolux_testing::exact::{BLOCKED_SQUARES, parallel_rectangles, perpendicular_rectangles};
use isolux_testing::mutants::{Fault, with_fault};
use isolux_testing::scenes::{cut, problem, rectangles, scene};
use isolux_testing::statistics::p_of_z;
use std::ops::ControlFlow;

const FLOOR: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
const ABOVE: [[f32; 3]; 4] = [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0]];
const BESIDE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 2.0], [0.0, 0.0, 2.0]];
const BLOCKER: [[f32; 3]; 4] = [[0.0, 0.0, 0.5], [0.0, 0.5, 0.5], [0.5, 0.5, 0.5], [0.5, 0.0, 0.5]];

fn matrix(problem: &Problem, name: &str, settings: Settings) -> FormFactors {
    let way = way(name, problem, &settings).unwrap();
    compute(problem, &*way, |_, _| ControlFlow::Continue(())).unwrap()
}

fn on_object(problem: &Problem, e: usize, object: u32) -> bool {
    problem.object(e as u32) == object
}

/// `F12` of the first two objects, and its standard error if entries have one, taken as independent.
fn between_objects(problem: &Problem, factors: &FormFactors) -> (f64, f64) {
    let (mut exchange, mut variance, mut area) = (0.0, 0.0, 0.0);
    for i in (0..factors.len()).filter(|&i| on_object(problem, i, 0)) {
        area += factors.areas()[i];
        for k in factors.starts()[i]..factors.starts()[i + 1] {
            if on_object(problem, factors.columns()[k] as usize, 1) {
                exchange += factors.areas()[i] * factors.values()[k];
                let error = factors.std_errors().get(k).copied().unwrap_or(0.0);
                variance += (factors.areas()[i] * f64::from(error)).powi(2);
            }
        }
    }
    (exchange / area, variance.sqrt() / area)
}

fn squares(parts: &[[[f32; 3]; 4]], elements: u64) -> Problem {
    Problem::new(rectangles(parts), Resolution::Elements(elements)).unwrap()
}

/// Relative error of the form factor of the first two of `parts`.
fn error(parts: &[[[f32; 3]; 4]], elements: u64, name: &str, settings: Settings, exact: f64) -> f64 {
    let problem = squares(parts, elements);
    between_objects(&problem, &matrix(&problem, name, settings)).0 / exact - 1.0
}

fn cases() -> [(&'static [[[f32; 3]; 4]], f64); 3] {
    [
        (&[FLOOR, ABOVE], parallel_rectangles(1.0, 1.0, 1.0)),
        (&[FLOOR, BESIDE], perpendicular_rectangles(1.0, 1.0, 2.0)),
        (&[FLOOR, ABOVE, BLOCKER], BLOCKED_SQUARES),
    ]
}

#[test]
fn contour_integrals_are_exact_where_nothing_blocks() {
    for (parts, exact) in &cases()[..2] {
        for elements in [4, 64, 400] {
            let found = error(parts, elements, "contour", Settings::default(), *exact);
            assert!(found.abs() < 1e-6, "{elements} elements: {found}");
        }
    }
}

#[test]
fn contour_integrals_converge_to_the_blocked_form_factor() {
    let (parts, exact) = cases()[2];
    let found = |elements, visibility| {
        error(parts, elements, "contour", Settings { visibility, ..Settings::default() }, exact).abs()
    };
    for (elements, visibility, bound) in [(6, 8, 0.005), (6, 16, 0.002), (384, 4, 0.001), (384, 8, 0.0002)] {
        let error = found(elements, visibility);
        assert!(error < bound, "{elements} elements, {visibility} divisions: {error}");
    }
    // The fault: one ray between the centres of large elements.
    let fault = found(6, 1);
    assert!(fault > 0.02, "{fault}");
}

#[test]
fn hemicubes_converge_to_the_exact_form_factors() {
    for (parts, exact) in cases() {
        let found = |hemicubes, resolution| {
            let settings = Settings { hemicubes, resolution, ..Settings::default() };
            error(parts, 6, "hemicube", settings, exact).abs()
        };
        assert!(found(16, 128) < 0.001, "{}", found(16, 128));
        // The fault, which the method is known for: a large element is taken for its middle.
        assert!(found(1, 128) > 0.005, "{}", found(1, 128));
    }
}

#[test]
fn lines_have_honest_standard_errors() {
    let settings = Settings { rays: 200_000, ..Settings::default() };
    let tests =
        [("form factor matrix by local lines", "local-lines"), ("form factor matrix by global lines", "global-lines")];
    for ((test, name), (parts, exact)) in tests.into_iter().flat_map(|test| cases().map(|case| (test, case))) {
        let problem = squares(parts, 6);
        let (found, std_error) = between_objects(&problem, &matrix(&problem, name, settings));
        assert_z(test, (found - exact) / std_error);
    }
    let faulty = with_fault(squares(&[FLOOR, ABOVE], 6), Fault::NarrowLobe(0.98));
    let (found, std_error) = between_objects(&faulty, &matrix(&faulty, "local-lines", settings));
    assert!(refutes(p_of_z((found - parallel_rectangles(1.0, 1.0, 1.0)) / std_error)));
}

/// The sum of a row is a share of lines that end on a front, too: one line in a thousand that leaks is found.
#[test]
fn rows_of_a_closed_room_sum_to_one() {
    let sums = |problem: &Problem, name: &str| -> Vec<f64> {
        let settings = Settings { rays: 2000, ..Settings::default() };
        let factors = matrix(problem, name, settings);
        (0..factors.len()).map(|i| factors.row_sum(i)).collect()
    };
    let room = problem("cubes", 400);
    for sum in sums(&room, "hemicube").into_iter().chain(sums(&room, "local-lines")) {
        assert!((sum - 1.0).abs() < 2e-3, "{sum}");
    }
    let worst = |sums: Vec<f64>| sums.into_iter().map(|sum| (sum - 1.0).abs()).fold(0.0, f64::max);
    assert!(worst(sums(&problem("box", 300), "contour")) < 1e-6);
    let mean = |sums: Vec<f64>| sums.iter().sum::<f64>() / sums.len() as f64;
    assert!((mean(sums(&room, "contour")) - 1.0).abs() < 0.01);
    let leaky = with_fault(problem("cubes", 400), Fault::Leaks(0.01));
    assert!(worst(sums(&leaky, "hemicube")) > 2e-3);
}

#[test]
fn every_way_gives_form_factors_of_the_box() {
    let room = problem("box", 48);
    let exact = contour::form_factors::<48>(&room);
    for entry in WAYS {
        let settings = Settings { rays: 20_000, hemicubes: 4, ..Settings::default() };
        let factors = matrix(&room, entry.name, settings);
        let far = (0..48).flat_map(|i| (0..48).map(move |j| (i, j)));
        let worst = far.map(|(i, j)| (factors.get(i, j) - exact[i][j]).abs()).fold(0.0, f64::max);
        assert!(worst < if entry.name == "contour" { 1e-9 } else { 0.02 }, "{}: {worst}", entry.name);
        assert!(!entry.what.is_empty() && !entry.source.is_empty());
    }
}

#[test]
fn corrections_bring_lines_nearer_to_the_exact_matrix() {
    let room = problem("box", 48);
    let exact = contour::form_factors::<48>(&room);
    let rough = matrix(&room, "local-lines", Settings { rays: 500, ..Settings::default() });
    let error = |factors: &FormFactors| {
        let squares = (0..48).flat_map(|i| (0..48).map(move |j| (i, j)));
        squares.map(|(i, j)| (factors.areas()[i] * (factors.get(i, j) - exact[i][j])).powi(2)).sum::<f64>().sqrt()
    };
    let [reciprocal, closed] =
        [Correction::Reciprocity, Correction::Enclosure].map(|correction| correction.apply(rough.clone()));
    assert!(rough.reciprocity().relative_rms > 0.01 && closed.reciprocity().largest < 1e-12);
    assert!((0..48).all(|i| (closed.row_sum(i) - 1.0).abs() < 1e-9));
    assert!(error(&reciprocal) < 0.9 * error(&rough), "{} {}", error(&reciprocal), error(&rough));
    assert!(error(&closed) < error(&rough));
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let room = problem("cubes", 120);
    for entry in WAYS {
        let settings = Settings { rays: 500, resolution: 16, ..Settings::default() };
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| matrix(&room, entry.name, settings))
        };
        assert!(on(1) == on(3), "{}", entry.name);
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let sphere = problem("sphere", 8);
    let refused = |name: &str, settings| way(name, &sphere, &settings).err().unwrap().to_string();
    assert!(refused("contour", Settings::default()).contains("flat elements"));
    assert!(refused("local-lnes", Settings::default()).contains("did you mean 'local-lines'"));
    assert!(refused("local-lines", Settings { rays: 0, ..Settings::default() }).contains("at least one line"));
    let large = cut(scene("box"), 20_000);
    assert!(way("contour", &large, &Settings::default()).err().unwrap().to_string().contains("100 million"));
}
