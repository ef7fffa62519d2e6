//! The same input gives the same bits, whatever the number of threads and however often a run was interrupted.

#![allow(clippy::unwrap_used)]

use isolux_core::run::run;
use isolux_core::solvers::monte_carlo::{Budget, Settings};
use isolux_core::solvers::{MonteCarlo, Solver};
use isolux_core::{Problem, Solution};
use isolux_testing::ensemble::{solve, with_rays};
use isolux_testing::scenes::problem;
use rayon::ThreadPoolBuilder;
use std::ops::ControlFlow;

/// Every bit of a solution.
fn bits(solution: &Solution) -> Vec<u8> {
    postcard::to_stdvec(solution).unwrap()
}

/// Few replicates of many rays, so that steps have several pieces.
fn in_pieces() -> Settings {
    Settings { replicates: 8, ..with_rays(800_000) }
}

fn solve_on(threads: usize, problem: &Problem, settings: Settings) -> Vec<u8> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    bits(&pool.install(|| solve(problem, settings)))
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for (name, elements) in [("cornell-box", 2000), ("office", 45_000)] {
        let problem = problem(name, elements);
        let one = solve_on(1, &problem, in_pieces());
        for threads in [2, 3, 7] {
            assert!(solve_on(threads, &problem, in_pieces()) == one, "{name} on {threads} threads");
        }
    }
}

#[test]
fn another_seed_gives_another_solution() {
    let problem = problem("cornell-box", 500);
    let solution = |seed| solve(&problem, Settings { seed, ..with_rays(20_000) });
    assert_eq!(solution(1), solution(1));
    assert_ne!(solution(1).irradiance, solution(2).irradiance);
}

/// A run whose state is saved and loaded between all steps, the parts of each step computed last one first.
#[test]
fn an_interrupted_run_continues_with_the_same_bits() {
    let problem = problem("cornell-box", 2000);
    let mut solver = MonteCarlo::new(&problem, in_pieces()).unwrap();
    let mut most_pieces = 0;
    while let Some(pieces) = solver.step() {
        most_pieces = most_pieces.max(pieces.end);
        let mut parts: Vec<_> = pieces.rev().map(|piece| solver.part(&problem, piece)).collect();
        while let Some(part) = parts.pop() {
            solver.absorb(&problem, part);
        }
        solver = postcard::from_bytes(&postcard::to_stdvec(&solver).unwrap()).unwrap();
    }
    assert!(most_pieces > 1, "steps of several pieces are tried");
    assert!(bits(&solver.solution(&problem)) == bits(&solve(&problem, in_pieces())));
}

/// A run without end, stopped in its second round, goes on as if it had not been.
#[test]
fn an_endless_run_can_be_taken_up_again() {
    let problem = problem("cornell-box", 500);
    let settings = Settings { budget: Budget::Endless, ..Settings::default() };
    let until = |solver: &mut MonteCarlo, rays: u64| {
        run(solver, &problem, |p| if p.rays >= rays { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    };
    let mut stopped = MonteCarlo::new(&problem, settings).unwrap();
    until(&mut stopped, 30_000);
    let mut resumed: MonteCarlo = postcard::from_bytes(&postcard::to_stdvec(&stopped).unwrap()).unwrap();
    let mut whole = MonteCarlo::new(&problem, settings).unwrap();
    assert!(bits(&until(&mut resumed, 90_000)) == bits(&until(&mut whole, 90_000)));
}
