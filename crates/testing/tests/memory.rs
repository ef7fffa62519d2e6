//! At most 150 bytes an element beside the scene: elements, solver, light on its way and solution together; 190 for a solve of
//! several rounds, which keeps the rounds before and is stopped with its light still on the way.
//!
//! The one test of this file, for its allocator counts for the whole process.

use isolux_core::solvers::monte_carlo::{Budget, Settings};
use isolux_testing::ensemble::{solve, solve_until, with_rays};
use isolux_testing::scenes::{cut, scene};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

const ELEMENTS: u64 = 500_000;

/// Most bytes an element in a solve of one round, and of several.
const MOST: [f64; 2] = [150.0, 190.0];

#[test]
fn memory_is_a_known_number_of_bytes_an_element() {
    let endless = Settings { budget: Budget::Endless, replicates: 8, ..Settings::default() };
    let in_one_round = peak_per_element(|problem| solve(problem, Settings { replicates: 8, ..with_rays(4_000_000) }));
    let in_two_rounds = peak_per_element(|problem| solve_until(problem, endless, 6_500_000));
    let [one, two] = MOST;
    assert!(in_one_round < one && in_two_rounds < two, "{in_one_round} and {in_two_rounds} bytes an element");
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
