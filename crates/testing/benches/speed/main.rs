//! Speed of the ray kernel on one core, beside Embree's, and of whole solves: `make bench`, or `make bench EMBREE=1` with Embree.
//!
//! Contestants answer the same questions about the same rays, in turn, round after round, so that a machine that drifts
//! drifts for all of them. With `BENCH_REPORT` set to a path the medians are written there as a page (`report.rs`).

mod contestant;
#[cfg(feature = "embree")]
mod embree;
mod end_to_end;
mod rays;
mod report;

use anyhow::Result;
use contestant::{Contestant, contestants};
use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput};
use isolux_core::Problem;
use isolux_core::geometry::{Bvh, Hit};
use isolux_core::mesh::Resolution;
use isolux_core::scene::Scene;
use isolux_core::scene::builtin::builtin;
use rays::{RAYS, Rays};
use std::hint::black_box;
use std::time::Duration;

/// What is traced: a name for the table, and the built-in scene.
const SCENES: [(&str, &str); 3] =
    [("cornell-box", "cornell-box"), ("office", "office"), ("office, 93 rows", "office:size=93")];

/// Every contestant answers every question that many times.
const ROUNDS: usize = 3;

fn main() -> Result<()> {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(50))
        .measurement_time(Duration::from_millis(200))
        .without_plots()
        .configure_from_args();
    let mut facts = Vec::new();
    for (name, spec) in SCENES {
        facts.push(trace(&mut criterion, name, builtin(spec)?)?);
    }
    build(&mut criterion, &builtin(SCENES[2].1)?);
    criterion.final_summary();
    report::write(&facts)
}

/// All questions about one scene.
fn trace(criterion: &mut Criterion, name: &'static str, scene: Scene) -> Result<report::Facts> {
    let contestants = contestants(&scene)?;
    let bytes = Bvh::new(&scene).bytes();
    let rays = Rays::through(&Problem::new(scene, Resolution::Elements(200_000))?);
    for round in 0..ROUNDS {
        for question in report::Question::ALL {
            let mut group = criterion.benchmark_group(question.group(name));
            group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(RAYS as u64));
            for contestant in &contestants {
                let id = BenchmarkId::new(contestant.name(), round);
                group.bench_function(id, |bencher| bencher.iter(|| ask(question, contestant.as_ref(), &rays)));
            }
        }
    }
    Ok(report::Facts { name, triangles: rays.triangles, bytes, differing: differing(&contestants, &rays) })
}

fn ask(question: report::Question, contestant: &dyn Contestant, rays: &Rays) {
    let mut hits = vec![Hit::MISS; RAYS];
    let mut blocked = vec![false; RAYS];
    match question {
        report::Question::Incoherent => contestant.closest(&rays.incoherent, &mut hits),
        report::Question::Sorted => contestant.closest(&rays.sorted, &mut hits),
        report::Question::Shadow => contestant.any(&rays.shadow, &rays.reach, &mut blocked),
        report::Question::ShadowClosest => contestant.closest(&rays.shadow, &mut hits),
    }
    black_box((hits, blocked));
}

/// How many of the incoherent rays the last contestant sees end elsewhere than the first: at a distance that differs by
/// more than 1e-4 of itself.
fn differing(contestants: &[Box<dyn Contestant>], rays: &Rays) -> usize {
    let mut hits = [vec![Hit::MISS; RAYS], vec![Hit::MISS; RAYS]];
    contestants[0].closest(&rays.incoherent, &mut hits[0]);
    contestants[contestants.len() - 1].closest(&rays.incoherent, &mut hits[1]);
    let differ = |(a, b): &(&Hit, &Hit)| (a.t - b.t).abs() > 1e-4 * a.t.min(b.t);
    hits[0].iter().zip(&hits[1]).filter(differ).count()
}

/// Time to build the ray structure of a million triangles, on all cores.
fn build(criterion: &mut Criterion, scene: &Scene) {
    let mut group = criterion.benchmark_group(report::BUILD);
    group.sampling_mode(SamplingMode::Flat);
    group.bench_function(BenchmarkId::new("isolux", 0), |bencher| bencher.iter(|| black_box(Bvh::new(scene))));
    #[cfg(feature = "embree")]
    group.bench_function(BenchmarkId::new("Embree", 0), |bencher| {
        bencher.iter(|| black_box(embree::Embree::new(scene).is_ok()));
    });
}
