//! Light groups: what is solved apart adds up to what is solved together, in any mixture.

#![allow(clippy::unwrap_used)]

use glam::Vec3;
use isolux_core::math::Rgb;
use isolux_core::merge::merge;
use isolux_core::run::run;
use isolux_core::scene::{Grouping, Light, LightKind, Scene};
use isolux_core::solution::GroupLight;
use isolux_core::solvers::monte_carlo::{Budget, Method, Settings};
use isolux_core::solvers::{LightGroups, MonteCarlo, Solver, deterministic};
use isolux_core::superposition::{alone, mix, sum};
use isolux_core::{Accuracy, Error, Problem, Quantity, Solution};
use isolux_io::checkpoint_file::{self, Clock};
use isolux_testing::budget::{assert_t_of, refutes};
use isolux_testing::ensemble::{Exact, assert_exact, constant_elements, irradiances, refutes_exact};
use isolux_testing::honesty::of_error;
use isolux_testing::scenes::{cut, problem, scene, sphere_irradiance};
use isolux_testing::statistics::p_of_t;
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;
use std::ops::ControlFlow;

const RUNS: u64 = 24;

/// Intensity of the bulb in the middle of the sphere [cd].
const BULB: Rgb = Rgb::new(300.0, 150.0, 0.0);

/// The inside of a sphere, four of whose octants shine in different colours, with a bulb in its middle.
fn sphere() -> Problem {
    let kind = LightKind::Point { position: Vec3::ZERO };
    let bulb = Light { name: "bulb".to_owned(), intensity: BULB, kind };
    cut(Scene { lights: vec![bulb], ..scene("sphere:rho=0.5") }, 8 * 16)
}

/// The exact irradiance of [`sphere`] with any emission: that of the octants, and the bulb's, which is as even.
fn answer(problem: &Problem) -> Exact {
    let mesh = &problem.mesh;
    let rho = |c: usize| -> f64 {
        let weighted = |e| f64::from(mesh.reflectivity(e).to_array()[c]) * f64::from(mesh.area(e));
        mesh.elements().map(weighted).sum::<f64>() / mesh.total_area()
    };
    let bulb =
        |c: usize| problem.scene.lights.iter().map(|light| f64::from(light.intensity.to_array()[c])).sum::<f64>();
    let of_bulb: [f64; 3] = std::array::from_fn(|c| bulb(c) / (1.0 - rho(c)));
    sphere_irradiance(problem).iter().map(|of_octants| std::array::from_fn(|c| of_octants[c] + of_bulb[c])).collect()
}

/// A solver of each group for itself.
fn apart(problem: &Problem, grouping: &Grouping, settings: Settings) -> Result<LightGroups, Error> {
    let make = |problem: &Problem, budget, seed| {
        let solver = MonteCarlo::new(problem, Settings { budget, seed, ..settings })?;
        Ok(Box::new(solver) as Box<dyn Solver>)
    };
    LightGroups::new(problem, grouping, settings.budget, settings.seed, make)
}

fn solve_apart(problem: &Problem, settings: Settings) -> Solution {
    let mut solver = apart(problem, &Grouping::Objects, settings).unwrap();
    run(&mut solver, problem, |_| ControlFlow::Continue(()))
}

fn ensemble(problem: &Problem) -> Vec<Solution> {
    let settings = constant_elements(60_000);
    (0..RUNS).into_par_iter().map(|seed| solve_apart(problem, Settings { seed, ..settings })).collect()
}

fn remixed(problem: &Problem, solution: &Solution, factors: &[Rgb]) -> (Problem, Solution) {
    mix(problem, solution.clone(), factors).unwrap()
}

/// Off, dimmed, brighter, coloured, and as it was.
const FACTORS: [Rgb; 5] = [Rgb::BLACK, Rgb::grey(0.25), Rgb::grey(3.0), Rgb::new(1.0, 0.5, 0.0), Rgb::WHITE];

#[test]
fn groups_add_up_alone_and_in_any_mixture() {
    let problem = sphere();
    let runs = ensemble(&problem);
    assert_eq!(runs[0].groups.len(), 5, "four octants and the bulb");
    assert_exact("light groups: sum", &problem, &irradiances(&runs), &answer(&problem));
    for k in 0..5 {
        let lit: Vec<Rgb> = (0..5).map(|other| if other == k { Rgb::WHITE } else { Rgb::BLACK }).collect();
        let (lamp, _) = remixed(&problem, &runs[0], &lit);
        let of_lamp: Vec<Solution> = runs.iter().map(|run| alone(&problem, run, k)).collect();
        assert_exact("light groups: each alone", &lamp, &irradiances(&of_lamp), &answer(&lamp));
    }
    let (mixed, _) = remixed(&problem, &runs[0], &FACTORS);
    let mixtures: Vec<Solution> = runs.iter().map(|run| remixed(&problem, run, &FACTORS).1).collect();
    assert_exact("light groups: mixture", &mixed, &irradiances(&mixtures), &answer(&mixed));

    for (runs, problem) in [(&runs, &problem), (&mixtures, &mixed)] {
        let honest = of_error(problem, runs, &answer(problem));
        assert_t_of("light groups: error bars", &honest.name, honest.t, honest.dof);
        assert!(runs.iter().all(|run| run.balance.residual().abs() < 1e-6));
    }
    // Faults: a group that is a twentieth too bright, one that is not there, and error bars that do not add in squares.
    let with = |change: &dyn Fn(&mut GroupLight)| -> Vec<Solution> {
        let faulty = |run: &Solution| {
            let mut groups = run.groups.clone();
            change(&mut groups[0]);
            sum(&problem, &groups, run.provenance.clone())
        };
        runs.iter().map(faulty).collect()
    };
    assert!(!refutes_exact(&problem, &irradiances(&with(&|_| {})), &answer(&problem)));
    for factor in [1.05, 0.0] {
        let faulty = with(&|part| part.factor = Rgb::grey(factor));
        assert!(refutes_exact(&problem, &irradiances(&faulty), &answer(&problem)), "{factor}");
    }
    let added = |run: &Solution| {
        let error = |e: usize| run.groups.iter().map(|part| part.solution.std_error[e]).sum();
        Solution { std_error: (0..run.std_error.len()).map(error).collect(), ..run.clone() }
    };
    let dishonest = of_error(&problem, &runs.iter().map(added).collect::<Vec<_>>(), &answer(&problem));
    assert!(refutes(p_of_t(dishonest.t, dishonest.dof)), "{}: {}", dishonest.name, dishonest.t);
}

/// A box whose floor, ceiling and one wall shine in different colours.
fn bright_box() -> Scene {
    let mut scene = scene("box");
    for (k, object) in scene.objects.iter_mut().enumerate() {
        let emission = [[100.0, 50.0, 0.0], [10.0, 20.0, 90.0], [5.0; 3]].get(k).map_or(Rgb::BLACK, |&e| Rgb::from(e));
        let material = scene.materials[object.material as usize].clone();
        object.material = scene.materials.len() as u32;
        scene.materials.push(isolux_core::scene::Material { emission, ..material });
    }
    scene
}

fn exactly(problem: &Problem, method: &str) -> Solution {
    let mut solver = deterministic::solver(method, problem, &deterministic::Settings::default()).unwrap();
    run(solver.as_mut(), problem, |_| ControlFlow::Continue(()))
}

fn exactly_apart(problem: &Problem, method: &str) -> Solution {
    let settings = deterministic::Settings::default();
    let make = |problem: &Problem, _, _| deterministic::solver(method, problem, &settings);
    let mut solver = LightGroups::new(problem, &Grouping::Objects, Budget::Heuristic, 1, make).unwrap();
    run(&mut solver, problem, |_| ControlFlow::Continue(()))
}

/// The largest difference of irradiance, relative to the largest irradiance.
fn difference(a: &Solution, b: &Solution) -> f32 {
    let largest =
        |values: &mut dyn Iterator<Item = Rgb>| values.map(|v| v.map(f32::abs).max_channel()).fold(0.0, f32::max);
    let apart = largest(&mut a.irradiance.iter().zip(&b.irradiance).map(|(&a, &b)| a - b));
    apart / largest(&mut b.irradiance.iter().copied())
}

#[test]
fn deterministic_methods_agree_to_rounding() {
    let problem = cut(bright_box(), 300);
    // What iterations leave unshot differs.
    for (method, rounding) in [("direct", 2e-6), ("gauss-seidel", 2e-5), ("jacobi-gather", 2e-5)] {
        let (together, groups) = (exactly(&problem, method), exactly_apart(&problem, method));
        assert!(difference(&groups, &together) < rounding, "{method}: {}", difference(&groups, &together));
        let parameters = |solution: &Solution| solution.provenance.parameters.clone();
        assert_eq!(parameters(&groups)[..parameters(&together).len()], parameters(&together));
        let factors = [Rgb::BLACK, Rgb::grey(0.3), Rgb::new(4.0, 1.0, 0.0)];
        let (mixed, mixture) = remixed(&problem, &groups, &factors);
        let again = exactly(&mixed, method);
        assert!(difference(&mixture, &again) < rounding, "{method}: {}", difference(&mixture, &again));
        assert!((mixture.balance.emitted / again.balance.emitted - 1.0).abs() < 1e-6);
        assert!(mixture.balance.residual().abs() < 1e-9 && mixture.provenance.scene_hash == mixed.scene.hash());
        // The fault of a factor that is forgotten.
        assert!(difference(&groups, &again) > 0.1);
    }
}

#[test]
fn a_mixture_with_all_factors_one_is_what_was_stored_bit_for_bit() {
    let problem = sphere();
    let solution = solve_apart(&problem, constant_elements(30_000));
    let (same_problem, same) = remixed(&problem, &solution, &[Rgb::WHITE; 5]);
    assert!(same == solution && same_problem.scene.hash() == problem.scene.hash());
    let (mixed_problem, mixed) = remixed(&problem, &solution, &FACTORS);
    assert!(mixed.irradiance != solution.irradiance);
    // What was switched off is switched on again.
    let (_, again) = remixed(&mixed_problem, &mixed, &[Rgb::WHITE; 5]);
    assert!(again == solution);
}

#[test]
fn groups_are_merged_one_by_one() {
    let problem = sphere();
    let [a, b] = [1, 2].map(|seed| solve_apart(&problem, Settings { seed, ..constant_elements(30_000) }));
    let merged = merge(&problem, &[a.clone(), b.clone()]).unwrap();
    assert!(remixed(&problem, &merged, &[Rgb::WHITE; 5]).1 == merged);
    // To rounding the same as the sums merged.
    let sums = [a, b].map(|solution| Solution { groups: Vec::new(), ..solution });
    let of_sums = merge(&problem, &sums).unwrap();
    assert!(difference(&merged, &of_sums) < 1e-6 && merged.work == of_sums.work);
    let error = |solution: &Solution| solution.certainty.as_ref().unwrap().scene.std_error();
    assert!((error(&merged) / error(&of_sums) - 1.0).abs() < 1e-3, "{} {}", error(&merged), error(&of_sums));
}

#[test]
fn the_bits_do_not_depend_on_threads_or_interruptions() {
    let problem = sphere();
    for method in ["auto", "stochastic-jacobi", "random-walk"] {
        let settings = Settings { method: Method::named(method).unwrap(), replicates: 8, ..constant_elements(30_000) };
        let whole = solve_apart(&problem, settings);
        for threads in [1, 2, 3, 7] {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert!(pool.install(|| solve_apart(&problem, settings)) == whole, "{method}: {threads} threads");
        }
        // Saved and loaded after every eleventh piece.
        let mut solver: Box<dyn Solver> = Box::new(apart(&problem, &Grouping::Objects, settings).unwrap());
        let (mut pieces, mut loaded) = (0, 0);
        while let Some(range) = solver.step() {
            let part = solver.part(&problem, range.start);
            solver.absorb(&problem, part);
            pieces += 1;
            if pieces % 11 == 0 {
                let file = checkpoint_file::write(&problem, solver.as_ref(), Clock::default()).unwrap();
                solver = checkpoint_file::read("a", &file).unwrap().solver;
                loaded += 1;
            }
        }
        assert!(solver.solution(&problem) == whole && loaded > 5, "{method}: loaded {loaded} times");
    }
}

#[test]
fn all_groups_are_about_equally_far_when_somebody_breaks_off() {
    let problem = sphere();
    for budget in [Budget::Rays(400_000), Budget::Endless] {
        let settings = Settings { budget, ..constant_elements(1) };
        let mut solver = apart(&problem, &Grouping::Objects, settings).unwrap();
        let enough = |rays| if rays < 200_000 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
        let solution = run(&mut solver, &problem, |progress| enough(progress.rays));
        let lumens = |part: &GroupLight| part.solution.balance.emitted;
        let all: f64 = solution.groups.iter().map(lumens).sum();
        for part in &solution.groups {
            let share = 0.5 * (lumens(part) / all + 0.2);
            let rays = part.solution.work.rays as f64 / solution.work.rays as f64;
            assert!((0.8..1.25).contains(&(rays / share)), "{budget:?}, {}: {rays} of {share}", part.group.name);
            assert!(part.solution.certainty.is_some(), "{}", part.group.name);
        }
    }
}

#[test]
fn the_sum_becomes_as_accurate_as_was_asked_for() {
    let problem = sphere();
    let accuracy = Accuracy { error: 0.02, confidence: 0.95, of: Quantity::Rms };
    let settings = |most_rays| Settings { budget: Budget::Accuracy { accuracy, most_rays }, ..constant_elements(1) };
    let solution = solve_apart(&problem, settings(None));
    assert!(accuracy.excess(&problem, &solution) <= 1.0, "{}", accuracy.excess(&problem, &solution));
    assert_eq!(solution.provenance.parameter("error"), Some("0.02"));
    let limited = solve_apart(&problem, settings(Some(50_000)));
    assert!(accuracy.excess(&problem, &limited) > 1.0 && limited.work.rays < 60_000, "{}", limited.work.rays);

    // A run that was finished goes on, to an accuracy, and then to more rays.
    let mut solver = apart(&problem, &Grouping::Objects, constant_elements(20_000)).unwrap();
    run(&mut solver, &problem, |_| ControlFlow::Continue(()));
    solver.go_on(&problem, settings(None).budget).unwrap();
    let extended = run(&mut solver, &problem, |_| ControlFlow::Continue(()));
    assert!(accuracy.excess(&problem, &extended) <= 1.0);
    assert!(extended.provenance.parameter("extended from").unwrap().contains("rays 20000"));
    assert!(solver.go_on(&problem, Budget::Rays(1000)).unwrap_err().to_string().contains("ask for more"));
    let rays = 3 * extended.work.rays;
    solver.go_on(&problem, Budget::Rays(rays)).unwrap();
    let more = run(&mut solver, &problem, |_| ControlFlow::Continue(()));
    assert!(more.work.rays >= rays && more.work.rays < rays + rays / 4, "{} of {rays}", more.work.rays);
}

#[test]
fn what_an_ordinary_solve_refuses_is_refused() {
    let problem = problem("box", 60);
    let refused = |settings| apart(&problem, &Grouping::Objects, settings).map(|_| ()).unwrap_err().to_string();
    assert!(refused(Settings { replicates: 3, ..constant_elements(1000) }).contains("at least 8"));
    assert!(refused(constant_elements(1)).contains("ask for more"));
    let dark = cut(
        Scene { materials: vec![isolux_core::scene::Material::diffuse("m", Rgb::grey(0.5)); 8], ..scene("box") },
        60,
    );
    assert!(apart(&dark, &Grouping::Objects, constant_elements(1000)).is_err());
}
