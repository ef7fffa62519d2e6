//! Crossings per second of global lines on one core: `cargo bench --bench lines`.
//!
//! Lines are traced for all their hits; bundles of 512 x 512 parallel lines are rasterised. "crossings" stops there, "spans" goes
//! on to the elements at their ends.

use criterion::{Criterion, SamplingMode, Throughput};
use isolux_core::geometry::{HitLists, Ray, raster::Raster, raster::grid::Grid};
use isolux_core::math::warp::square_to_sphere;
use isolux_core::mesh::Resolution;
use isolux_core::sampling::{OwenSobol, Sequence};
use isolux_core::scene::builtin::builtin;
use isolux_core::transport::{Bundle, global_line};
use isolux_core::{Error, Problem};
use std::hint::black_box;

const LINES: u64 = 1 << 16;
const CELLS: u32 = 512;

fn main() -> Result<(), Error> {
    let mut criterion = Criterion::default().sample_size(10).without_plots().configure_from_args();
    for name in ["cubes", "office"] {
        let problem = Problem::new(builtin(name)?, Resolution::Elements(100_000))?;
        let mut group = criterion.benchmark_group(format!("global lines, {name}"));
        group.sampling_mode(SamplingMode::Flat);
        for (way, count) in WAYS {
            group.throughput(Throughput::Elements(count(&problem)));
            group.bench_function(way, |bencher| bencher.iter(|| count(&problem)));
        }
    }
    criterion.final_summary();
    Ok(())
}

/// What is measured, and how much it counts each time.
type Way = (&'static str, fn(&Problem) -> u64);

const WAYS: [Way; 4] = [
    ("lines, crossings", traced),
    ("lines, spans", lines),
    ("bundle, crossings", rasterised),
    ("bundle, spans", bundle),
];

fn traced(problem: &Problem) -> u64 {
    let mut samples = vec![[0.0; 4]; LINES as usize];
    OwenSobol::new(1).fill(0, 0, &mut samples);
    let sphere = problem.geometry.bounding_sphere();
    let rays: Vec<Ray> = samples.iter().map(|&sample| global_line::ray(sample, sphere)).collect();
    let mut lists = HitLists::default();
    let mut crossings = 0;
    for batch in rays.chunks(512) {
        problem.geometry.all(batch, &mut lists);
        crossings += lists.iter().map(<[_]>::len).sum::<usize>();
    }
    crossings as u64
}

fn lines(problem: &Problem) -> u64 {
    let mut spans = 0;
    global_line::trace(problem, &OwenSobol::new(1), 0..LINES, |span| {
        black_box(span);
        spans += 1;
    });
    spans
}

fn rasterised(problem: &Problem) -> u64 {
    let scene = &problem.scene;
    let mut samples = [[0.0; 4]];
    OwenSobol::new(1).fill(0, 0, &mut samples);
    let [[x1, x2, x3, x4]] = samples;
    let direction = square_to_sphere([x1, x2].into()).normalize();
    let grid = Grid::new(problem.geometry.bounding_sphere(), direction, [x3, x4].into(), CELLS);
    let raster = Raster::new(grid, (0..scene.triangles.len() as u32).map(|t| scene.corners(t)));
    (0..grid.tiles()).map(|tile| raster.crossings(tile).iter().map(<[_]>::len).sum::<usize>() as u64).sum()
}

fn bundle(problem: &Problem) -> u64 {
    let Ok(bundle) = Bundle::nth(problem, &OwenSobol::new(1), 0, CELLS) else { return 0 };
    let mut spans = 0;
    for tile in 0..bundle.tiles() {
        bundle.spans(tile, |span| {
            black_box(span);
            spans += 1;
        });
    }
    spans
}
