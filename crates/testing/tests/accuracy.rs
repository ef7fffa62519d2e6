//! Who asks for an accuracy gets it: solves end when they are accurate enough, and keep what they promise.

#![allow(clippy::unwrap_used)]

use isolux_core::mesh::ElementMesh;
use isolux_core::report::per_object;
use isolux_core::run::run;
use isolux_core::solvers::MonteCarlo;
use isolux_core::solvers::monte_carlo::{Budget, Settings};
use isolux_core::{Accuracy, Problem, Quantity, Solution};
use isolux_testing::budget::{assert_t_of, assert_z, refutes};
use isolux_testing::ensemble::{constant_elements, ensemble, solve, with_rays};
use isolux_testing::honesty::of_objects;
use isolux_testing::scenes::{furnace_answer, problem};
use isolux_testing::statistics::{p_of_z, z_of_count};
use std::ops::ControlFlow;

const SOLVES: u64 = 200;
const CONFIDENCE: f64 = 0.9;

fn asking(error: f64, of: Quantity) -> Settings {
    let accuracy = Accuracy { error, confidence: CONFIDENCE, of };
    Settings { budget: Budget::Accuracy { accuracy, most_rays: None }, replicates: 8, ..constant_elements(1) }
}

/// Area-weighted RMS error of a furnace, where the irradiance is 1.
fn true_rms(mesh: &ElementMesh, solution: &Solution) -> f64 {
    let square = |e: u32| f64::from(mesh.area(e)) * (solution.irradiance[e as usize].luminance_f64() - 1.0).powi(2);
    (mesh.elements().map(square).sum::<f64>() / mesh.total_area()).sqrt()
}

/// Solves whose error is larger than `asked`, in standard deviations beyond those that may be.
fn broken_promises(errors: &[f64], asked: f64) -> f64 {
    let broken = errors.iter().filter(|error| **error > asked).count() as u64;
    z_of_count(broken, errors.len() as u64, 1.0 - CONFIDENCE).max(0.0)
}

/// The fault: errors are twice what is stated.
#[test]
fn the_promise_is_kept_for_all_elements() {
    let problem = problem("labyrinth:rho=0.9", 796);
    let asked = 0.1;
    let runs = ensemble(&problem, asking(asked, Quantity::Rms), SOLVES);
    let errors: Vec<f64> = runs.iter().map(|run| true_rms(&problem.mesh, run)).collect();
    assert_z("promises of the error of all elements", broken_promises(&errors, asked));
    assert!(refutes(p_of_z(broken_promises(&errors, asked / 2.0))));
}

#[test]
fn the_promise_is_kept_for_the_mean_and_for_an_object() {
    let problem = problem("labyrinth:rho=0.9", 796);
    let asked = 0.01;
    for of in [Quantity::Mean, Quantity::Object(3)] {
        let mean = |run: &Solution| match of {
            Quantity::Object(object) => per_object(&problem, run)[object as usize].mean,
            _ => run.certainty.as_ref().unwrap().scene.mean,
        };
        let runs = ensemble(&problem, asking(asked, of), SOLVES);
        let errors: Vec<f64> = runs.iter().map(|run| (mean(run) - 1.0).abs()).collect();
        assert_z("promises of the error of means", broken_promises(&errors, asked));
        assert!(refutes(p_of_z(broken_promises(&errors, asked / 3.0))), "{of:?}");
    }
}

/// Errors of means in their own standard errors.
#[test]
fn scores_of_objects_follow_student() {
    let problem = problem("labyrinth:rho=0.5", 796);
    let runs = ensemble(&problem, Settings { replicates: 16, ..constant_elements(300_000) }, 48);
    for deviation in of_objects(&problem, &runs, &furnace_answer(&problem), 16) {
        assert_t_of("honest error bars of objects", &deviation.name, deviation.t, deviation.dof);
    }
}

#[test]
fn means_are_those_of_the_elements() {
    let problem = problem("cornell-box", 500);
    for budget in [Budget::Rays(50_000), asking(0.2, Quantity::Rms).budget] {
        let solution = solve(&problem, Settings { budget, replicates: 8, ..Settings::default() });
        let certainty = solution.certainty.as_ref().unwrap();
        let objects = per_object(&problem, &solution);
        let area: f64 = objects.iter().map(|object| object.area).sum();
        let mean = objects.iter().map(|object| object.incident).sum::<f64>() / area;
        assert!((certainty.scene.mean / mean - 1.0).abs() < 1e-5, "{budget:?}");
        for object in objects {
            let estimate = certainty.faces[2 * object.object as usize];
            assert!((estimate.mean / object.mean - 1.0).abs() < 1e-5, "{}", object.name);
        }
    }
}

fn bound(problem: &Problem, solution: &Solution, of: Quantity) -> f64 {
    of.error_bound(problem, solution, CONFIDENCE)
}

#[test]
fn solves_end_when_they_are_accurate_enough_or_have_no_rays_left() {
    let problem = problem("cornell-box", 500);
    for (of, error) in [(Quantity::Rms, 0.1), (Quantity::Max, 0.8), (Quantity::Mean, 0.01), (Quantity::Object(0), 0.02)]
    {
        let solution = solve(&problem, asking(error, of));
        let reached = bound(&problem, &solution, of);
        assert!(reached <= error && reached > 0.1 * error, "{of:?}: {reached}");
        let accuracy = Accuracy { error: 0.1 * error, confidence: CONFIDENCE, of };
        let limited = Budget::Accuracy { accuracy, most_rays: Some(100_000) };
        let solution = solve(&problem, Settings { budget: limited, ..asking(error, of) });
        assert!(bound(&problem, &solution, of) > 0.1 * error, "{of:?}");
        assert!((50_000..120_000).contains(&solution.work.rays), "{of:?}: {}", solution.work.rays);
    }
}

#[test]
fn more_confidence_and_less_error_cost_more_rays() {
    let problem = problem("labyrinth:rho=0.5", 796);
    let rays = |error, confidence| {
        let accuracy = Accuracy { error, confidence, of: Quantity::Rms };
        let budget = Budget::Accuracy { accuracy, most_rays: None };
        solve(&problem, Settings { budget, replicates: 8, ..with_rays(1) }).work.rays
    };
    let base = rays(0.025, 0.5);
    assert!(rays(0.025, 0.9999) > base, "{base}");
    // Low-discrepancy numbers converge faster than with the root of the rays.
    let half = rays(0.0125, 0.5);
    assert!((1.5..6.0).contains(&(half as f64 / base as f64)), "{base} {half}");
}

/// What is shown while solving: how far it is from what is asked for, and how many rays that takes.
#[test]
fn progress_tells_how_many_rays_are_left() {
    let problem = problem("cornell-box", 500);
    let mut solver = MonteCarlo::new(&problem, asking(0.05, Quantity::Rms)).unwrap();
    let mut seen = Vec::new();
    let solution = run(&mut solver, &problem, |progress| {
        seen.push(*progress);
        ControlFlow::Continue(())
    });
    let last = seen.last().unwrap();
    assert!(last.excess.unwrap() <= 1.0 && last.rays_in_all == Some(solution.work.rays));
    assert_eq!((seen[0].excess, seen[0].rays_in_all), (None, None));
    let planned = seen.iter().rev().find(|progress| progress.excess.is_some_and(|excess| excess > 1.0)).unwrap();
    let share = planned.rays_in_all.unwrap() as f64 / solution.work.rays as f64;
    assert!((0.8..1.2).contains(&share), "{share}");
}
