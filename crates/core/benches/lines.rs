//! Crossings per second of global lines on one core: `cargo bench -p isolux-core --bench lines`, with names of scenes for only these.
//!
//! Lines are traced for all their hits; bundles of parallel lines are rasterised, on grids as fine as the rule of
//! [`bundle_gather`] makes them. "hits" stops at the triangles, "crossings" finds the elements on both sides, "gather" also adds
//! up what they see, and "spans" says who sees whom. All count crossings of surfaces. Figures are medians of five interleaved rounds;
//! nothing is judged.
#![allow(clippy::print_stdout)]

use isolux_core::geometry::raster::{Raster, TileLists, grid::Grid};
use isolux_core::geometry::{HitLists, Ray};
use isolux_core::math::Rgb;
use isolux_core::math::warp::square_to_sphere;
use isolux_core::mesh::Resolution;
use isolux_core::sampling::{OwenSobol, Sample, Sequence};
use isolux_core::scene::builtin::builtin;
use isolux_core::scene::{Scene, Triangle, Vertex};
use isolux_core::transport::bundle_gather::{Source, Sums, gather, grid_cells, samples_of_bundle};
use isolux_core::transport::{Bundle, bundle, global_line};
use isolux_core::{Error, Problem};
use std::hint::black_box;
use std::time::{SystemTime, UNIX_EPOCH};

const LINES: u64 = 1 << 16;
/// Samples of the bundles of a round, and most bundles.
const SAMPLES: f64 = 4e6;
const BUNDLES: usize = 64;
const ROUNDS: usize = 5;

fn main() -> Result<(), Error> {
    let asked: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    println!("Million crossings per second of processor time, on one thread\n");
    println!("| scene | triangles | elements | cells | rays: hits | bundles: hits | crossings | gather | spans |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for (name, scene) in
        [("cornell-box", builtin("cornell-box")?), ("office", builtin("office")?), ("million", million()?)]
    {
        if !asked.is_empty() && !asked.iter().any(|asked| asked == name) {
            continue;
        }
        let problem = Problem::new(scene, Resolution::Elements(200_000))?;
        let cells = grid_cells(&problem, u64::MAX);
        let rates = rates(&problem, cells).map(|rate| format!("{rate:.1}")).join(" | ");
        let (triangles, elements) = (problem.scene.triangles.len(), problem.mesh.len());
        println!("| {name} | {triangles} | {elements} | {cells} | {rates} |");
    }
    Ok(())
}

/// The office with every triangle cut into 25: 900,000 triangles.
fn million() -> Result<Scene, Error> {
    const N: u32 = 5;
    let mut scene = builtin("office")?;
    let coarse = std::mem::take(&mut scene.triangles);
    let corners: Vec<Vertex> = std::mem::take(&mut scene.vertices);
    for triangle in coarse {
        let [a, b, c] = triangle.vertices.map(|v| corners[v as usize].position);
        let first = scene.vertices.len() as u32;
        for (i, j) in (0..=N).flat_map(|i| (0..=N - i).map(move |j| (i, j))) {
            let [u, v] = [i, j].map(|k| k as f32 / N as f32);
            scene.vertices.push(Vertex::at(a + u * (b - a) + v * (c - a)));
        }
        let at = |i: u32, j: u32| first + i * (N + 1) - i * i.saturating_sub(1) / 2 + j;
        for (i, j) in (0..N).flat_map(|i| (0..N - i).map(move |j| (i, j))) {
            scene.triangles.push(Triangle { vertices: [at(i, j), at(i + 1, j), at(i, j + 1)], ..triangle });
            if i + j + 2 <= N {
                scene.triangles.push(Triangle { vertices: [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], ..triangle });
            }
        }
    }
    Ok(scene)
}

/// Millions of crossings a second of each way, medians.
fn rates(problem: &Problem, cells: u32) -> [f64; 5] {
    let bundles = (SAMPLES / samples_of_bundle(problem, cells)).ceil() as usize;
    let mut samples = vec![[0.0; 4]; bundles.min(BUNDLES)];
    OwenSobol::new(1).fill(bundle::STREAM, 0, &mut samples);
    let source = Source::new(problem, |_| Rgb::WHITE);
    let mut sums = Sums::new(problem);
    let [of_rays, of_bundles] = [traced(problem), rasterised(problem, &samples, cells)];
    let mut rounds = [[0.0; 5]; ROUNDS];
    for round in &mut rounds {
        *round = [
            millions_per_second(of_rays, || _ = black_box(traced(problem))),
            millions_per_second(of_bundles, || _ = black_box(rasterised(problem, &samples, cells))),
            millions_per_second(of_bundles, || {
                each_bundle(problem, &samples, cells, |bundle| {
                    let mut found = TileLists::default();
                    (0..bundle.tiles()).for_each(|tile| bundle.crossings(tile, black_box(&mut found)));
                });
            }),
            millions_per_second(of_bundles, || {
                each_bundle(problem, &samples, cells, |bundle| gather(bundle, &source, &mut sums));
            }),
            millions_per_second(of_bundles, || {
                each_bundle(problem, &samples, cells, |bundle| {
                    bundle.spans(0..bundle.tiles(), |span| _ = black_box(span))
                });
            }),
        ];
    }
    std::array::from_fn(|way| {
        let mut rates = rounds.map(|round| round[way]);
        rates.sort_by(f64::total_cmp);
        rates[ROUNDS / 2]
    })
}

/// The rate at which `run` makes so many things.
fn millions_per_second(things: usize, run: impl FnOnce()) -> f64 {
    let start = seconds();
    run();
    things as f64 * 1e-6 / (seconds() - start)
}

/// Seconds that the processor has spent on this thread, so that a busy machine is not taken for a slow program; where the system
/// does not say, those of the clock.
fn seconds() -> f64 {
    let spent = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = spent.and_then(|text| text.split(' ').next().and_then(|first| first.parse::<f64>().ok()));
    let clock = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64());
    nanoseconds.map_or_else(clock, |spent| spent * 1e-9)
}

fn traced(problem: &Problem) -> usize {
    let mut samples = vec![[0.0; 4]; LINES as usize];
    OwenSobol::new(1).fill(0, 0, &mut samples);
    let sphere = problem.geometry.bounding_sphere();
    let rays: Vec<Ray> = samples.iter().map(|&sample| global_line::ray(sample, sphere)).collect();
    let (mut crossings, mut lists) = (0, HitLists::default());
    for batch in rays.chunks(512) {
        problem.geometry.all(batch, &mut lists);
        crossings += lists.iter().map(<[_]>::len).sum::<usize>();
    }
    crossings
}

fn rasterised(problem: &Problem, samples: &[Sample], cells: u32) -> usize {
    let mut crossings = 0;
    for &[x1, x2, x3, x4] in samples {
        let direction = square_to_sphere([x1, x2].into()).normalize();
        let grid = Grid::new(problem.geometry.bounding_sphere(), direction, [x3, x4].into(), cells);
        let raster = Raster::of(&problem.scene, grid);
        for tile in 0..grid.tiles() {
            crossings += raster.hits(tile).iter().map(|list| list.len()).sum::<usize>();
        }
    }
    crossings
}

fn each_bundle(problem: &Problem, samples: &[Sample], cells: u32, mut each: impl FnMut(&Bundle)) {
    let bundles = samples.iter().filter_map(|&sample| Bundle::new(problem, sample, cells).ok());
    bundles.for_each(|bundle| each(&bundle));
}
