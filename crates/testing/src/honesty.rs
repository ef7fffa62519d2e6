//! Whether error bars are honest: over many seeds, errors in units of their own error bars follow Student's t.

use crate::ensemble::Exact;
use crate::projections::Deviation;
use isolux_core::math::Rgb;
use isolux_core::math::estimate::student;
use isolux_core::math::moments::Moments;
use isolux_core::{Problem, Solution};

/// How far the errors of independent `runs` are from those that their standard errors announce, each from the mean of
/// `replicates` replicates. Elements of one run are lit by the same rays, so the spread of a quantity is taken between runs:
///
/// - *variance*: the mean over elements of t² is `(R - 1) / (R - 3)`;
/// - *tails*: the shares of |t| above the 10 %, 1 % and 0.1 % points of Student's t with R - 1 degrees of freedom;
/// - *error*: the sum by area of squared errors is that of the squared standard errors.
pub fn of_student(problem: &Problem, runs: &[Solution], exact: &Exact, replicates: u32) -> Vec<Deviation> {
    let dof = f64::from(replicates) - 1.0;
    let mean = |run: &Solution, f: &dyn Fn(f64) -> f64| {
        let scores = scores(run, exact);
        scores.iter().map(|&t| f(t)).sum::<f64>() / scores.len() as f64
    };
    let variance = runs.iter().map(|run| mean(run, &|t| t * t)).collect();
    let tail = |p: f64| {
        let bound = student(1.0 - p, dof);
        let shares = runs.iter().map(|run| mean(run, &|t| f64::from(u8::from(t.abs() > bound)))).collect();
        deviation(&format!("share beyond the {p} point"), &shares, p)
    };
    let mut all = vec![of_error(problem, runs, exact), deviation("mean t²", &variance, dof / (dof - 2.0))];
    all.extend([0.1, 0.01, 0.001].map(tail));
    all
}

/// The last of the quantities of [`of_student`], which holds for any distribution and any weights of rounds.
pub fn of_error(problem: &Problem, runs: &[Solution], exact: &Exact) -> Deviation {
    let excess = |run: &Solution| {
        let of_element = |e: u32| {
            let (error, std_error) = errors(run, exact, e as usize);
            f64::from(problem.mesh.area(e)) * (error * error - std_error * std_error)
        };
        problem.mesh.elements().map(of_element).sum::<f64>()
    };
    deviation("squared error", &runs.iter().map(excess).collect(), 0.0)
}

/// As [`of_student`], of the mean irradiances of the scene and of its objects: mean t², and the share beyond the 10 % point.
///
/// # Panics
/// If a run has no certainty.
pub fn of_objects(problem: &Problem, runs: &[Solution], exact: &Exact, replicates: u32) -> Vec<Deviation> {
    let dof = f64::from(replicates) - 1.0;
    let mesh = &problem.mesh;
    let (mut sums, mut areas) = (vec![0.0; problem.faces()], vec![0.0; problem.faces()]);
    for e in mesh.elements() {
        let face = problem.face(e) as usize;
        let [r, g, b] = exact[e as usize].map(|value| value as f32);
        sums[face] += f64::from(mesh.area(e)) * Rgb::new(r, g, b).luminance_f64();
        areas[face] += f64::from(mesh.area(e));
    }
    let scene = sums.iter().sum::<f64>() / areas.iter().sum::<f64>();
    let exact = || std::iter::once(scene).chain(sums.iter().zip(&areas).map(|(sum, area)| sum / area));
    let scores = |run: &Solution| -> Vec<f64> {
        let certainty = run.certainty.as_ref().expect("replicates enough");
        let estimates = std::iter::once(&certainty.scene).chain(&certainty.faces);
        let scored = estimates.zip(exact()).filter(|(_, exact)| !exact.is_nan());
        scored.map(|(estimate, exact)| (estimate.mean - exact) / estimate.std_error()).collect()
    };
    let mean = |run: &Solution, f: &dyn Fn(f64) -> f64| {
        let scores = scores(run);
        scores.iter().map(|&t| f(t)).sum::<f64>() / scores.len() as f64
    };
    let bound = student(0.9, dof);
    let squares = runs.iter().map(|run| mean(run, &|t| t * t)).collect();
    let beyond = runs.iter().map(|run| mean(run, &|t| f64::from(u8::from(t.abs() > bound)))).collect();
    vec![
        deviation("mean t² of objects", &squares, dof / (dof - 2.0)),
        deviation("share of objects beyond the 0.1 point", &beyond, 0.1),
    ]
}

/// How many deviations [`of_objects`] gives.
pub const COMPARISONS_OF_OBJECTS: u32 = 2;

/// How many deviations [`of_student`] gives.
pub const COMPARISONS: u32 = 5;

/// Errors in their own standard errors, of the green channel.
fn scores(run: &Solution, exact: &Exact) -> Vec<f64> {
    let score = |e| {
        let (error, std_error) = errors(run, exact, e);
        error / std_error
    };
    (0..exact.len()).map(score).collect()
}

/// Error and standard error of the green irradiance of element `e` [lux].
fn errors(run: &Solution, exact: &Exact, e: usize) -> (f64, f64) {
    (f64::from(run.irradiance[e].g) - exact[e][1], f64::from(run.std_error[e].g))
}

fn deviation(name: &str, values: &Moments, expected: f64) -> Deviation {
    let t = (values.mean - expected) / values.std_error();
    Deviation { name: format!("{name} ({:.4} for {expected:.4})", values.mean), t, dof: values.count as f64 - 1.0 }
}
