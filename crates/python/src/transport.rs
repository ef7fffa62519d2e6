//! Lines between elements, many at once: what a solver in Python is made of.

use crate::fail::Fail;
use glam::{Vec2, Vec3};
use isolux_core::geometry::{Hit, NONE, Ray};
use isolux_core::math::warp::square_to_triangle;
use isolux_core::transport::{Departure, Footprint};
use isolux_core::{Error, Problem};
use rayon::prelude::*;

/// Rays that are traced together.
const BATCH: usize = 1024;
/// The number of no element, and that of the back of a one-sided surface.
const NOTHING: i64 = -1;
const BACK: i64 = -2;

/// An element, or nothing, as Python counts.
pub fn number(element: u32) -> i64 {
    if element == NONE { NOTHING } else { i64::from(element) }
}

fn refused(name: &'static str, value: String, allowed: &'static str) -> Fail {
    Error::Parameter { name, value, allowed }.into()
}

fn check_count(name: &'static str, count: usize, wanted: usize) -> Result<(), Fail> {
    if count == wanted { Ok(()) } else { Err(refused(name, count.to_string(), "as many as the others have rows")) }
}

/// `number` as an element of `problem`.
fn element(problem: &Problem, number: i64) -> Result<u32, Fail> {
    let known = u32::try_from(number).ok().filter(|&e| (e as usize) < problem.mesh.len());
    known.ok_or_else(|| refused("element", number.to_string(), "the elements of a problem are 0 to len(problem) - 1"))
}

/// Rays from `origins`, which never meet the triangles of the elements that they are `leaving`.
///
/// # Errors
/// For arrays of different lengths, numbers that are not finite, directions without length, and unknown elements.
pub fn rays(
    problem: &Problem,
    origins: &[[f32; 3]],
    directions: &[[f32; 3]],
    leaving: Option<&[i64]>,
) -> Result<Vec<Ray>, Fail> {
    check_count("directions", directions.len(), origins.len())?;
    check_count("leaving", leaving.map_or(origins.len(), <[i64]>::len), origins.len())?;
    let what = "origins are finite, and directions have a length";
    let ray = |k: usize| {
        let (origin, direction) = (Vec3::from(origins[k]), Vec3::from(directions[k]));
        let direction = direction.try_normalize().filter(|_| origin.is_finite());
        let from = match leaving {
            Some(leaving) => problem.mesh.triangle(element(problem, leaving[k])?),
            None => NONE,
        };
        Ok(Ray { origin, direction: direction.ok_or_else(|| refused("ray", k.to_string(), what))?, from })
    };
    (0..origins.len()).map(ray).collect()
}

/// What each ray meets first, and at what distance [m]; infinite if it is nothing.
pub fn trace(problem: &Problem, rays: &[Ray]) -> (Vec<i64>, Vec<f32>) {
    let batch = |rays: &[Ray]| {
        let mut hits = vec![Hit::MISS; rays.len()];
        problem.geometry.closest(rays, &mut hits);
        hits
    };
    let hits: Vec<Hit> = rays.par_chunks(BATCH).flat_map_iter(batch).collect();
    let met = |hit: &Hit| match hit.is_miss() {
        true => NOTHING,
        false => problem.mesh.at(hit.triangle, hit.uv, hit.back).map_or(BACK, i64::from),
    };
    hits.iter().map(|hit| (met(hit), hit.t)).unzip()
}

/// The local line of each of `elements` that belongs to its `samples`: two numbers choose the point, two the direction.
///
/// # Errors
/// For an unknown element, and for numbers outside of [0, 1).
#[expect(clippy::type_complexity)]
pub fn local_lines(
    problem: &Problem,
    elements: &[i64],
    samples: &[[f32; 4]],
) -> Result<(Vec<[f32; 3]>, Vec<[f32; 3]>), Fail> {
    check_count("samples", samples.len(), elements.len())?;
    let line = |(&number, sample): (&i64, &[f32; 4])| {
        check_sample(sample)?;
        let ray = Departure::new(problem, element(problem, number)?, Footprint::WHOLE).ray(*sample);
        Ok((ray.origin.to_array(), ray.direction.to_array()))
    };
    elements.iter().zip(samples).map(line).collect()
}

/// The point of each of `elements` that belongs to its `samples`, and the unit normal there.
///
/// # Errors
/// As [`local_lines`].
#[expect(clippy::type_complexity)]
pub fn points(
    problem: &Problem,
    elements: &[i64],
    samples: &[[f32; 2]],
) -> Result<(Vec<[f32; 3]>, Vec<[f32; 3]>), Fail> {
    check_count("samples", samples.len(), elements.len())?;
    let point = |(&number, sample): (&i64, &[f32; 2])| {
        check_sample(sample)?;
        let departure = Departure::new(problem, element(problem, number)?, Footprint::WHOLE);
        let start = departure.start(square_to_triangle(Vec2::from(*sample)));
        Ok((start.origin.to_array(), start.normal.to_array()))
    };
    elements.iter().zip(samples).map(point).collect()
}

fn check_sample(sample: &[f32]) -> Result<(), Fail> {
    match sample.iter().find(|number| !(0.0..=1.0).contains(*number)) {
        Some(number) => Err(refused("samples", number.to_string(), "numbers between 0 and 1")),
        None => Ok(()),
    }
}
