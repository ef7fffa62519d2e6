//! Crossings per second of global lines on one core: `cargo bench -p isolux-core --bench lines`.
//!
//! Lines are traced for all their hits; bundles of 512 x 512 parallel lines are rasterised. "crossings" stops there, "spans" goes
//! on to the elements at their ends. Figures are medians of five rounds; nothing is judged.
#![allow(clippy::print_stdout)]

use isolux_core::geometry::{HitLists, Ray, raster::Raster, raster::grid::Grid};
use isolux_core::math::warp::square_to_sphere;
use isolux_core::mesh::Resolution;
use isolux_core::sampling::{OwenSobol, Sequence};
use isolux_core::scene::builtin::builtin;
use isolux_core::transport::{Bundle, global_line};
use isolux_core::{Error, Problem};
use std::hint::black_box;
use std::time::Instant;

const LINES: u64 = 1 << 18;
const CELLS: u32 = 512;
const BUNDLES: u64 = 4;

fn main() -> Result<(), Error> {
    println!("Million crossings per second on one core\n");
    println!("| scene | triangles | lines: crossings | lines: spans | bundles: crossings | bundles: spans |");
    println!("|---|---|---|---|---|---|");
    for name in ["cubes", "office"] {
        let problem = Problem::new(builtin(name)?, Resolution::Elements(100_000))?;
        let rates = [traced(&problem), lines(&problem), rasterised(&problem), bundles(&problem)];
        let [traced, lines, rasterised, bundles] = rates.map(|rate| format!("{rate:.1}"));
        let triangles = problem.scene.triangles.len();
        println!("| {name} | {triangles} | {traced} | {lines} | {rasterised} | {bundles} |");
    }
    Ok(())
}

fn traced(problem: &Problem) -> f64 {
    let mut samples = vec![[0.0; 4]; LINES as usize];
    OwenSobol::new(1).fill(0, 0, &mut samples);
    let sphere = problem.geometry.bounding_sphere();
    let rays: Vec<Ray> = samples.iter().map(|&sample| global_line::ray(sample, sphere)).collect();
    let mut lists = HitLists::default();
    millions_per_second(|| {
        let mut crossings = 0;
        for batch in rays.chunks(512) {
            problem.geometry.all(batch, &mut lists);
            crossings += lists.iter().map(<[_]>::len).sum::<usize>();
        }
        crossings
    })
}

fn lines(problem: &Problem) -> f64 {
    millions_per_second(|| {
        let mut spans = 0;
        global_line::trace(problem, &OwenSobol::new(1), 0..LINES, |span| {
            black_box(span);
            spans += 1;
        });
        spans
    })
}

fn rasterised(problem: &Problem) -> f64 {
    let scene = &problem.scene;
    let mut samples = [[0.0; 4]; BUNDLES as usize];
    OwenSobol::new(1).fill(0, 0, &mut samples);
    millions_per_second(|| {
        let mut crossings = 0;
        for [x1, x2, x3, x4] in samples {
            let direction = square_to_sphere([x1, x2].into()).normalize();
            let grid = Grid::new(problem.geometry.bounding_sphere(), direction, [x3, x4].into(), CELLS);
            let raster = Raster::new(grid, (0..scene.triangles.len() as u32).map(|t| scene.corners(t)));
            for tile in 0..grid.tiles() {
                crossings += raster.crossings(tile).iter().map(<[_]>::len).sum::<usize>();
            }
        }
        crossings
    })
}

fn bundles(problem: &Problem) -> f64 {
    millions_per_second(|| {
        let mut spans = 0;
        for number in 0..BUNDLES {
            let Ok(bundle) = Bundle::nth(problem, &OwenSobol::new(1), number, CELLS) else { continue };
            for tile in 0..bundle.tiles() {
                bundle.spans(tile, |span| {
                    black_box(span);
                    spans += 1;
                });
            }
        }
        spans
    })
}

/// Median over five runs of how many millions of things `run` makes in a second.
fn millions_per_second(mut run: impl FnMut() -> usize) -> f64 {
    let mut rates: Vec<f64> = (0..5)
        .map(|_| {
            let start = Instant::now();
            run() as f64 * 1e-6 / start.elapsed().as_secs_f64()
        })
        .collect();
    rates.sort_by(f64::total_cmp);
    rates[2]
}
