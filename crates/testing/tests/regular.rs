//! Regular power shooting from scratch is as far behind as its recursion says.

#![allow(clippy::unwrap_used)]

use isolux_core::Problem;
use isolux_core::solvers::monte_carlo::Settings;
use isolux_testing::battery::{regular, with_method};
use isolux_testing::budget::assert_t_of;
use isolux_testing::ensemble::{Exact, deviations, ensemble, irradiances, refutes_exact, with_rays};
use isolux_testing::projections::Deviation;
use isolux_testing::scenes::{problem, sphere_irradiance};

const RHO: f64 = 0.8;

/// Irradiances of a sphere of reflectivity `RHO` expected after so many averaged iterations. Each `F` leaves the same
/// everywhere, so of direct light 1 iteration k brings `rho (1 + b)`, and `b` is the mean of what they bring.
fn expected(problem: &Problem, iterations: u32) -> Exact {
    let mut b = 0.0;
    for k in 1..=iterations {
        b += (RHO * (1.0 + b) - b) / f64::from(k);
    }
    let solution = 1.0 / (1.0 - RHO);
    sphere_irradiance(problem).into_iter().map(|exact| exact.map(|e| e * (1.0 + b) / solution)).collect()
}

#[test]
fn the_mean_is_that_of_eight_iterations_and_of_no_other_number() {
    let problem = problem("sphere:rho=0.8", 8 * 16);
    let method = regular()[0].method;
    let settings = with_method(method, Settings { replicates: 8, ..with_rays(40_000) });
    let runs = irradiances(&ensemble(&problem, settings, 24));
    for Deviation { name, t, dof } in deviations(&problem, &runs, &expected(&problem, 8)) {
        assert_t_of("regular power shooting", &name, t, dof);
    }
    // One iteration too few or too many is seen, and so is that it is not the solution.
    for wrong in [expected(&problem, 7), expected(&problem, 9), sphere_irradiance(&problem)] {
        assert!(refutes_exact(&problem, &runs, &wrong));
    }
}
