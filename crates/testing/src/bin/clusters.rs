//! What clusters are worth: rooms with finely modelled furniture, solved with equal numbers of rays on meshes with and without
//! clusters, against the points of an independent renderer (`shared/scenes/ref`).
//!
//! `clusters [RAYS] [SCENES]` prints a table. Errors are of luminance irradiance at points that are uniform over the visible surfaces:
//! RMS, in the mean irradiance of the points, and the median of the relative ones; of the element at a point, and of the light
//! that is shown there. The reference's own noise, at most 3 % a point, is in all of them.

#![allow(clippy::print_stdout)]

use anyhow::{Context, Result};
use isolux_core::Problem;
use isolux_core::mesh::Resolution;
use isolux_core::run::run;
use isolux_core::solvers::MonteCarlo;
use isolux_core::solvers::monte_carlo::{Budget, Settings};
use isolux_core::view::VertexField;
use isolux_io::import::{ImportOptions, read_scene};
use isolux_testing::reference::{self, Comparison, Value};
use std::ops::ControlFlow;
use std::path::PathBuf;

const RAYS: u64 = 20_000_000;
const ROOMS: [&str; 2] = ["living-room", "classroom"];
const MESHES: [Resolution; 7] = [
    Resolution::Extra(0),
    Resolution::Extra(400_000),
    Resolution::Clustered(20_000),
    Resolution::Clustered(60_000),
    Resolution::Clustered(150_000),
    Resolution::Clustered(400_000),
    Resolution::Clustered(700_000),
];
const SEEDS: std::ops::RangeInclusive<u64> = 1..=2;

fn main() -> Result<()> {
    let mut arguments = std::env::args();
    let rays = arguments.nth(1).map_or(Ok(RAYS), |rays| rays.parse())?;
    let scenes = arguments.next().map(PathBuf::from).or_else(reference::scenes_folder);
    let scenes = scenes.context("there is no folder shared/scenes beside the workspace or above it")?;
    println!("room,mesh,elements,rays,element_rms,element_median,shown_rms,shown_median");
    for room in ROOMS {
        for resolution in MESHES {
            let scene = read_scene(&scenes.join(room).with_extension("glb"), &ImportOptions::default())?;
            let problem = Problem::new(scene, resolution)?;
            let reference = reference::read(&scenes.join("ref").join(room).with_extension("npz"))?;
            let mut comparison = Comparison::new(reference.good, &problem)?;
            for seed in SEEDS {
                let settings = Settings { seed, budget: Budget::Rays(rays), replicates: 8, ..Settings::default() };
                let mut solver = MonteCarlo::new(&problem, settings)?;
                let solution = run(&mut solver, &problem, |_| ControlFlow::Continue(()));
                comparison.push(&problem, &solution, &VertexField::new(&problem, &solution));
            }
            let [element, shown] = Value::ALL.map(|of| comparison.errors(of));
            println!(
                "{room},{resolution:?},{},{rays},{:.4},{:.4},{:.4},{:.4}",
                problem.mesh.len(),
                element.0,
                element.1,
                shown.0,
                shown.1
            );
        }
    }
    Ok(())
}
