//! Whole solves on uniform and on adaptive meshes, cut along contacts or not: what is left of the error after the same number of rays, those that find the mesh included.
//!
//! `mesh-solves [ELEMENTS]` (400,000, the default of `isolux solve`) prints a table. Errors are those of luminance irradiance against an independent renderer
//! at points that are uniform over the visible surfaces: RMS in the mean irradiance of the points, and the median of the relative ones, of the element at
//! a point, and of the light that is shown there. The reference's own noise, at most 3 % a point, is in all of them. Seconds are those of the
//! mesh and of the solve.

#![allow(clippy::print_stdout)]

use anyhow::{Context, Result};
use isolux_core::adaptive::{Meshed, Spread, Wish};
use isolux_core::mesh::Resolution;
use isolux_core::run::run;
use isolux_core::solvers::MonteCarlo;
use isolux_core::solvers::monte_carlo::{Budget, LightPart, Settings};
use isolux_core::view::VertexField;
use isolux_core::{Error, Problem, Solution};
use isolux_io::import::{ImportOptions, read_scene};
use isolux_testing::reference::{self, Comparison, Value};
use std::ops::ControlFlow;
use std::time::Instant;

const ELEMENTS: u64 = 400_000;
const ROOMS: [&str; 2] = ["living-room", "classroom"];
const RAYS: [u64; 3] = [25, 100, 400];
const MESHES: [(&str, Spread, bool); 4] = [
    ("uniform", Spread::Uniform, false),
    ("uniform, cut along contacts", Spread::Uniform, true),
    ("adaptive", Spread::Adaptive, false),
    ("adaptive, cut along contacts", Spread::Adaptive, true),
];

fn main() -> Result<()> {
    let elements = std::env::args().nth(1).map_or(Ok(ELEMENTS), |text| text.parse())?;
    let scenes =
        reference::scenes_folder().context("there is no folder shared/scenes beside the workspace or above it")?;
    println!(
        "| room | rays an element | mesh | element: RMS | median | shown: RMS | median | mesh found in | solved in |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for room in ROOMS {
        let scene = read_scene(&scenes.join(room).with_extension("glb"), &ImportOptions::default())?;
        let points = reference::read(&scenes.join("ref").join(room).with_extension("npz"))?.good;
        for share in RAYS {
            for (name, spread, along_contacts) in MESHES {
                let start = Instant::now();
                let budget = Budget::Rays(share * elements);
                let (resolution, light) = (Resolution::Clustered(elements), LightPart::All);
                let wish = Wish { resolution, spread: Some(spread), along_contacts, budget, light };
                let Meshed { problem, budget, .. } =
                    wish.cut::<Error>(scene.clone(), |_| Ok(()), |_| ControlFlow::Continue(()))?;
                let meshed = start.elapsed().as_secs_f64();
                let solution = solve(&problem, Settings { budget, ..Settings::default() })?;
                let solved = start.elapsed().as_secs_f64() - meshed;
                let mut comparison = Comparison::new(points.clone(), &problem)?;
                comparison.push(&problem, &solution, &VertexField::new(&problem, &solution));
                let errors = Value::ALL.map(|of| comparison.errors(of));
                let percent = errors.map(|(rms, median)| format!("{:.2} % | {:.2} %", 100.0 * rms, 100.0 * median));
                println!("| {room} | {share} | {name} | {} | {meshed:.1} s | {solved:.1} s |", percent.join(" | "));
            }
        }
    }
    Ok(())
}

fn solve(problem: &Problem, settings: Settings) -> Result<Solution, Error> {
    Ok(run(&mut MonteCarlo::new(problem, settings)?, problem, |_| ControlFlow::Continue(())))
}
