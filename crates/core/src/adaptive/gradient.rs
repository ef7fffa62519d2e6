//! How steep the light is: what a pilot tells of the gradient of irradiance.
//!
//! ```text
//! g² = 2 Σ_j s_j (E_j - E)² / Σ_j s_j |x_j - x|²
//! ```
//!
//! over the neighbours of an element on the same smooth surface, with their shares s ([`crate::view`]): for a direction that may be any
//! `(g · d)²` is `g² d² / 2` in the mean. Noise was taken out of E before, as far as the error bars allow. At an edge of a shadow that is the jump
//! over the distance, so it is as steep as the pilot can tell. What is less steep than a share of the mean counts as that: the noise of a
//! pilot tells no better, and an element more there costs little.

use crate::view::neighbours::Neighbours;
use crate::view::smooth;
use crate::view::vertices::Vertices;
use crate::{Problem, Solution};
use glam::Vec2;
use rayon::prelude::*;
use std::ops::Range;

/// The least gradient, as a share of the mean one.
const LEAST: f64 = 0.3;

/// What is known at the middle of an element of a pilot.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Barycentric coordinates on the triangle.
    pub uv: Vec2,
    /// Area of the element [m²].
    pub area: f64,
    /// Irradiance [lux].
    pub value: f64,
    /// g² [lux²/m²].
    pub square: f64,
}

/// What is known everywhere: the samples of each triangle.
#[derive(Clone, Debug)]
pub struct Known {
    samples: Vec<Sample>,
    of_triangle: Vec<Range<usize>>,
}

impl Known {
    /// What `solution` tells.
    pub fn of(problem: &Problem, solution: &Solution) -> Known {
        let mesh = &problem.mesh;
        let light = smooth(problem, solution).irradiance;
        let light: Vec<f64> = light.into_iter().map(|light| light.luminance_f64()).collect();
        let mut squares = squared_gradients(problem, &light);
        let area = |e: u32| f64::from(mesh.area(e));
        let mean = (0..).zip(&squares).map(|(e, g)| area(e) * g.sqrt()).sum::<f64>() / mesh.total_area();
        // In the dark all elements are equal.
        let least = if mean > 0.0 { (LEAST * mean).powi(2) } else { 1.0 };
        squares.iter_mut().for_each(|g| *g = g.max(least));
        let sample = |e: u32| Sample {
            uv: middle(problem, e),
            area: area(e),
            value: light[e as usize],
            square: squares[e as usize],
        };
        let mut of_triangle = vec![0..0; problem.scene.triangles.len()];
        // Elements are numbered triangle by triangle.
        for e in 0..mesh.len() {
            let range = &mut of_triangle[mesh.triangle(e as u32) as usize];
            *range = if range.end == 0 { e..e + 1 } else { range.start..e + 1 };
        }
        Known { samples: mesh.elements().map(sample).collect(), of_triangle }
    }

    pub fn on(&self, triangle: u32) -> &[Sample] {
        &self.samples[self.of_triangle[triangle as usize].clone()]
    }

    /// Error [lux² m²] that no element exceeds.
    pub fn error_of_one(&self, problem: &Problem) -> f64 {
        let steepest = self.samples.iter().map(|sample| sample.square).fold(0.0, f64::max);
        steepest * problem.mesh.total_area() * f64::from(problem.geometry.bounding_sphere().1).powi(2)
    }
}

/// What some samples tell together.
#[derive(Clone, Copy, Debug)]
pub struct Summary {
    /// Mean g² [lux²/m²].
    pub square: f64,
    /// Mean area of their elements [m²].
    pub area: f64,
    /// Variance between them [lux²].
    pub variance: f64,
}

impl Summary {
    /// `None` without samples.
    pub fn of(samples: &[Sample]) -> Option<Summary> {
        let area = samples.iter().map(|sample| sample.area).sum::<f64>();
        let mean = |value: &dyn Fn(&Sample) -> f64| samples.iter().map(|s| s.area * value(s)).sum::<f64>() / area;
        if area <= 0.0 {
            return None;
        }
        let middle = mean(&|sample| sample.value);
        let variance = mean(&|sample| (sample.value - middle).powi(2));
        Some(Summary { square: mean(&|sample| sample.square), area: area / samples.len() as f64, variance })
    }
}

/// g² [lux²/m²] of every element.
fn squared_gradients(problem: &Problem, light: &[f64]) -> Vec<f64> {
    let weight: Vec<f32> = problem.mesh.elements().map(|e| problem.mesh.area(e)).collect();
    let neighbours = Neighbours::new(problem, &Vertices::new(problem), &weight);
    let position = |e: u32| problem.geometry.surface(problem.mesh.triangle(e), middle(problem, e)).0;
    let square = |e: u32| {
        let (here, value) = (position(e), light[e as usize]);
        let (mut change, mut distance) = (0.0, 0.0);
        for (n, share) in neighbours.of(e as usize) {
            change += f64::from(share) * (light[n] - value).powi(2);
            distance += f64::from(share * position(n as u32).distance_squared(here));
        }
        if distance > 0.0 { 2.0 * change / distance } else { 0.0 }
    };
    (0..problem.mesh.len() as u32).into_par_iter().map(square).collect()
}

/// Barycentric coordinates on its triangle of the middle of element `e`.
fn middle(problem: &Problem, e: u32) -> Vec2 {
    problem.mesh.corners(e).iter().sum::<Vec2>() / 3.0
}
