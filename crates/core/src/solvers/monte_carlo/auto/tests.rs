//! Phases that few plans give much to, with a plan that does: what they lose, or count twice, is seen.

use super::*;
use crate::mesh::Resolution;
use crate::scene::builtin::builtin;

/// Of every octant [lm/m²].
const EMISSION: f64 = 100.0;
const DARK: f64 = 0.05;
const BRIGHT: f64 = 0.9;
const RUNS: u64 = 32;

/// A sphere that emits everywhere, and has one bright octant.
fn with_one_bright_octant() -> Problem {
    let mut scene = builtin("sphere").expect("built in");
    for material in &mut scene.materials {
        (material.reflectivity, material.emission) = (Rgb::grey(DARK as f32), Rgb::grey(EMISSION as f32));
    }
    scene.materials[0].reflectivity = Rgb::grey(BRIGHT as f32);
    Problem::new(scene, Resolution::Elements(8 * 16)).expect("a scene that can be cut")
}

/// Mean indirect irradiance [lux] of a complete solution by `plan`.
fn mean_irradiance(problem: &Problem, plan: Plan, seed: u64) -> f64 {
    let mut auto = Auto::new(problem, &Settings { light: LightPart::Indirect, ..Settings::default() });
    let experience = Experience::expected(problem);
    (auto.plan, auto.planned_for) = (plan, 1);
    auto.restart(problem, seed, auto.planned_for, &experience);
    while let Some(pieces) = auto.pieces() {
        for piece in pieces {
            let part = auto.part(problem, piece);
            auto.absorb(problem, part, &experience);
        }
    }
    let area = problem.mesh.total_area();
    let weight = auto.bundles.precision().weight_of_bundles(area / problem.mesh.len() as f64);
    assert!(auto.bundles.precision().level().is_finite() && weight > 0.7, "the plan has little surplus: {weight}");
    auto.shooting.light().indirect.iter().map(|flux| flux.luminance_f64()).sum::<f64>() / area
}

/// A tenth of the surplus is 2.8 % of it. The error of the mean is 0.2 %.
#[test]
fn what_is_gathered_up_to_a_level_and_the_surplus_are_all_of_the_light() {
    let problem = with_one_bright_octant();
    let plan = Plan { emission: 100_000, reflection: 1000, bundles: 100_000, surplus: 100_000, ..Plan::default() };
    let mean = (0..RUNS).map(|seed| mean_irradiance(&problem, plan, seed)).sum::<f64>() / RUNS as f64;
    let exact = EMISSION / (1.0 - (7.0 * DARK + BRIGHT) / 8.0) - EMISSION;
    assert!((mean / exact - 1.0).abs() < 0.01, "{mean} instead of {exact}");
}
