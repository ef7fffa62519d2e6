//! The Cornell box against an independent renderer, and a fault that the comparison must see.

#![allow(clippy::unwrap_used, clippy::print_stderr)]

use isolux_core::Problem;
use isolux_core::mesh::Resolution;
use isolux_core::run::run;
use isolux_core::scene::Scene;
use isolux_core::solvers::MonteCarlo;
use isolux_core::solvers::monte_carlo::{Budget, Settings};
use isolux_core::view::VertexField;
use isolux_io::import::{ImportOptions, read_scene};
use isolux_testing::reference::{self, CHANNELS, Comparison, Ratio, Value};
use std::ops::ControlFlow;
use std::path::Path;

/// Ratios of four solutions of `scene` to the reference, for elements and points and each channel. The same numbers in every run of the test.
fn ratios(folder: &Path, scene: Scene) -> Vec<(String, Ratio)> {
    let problem = Problem::new(scene, Resolution::Elements(20_000)).unwrap();
    let reference = reference::read(&folder.join("ref/cornell-box.npz")).unwrap();
    let mut comparison = Comparison::new(reference.good, &problem).unwrap();
    for seed in 1..=4 {
        let settings = Settings { seed, budget: Budget::Rays(2_000_000), replicates: 8, ..Settings::default() };
        let mut solver = MonteCarlo::new(&problem, settings).unwrap();
        let solution = run(&mut solver, &problem, |_| ControlFlow::Continue(()));
        comparison.push(&problem, &solution, &VertexField::new(&problem, &solution));
    }
    let each = Value::ALL.into_iter().flat_map(|value| (0..CHANNELS.len()).map(move |channel| (value, channel)));
    each.map(|(value, c)| (format!("{value:?} {}", CHANNELS[c]), comparison.ratio(value, c, |_| true))).collect()
}

#[test]
fn the_cornell_box_agrees_with_an_independent_renderer_and_not_with_three_percent_more_reflectivity() {
    let Some(folder) = reference::scenes_folder() else {
        eprintln!("there is no folder shared/scenes with references: skipped");
        return;
    };
    let scene = read_scene(&folder.join("cornell-box.glb"), &ImportOptions::default()).unwrap();
    for (what, ratio) in ratios(&folder, scene.clone()) {
        assert!(ratio.agrees(), "{what}: {} ± {}", ratio.value, ratio.std_error);
    }
    let mut brighter = scene;
    brighter.materials.iter_mut().for_each(|material| material.reflectivity = material.reflectivity * 1.03);
    for (what, ratio) in ratios(&folder, brighter) {
        assert!(!ratio.agrees(), "{what}: {} ± {} hides the fault", ratio.value, ratio.std_error);
    }
}
