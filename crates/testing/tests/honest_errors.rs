//! Error bars are honest: over many seeds, errors measured in their own error bars follow Student's t.

#![allow(clippy::unwrap_used)]

use isolux_core::math::hash::derive;
use isolux_core::merge::merge;
use isolux_core::run::run;
use isolux_core::solvers::monte_carlo::{Budget, Method, Settings};
use isolux_core::solvers::{MonteCarlo, Solver};
use isolux_core::{Problem, Solution};
use isolux_testing::budget::{assert_t_of, refutes};
use isolux_testing::ensemble::{Exact, constant_elements, ensemble, solve, solve_until, with_rays};
use isolux_testing::honesty::{of_error, of_student};
use isolux_testing::projections::Deviation;
use isolux_testing::scenes::{furnace_answer, problem, sphere_irradiance};
use isolux_testing::statistics::p_of_t;
use std::ops::ControlFlow;

const REPLICATES: u32 = 16;

fn assert_student(problem: &Problem, runs: &[Solution], exact: &Exact) {
    assert_student_of("honest error bars", problem, runs, exact, REPLICATES);
}

fn assert_student_of(test: &str, problem: &Problem, runs: &[Solution], exact: &Exact, replicates: u32) {
    for Deviation { name, t, dof } in of_student(problem, runs, exact, replicates) {
        assert_t_of(test, &name, t, dof);
    }
}

#[test]
fn scores_of_a_labyrinth_follow_student() {
    for name in ["labyrinth:rho=0.5", "labyrinth:rho=0.9"] {
        let problem = problem(name, 796);
        let runs = ensemble(&problem, with_rays(300_000), 32);
        assert_student(&problem, &runs, &furnace_answer(&problem));
    }
}

#[test]
fn scores_of_a_sphere_follow_student() {
    for name in ["sphere:rho=0.5", "sphere:rho=0.9"] {
        let problem = problem(name, 8 * 16);
        let runs = ensemble(&problem, with_rays(100_000), 48);
        assert_student(&problem, &runs, &sphere_irradiance(&problem));
    }
}

/// Auto merges many estimates, each with weights of its own, and takes fewer complete solutions.
#[test]
fn scores_of_auto_follow_student() {
    let method = Method::named("auto").unwrap();
    let replicates = method.natural_replicates();
    for rho in ["0.5", "0.9"] {
        let problem = problem(&format!("labyrinth:rho={rho}"), 796);
        let runs = ensemble(&problem, Settings { method, replicates, ..constant_elements(300_000) }, 32);
        assert_student_of("honest error bars of auto", &problem, &runs, &furnace_answer(&problem), replicates);
    }
}

/// Few lines give errors that are not normal, but the mean square of the error bars is still that of the errors.
#[test]
fn squared_errors_are_honest_with_few_lines() {
    let problem = problem("labyrinth:rho=0.5", 796);
    let runs = ensemble(&problem, with_rays(20_000), 48);
    let Deviation { name, t, dof } = of_error(&problem, &runs, &furnace_answer(&problem));
    assert_t_of("honest error bars with few lines", &name, t, dof);
}

/// The estimate after two rounds, the second with twice the rays of the first.
#[test]
fn squared_errors_are_honest_over_rounds_of_different_sizes() {
    let problem = problem("labyrinth:rho=0.5", 796);
    let settings = |seed| Settings { seed, budget: Budget::Endless, ..Settings::default() };
    let runs: Vec<Solution> = (0..48).map(|seed| solve_until(&problem, settings(seed), 48_000)).collect();
    assert!(runs.iter().all(|run| run.work.replicates == 2 * REPLICATES));
    let Deviation { name, t, dof } = of_error(&problem, &runs, &furnace_answer(&problem));
    assert_t_of("honest error bars over rounds", &name, t, dof);
}

/// A finished run, extended to twice as many rays.
#[test]
fn squared_errors_are_honest_when_a_run_is_extended() {
    let problem = problem("labyrinth:rho=0.5", 796);
    for name in ["stochastic-jacobi", "auto"] {
        let method = Method::named(name).unwrap();
        let replicates = method.natural_replicates();
        let settings = |seed| Settings { method, replicates, seed, ..constant_elements(100_000) };
        let runs: Vec<Solution> = (0..32).map(|seed| solve_extended(&problem, settings(seed), 200_000)).collect();
        assert!(runs.iter().all(|run| run.work.replicates == 2 * replicates && run.work.rays > 180_000));
        let Deviation { name, t, dof } = of_error(&problem, &runs, &furnace_answer(&problem));
        assert_t_of("honest error bars of extended runs", &name, t, dof);
    }
}

fn solve_extended(problem: &Problem, settings: Settings, rays: u64) -> Solution {
    let mut solver = MonteCarlo::new(problem, settings).unwrap();
    run(&mut solver, problem, |_| ControlFlow::Continue(()));
    solver.go_on(problem, Budget::Rays(rays)).unwrap();
    run(&mut solver, problem, |_| ControlFlow::Continue(()))
}

/// Two runs of different sizes, made one.
#[test]
fn squared_errors_are_honest_when_runs_are_merged() {
    let problem = problem("labyrinth:rho=0.5", 796);
    let merged = |seed: u64| {
        let part = |k: u64| solve(&problem, Settings { seed: 2 * seed + k, ..with_rays(20_000 * (k + 1)) });
        merge(&problem, &[part(0), part(1)]).unwrap()
    };
    let runs: Vec<Solution> = (0..48).map(merged).collect();
    let Deviation { name, t, dof } = of_error(&problem, &runs, &furnace_answer(&problem));
    assert_t_of("honest error bars of merged runs", &name, t, dof);
}

/// The fault: a run is merged with itself, under the name of another seed.
#[test]
fn merged_runs_that_are_not_independent_are_seen() {
    let problem = problem("sphere:rho=0.5", 8 * 16);
    let merged = |seed| {
        let one = solve(&problem, Settings { seed, ..with_rays(20_000) });
        let mut other = one.clone();
        other.provenance.seed += 1000;
        merge(&problem, &[one, other]).unwrap()
    };
    let runs: Vec<Solution> = (0..48).map(merged).collect();
    let Deviation { t, dof, .. } = of_error(&problem, &runs, &sphere_irradiance(&problem));
    assert!(refutes(p_of_t(t, dof)), "t = {t}");
}

/// The fault: replicates come in pairs that share their random numbers.
#[test]
fn replicates_that_share_their_seed_are_seen() {
    let problem = problem("sphere:rho=0.5", 8 * 16);
    let runs: Vec<Solution> = (0..24).map(|seed| solve_in_pairs(&problem, seed)).collect();
    let deviations = of_student(&problem, &runs, &sphere_irradiance(&problem), REPLICATES);
    assert!(refutes(p_of_t(deviations[0].t, deviations[0].dof)), "squared errors: {:?}", deviations[0]);
    assert!(refutes(p_of_t(deviations[1].t, deviations[1].dof)), "scores: {:?}", deviations[1]);
}

fn solve_in_pairs(problem: &Problem, seed: u64) -> Solution {
    let mut solver = MonteCarlo::new(problem, Settings { seed, ..with_rays(20_000) }).unwrap();
    while let Some(pieces) = solver.step() {
        for piece in pieces {
            let part = solver.part(problem, piece);
            solver.absorb(problem, part);
        }
        let mut state = serde_json::to_value(&solver).unwrap();
        let replicate = state["replicate"].as_u64().unwrap();
        state["complete"]["Relaxation"]["seed"] = derive(seed, replicate & !1).into();
        solver = serde_json::from_value(state).unwrap();
    }
    solver.solution(problem)
}
