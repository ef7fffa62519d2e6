//! The study `studies/reference-rooms`: three rooms, solved on coarse and fine meshes, against an independent renderer.
//!
//! `reference-rooms [SCENES] [OUT]` reads the rooms and references in the folder SCENES (`shared/scenes` beside the
//! workspace or above it) and writes `result.csv`, `points.csv` and `z.svg` into the folder OUT (`studies/reference-rooms`).

#![allow(clippy::print_stdout, clippy::print_stderr)]

mod plot;
mod table;

use anyhow::{Context, Result};
use isolux_core::Problem;
use isolux_core::mesh::Resolution;
use isolux_core::run::run;
use isolux_core::solution::luminance_error;
use isolux_core::solvers::MonteCarlo;
use isolux_core::solvers::monte_carlo::{Budget, Method, Settings};
use isolux_core::view::VertexField;
use isolux_io::files::OutputFile;
use isolux_io::import::{ImportOptions, read_scene};
use isolux_testing::reference::{self, CHANNELS, Comparison, LUMINANCE, Value};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// The rooms, each on a coarse, a fine and perhaps a very fine mesh: how many elements beyond one for each side of a
/// triangle, and how many rays for each solution.
const ROOMS: [(&str, &[(u64, u64)]); 3] = [
    ("cornell-box", &[(20_000, 8_000_000), (200_000, 16_000_000)]),
    ("living-room", &[(200_000, 8_000_000), (2_000_000, 18_000_000)]),
    ("classroom", &[(200_000, 8_000_000), (2_000_000, 18_000_000), (8_000_000, 50_000_000)]),
];
/// One independent solution each.
const SEEDS: std::ops::RangeInclusive<u64> = 1..=6;
/// The method of all solutions.
const METHOD: &str = "stochastic-jacobi";
/// Complete solutions behind the error bars of one solution.
const REPLICATES: u32 = 8;

/// A room on one mesh, compared.
struct Trial {
    room: &'static str,
    problem: Problem,
    comparison: Comparison,
    /// The same where the reference has no light.
    dark: Comparison,
    /// Mean luminance irradiance [lux] over all solutions of each element, and its variance.
    light: Vec<(f32, f32)>,
    rays: u64,
    /// Light that the backs of one-sided surfaces took, relative to the emitted light.
    back_face: f64,
}

fn main() -> Result<()> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let Some(scenes) = arguments.next().or_else(reference::scenes_folder) else {
        eprintln!(
            "There is no folder shared/scenes beside the workspace or above it, so there is nothing to compare with."
        );
        eprintln!("Skipped. To name the folder: reference-rooms SCENES");
        return Ok(());
    };
    let out = arguments.next().unwrap_or_else(|| PathBuf::from("studies/reference-rooms"));
    let output = |name: &str| OutputFile::create(&out.join(name));
    let (ratios, points, picture) = (output("result.csv")?, output("points.csv")?, output("z.svg")?);

    let mut tables = table::Tables::default();
    let mut panels = Vec::new();
    for (room, meshes) in ROOMS {
        let mut z = Vec::new();
        for &(more, rays) in meshes {
            let trial = compare(&scenes, room, more, rays).with_context(|| format!("{room}, {more} more elements"))?;
            tables.add(&trial);
            z.push((0..trial.comparison.points.len()).map(|i| trial.comparison.z(i, LUMINANCE)).collect());
        }
        panels.push(plot::Panel { title: room, z });
    }
    ratios.finish(tables.ratios.as_bytes())?;
    points.finish(tables.points.as_bytes())?;
    picture.finish(plot::histograms(&panels)?.as_bytes())?;
    Ok(())
}

/// Solves the room once for each seed, and says how it went.
fn compare(scenes: &Path, room: &'static str, more: u64, rays: u64) -> Result<Trial> {
    let start = std::time::Instant::now();
    let scene = read_scene(&scenes.join(room).with_extension("glb"), &ImportOptions::default())?;
    let problem = Problem::new(scene, Resolution::Extra(more))?;
    let reference = reference::read(&scenes.join("ref").join(room).with_extension("npz"))?;
    let mut comparison = Comparison::new(reference.good, &problem)?;
    let mut dark = Comparison::new(reference.dark, &problem)?;
    let mut light = vec![(0.0, 0.0); problem.mesh.len()];
    let (mut rays_in_all, mut back_face) = (0, 0.0);
    let method = Method::named(METHOD)?;
    for seed in SEEDS {
        let settings =
            Settings { method, seed, budget: Budget::Rays(rays), replicates: REPLICATES, ..Settings::default() };
        let mut solver = MonteCarlo::new(&problem, settings)?;
        let solution = run(&mut solver, &problem, |_| ControlFlow::Continue(()));
        rays_in_all += solution.work.rays;
        back_face += solution.balance.back_face / solution.balance.emitted / SEEDS.count() as f64;
        let field = VertexField::new(&problem, &solution);
        comparison.push(&problem, &solution, &field);
        dark.push(&problem, &solution, &field);
        for ((mean, variance), (value, error)) in
            light.iter_mut().zip(solution.irradiance.iter().zip(&solution.std_error))
        {
            *mean += value.luminance() / SEEDS.count() as f32;
            *variance += (luminance_error(*error) / SEEDS.count() as f32).powi(2);
        }
    }
    let (elements, seconds) = (problem.mesh.len(), start.elapsed().as_secs_f64());
    println!("{room}: {elements} elements, {:.0} million rays, {seconds:.0} s", rays_in_all as f64 / 1e6);
    for (of, (channel, name)) in Value::ALL.into_iter().flat_map(|of| CHANNELS.iter().enumerate().map(move |c| (of, c)))
    {
        let ratio = comparison.ratio(of, channel, |_| true);
        let verdict = if ratio.agrees() { "agrees" } else { "DISAGREES" };
        println!("  {:7} {name:9} {:.4} ± {:.4}  {verdict}", of.name(), ratio.value, ratio.std_error);
    }
    Ok(Trial { room, problem, comparison, dark, light, rays: rays_in_all, back_face })
}
