//! Noise taken out as far as the error bars allow: neighbours even each other out where they do not differ significantly.
//!
//! ```text
//! x_i += Σ_j g_ij s_ij (x_j - x_i),    g = (1 - u)²+,    u = (x_j - x_i)² / (T² (V_i + V_j)),  the largest of the channels
//! ```
//!
//! three times, each reaching one ring of elements further, with the shares s of [`super::neighbours`] and Tukey's biweight g, which
//! is Black et al.'s robust anisotropic diffusion (IEEE Trans. Image Processing 1998) with the variance V of the noise in place of
//! a contrast to be set. What stands out of the noise, a shadow's edge, stays; what does not could not have been told from noise. All
//! light is evened out together, direct and reflected. Each pass makes V smaller, `V_i' = Σ w² V`, and so protects more. T falls from
//! pass to pass: the first takes the rare large errors away, and the last ones, when little noise is left, keep the shape of the light.
//!
//! Exchanges are symmetric, so the flux on every object is kept, to rounding. Biased: curved light becomes flatter by part of
//! its noise; even light and straight gradients, inside a surface, do not change. Linear in the elements, 250 bytes each, same bits for
//! any number of threads. A solution without noise, or whose noise is not known, stays as it is. `make study-smoothing` measures gain and bias.

use super::cover;
use super::neighbours::Neighbours;
use super::vertices::Vertices;
use crate::math::Rgb;
use crate::{Problem, Solution};
use rayon::prelude::*;

/// T in each pass: differences beyond so many combined standard errors are left alone, half as large ones for the most part evened out.
/// A pass reaches one ring of elements further; more than three take little noise away, and more of the light's shape.
const SIGNIFICANT: [f32; 3] = [5.0, 3.0, 2.4];
/// The parameter of a solution that says that noise was taken out.
pub const SMOOTHED: &str = "smoothed";

/// `solution` with the noise taken out of its irradiance; its parameters say so ([`SMOOTHED`]).
///
/// The standard errors stay those of the solution as it was computed: what is left of the noise is less, and what was evened out was
/// mostly within them. Without standard errors nothing changes.
pub fn smooth(problem: &Problem, solution: &Solution) -> Solution {
    let mut solution = solution.clone();
    if is_noise_known(&solution) {
        let vertices = Vertices::new(problem);
        let open = cover::open_shares(problem, &solution, &vertices);
        let smoothed = of_open_parts(problem, &solution, &vertices, &open);
        solution.irradiance = smoothed.into_iter().zip(&open).map(|(value, open)| value * divisor(*open)).collect();
        solution.provenance.parameters.push((SMOOTHED.to_owned(), "within the error bars".to_owned()));
    }
    solution
}

/// Irradiance [lux] of the open part of every element, `open[e]` of its area, with the noise taken out.
pub(super) fn of_open_parts(problem: &Problem, solution: &Solution, vertices: &Vertices, open: &[f32]) -> Vec<Rgb> {
    let value = as_computed(solution, open);
    let Some(std_error) = errors_of_open_parts(solution, open) else { return value };
    let weight: Vec<f32> = (0..).zip(open).map(|(e, open)| problem.mesh.area(e) * open).collect();
    let neighbours = Neighbours::new(problem, vertices, &weight);
    let mut estimate = Estimate { value, variance: pooled(&neighbours, &std_error, &weight) };
    for significant in SIGNIFICANT {
        estimate = pass(&neighbours, &estimate, significant);
    }
    estimate.value
}

/// Irradiance [lux] of the open part of every element, noise and all.
pub(super) fn as_computed(solution: &Solution, open: &[f32]) -> Vec<Rgb> {
    solution.irradiance.iter().zip(open).map(|(value, open)| *value / divisor(*open)).collect()
}

/// Standard errors [lux] of [`as_computed`]; `None` if the noise is not known.
pub(super) fn errors_of_open_parts(solution: &Solution, open: &[f32]) -> Option<Vec<Rgb>> {
    let errors = || solution.std_error.iter().zip(open).map(|(s, open)| *s / divisor(*open)).collect();
    is_noise_known(solution).then(errors)
}

/// Light on an element all of which is covered stays as it is.
fn divisor(open: f32) -> f32 {
    if open > 0.0 { open } else { 1.0 }
}

fn is_noise_known(solution: &Solution) -> bool {
    solution.std_error.iter().all(|s| s.is_finite())
}

/// Irradiance [lux] of every element, with its variance.
struct Estimate {
    value: Vec<Rgb>,
    variance: Vec<Rgb>,
}

/// Variances from a handful of replicates are noisy themselves, and low where the value is low by chance: weights of them would pull
/// everything down. Standard error times root of area varies little from element to element (theory: `V = c E / A` for shooting), so
/// its mean over the neighbours tells more; but an element that knows of a rare bright ray has its own, larger one.
fn pooled(neighbours: &Neighbours, std_error: &[Rgb], weight: &[f32]) -> Vec<Rgb> {
    let scaled = |e: usize| std_error[e] * weight[e].sqrt();
    let pool = |e: usize| {
        let (mut sum, mut own) = (Rgb::BLACK, 1.0);
        for (n, share) in neighbours.of(e) {
            sum += scaled(n) * share;
            own -= share;
        }
        let mean = if own < 1.0 { (sum + scaled(e) * own) / weight[e].sqrt() } else { std_error[e] };
        let larger = |a: f32, b: f32| a.max(b).powi(2);
        Rgb::new(larger(mean.r, std_error[e].r), larger(mean.g, std_error[e].g), larger(mean.b, std_error[e].b))
    };
    (0..std_error.len()).into_par_iter().map(pool).collect()
}

fn pass(neighbours: &Neighbours, old: &Estimate, significant: f32) -> Estimate {
    let even_out = |e: usize| {
        let (mut gain, mut variance, mut own) = (Rgb::BLACK, Rgb::BLACK, 1.0);
        for (n, share) in neighbours.of(e) {
            let difference = old.value[n] - old.value[e];
            let w = share * likeness(difference, old.variance[n] + old.variance[e], significant);
            gain += difference * w;
            variance += old.variance[n] * (w * w);
            own -= w;
        }
        (old.value[e] + gain, variance + old.variance[e] * (own * own))
    };
    let (value, variance) = (0..old.value.len()).into_par_iter().map(even_out).unzip();
    Estimate { value, variance }
}

/// `g`: 1 for equal values, 0 for a difference of `significant` standard errors of noise of `variance` in some channel.
fn likeness(difference: Rgb, variance: Rgb, significant: f32) -> f32 {
    let surprise = |d: f32, v: f32| if d == 0.0 { 0.0 } else { d * d / (significant * significant * v) };
    let [r, g, b] = [difference.r, difference.g, difference.b];
    let u = surprise(r, variance.r).max(surprise(g, variance.g)).max(surprise(b, variance.b));
    (1.0 - u).max(0.0).powi(2)
}

#[cfg(test)]
mod tests;
