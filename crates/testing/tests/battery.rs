//! Every method of the table with every sample sequence: exact answers, balance, same bits, resume, scenes without light.

#![allow(clippy::unwrap_used)]

use glam::Vec3;
use isolux_core::math::Rgb;
use isolux_core::mesh::Resolution;
use isolux_core::sampling::SequenceName;
use isolux_core::scene::{Material, Object, Scene, Triangle, Vertex};
use isolux_core::solvers::Solver;
use isolux_core::solvers::monte_carlo::axes::{FirstShot, Lines, Walk};
use isolux_core::solvers::monte_carlo::{Budget, Method, MonteCarlo, Settings};
use isolux_core::{Problem, Solution};
use isolux_testing::battery::{
    is_unbiased, leaves_nothing, methods, methods_and_sequences, regular, with_method, with_sequences,
};
use isolux_testing::budget::assert_t_of;
use isolux_testing::contour::convex_room_answer;
use isolux_testing::ensemble::{
    Exact, deviations, ensemble, irradiances, radiosities, refutes_exact, solve, with_rays,
};
use isolux_testing::projections::Deviation;
use isolux_testing::scenes::{brighten, cut, furnace, furnace_answer, problem, scene, sphere_answer};
use rayon::ThreadPoolBuilder;

const RUNS: u64 = 24;

/// Few rays, in replicates of which each is a solution.
fn rays(rays: u64) -> Settings {
    Settings { replicates: 8, ..with_rays(rays) }
}

/// Holds the mean of runs against `exact`: within chance for methods without bias, within a
/// hundredth of the total for those whose bias is known to vanish with many rays.
fn assert_mean(test: &str, name: &str, problem: &Problem, unbiased: bool, runs: &[Vec<Rgb>], exact: &Exact) {
    if unbiased {
        for Deviation { name: quantity, t, dof } in deviations(problem, runs, exact) {
            assert_t_of(test, &format!("{name}: {quantity}"), t, dof);
        }
        return;
    }
    let area = |e: usize| f64::from(problem.mesh.area(e as u32));
    let total: f64 = exact.iter().enumerate().map(|(e, value)| area(e) * value.iter().sum::<f64>()).sum();
    let of_run = |run: &Vec<Rgb>| -> f64 {
        run.iter().enumerate().map(|(e, v)| area(e) * v.to_array().map(f64::from).iter().sum::<f64>()).sum()
    };
    let mean = runs.iter().map(of_run).sum::<f64>() / runs.len() as f64;
    assert!((mean / total - 1.0).abs() < 0.01, "{name}: {mean} is not {total}");
}

#[test]
fn discrete_methods_solve_the_system_of_twelve_triangles() {
    let problem = problem("box", 12);
    let exact = convex_room_answer::<12>(&problem);
    for trial in methods_and_sequences().filter(|trial| trial.method.walk == Walk::Discrete) {
        let unbiased = is_unbiased(&trial.method);
        let runs = ensemble(&problem, with_method(trial.method, rays(if unbiased { 8_000 } else { 80_000 })), RUNS);
        assert_mean("battery: box", &trial.name, &problem, unbiased, &irradiances(&runs), &exact);
    }
}

#[test]
fn all_methods_keep_the_furnace() {
    let problem = cut(furnace(scene("box")), 120);
    let exact = furnace_answer(&problem);
    for trial in methods_and_sequences() {
        let runs = ensemble(&problem, with_method(trial.method, rays(12_000)), RUNS);
        let unbiased = is_unbiased(&trial.method);
        assert_mean("battery: furnace", &trial.name, &problem, unbiased, &irradiances(&runs), &exact);
    }
}

#[test]
fn all_methods_solve_the_sphere() {
    let problem = problem("sphere:rho=0.5", 8 * 16);
    let exact = sphere_answer(&problem);
    for trial in methods_and_sequences() {
        let runs = ensemble(&problem, with_method(trial.method, rays(12_000)), RUNS);
        let unbiased = is_unbiased(&trial.method);
        assert_mean("battery: sphere", &trial.name, &problem, unbiased, &radiosities(&problem, &runs), &exact);
    }
}

/// Faults of every method: a twentieth more energy, and reflectivity applied twice.
#[test]
fn faults_are_seen_with_every_method() {
    let sound = problem("box", 12);
    let exact = convex_room_answer::<12>(&sound);
    let mut brighter = scene("box");
    brighten(&mut brighter, 1.05);
    let mut twice = scene("box");
    twice.materials.iter_mut().for_each(|m| m.reflectivity = m.reflectivity * m.reflectivity);
    let mutants = [cut(brighter, 12), cut(twice, 12)];
    // Bundles that seldom meet the lamp are noisier than any fault.
    let seldom = |method: &Method| method.lines == Lines::Bundle && method.first_shot == FirstShot::Same;
    let can_see = |method: &Method| method.walk == Walk::Discrete && !seldom(method);
    for trial in methods().into_iter().filter(|trial| can_see(&trial.method)) {
        // With random numbers none of them is biased.
        let method = Method { sequence: SequenceName::RANDOM, ..trial.method };
        assert!(is_unbiased(&method), "{}", trial.name);
        // The few lines of few bundles are noisy.
        let enough = if trial.method.lines == Lines::Bundle { 2_000_000 } else { 60_000 };
        for mutant in &mutants {
            let runs = ensemble(mutant, with_method(method, rays(enough)), RUNS);
            assert!(refutes_exact(mutant, &irradiances(&runs), &exact), "{}", trial.name);
        }
    }
}

#[test]
fn faults_are_seen_with_a_continuous_walk() {
    let exact = sphere_answer(&problem("sphere:rho=0.5", 8 * 16));
    let mut brighter = scene("sphere:rho=0.5");
    brighten(&mut brighter, 1.02);
    let mutant = cut(brighter, 8 * 16);
    let method = Method::named("particle-tracing").unwrap();
    let runs = ensemble(&mutant, with_method(method, rays(60_000)), RUNS);
    assert!(refutes_exact(&mutant, &radiosities(&mutant, &runs), &exact));
}

#[test]
fn the_balance_of_every_method_closes() {
    for (name, elements) in [("cubes", 500), ("cornell-box", 500)] {
        let problem = problem(name, elements);
        for trial in methods_and_sequences().chain(with_sequences(regular())) {
            let balance = solve(&problem, with_method(trial.method, rays(40_000))).balance;
            assert!(balance.residual().abs() < 1e-6, "{}: {} of {balance:?}", trial.name, balance.residual());
            let unshot = (balance.unshot / balance.emitted).abs();
            assert!(unshot < 1e-6 || !leaves_nothing(&trial.method), "{}: {balance:?}", trial.name);
        }
    }
}

/// Every bit of a solution.
fn bits(solution: &Solution) -> Vec<u8> {
    postcard::to_stdvec(solution).unwrap()
}

#[test]
fn every_method_gives_the_same_bits_on_any_number_of_threads_and_when_resumed() {
    let problem = problem("cornell-box", 300);
    for trial in methods_and_sequences().chain(regular()) {
        let settings = Settings { method: trial.method, ..rays(150_000) };
        let on = |threads: usize| {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            bits(&pool.install(|| solve(&problem, settings)))
        };
        let one = on(1);
        for threads in [2, 3, 7] {
            assert!(on(threads) == one, "{} on {threads} threads", trial.name);
        }
        let mut solver = MonteCarlo::new(&problem, settings).unwrap();
        while let Some(pieces) = solver.step() {
            // In the middle of a step, too.
            let end = pieces.end.min(pieces.start + 3);
            let mut parts: Vec<_> = (pieces.start..end).rev().map(|piece| solver.part(&problem, piece)).collect();
            while let Some(part) = parts.pop() {
                solver.absorb(&problem, part);
            }
            solver = postcard::from_bytes(&postcard::to_stdvec(&solver).unwrap()).unwrap();
        }
        assert!(bits(&solver.solution(&problem)) == one, "{} resumed", trial.name);
    }
}

/// One triangle that glows, or does not.
fn lonely(emission: f32) -> Problem {
    let scene = Scene {
        vertices: [Vec3::ZERO, Vec3::X, Vec3::Y].map(Vertex::at).to_vec(),
        triangles: vec![Triangle { vertices: [0, 1, 2], object: 0, source: 0 }],
        objects: vec![Object { name: String::new(), material: 0 }],
        materials: vec![Material { emission: Rgb::grey(emission), ..Material::diffuse("", Rgb::grey(0.5)) }],
        ..Scene::default()
    };
    Problem::new(scene, Resolution::Elements(1)).unwrap()
}

#[test]
fn scenes_without_light_and_with_one_element_are_no_trouble() {
    for trial in methods().into_iter().chain(regular()) {
        for budget in [Budget::Heuristic, Budget::Rays(1000)] {
            let settings = Settings { budget, replicates: 8, ..with_method(trial.method, Settings::default()) };
            let dark = solve(&lonely(0.0), settings);
            assert_eq!((dark.irradiance[0], dark.balance.emitted), (Rgb::BLACK, 0.0), "{}", trial.name);
            let glowing = solve(&lonely(1.0), settings);
            assert_eq!(glowing.irradiance[0], Rgb::BLACK, "{}", trial.name);
            let mut black = scene("box");
            black.materials.iter_mut().for_each(|m| m.reflectivity = Rgb::BLACK);
            let black = cut(black, 12);
            assert!(solve(&black, settings).irradiance.iter().all(|e| e.is_finite()), "{}", trial.name);
        }
    }
}
