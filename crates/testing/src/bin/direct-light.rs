//! How well direct light is sampled: error for as many rays, and for as much time, of its estimators and of shooting.
//!
//! `direct-light [RAYS]` with so many rays an element (64; a quarter in the living room, which has many elements). In all scenes
//! everything is black, so all light is direct. Errors are relative to the mean irradiance: area-weighted RMS, and unweighted RMS; and
//! the median over elements of the error relative to their own irradiance; against a reference with 32 times as many rays. The last
//! column is how many times shooting would need that time for the same area-weighted error. One thread; methods take turns.

#![allow(clippy::print_stdout)]

use anyhow::Result;
use glam::Vec2;
use isolux_core::Problem;
use isolux_core::geometry::Hit;
use isolux_core::math::Rgb;
use isolux_core::math::warp::square_to_triangle;
use isolux_core::mesh::Resolution;
use isolux_core::run::run;
use isolux_core::sampling::{OwenSobol, Sequence};
use isolux_core::scene::Scene;
use isolux_core::scene::builtin::builtin;
use isolux_core::solvers::direct_light::DirectLight;
use isolux_core::solvers::monte_carlo::{self, Budget, MonteCarlo};
use isolux_core::transport::direct_light::{DirectEstimator, Rays};
use isolux_core::transport::{Departure, Footprint, LightSampler};
use isolux_testing::reference::scenes_folder;
use std::ops::ControlFlow;
use std::time::Instant;

const RAYS: u32 = 64;
const SEEDS: u64 = 3;
/// Rays of the reference for each ray that is measured.
const REFERENCE: u32 = 32;
/// Rounds that share the rays of the adaptive estimate.
const ROUNDS: u32 = 4;

/// Irradiances [lux] for a seed, and the rays they took.
type Estimate = fn(&Problem, u32, u64) -> Result<(Vec<Rgb>, u64)>;

const METHODS: [(&str, Estimate); 6] = [
    ("shooting", shooting),
    ("uniform on emitters", uniform),
    ("cosine rays", |problem, n, seed| Ok(fixed(problem, Rays { light: 0, cosine: n }, seed))),
    ("light rays", |problem, n, seed| Ok(fixed(problem, Rays { light: n, cosine: 0 }, seed))),
    ("both, half and half", |problem, n, seed| Ok(fixed(problem, Rays { light: n - n / 2, cosine: n / 2 }, seed))),
    ("both, shares as measured", adaptive),
];

fn main() -> Result<()> {
    let rays = std::env::args().nth(1).map_or(Ok(RAYS), |text| text.parse())?;
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    for name in ["cornell-box", "office"] {
        measure(name, builtin(name)?, 3000, rays)?;
    }
    if let Some(folder) = scenes_folder() {
        let room = isolux_io::import::read_scene(&folder.join("living-room.glb"), &Default::default())?;
        measure("living-room", room, 1, rays.div_ceil(4))?;
    }
    Ok(())
}

fn measure(name: &str, mut scene: Scene, elements: u64, rays: u32) -> Result<()> {
    scene.materials.iter_mut().for_each(|material| material.reflectivity = Rgb::BLACK);
    let problem = Problem::new(scene, Resolution::Elements(elements))?;
    let emitters = LightSampler::new(&problem).emitters().len();
    println!("\n{name}: {} elements, {emitters} emitters, {rays} rays an element\n", problem.mesh.len());
    let (reference, _) = fixed(&problem, Rays { light: rays * REFERENCE / 2, cosine: rays * REFERENCE / 2 }, 1 << 32);
    let mut sums = [[0.0; 5]; METHODS.len()];
    for seed in 0..SEEDS {
        for ((_, estimate), sums) in METHODS.iter().zip(&mut sums) {
            let start = Instant::now();
            let (found, traced) = estimate(&problem, rays, seed)?;
            let seconds = start.elapsed().as_secs_f64();
            let [weighted, plain, median] = errors(&problem, &found, &reference);
            sums.iter_mut()
                .zip([weighted, plain, median, traced as f64, seconds])
                .for_each(|(s, v)| *s += v / SEEDS as f64);
        }
    }
    println!("| method | error, by area | error, by element | median | Mrays | µs a ray | time of shooting |");
    println!("|---|---|---|---|---|---|---|");
    let work = |[squared, _, _, _, seconds]: [f64; 5]| squared * seconds;
    let of_shooting = work(sums[0]);
    for ((method, _), sums) in METHODS.iter().zip(sums) {
        let [weighted, plain] = [sums[0], sums[1]].map(|squared| 100.0 * squared.sqrt());
        let (micros, gain) = (1e6 * sums[4] / sums[3], of_shooting / work(sums));
        println!(
            "| {method} | {weighted:.3} % | {plain:.2} % | {:.2} % | {:.2} | {micros:.2} | {gain:.1} |",
            100.0 * sums[2],
            sums[3] * 1e-6
        );
    }
    Ok(())
}

/// Mean squared errors of luminance over the squared mean: weighted by area, and of elements alike; and the median relative error.
fn errors(problem: &Problem, found: &[Rgb], reference: &[Rgb]) -> [f64; 3] {
    let mut relative = Vec::new();
    let (mut area, mut sum, mut weighted, mut plain) = (0.0, 0.0, 0.0, 0.0);
    for e in problem.mesh.elements() {
        let a = f64::from(problem.mesh.area(e));
        let [found, exact] = [found, reference].map(|values| values[e as usize].luminance_f64());
        area += a;
        sum += a * exact;
        weighted += a * (found - exact).powi(2);
        plain += (found - exact).powi(2);
        if exact > 0.0 {
            relative.push((found / exact - 1.0).abs());
        }
    }
    relative.sort_by(f64::total_cmp);
    let mean = sum / area;
    let [weighted, plain] = [weighted / area, plain / problem.mesh.len() as f64].map(|square| square / (mean * mean));
    [weighted, plain, relative[relative.len() / 2]]
}

fn fixed(problem: &Problem, rays: Rays, seed: u64) -> (Vec<Rgb>, u64) {
    let (sampler, sequence) = (LightSampler::new(problem), OwenSobol::new(seed));
    let mut light = DirectEstimator::new(problem, &sampler, &sequence);
    let mut traced = 0;
    let mut of_element = |e| {
        let (irradiance, rays) = light.irradiance(e, rays);
        traced += rays;
        irradiance
    };
    (problem.mesh.elements().map(&mut of_element).collect(), traced)
}

fn adaptive(problem: &Problem, rays: u32, seed: u64) -> Result<(Vec<Rgb>, u64)> {
    let mut light = DirectLight::new(problem, seed, "owen-sobol".parse()?);
    let of_round = f64::from(rays / ROUNDS) * problem.mesh.len() as f64;
    let (mut sum, mut traced) = (vec![Rgb::BLACK; problem.mesh.len()], 0);
    light.begin_trial();
    for round in 0..=ROUNDS {
        for piece in 0..light.pieces() {
            let received = light.piece(problem, piece);
            traced += received.iter().map(|received| u64::from(received.traced)).sum::<u64>();
            light.merge(problem, piece, &received, |e, irradiance, _| sum[e as usize] += irradiance);
            light.learn(piece, &received);
        }
        if round < ROUNDS {
            light.begin_round(problem, of_round, f64::INFINITY);
        }
    }
    Ok((sum.into_iter().map(|sum| sum / ROUNDS as f32).collect(), traced))
}

/// Breadth-first, one complete solution: in a black room its first and only step.
fn shooting(problem: &Problem, rays: u32, seed: u64) -> Result<(Vec<Rgb>, u64)> {
    let budget = Budget::Rays(u64::from(rays) * problem.mesh.len() as u64);
    let settings = monte_carlo::Settings { budget, seed, replicates: 1, ..Default::default() };
    let solution = run(&mut MonteCarlo::new(problem, settings)?, problem, |_| ControlFlow::Continue(()));
    Ok((solution.irradiance, solution.work.rays))
}

/// The plain way: an emitter in proportion to its flux, a uniform point of it.
fn uniform(problem: &Problem, rays: u32, seed: u64) -> Result<(Vec<Rgb>, u64)> {
    let (sampler, sequence) = (LightSampler::new(problem), OwenSobol::new(seed));
    let emitters = sampler.emitters();
    let mut before = vec![0.0];
    emitters.iter().for_each(|emitter| before.push(before[before.len() - 1] + emitter.flux()));
    let total = before[emitters.len()];
    let mut traced = 0;
    let mut samples = vec![[0.0; 4]; rays as usize];
    let mut of_element = |e: u32| {
        sequence.fill(u64::from(e), 0, &mut samples);
        let departure = Departure::new(problem, e, Footprint::WHOLE);
        let (mut sent, mut given) = (Vec::new(), Vec::new());
        for &[x1, x2, x3, x4] in &samples {
            let at = f64::from(x3) * total;
            let k = before[1..emitters.len()].partition_point(|&before| before <= at);
            let (emitter, share) = (&emitters[k], emitters[k].flux() / total);
            let uv = square_to_triangle(Vec2::new(((at - before[k]) / emitter.flux()) as f32, x4));
            let [a, b, c] = emitter.corners;
            let start = departure.start(square_to_triangle(Vec2::new(x1, x2)));
            let way = a + uv.x * (b - a) + uv.y * (c - a) - start.origin;
            let direction = way.normalize_or_zero();
            let (cos, cos_there) = (direction.dot(start.normal), -direction.dot(emitter.normal));
            if cos > 0.0 && cos_there > 0.0 {
                let weight = cos * cos_there * emitter.area / (std::f32::consts::PI * way.length_squared());
                sent.push(start.ray(direction));
                given.push((emitter, emitter.emission * (weight / (share as f32 * rays as f32))));
            }
        }
        traced += sent.len() as u64;
        let mut hits = vec![Hit::MISS; sent.len()];
        problem.geometry.closest(&sent, &mut hits);
        let arrived = hits
            .iter()
            .zip(&given)
            .filter(|(hit, (emitter, _))| (hit.triangle, hit.back) == (emitter.triangle, emitter.back));
        arrived.map(|(_, (_, irradiance))| *irradiance).sum::<Rgb>()
    };
    Ok((problem.mesh.elements().map(&mut of_element).collect(), traced))
}
