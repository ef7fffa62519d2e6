//! What a mesh that follows the light gains: discretisation errors of uniform and adaptive meshes of equal numbers of elements.
//!
//! `mesh [ELEMENTS...]` (10,000 in the built-in rooms and 100,000 in the living room, more than one for each side of a triangle). The error of a
//! mesh is the RMS over the area of what a reference differs from its means over the elements, relative to the mean irradiance; *interpolated*, from
//! the field of vertices with those means. The reference is uniform with 16 times as many elements, and solved twice with 50 rays an element: the mean
//! product of what both differ from their means has no noise in it. *Uniform* cuts every triangle for itself; *with clusters*, as `isolux solve --mesh
//! uniform` does it, puts small ones together whatever the light. Three seeds of adaptive meshes, the RMS of their errors; *rays* are what it took to find
//! them, as a share of the hundred an element that a solve takes.

#![allow(clippy::print_stdout)]

use anyhow::Result;
use glam::Vec2;
use isolux_core::adaptive::{Effort, Followed, follow_light};
use isolux_core::math::Rgb;
use isolux_core::mesh::{ElementMesh, Resolution};
use isolux_core::run::run;
use isolux_core::scene::builtin::builtin;
use isolux_core::scene::{Contacts, Scene};
use isolux_core::solvers::MonteCarlo;
use isolux_core::solvers::budget::RAYS_PER_ELEMENT;
use isolux_core::solvers::monte_carlo::{Budget, LightPart, Settings};
use isolux_core::view::VertexField;
use isolux_core::{Problem, Solution};
use isolux_testing::reference::scenes_folder;
use std::ops::ControlFlow;
use std::time::Instant;

const ELEMENTS: u64 = 10_000;
const ELEMENTS_OF_LIVING_ROOM: u64 = 100_000;
/// Elements of the reference for each one of the meshes.
const FINER: u64 = 16;
const SEEDS: [u64; 3] = [1, 2, 3];

fn main() -> Result<()> {
    let asked: Vec<u64> = std::env::args().skip(1).map(|text| text.parse()).collect::<Result<_, _>>()?;
    let elements = |default: u64| if asked.is_empty() { vec![default] } else { asked.clone() };
    println!(
        "| room | elements | uniform | with clusters | adaptive | gain | interpolated: uniform | adaptive | gain | rays | found in |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for name in ["cornell-box", "cubes"] {
        measure(name, &builtin(name)?, &elements(ELEMENTS))?;
    }
    match scenes_folder() {
        Some(folder) => {
            let room = isolux_io::import::read_scene(&folder.join("living-room.glb"), &Default::default())?;
            measure("living room", &room, &elements(ELEMENTS_OF_LIVING_ROOM))?;
        }
        None => println!("\nThe living room is left out: the folder of the scenes is not there."),
    }
    Ok(())
}

fn measure(name: &str, scene: &Scene, elements: &[u64]) -> Result<()> {
    for &more in elements {
        let fine = Problem::new(scene.clone(), Resolution::Extra(FINER * more))?;
        let rays = RAYS_PER_ELEMENT / 2 * fine.mesh.len() as u64;
        let of_seed = |seed| solve(&fine, Settings { seed, budget: Budget::Rays(rays), ..Settings::default() });
        let solutions = [of_seed(1 << 32)?, of_seed(1 << 33)?];
        let reference = Reference { fine, solutions };
        let uniform = Problem::new(scene.clone(), Resolution::Extra(more))?;
        let count = uniform.mesh.len() as u64;
        let [constant, interpolated] = reference.errors(&uniform);
        let [clustered, _] = reference.errors(&Problem::new(scene.clone(), Resolution::Clustered(count))?);
        let (mut squares, mut seconds, mut taken, mut used) = ([0.0; 2], 0.0, 0, 0);
        for seed in SEEDS {
            let start = Instant::now();
            let effort = Effort { rays: RAYS_PER_ELEMENT * count, seed, light: LightPart::All };
            let pilot = |problem: &Problem, settings: Settings| solve(problem, settings).map(Some);
            let Followed { problem: adaptive, rays } =
                follow_light(scene.clone(), count, &Contacts::NONE, effort, pilot)?;
            seconds += start.elapsed().as_secs_f64() / SEEDS.len() as f64;
            (taken, used) = (taken + rays, adaptive.mesh.len());
            let errors = reference.errors(&adaptive);
            squares.iter_mut().zip(errors).for_each(|(sum, error)| *sum += error * error / SEEDS.len() as f64);
        }
        let [adaptive, field] = squares.map(f64::sqrt);
        let percent = |x: f64| format!("{:.2} %", 100.0 * x);
        println!(
            "| {name} | {count} ({used}) | {} | {} | {} | {:.2} | {} | {} | {:.2} | {:.0} % | {seconds:.1} s |",
            percent(constant),
            percent(clustered),
            percent(adaptive),
            constant / adaptive,
            percent(interpolated),
            percent(field),
            interpolated / field,
            100.0 * taken as f64 / (SEEDS.len() as u64 * RAYS_PER_ELEMENT * count) as f64,
        );
    }
    Ok(())
}

fn solve(problem: &Problem, settings: Settings) -> Result<Solution> {
    Ok(run(&mut MonteCarlo::new(problem, settings)?, problem, |_| ControlFlow::Continue(())))
}

/// Two independent solutions on a much finer mesh.
struct Reference {
    fine: Problem,
    solutions: [Solution; 2],
}

impl Reference {
    /// Errors of `coarse`, with constant elements and interpolated, relative to the mean.
    fn errors(&self, coarse: &Problem) -> [f64; 2] {
        let mesh = &self.fine.mesh;
        let places = mesh.elements().map(|e| (mesh.triangle(e), middle(mesh, e), mesh.place(e).back));
        let places: Vec<(u32, Vec2, bool)> = places.collect();
        let home = |(triangle, uv, back): (u32, Vec2, bool)| coarse.mesh.at(triangle, uv, back).map(|e| e as usize);
        let homes: Vec<Option<usize>> = places.iter().map(|place| home(*place)).collect();
        let means = self.solutions.each_ref().map(|solution| self.means(solution, &homes, coarse.mesh.len()));
        let fields = means.each_ref().map(|means| {
            let irradiance: Vec<Rgb> = means.iter().map(|mean| Rgb::grey(*mean as f32)).collect();
            let std_error = vec![Rgb::grey(f32::NAN); means.len()];
            VertexField::as_computed(coarse, &Solution { irradiance, std_error, ..self.solutions[0].clone() })
        });
        // What both solutions have in common has no noise in the mean.
        let (mut constant, mut interpolated, mut flux) = (0.0, 0.0, 0.0);
        for (e, (&(triangle, uv, back), home)) in (0..).zip(places.iter().zip(&homes)) {
            let (area, Some(home)) = (f64::from(mesh.area(e)), *home) else { continue };
            let light = self.solutions.each_ref().map(|solution| solution.irradiance[e as usize].luminance_f64());
            let shown = fields.each_ref().map(|f| f.irradiance_at(coarse, triangle, uv, back).luminance_f64());
            constant += area * (light[0] - means[0][home]) * (light[1] - means[1][home]);
            interpolated += area * (light[0] - shown[0]) * (light[1] - shown[1]);
            flux += area * (light[0] + light[1]) / 2.0;
        }
        let total = mesh.total_area();
        [constant, interpolated].map(|square: f64| (square / total).max(0.0).sqrt() / (flux / total))
    }

    /// Means of a `solution` over the elements of a coarse mesh, in which each of the fine ones has its home.
    fn means(&self, solution: &Solution, homes: &[Option<usize>], elements: usize) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); elements];
        for (e, home) in (0..).zip(homes) {
            let Some(home) = *home else { continue };
            let area = f64::from(self.fine.mesh.area(e));
            sums[home].0 += area * solution.irradiance[e as usize].luminance_f64();
            sums[home].1 += area;
        }
        sums.into_iter().map(|(flux, area)| if area > 0.0 { flux / area } else { 0.0 }).collect()
    }
}

/// Barycentric coordinates on its triangle of the middle of an element.
fn middle(mesh: &ElementMesh, e: u32) -> Vec2 {
    mesh.corners(e).iter().sum::<Vec2>() / 3.0
}
