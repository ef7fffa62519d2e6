//! The deterministic solvers against dense exact answers, each other, and faults that are planted.

#![allow(clippy::unwrap_used)]

use isolux_core::form_factors::{self, Correction, compute, way};
use isolux_core::math::Rgb;
use isolux_core::run::run;
use isolux_core::scene::Light;
use isolux_core::scene::LightKind;
use isolux_core::solvers::Solver;
use isolux_core::solvers::deterministic::{DETERMINISTIC, Settings, lu, solver};
use isolux_core::{Problem, Solution};
use isolux_testing::contour::convex_room_answer;
use isolux_testing::ensemble::Exact;
use isolux_testing::mutants::{Fault, with_fault};
use isolux_testing::scenes::{brighten, cut, flip, furnace, problem, scene};
use std::ops::ControlFlow;

/// Solvers on a matrix of form factors.
const ON_A_MATRIX: [&str; 5] = ["jacobi-gather", "jacobi-shoot", "jacobi-incremental", "gauss-seidel", "direct"];

fn precise() -> Settings {
    Settings { unshot: 1e-9, ..Settings::default() }
}

fn solve(problem: &Problem, name: &str, settings: &Settings) -> Solution {
    let mut solver = solver(name, problem, settings).unwrap();
    run(&mut *solver, problem, |_| ControlFlow::Continue(()))
}

/// RMS difference of irradiances, weighted by area, relative to the RMS of `exact`.
fn difference(problem: &Problem, solution: &Solution, exact: &Exact) -> f64 {
    let (mut differences, mut squares) = (0.0, 0.0);
    for e in problem.mesh.elements() {
        let area = f64::from(problem.mesh.area(e));
        let found = solution.irradiance[e as usize].to_array();
        for (found, exact) in found.into_iter().zip(exact[e as usize]) {
            differences += area * (f64::from(found) - exact).powi(2);
            squares += area * exact.powi(2);
        }
    }
    (differences / squares).sqrt()
}

fn as_exact(solution: &Solution) -> Exact {
    solution.irradiance.iter().map(|e| e.to_array().map(f64::from)).collect()
}

fn assert_balanced(problem: &Problem, solution: &Solution) {
    let b = solution.balance;
    assert!(b.residual().abs() < 1e-6, "{problem:?} {}: {b:?}", solution.provenance.method);
    let emitted: f64 = problem.mesh.elements().map(|e| problem.mesh.emitted_flux(e).luminance_f64()).sum();
    assert!((b.emitted / emitted - 1.0).abs() < 1e-6 && b.absorbed >= 0.0, "{b:?}");
    assert!(solution.std_error.iter().all(|e| e.r.is_nan()), "nothing is known of the error");
}

#[test]
fn solvers_on_a_matrix_solve_the_box_exactly() {
    let (small, large) = (problem("box", 12), problem("box", 48));
    let mut twice = scene("box");
    twice.materials.iter_mut().for_each(|m| m.reflectivity = m.reflectivity * m.reflectivity);
    let mut more = scene("box");
    brighten(&mut more, 1.0001);
    let faults = [cut(twice, 12), cut(more, 12)];
    for name in ON_A_MATRIX {
        for (room, exact) in [(&small, convex_room_answer::<12>(&small)), (&large, convex_room_answer::<48>(&large))] {
            let solution = solve(room, name, &precise());
            let error = difference(room, &solution, &exact);
            assert!(error < 1e-6, "{name}: {error}");
            assert_balanced(room, &solution);
            assert!(solution.balance.unshot.abs() < 1e-6 * solution.balance.emitted, "{:?}", solution.balance);
        }
        for fault in &faults {
            let error = difference(fault, &solve(fault, name, &precise()), &convex_room_answer::<12>(&small));
            assert!(error > 5e-5, "{name}: {error}");
        }
    }
}

/// The solution after `iterations`, the matrix computed before.
fn after(problem: &Problem, name: &str, iterations: u32) -> Solution {
    let mut solver = solver(name, problem, &precise()).unwrap();
    for _ in 0..=iterations {
        let parts: Vec<_> = solver.step().unwrap().map(|piece| solver.part(problem, piece)).collect();
        parts.into_iter().for_each(|part| solver.absorb(problem, part));
    }
    solver.solution(problem)
}

#[test]
fn the_three_jacobi_forms_agree_after_every_iteration() {
    let room = problem("cubes", 200);
    for iterations in [1, 2, 5] {
        let gathered = after(&room, "jacobi-gather", iterations);
        for name in ["jacobi-shoot", "jacobi-incremental"] {
            let apart = difference(&room, &after(&room, name, iterations), &as_exact(&gathered));
            assert!(apart < 1e-6, "{name} after {iterations}: {apart}");
        }
        // The fault: an iteration too many.
        let late = difference(&room, &after(&room, "jacobi-shoot", iterations + 1), &as_exact(&gathered));
        assert!(late > 1e-3, "{late}");
        assert_balanced(&room, &gathered);
    }
}

/// Closed form factors make the furnace exact, whatever their error.
#[test]
fn the_labyrinth_is_a_furnace() {
    let room = problem("labyrinth:rho=0.5", 796);
    let factors = form_factors::Settings { resolution: 32, ..Default::default() };
    let settings = |way: &str, correction| Settings { way: way.to_owned(), factors, correction, ..precise() };
    let ones = vec![[1.0; 3]; room.mesh.len()];
    for name in ON_A_MATRIX {
        let solution = solve(&room, name, &settings("hemicube", Correction::Enclosure));
        let error = difference(&room, &solution, &ones);
        assert!(error < 1e-6, "{name}: {error}");
        assert_balanced(&room, &solution);
    }
    let error = |name, settings: Settings| difference(&room, &solve(&room, name, &settings), &ones);
    let contour = || settings("contour", Correction::Reciprocity);
    assert!(error("gauss-seidel", contour()) < 0.005);
    assert!(error("hierarchical", Settings { unshot: 1e-6, ..contour() }) < 0.005);
    assert!(error("southwell", Settings { unshot: 1e-3, ..contour() }) < 0.06);
    // The fault: rows of hemicubes that were made reciprocal do not sum to one.
    assert!(error("gauss-seidel", settings("hemicube", Correction::Reciprocity)) > 0.01);
}

/// Irradiances from the power system of the hemicubes as they are: what Southwell's method converges to.
fn shot_by_hemicubes(problem: &Problem, settings: &form_factors::Settings) -> Exact {
    let way = way("hemicube", problem, settings).unwrap();
    let factors = compute(problem, &*way, |_, _| ControlFlow::Continue(())).unwrap();
    let n = factors.len();
    let mut exact = vec![[0.0; 3]; n];
    for c in 0..3 {
        let value = |color: Rgb| f64::from(color.to_array()[c]);
        let (mut matrix, mut right) = (vec![0.0; n * n], vec![0.0; n]);
        for j in 0..n {
            matrix[j * n + j] += 1.0;
            for (i, f) in factors.row(j) {
                let share = f * factors.areas()[j] / factors.areas()[i];
                matrix[i * n + j] -= share * value(problem.mesh.reflectivity(j as u32));
                right[i] += share * value(problem.mesh.emission(j as u32));
            }
        }
        lu::solve(matrix, right).unwrap().iter().zip(&mut exact).for_each(|(e, exact)| exact[c] = *e);
    }
    exact
}

#[test]
fn southwell_converges_to_the_solution_of_its_hemicubes() {
    let factors = form_factors::Settings { resolution: 16, ..Default::default() };
    let settings = Settings { factors, unshot: 1e-6, ..Settings::default() };
    for room in [problem("box", 48), problem("cornell-box", 150)] {
        let solution = solve(&room, "southwell", &settings);
        let exact = shot_by_hemicubes(&room, &factors);
        let error = difference(&room, &solution, &exact);
        assert!(error < 3e-6, "{error}");
        assert_balanced(&room, &solution);
        let other = form_factors::Settings { resolution: 14, ..factors };
        assert!(difference(&room, &solution, &shot_by_hemicubes(&room, &other)) > 1e-4);
    }
    // With hemicubes that are fine enough, the exact answer; not so with a lobe that is too narrow.
    let room = problem("box", 48);
    let exact = convex_room_answer::<48>(&room);
    let factors = form_factors::Settings { resolution: 32, hemicubes: 4, ..Default::default() };
    let settings = Settings { factors, unshot: 1e-3, ..Settings::default() };
    let (error, faulty) = (
        difference(&room, &solve(&room, "southwell", &settings), &exact),
        difference(
            &room,
            &solve(&with_fault(problem("box", 48), Fault::NarrowLobe(0.9)), "southwell", &settings),
            &exact,
        ),
    );
    assert!(error < 0.02 && faulty > 0.03, "{error} {faulty}");
}

#[test]
fn the_ambient_term_brings_an_unfinished_solution_nearer() {
    let room = problem("box", 48);
    let exact = convex_room_answer::<48>(&room);
    let error = |ambient| {
        let settings = Settings { unshot: 0.2, ambient, ..Settings::default() };
        let solution = solve(&room, "southwell", &settings);
        assert_balanced(&room, &solution);
        difference(&room, &solution, &exact)
    };
    assert!(error(true) < 0.5 * error(false), "{} {}", error(true), error(false));
}

/// Within the error that its module states, and nearer the finer the links.
#[test]
fn hierarchical_radiosity_converges_as_links_get_finer() {
    for room in [problem("box", 1000), problem("cubes", 800)] {
        let reference = as_exact(&solve(&room, "gauss-seidel", &precise()));
        let error = |link_power| {
            let solution = solve(&room, "hierarchical", &Settings { link_power, unshot: 1e-6, ..Settings::default() });
            assert_balanced(&room, &solution);
            difference(&room, &solution, &reference)
        };
        let errors = [1e-3, 1e-4, 1e-5].map(error);
        assert!(errors[0] > errors[1] && errors[1] > errors[2], "{errors:?}");
        assert!(errors[0] < 0.2 && errors[2] < 0.05, "{errors:?}");
        assert!(errors[1] > 0.05, "the bound sees links that are too coarse: {errors:?}");
    }
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let room = problem("cubes", 300);
    let factors = form_factors::Settings { resolution: 16, ..Default::default() };
    for entry in DETERMINISTIC {
        let settings = Settings { way: "hemicube".to_owned(), factors, unshot: 1e-3, ..Settings::default() };
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| solve(&room, entry.name, &settings))
        };
        let (one, three) = (on(1), on(3));
        assert!(one.irradiance == three.irradiance && one.balance == three.balance, "{}", entry.name);
    }
}

/// The irradiance after a run whose state is saved and loaded after every piece.
fn resumed(problem: &Problem, mut solver: Box<dyn Solver>) -> Vec<Rgb> {
    while let Some(pieces) = solver.step() {
        let part = solver.part(problem, pieces.start);
        solver.absorb(problem, part);
        solver = postcard::from_bytes(&postcard::to_stdvec(&solver).unwrap()).unwrap();
    }
    solver.solution(problem).irradiance
}

#[test]
fn interrupted_runs_continue_with_the_same_bits() {
    let room = problem("cubes", 120);
    let factors = form_factors::Settings { resolution: 16, ..Default::default() };
    let settings = &Settings { way: "hemicube".to_owned(), factors, unshot: 1e-2, ..Settings::default() };
    for entry in DETERMINISTIC {
        let irradiance = resumed(&room, (entry.make)(&room, settings).unwrap());
        assert!(irradiance == solve(&room, entry.name, settings).irradiance, "{}", entry.name);
    }
}

#[test]
fn open_scenes_and_flipped_walls_are_balanced() {
    let mut flipped = scene("box");
    flip(&mut flipped, "left");
    for room in [problem("cornell-box", 300), cut(flipped, 48)] {
        for entry in DETERMINISTIC {
            let solution = solve(&room, entry.name, &Settings { unshot: 1e-4, ..Settings::default() });
            assert_balanced(&room, &solution);
            assert!(solution.balance.escaped + solution.balance.back_face > 0.0, "{:?}", solution.balance);
        }
    }
}

#[test]
fn without_light_nothing_is_lit_and_where_nothing_absorbs_it_ends() {
    let mut dark = scene("box");
    brighten(&mut dark, 0.0);
    let mut endless = scene("box");
    endless.materials.iter_mut().for_each(|m| m.reflectivity = Rgb::grey(1.5));
    let (dark, endless) = (cut(dark, 12), cut(endless, 12));
    for entry in DETERMINISTIC {
        let solution = solve(&dark, entry.name, &Settings::default());
        assert!(solution.irradiance.iter().all(|e| e.is_black()), "{}", entry.name);
        if entry.name != "direct" {
            let factors = form_factors::Settings { resolution: 4, ..Default::default() };
            let solution = solve(&endless, entry.name, &Settings { factors, ..Settings::default() });
            assert!(solution.balance.unshot > 0.9 * solution.balance.emitted, "{}", entry.name);
        }
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let refused = |problem: &Problem, name: &str, settings: Settings| {
        solver(name, problem, &settings).err().expect("refused").to_string()
    };
    let mut with_lamp = scene("box");
    let kind = LightKind::Point { position: glam::Vec3::ONE };
    with_lamp.lights.push(Light { name: "lamp".into(), intensity: Rgb::WHITE, kind });
    let with_lamp = cut(with_lamp, 12);
    for entry in DETERMINISTIC {
        assert!(refused(&with_lamp, entry.name, Settings::default()).contains("use stochastic-jacobi"));
    }
    assert!(refused(&problem("box", 5000), "direct", Settings::default()).contains("4000 elements at most"));
    let room = problem("box", 12);
    assert!(refused(&room, "souhtwell", Settings::default()).contains("did you mean 'southwell'"));
    assert!(refused(&room, "southwell", Settings { unshot: 0.0, ..Settings::default() }).contains("above 0"));
    assert!(refused(&problem("sphere", 8), "hierarchical", Settings::default()).contains("flat elements"));
    let mut white = furnace(scene("box"));
    white.materials[0].reflectivity = Rgb::WHITE;
    let white = cut(white, 12);
    assert!(refused(&white, "direct", Settings::default()).contains("below 1"));
}
