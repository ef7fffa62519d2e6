//! At most 200 bytes an element beside the scene: elements, solver, light on its way and solution together.
//!
//! The one test of this file, for its allocator counts for the whole process.

use isolux_core::solvers::monte_carlo::{Budget, Settings};
use isolux_testing::ensemble::{solve, solve_until, with_rays};
use isolux_testing::scenes::{cut, scene};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

const ELEMENTS: u64 = 500_000;

#[test]
fn two_hundred_bytes_an_element_are_enough() {
    let endless = Settings { budget: Budget::Endless, replicates: 8, ..Settings::default() };
    let in_one_round = peak_per_element(|problem| solve(problem, Settings { replicates: 8, ..with_rays(4_000_000) }));
    let in_two_rounds = peak_per_element(|problem| solve_until(problem, endless, 6_500_000));
    assert!(in_one_round < 200.0 && in_two_rounds < 200.0, "{in_one_round} and {in_two_rounds} bytes an element");
}

/// Greatest memory [bytes an element] beside the scene while the problem is made and solved.
fn peak_per_element(solve: impl Fn(&isolux_core::Problem) -> isolux_core::Solution) -> f64 {
    let scene = scene("cubes");
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let problem = cut(scene, ELEMENTS);
    let solution = solve(&problem);
    assert_eq!(solution.irradiance.len(), problem.mesh.len());
    (MEMORY.peak_usage() - before) as f64 / problem.mesh.len() as f64
}
