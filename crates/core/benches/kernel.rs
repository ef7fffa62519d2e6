//! Rays per second of the kernel on one core: `cargo bench -p isolux-core --bench kernel`.
//!
//! Diffuse rays (uniform points of random triangles, cosine directions) in three closed rooms. "sorted" is the same with
//! the origins along a space-filling curve, as the solvers shoot them. Figures are medians of five rounds; nothing is judged.
#![allow(clippy::print_stdout)]

use glam::{Vec2, Vec3};
use isolux_core::geometry::{Bvh, Geometry, Hit, NONE, Ray};
use isolux_core::math::{Frame, warp};
use isolux_core::scene::{Scene, Triangle, Vertex};
use std::f32::consts::{PI, TAU};
use std::hint::black_box;
use std::time::Instant;

const RAYS: usize = 1 << 18;

fn main() {
    println!("Million rays per second on one core\n");
    println!("| triangles | build [s] | bytes each | rays | closest | any | closest, portable |");
    println!("|---|---|---|---|---|---|---|");
    for scene in [room(2, 0, 0), room(4, 7, 51), room(40, 200, 51)] {
        measure(&scene);
    }
}

fn measure(scene: &Scene) {
    let start = Instant::now();
    let bvh = Bvh::new(scene);
    let (build, triangles) = (start.elapsed().as_secs_f64(), scene.triangles.len());
    let bytes = bvh.bytes() / triangles;
    let portable = Bvh::portable(scene);
    let mut rays = diffuse_rays(&bvh, triangles);
    for order in ["unsorted", "sorted"] {
        if order == "sorted" {
            rays.sort_by_cached_key(|ray| morton(ray.origin / 10.0));
        }
        let mut hits = vec![Hit::MISS; RAYS];
        let portable = million_rays_per_second(|| portable.closest(&rays, &mut hits));
        let closest = million_rays_per_second(|| bvh.closest(&rays, &mut hits));
        // Light sources are as far as what is seen, on the average: half the rays stop short of it.
        let reach: Vec<f32> = hits.iter().zip([0.9, 1.1].into_iter().cycle()).map(|(hit, k)| hit.t * k).collect();
        let mut blocked = vec![false; RAYS];
        let any = million_rays_per_second(|| bvh.any(&rays, &reach, &mut blocked));
        println!("| {triangles} | {build:.2} | {bytes} | {order} | {closest:.2} | {any:.2} | {portable:.2} |");
    }
}

/// Median speed of five runs of `shoot`, which shoots all rays.
fn million_rays_per_second(mut shoot: impl FnMut()) -> f64 {
    let mut seconds: Vec<f64> = (0..5)
        .map(|_| {
            let start = Instant::now();
            shoot();
            black_box(());
            start.elapsed().as_secs_f64()
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    RAYS as f64 * 1e-6 / seconds[2]
}

fn diffuse_rays(bvh: &Bvh, triangles: usize) -> Vec<Ray> {
    let mut random = Random(1);
    let ray = |_| {
        let from = ((random.next() * triangles as f32) as usize).min(triangles - 1) as u32;
        let (point, normal) = bvh.surface(from, warp::square_to_triangle(random.pair()));
        let direction = Frame::about(normal).to_world(warp::square_to_cosine_hemisphere(random.pair()));
        Ray { origin: point + normal * bvh.lift(), direction: direction.normalize(), from }
    };
    (0..RAYS).map(ray).collect()
}

/// A room ten metres wide, seen from inside, with boxes on the floor and tessellated balls in the air.
fn room(boxes: usize, balls: usize, rings: usize) -> Scene {
    let mut scene = Scene::default();
    let mut random = Random(2);
    push_box(&mut scene, Vec3::splat(10.0), Vec3::ZERO);
    for _ in 0..boxes {
        let low = Vec3::new(8.0 * random.next() + 0.5, 8.0 * random.next() + 0.5, 0.0);
        let size = Vec3::new(0.3 + random.next(), 0.3 + random.next(), 0.3 + 3.0 * random.next());
        push_box(&mut scene, low, low + size);
    }
    for _ in 0..balls {
        let center = Vec3::new(random.next(), random.next(), random.next()) * 8.0 + 1.0;
        push_ball(&mut scene, center, 0.2 + 0.6 * random.next(), rings);
    }
    scene
}

/// A box seen from outside; from inside if `low` and `high` are exchanged.
fn push_box(scene: &mut Scene, low: Vec3, high: Vec3) {
    let first = scene.vertices.len() as u32;
    let pick = |k: u32, bit: u32, axis: usize| if k & bit == 0 { low[axis] } else { high[axis] };
    let corner = |k| Vertex::at(Vec3::new(pick(k, 1, 0), pick(k, 2, 1), pick(k, 4, 2)));
    scene.vertices.extend((0..8).map(corner));
    for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        push_triangle(scene, [a, b, c].map(|k| first + k));
        push_triangle(scene, [a, c, d].map(|k| first + k));
    }
}

/// A ball of `2 rings (rings - 1)` triangles.
fn push_ball(scene: &mut Scene, center: Vec3, radius: f32, rings: usize) {
    let first = scene.vertices.len();
    for (ring, k) in (0..=rings).flat_map(|ring| (0..rings).map(move |k| (ring, k))) {
        let (sin, cos) = (PI * ring as f32 / rings as f32).sin_cos();
        let (y, x) = (TAU * k as f32 / rings as f32).sin_cos();
        scene.vertices.push(Vertex::at(center + radius * Vec3::new(sin * x, sin * y, cos)));
    }
    for (ring, k) in (0..rings).flat_map(|ring| (0..rings).map(move |k| (ring, k))) {
        let vertex = |ring: usize, k: usize| (first + ring * rings + k % rings) as u32;
        let [a, b, c, d] = [vertex(ring, k), vertex(ring + 1, k), vertex(ring + 1, k + 1), vertex(ring, k + 1)];
        if ring + 1 < rings {
            push_triangle(scene, [a, b, c]);
        }
        if ring > 0 {
            push_triangle(scene, [a, c, d]);
        }
    }
}

fn push_triangle(scene: &mut Scene, vertices: [u32; 3]) {
    scene.triangles.push(Triangle { vertices, object: 0, source: NONE });
}

/// Position on a space-filling curve through the unit cube.
fn morton(p: Vec3) -> u64 {
    let [x, y, z] = (p.clamp(Vec3::ZERO, Vec3::ONE) * 1023.0).to_array().map(|v| v as u64);
    (0..10).fold(0, |code, bit| {
        code | (x >> bit & 1) << (3 * bit) | (y >> bit & 1) << (3 * bit + 1) | (z >> bit & 1) << (3 * bit + 2)
    })
}

/// Weyl sequence, mixed (Steele et al., SplitMix, 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 40) as f32 / (1u64 << 24) as f32
    }

    fn pair(&mut self) -> Vec2 {
        Vec2::new(self.next(), self.next())
    }
}
