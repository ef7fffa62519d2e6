//! What a mesh that follows the light gains: discretisation errors of uniform and adaptive meshes of equal numbers of elements.
//!
//! `mesh [ELEMENTS...]` (10,000 in the built-in rooms and 100,000 in the living room, more than one for each side of a triangle). The error of a
//! mesh is the RMS over the area of what a reference differs from its means over the elements, relative to the mean irradiance; *interpolated*, from
//! the field of vertices with those means. The reference is uniform with 16 times as many elements and has 100 rays an element; its noise is taken off
//! by its standard errors. Pilots have a tenth of the rays that the mesh would be solved with, so chance is in the meshes: three seeds, the RMS of
//! their errors. *Known light* is the gain of a mesh that is made of the reference itself: what pilots without noise would find.

#![allow(clippy::print_stdout)]

use anyhow::Result;
use isolux_core::adaptive::{SHARE, adapt, follow_light, pilot_settings};
use isolux_core::math::Rgb;
use isolux_core::mesh::Resolution;
use isolux_core::run::run;
use isolux_core::scene::Scene;
use isolux_core::scene::builtin::builtin;
use isolux_core::solvers::MonteCarlo;
use isolux_core::solvers::budget::RAYS_PER_ELEMENT;
use isolux_core::solvers::monte_carlo::LightPart;
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
        "| room | elements | uniform | adaptive | gain | known light | interpolated: uniform | adaptive | gain | mesh found in |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
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
    let least = Resolution::least(scene);
    for &more in elements {
        let fine = Problem::new(scene.clone(), Resolution::Extra(FINER * more))?;
        let reference = Reference { solution: solve(&fine, RAYS_PER_ELEMENT * fine.mesh.len() as u64, 1 << 32)?, fine };
        let uniform = Problem::new(scene.clone(), Resolution::Extra(more))?;
        let [constant, interpolated] = reference.errors(&uniform);
        let known = adapt(&reference.fine, &reference.solution, uniform.mesh.len() as u64)?;
        let [known, _] = reference.errors(&Problem::with_cut(scene.clone(), &known)?);
        let (mut squares, mut seconds, mut used) = ([0.0; 2], 0.0, 0);
        for seed in SEEDS {
            let start = Instant::now();
            let rays = SHARE * (RAYS_PER_ELEMENT * (least + more)) as f64;
            let pilot = |problem: &Problem, share: f64| solve(problem, (share * rays) as u64, seed).map(Some);
            let adaptive = follow_light(scene.clone(), uniform.mesh.len() as u64, pilot)?;
            seconds += start.elapsed().as_secs_f64() / SEEDS.len() as f64;
            used = adaptive.mesh.len();
            let errors = reference.errors(&adaptive);
            squares.iter_mut().zip(errors).for_each(|(sum, error)| *sum += error * error / SEEDS.len() as f64);
        }
        let [adaptive, field] = squares.map(f64::sqrt);
        let percent = |x: f64| format!("{:.2} %", 100.0 * x);
        println!(
            "| {name} | {} ({used}) | {} | {} | {:.2} | {:.2} | {} | {} | {:.2} | {seconds:.1} s |",
            uniform.mesh.len(),
            percent(constant),
            percent(adaptive),
            constant / adaptive,
            constant / known,
            percent(interpolated),
            percent(field),
            interpolated / field,
        );
    }
    Ok(())
}

fn solve(problem: &Problem, rays: u64, seed: u64) -> Result<Solution> {
    let settings = pilot_settings(seed, rays, LightPart::All);
    Ok(run(&mut MonteCarlo::new(problem, settings)?, problem, |_| ControlFlow::Continue(())))
}

/// A solution on a much finer mesh.
struct Reference {
    fine: Problem,
    solution: Solution,
}

impl Reference {
    /// Errors of `coarse`, with constant elements and interpolated, relative to the mean.
    fn errors(&self, coarse: &Problem) -> [f64; 2] {
        let mesh = &self.fine.mesh;
        let light = |e: u32| self.solution.irradiance[e as usize].luminance_f64();
        let variance = |e: u32| self.solution.std_error[e as usize].luminance_f64().powi(2);
        let area = |e: u32| f64::from(mesh.area(e));
        let place = |e: u32| (mesh.triangle(e), mesh.corners(e).iter().sum::<glam::Vec2>() / 3.0, mesh.place(e).back);
        let home: Vec<Option<u32>> = mesh
            .elements()
            .map(|e| {
                let (triangle, uv, back) = place(e);
                coarse.mesh.at(triangle, uv, back)
            })
            .collect();
        let (mut areas, mut means) = (vec![0.0; coarse.mesh.len()], vec![Rgb::BLACK; coarse.mesh.len()]);
        let mut sums = vec![0.0; coarse.mesh.len()];
        for (e, home) in (0..).zip(&home) {
            if let Some(home) = home {
                areas[*home as usize] += area(e);
                sums[*home as usize] += area(e) * light(e);
            }
        }
        for (mean, (sum, area)) in means.iter_mut().zip(sums.iter().zip(&areas)) {
            *mean = Rgb::grey((sum / f64::max(*area, f64::MIN_POSITIVE)) as f32);
        }
        let std_error = vec![Rgb::grey(f32::NAN); means.len()];
        let projected = Solution { irradiance: means, std_error, ..self.solution.clone() };
        let field = VertexField::as_computed(coarse, &projected);
        let (mut constant, mut interpolated, mut flux) = (0.0, 0.0, 0.0);
        for (e, home) in (0..).zip(&home) {
            let (triangle, uv, back) = place(e);
            let Some(home) = home.map(|home| home as usize) else { continue };
            let shown = field.irradiance_at(coarse, triangle, uv, back).luminance_f64();
            constant +=
                area(e) * ((light(e) - sums[home] / areas[home]).powi(2) - variance(e) * (1.0 - area(e) / areas[home]));
            interpolated += area(e) * ((light(e) - shown).powi(2) - variance(e));
            flux += area(e) * light(e);
        }
        let total = mesh.total_area();
        [constant, interpolated].map(|square: f64| (square / total).max(0.0).sqrt() / (flux / total))
    }
}
