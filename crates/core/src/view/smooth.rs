//! Noise taken out as far as the error bars allow: neighbours are mixed where they do not differ significantly.
//!
//! A pass replaces an element's irradiance by the area-weighted mean over those elements around it whose difference is
//! within two combined standard errors in every channel. What stands out of the noise, a shadow's edge, stays; what does not
//! could not have been told from noise. Each pass makes the error bars smaller and so protects more. Nothing to be set, and
//! nothing happens to a solution without noise.

use super::vertices::Vertices;
use crate::math::Rgb;
use crate::{Problem, Solution};
use rayon::prelude::*;

/// A pass reaches one ring of elements further.
const PASSES: usize = 3;
/// Differences within this many combined standard errors are noise, as 95 % of all noise is.
const SIGNIFICANT: f32 = 2.0;
/// A vertex where more elements meet is the hub of a fan: its elements are not neighbours in any useful sense.
const HUB: usize = 64;

/// Irradiance [lux] of the open part of every element, with its variance.
struct Estimate {
    value: Vec<Rgb>,
    variance: Vec<Rgb>,
}

/// Irradiance [lux] of the open part of every element, `open[e]` of its area, without insignificant differences.
pub fn smooth(problem: &Problem, solution: &Solution, vertices: &Vertices, open: &[f32]) -> Vec<Rgb> {
    let elements = 0..problem.mesh.len();
    let share = |e: usize| if open[e] > 0.0 { open[e] } else { 1.0 };
    let value: Vec<Rgb> = elements.clone().map(|e| solution.irradiance[e] / share(e)).collect();
    if solution.std_error.iter().any(|s| !s.is_finite()) {
        return value;
    }
    let variance = elements.map(|e| (solution.std_error[e] / share(e)).map(|s| s * s)).collect();
    let mut estimate = Estimate { value, variance };
    let weight: Vec<f32> = (0..).zip(open).map(|(e, open)| problem.mesh.area(e) * open).collect();
    estimate.variance = pooled(problem, vertices, &estimate.variance, &weight);
    for _ in 0..PASSES {
        estimate = pass(problem, vertices, &estimate, &weight);
    }
    estimate.value
}

/// Elements around `e`: those that touch a corner of it, itself included; once for each corner they share.
fn around<'a>(problem: &Problem, vertices: &'a Vertices, e: u32) -> impl Iterator<Item = usize> + use<'a> {
    let corners = vertices.of_element(problem, e).into_iter();
    corners.map(|v| vertices.touching(v)).filter(|touching| touching.len() <= HUB).flatten().map(|&n| n as usize)
}

/// Variances estimated from a handful of replicates are noisy themselves, and zero where no light happened to arrive.
/// Variance times area varies little from element to element (theory: `V = c E / A` for shooting), so its mean over the
/// neighbourhood is the better estimate.
fn pooled(problem: &Problem, vertices: &Vertices, variance: &[Rgb], weight: &[f32]) -> Vec<Rgb> {
    let pool = |e: usize| {
        let (mut sum, mut count) = (Rgb::BLACK, 0.0);
        for n in around(problem, vertices, e as u32).filter(|&n| weight[n] > 0.0) {
            sum += variance[n] * weight[n];
            count += 1.0;
        }
        if count > 0.0 && weight[e] > 0.0 { sum / (count * weight[e]) } else { variance[e] }
    };
    (0..variance.len()).into_par_iter().map(pool).collect()
}

fn pass(problem: &Problem, vertices: &Vertices, old: &Estimate, weight: &[f32]) -> Estimate {
    let mixed = |e: usize| {
        let (mut deviation, mut variance, mut total) = (Rgb::BLACK, Rgb::BLACK, 0.0);
        for n in around(problem, vertices, e as u32) {
            let difference = old.value[n] - old.value[e];
            if n == e || insignificant(difference, old.variance[n] + old.variance[e]) {
                deviation += difference * weight[n];
                variance += old.variance[n] * (weight[n] * weight[n]);
                total += weight[n];
            }
        }
        if total > 0.0 {
            (old.value[e] + deviation / total, variance / (total * total))
        } else {
            (old.value[e], old.variance[e])
        }
    };
    let (value, variance) = (0..weight.len()).into_par_iter().map(mixed).unzip();
    Estimate { value, variance }
}

/// Whether a difference is within the noise of `variance`, in every channel.
fn insignificant(difference: Rgb, variance: Rgb) -> bool {
    let within = |d: f32, v: f32| d * d <= SIGNIFICANT * SIGNIFICANT * v;
    within(difference.r, variance.r) && within(difference.g, variance.g) && within(difference.b, variance.b)
}
