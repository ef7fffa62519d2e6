//! The rays that are traced: those a solver would shoot.

use isolux_core::Problem;
use isolux_core::geometry::{NONE, Ray};
use isolux_core::transport::{Departure, Footprint};
use isolux_testing::random::Random;

/// Rays of each kind.
pub const RAYS: usize = 1 << 16;

pub struct Rays {
    /// Diffuse rays: from uniform points of all surfaces in cosine-distributed directions, in random order.
    pub incoherent: Vec<Ray>,
    /// The same in the order of the elements they leave, which follows a space-filling curve.
    pub sorted: Vec<Ray>,
    /// From uniform points of all surfaces to uniform points of emitters that face them, in random order ...
    pub shadow: Vec<Ray>,
    /// ... and how far those are away, less a thousandth [m].
    pub reach: Vec<f32>,
    /// Triangles of the scene.
    pub triangles: usize,
}

impl Rays {
    /// The same rays every time.
    pub fn through(problem: &Problem) -> Rays {
        let mut random = Random::new(1);
        let sorted = diffuse(problem, &mut random);
        let mut incoherent = sorted.clone();
        for k in (1..RAYS).rev() {
            incoherent.swap(k, (random.bits() % (k as u64 + 1)) as usize);
        }
        let (shadow, reach) = to_emitters(problem, &incoherent, &mut random);
        Rays { incoherent, sorted, shadow, reach, triangles: problem.scene.triangles.len() }
    }
}

/// Rays of all elements, on each as many as its share of the area, in their order.
fn diffuse(problem: &Problem, random: &mut Random) -> Vec<Ray> {
    let per_area = RAYS as f64 / problem.mesh.total_area();
    let mut rays = Vec::with_capacity(RAYS);
    let mut area = 0.0;
    for element in problem.mesh.elements() {
        area += f64::from(problem.mesh.area(element));
        let last = element + 1 == problem.mesh.len() as u32;
        let due = if last { RAYS } else { (area * per_area) as usize };
        let departure = Departure::new(problem, element, Footprint::WHOLE);
        while rays.len() < due {
            rays.push(departure.ray([0; 4].map(|_| random.uniform())));
        }
    }
    rays
}

/// From the origins of `rays` to points of emitters, chosen by area; pairs that do not face each other are left out.
fn to_emitters(problem: &Problem, rays: &[Ray], random: &mut Random) -> (Vec<Ray>, Vec<f32>) {
    let mesh = &problem.mesh;
    let emitters: Vec<u32> = mesh.elements().filter(|&e| mesh.emission(e).luminance() > 0.0).collect();
    let mut end = 0.0;
    let mut ends = Vec::new();
    for &e in &emitters {
        end += mesh.area(e);
        ends.push(end);
    }
    let (mut shadow, mut reach) = (Vec::with_capacity(RAYS), Vec::with_capacity(RAYS));
    for ray in rays.iter().cycle().take(100 * RAYS) {
        let area = end * random.uniform();
        let emitter = emitters[ends.partition_point(|&e| e <= area).min(emitters.len() - 1)];
        let (triangle, point) = mesh.point(emitter, random.square());
        let (target, _) = problem.geometry.surface(triangle, point);
        let way = target - ray.origin;
        let direction = way.normalize_or_zero();
        let normal = problem.geometry.surface(ray.from, glam::Vec2::ZERO).1;
        // Diffuse rays leave on the side that they look at.
        let outwards = if ray.direction.dot(normal) < 0.0 { -normal } else { normal };
        if direction.dot(outwards) > 0.0 && direction.dot(mesh.normal(emitter)) < 0.0 && ray.from != NONE {
            shadow.push(Ray { direction, ..*ray });
            reach.push(way.length() * 0.999);
        }
        if shadow.len() == RAYS {
            break;
        }
    }
    (shadow, reach)
}
