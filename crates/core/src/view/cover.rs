//! What share of an element lies open: surfaces run on behind skirtings, under feet and inside walls.
//!
//! No model of a room is a closed skin; walls, skirtings and furniture pass through each other. An element of the floor
//! that lies half under a cupboard has half the irradiance of its neighbours, and one wholly under it has none, but nobody
//! can see the covered half. Left alone, its darkness would be interpolated into the floor before the cupboard. So some
//! points of each element that is darker than its neighbours look around: a point that sees nothing but darkness is
//! covered. An element's flux then belongs to its open share alone. Elements that the error bars cannot tell from their
//! neighbours are left alone: in the noise of the first seconds they would be most of all.

use super::plastic;
use super::vertices::Vertices;
use crate::geometry::{Hit, Ray};
use crate::math::Frame;
use crate::math::warp::square_to_cosine_hemisphere;
use crate::scene::LightKind;
use crate::solution::luminance_error;
use crate::{Problem, Solution};
use glam::Vec3;
use rayon::prelude::*;

/// Points looked from, in every element that may be covered.
const POINTS: u32 = 16;
/// Directions in which a point must see darkness to be covered.
const LOOKS: u32 = 6;
/// Elements darker than this share of the brightest neighbour may be covered.
const DARKER: f32 = 0.85;
/// Differences within this many combined standard errors may be noise.
const SIGNIFICANT: f32 = 2.0;
/// What has less than this share of the brightest neighbour's light is darkness.
const DARKNESS: f32 = 0.02;

/// Open share of every element, in [0, 1].
pub fn open_shares(problem: &Problem, solution: &Solution, vertices: &Vertices) -> Vec<f32> {
    let light = |e: u32| solution.irradiance[e as usize].luminance();
    // An error that is not known counts as none.
    let error = |e: u32| luminance_error(solution.std_error[e as usize]).max(0.0);
    let brighter = |a: u32, b: u32| if light(b) > light(a) { b } else { a };
    let brightest_at = |v: u32| vertices.touching(v).iter().copied().reduce(brighter);
    let brightest: Vec<Option<u32>> = (0..vertices.len() as u32).into_par_iter().map(brightest_at).collect();
    let share = |e: u32| {
        let neighbour =
            vertices.of_element(problem, e).into_iter().filter_map(|v| brightest[v as usize]).fold(e, brighter);
        let around = light(neighbour);
        let noise = SIGNIFICANT * error(e).hypot(DARKER * error(neighbour));
        // An open part brighter than all its neighbours would be a miscount of the points.
        let open_share = || open_share(problem, solution, e, around).max(light(e) / around);
        if light(e) + noise < DARKER * around { open_share() } else { 1.0 }
    };
    (0..problem.mesh.len() as u32).into_par_iter().map(share).collect()
}

/// The share of points of element `e` that see more than darkness, beside neighbours with the irradiance `around` [lux].
fn open_share(problem: &Problem, solution: &Solution, e: u32, around: f32) -> f32 {
    let mut covered: Vec<(Ray, u32)> = (0..POINTS).map(|k| (start(problem, e, k), k)).collect();
    covered.retain(|(ray, _)| !sees_a_light(problem, ray));
    for look in 0..LOOKS {
        let rays: Vec<Ray> = covered
            .iter()
            .map(|&(ray, k)| {
                let local = square_to_cosine_hemisphere(plastic::point(e, LOOKS * k + look));
                Ray { direction: Frame::about(ray.direction).to_world(local), ..ray }
            })
            .collect();
        let mut hits = vec![Hit::MISS; rays.len()];
        problem.geometry.closest(&rays, &mut hits);
        let mut dark = hits.iter().map(|hit| is_dark(problem, solution, hit, DARKNESS * around));
        covered.retain(|_| dark.next().unwrap_or(false));
        if covered.is_empty() {
            return 1.0;
        }
    }
    (POINTS as usize - covered.len()) as f32 / POINTS as f32
}

/// Point `k` of element `e`, lifted off the surface, looking along the normal.
fn start(problem: &Problem, e: u32, k: u32) -> Ray {
    let (triangle, uv) = problem.mesh.point(e, plastic::point(0, k));
    let (position, front) = problem.geometry.surface(triangle, uv);
    let normal = if problem.mesh.place(e).back { -front } else { front };
    Ray { origin: position + problem.geometry.lift() * normal, direction: normal, from: triangle }
}

/// Whether `hit` shows less light than `darkness` [lm/m²]. The open is not dark: who can see it can be seen from it.
fn is_dark(problem: &Problem, solution: &Solution, hit: &Hit, darkness: f32) -> bool {
    if hit.is_miss() {
        return false;
    }
    match problem.mesh.at(hit.triangle, hit.uv, hit.back) {
        None => true,
        Some(e) => (problem.mesh.emission(e) + solution.irradiance[e as usize]).luminance() < darkness,
    }
}

/// Whether a light without extent shines on the point from which `start` looks along the normal.
pub fn sees_a_light(problem: &Problem, start: &Ray) -> bool {
    let beyond = 4.0 * problem.geometry.bounding_sphere().1;
    problem.scene.lights.iter().any(|light| {
        let (direction, reach) = match light.kind {
            LightKind::Directional { direction } => (-direction, beyond),
            LightKind::Point { position } | LightKind::Spot { position, .. } => {
                let way = position - start.origin;
                (way.normalize_or(Vec3::Y), way.length())
            }
        };
        let in_beam = match light.kind {
            LightKind::Spot { direction: axis, outer_angle, .. } => axis.dot(-direction) > outer_angle.cos(),
            _ => true,
        };
        let mut blocked = [false];
        if in_beam && direction.dot(start.direction) > 0.0 {
            problem.geometry.any(&[Ray { direction, ..*start }], &[reach], &mut blocked);
            return !blocked[0];
        }
        false
    })
}
