//! How two solutions of the same scene differ, and whether their error bars explain it.
//!
//! All numbers are of luminance irradiance `E` [lux]. With areas `A`, irradiances `a`, `b` and standard errors `s, t` of an
//! element: the relative RMS difference is `sqrt(sum A (a - b)² / sum A)` over the mean of `(a + b) / 2`; the score of an
//! element is `z = (a - b) / sqrt(s² + t²)`, about standard normal if the solutions are independent, unbiased and honest.
//!
//! If the scene is cut into other elements, the second solution is averaged on those of the first ([`elements`]). The difference is that of the meshes, too, and
//! elements have no scores; means of scene and objects have.

mod elements;

use crate::math::Estimate;
use crate::problem::Side;
use crate::solution::luminance_error;
use crate::{Certainty, Error, Problem, Solution};

/// The result of [`compare`].
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Comparison {
    pub elements: usize,
    /// Number of elements of the second solution, if they are others.
    pub other_elements: Option<usize>,
    /// Area-weighted RMS of the difference, relative to the mean irradiance of both; NaN if both are dark.
    pub rms: f64,
    /// The value of `rms` that the standard errors of independent solutions let expect; NaN while they are unknown.
    pub expected_rms: f64,
    pub largest: Largest,
    /// Flux [lm] that leaves all surfaces, `sum A B`, in the first and in the second solution.
    pub power: [f64; 2],
    /// Of the whole scene; `None` while error bars of means are unknown.
    pub mean: Option<Means>,
    /// Of each object with elements.
    pub objects: Vec<ObjectMeans>,
    /// Scores of the elements; `None` if no element has a known, positive standard error.
    pub z: Option<Scores>,
}

/// Two mean irradiances [lux].
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Means {
    pub irradiance: [f64; 2],
    pub std_error: [f64; 2],
    /// Their difference over its standard deviation; 0 if both are zero.
    pub z: f64,
}

/// Those of an object.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ObjectMeans {
    pub name: String,
    /// Which side of it, if it has two.
    pub side: Option<Side>,
    #[serde(flatten)]
    pub means: Means,
}

impl Means {
    fn of(a: &Estimate, b: &Estimate) -> Means {
        let (difference, deviation) = (a.mean - b.mean, a.std_error().hypot(b.std_error()));
        Means {
            irradiance: [a.mean, b.mean],
            std_error: [a.std_error(), b.std_error()],
            z: if difference == 0.0 { 0.0 } else { difference / deviation },
        }
    }
}

/// The element with the largest absolute difference, the first of them if there are several.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Largest {
    pub element: u32,
    /// Irradiance [lux] in the first and in the second solution.
    pub irradiance: [f64; 2],
}

/// The distribution of z over the elements that have one, each counted once.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Scores {
    pub elements: usize,
    pub mean: f64,
    pub std_dev: f64,
    /// Share of the elements with `|z| > 3`; 0.0027 for a normal distribution.
    pub beyond_3: f64,
}

/// Compares solution `a` of `problem` with solution `b` of `other`.
///
/// # Errors
/// [`Error::NotComparable`] if the two problems are not the same scene.
pub fn compare(problem: &Problem, a: &Solution, other: &Problem, b: &Solution) -> Result<Comparison, Error> {
    if let Some(what) = problem.difference_of_scene(other) {
        return Err(Error::NotComparable { what });
    }
    let mesh = &problem.mesh;
    let is_same = problem.has_elements_of(other);
    let averaged = if is_same { Vec::new() } else { elements::irradiance_on(problem, other, b) };
    let irradiance = [&a.irradiance, if is_same { &b.irradiance } else { &averaged }];
    let (mut area, mut sum, mut sum_sq, mut variance) = (0.0, 0.0, 0.0, 0.0);
    let mut largest = Largest::default();
    let mut scores = Vec::new();
    for e in mesh.elements() {
        let element_area = f64::from(mesh.area(e));
        let lux = irradiance.map(|irradiance| irradiance[e as usize].luminance_f64());
        let error = |s: &Solution| f64::from(luminance_error(s.std_error[e as usize]));
        let errors = [error(a), if is_same { error(b) } else { f64::NAN }];
        let (difference, deviation) = (lux[0] - lux[1], errors[0].hypot(errors[1]));
        area += element_area;
        sum += element_area * 0.5 * (lux[0] + lux[1]);
        sum_sq += element_area * difference.powi(2);
        variance += element_area * deviation.powi(2);
        if difference.abs() > (largest.irradiance[0] - largest.irradiance[1]).abs() {
            largest = Largest { element: e, irradiance: lux };
        }
        if deviation > 0.0 {
            scores.push(difference / deviation);
        }
    }
    let relative = |sum_sq: f64| (sum_sq / area).sqrt() / (sum / area);
    let certainties = a.certainty.as_ref().zip(b.certainty.as_ref());
    Ok(Comparison {
        elements: mesh.len(),
        other_elements: (!is_same).then(|| other.mesh.len()),
        rms: relative(sum_sq),
        expected_rms: relative(variance),
        largest,
        power: [power(problem, a), power(other, b)],
        mean: certainties.map(|(a, b)| Means::of(&a.scene, &b.scene)),
        objects: certainties.map_or(Vec::new(), |(a, b)| means_of_objects(problem, a, b)),
        z: Scores::of(&scores),
    })
}

/// Flux [lm] that leaves all surfaces.
fn power(problem: &Problem, solution: &Solution) -> f64 {
    let of_element = |e| f64::from(problem.mesh.area(e)) * solution.radiosity(problem, e).luminance_f64();
    problem.mesh.elements().map(of_element).sum()
}

fn means_of_objects(problem: &Problem, a: &Certainty, b: &Certainty) -> Vec<ObjectMeans> {
    let faces = problem.sides().into_iter().enumerate().zip(a.faces.iter().zip(&b.faces));
    let means = |((face, side), (a, b)): ((usize, _), _)| {
        let name = problem.scene.objects[face / 2].name.clone();
        ObjectMeans { name, side, means: Means::of(a, b) }
    };
    let is_there = problem.has_faces();
    faces.filter(|((face, _), _)| is_there[*face]).map(means).collect()
}

impl Scores {
    fn of(scores: &[f64]) -> Option<Scores> {
        let count = scores.len() as f64;
        let mean = scores.iter().sum::<f64>() / count;
        let variance = scores.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / count;
        let beyond = scores.iter().filter(|z| z.abs() > 3.0).count() as f64;
        let of_all = Scores { elements: scores.len(), mean, std_dev: variance.sqrt(), beyond_3: beyond / count };
        (!scores.is_empty()).then_some(of_all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;
    use crate::mesh::Resolution;
    use crate::scene::{Material, Object, Scene, Triangle, Vertex};
    use glam::Vec3;

    /// Two triangles of 1 m² and 3 m², `rho = 1/2`, one element each.
    fn problem() -> Problem {
        let corners = [Vec3::ZERO, Vec3::X, 2.0 * Vec3::Y, 6.0 * Vec3::Z];
        let triangle = |vertices| Triangle { vertices, object: 0, source: 0 };
        let scene = Scene {
            vertices: corners.map(Vertex::at).to_vec(),
            triangles: vec![triangle([0, 1, 2]), triangle([0, 1, 3])],
            objects: vec![Object { name: "sheet".into(), material: 0 }],
            materials: vec![Material::diffuse("grey", Rgb::grey(0.5))],
            ..Scene::default()
        };
        Problem::new(scene, Resolution::Elements(2)).unwrap()
    }

    /// Irradiance and standard error of the small and of the large triangle.
    fn solution(problem: &Problem, small: [f32; 2], large: [f32; 2]) -> Solution {
        let values = |k: usize| {
            problem
                .mesh
                .elements()
                .map(move |e| Rgb::grey(if problem.mesh.triangle(e) == 0 { small[k] } else { large[k] }))
        };
        Solution { irradiance: values(0).collect(), std_error: values(1).collect(), ..Solution::default() }
    }

    fn close(x: f64, y: f64) -> bool {
        (x - y).abs() < 1e-5
    }

    #[test]
    fn a_small_case_by_hand() {
        let problem = problem();
        let a = solution(&problem, [10.0, 3.0], [20.0, 0.0]);
        let b = solution(&problem, [20.0, 4.0], [20.0, 0.0]);
        let c = compare(&problem, &a, &problem, &b).unwrap();
        // Mean (15 + 3 * 20) / 4; mean square of the difference 100 / 4, of the deviation 25 / 4.
        assert!(close(c.rms, 5.0 / 18.75) && close(c.expected_rms, 2.5 / 18.75), "{c:?}");
        assert_eq!(problem.mesh.triangle(c.largest.element), 0);
        assert!(close(c.largest.irradiance[0], 10.0) && close(c.largest.irradiance[1], 20.0));
        assert!(close(c.power[0], 35.0) && close(c.power[1], 40.0));
        assert!(c.mean.is_none() && c.objects.is_empty(), "no replicates have told the means");
        let z = c.z.unwrap();
        assert_eq!(z.elements, 1, "an element without an error has no score");
        assert!(close(z.mean, -2.0) && close(z.std_dev, 0.0) && z.beyond_3 == 0.0);
    }

    #[test]
    fn a_difference_far_beyond_the_error_bars_is_counted() {
        let problem = problem();
        let a = solution(&problem, [10.0, 1.0], [20.0, 1.0]);
        let b = solution(&problem, [10.0, 1.0], [30.0, 1.0]);
        let z = compare(&problem, &a, &problem, &b).unwrap().z.unwrap();
        assert_eq!((z.elements, z.beyond_3), (2, 0.5));
    }

    #[test]
    fn a_solution_does_not_differ_from_itself_and_unknown_errors_give_no_scores() {
        let problem = problem();
        let a = solution(&problem, [10.0, f32::NAN], [20.0, f32::NAN]);
        let c = compare(&problem, &a, &problem, &a).unwrap();
        assert_eq!((c.rms, c.largest, c.z), (0.0, Largest::default(), None));
        assert!(c.expected_rms.is_nan());
    }

    #[test]
    fn means_differ_by_so_many_standard_deviations() {
        let problem = problem();
        let certain = |mean: f64, error: f64| {
            let scene = Estimate { mean, variance: error * error, freedom: 7.0 };
            let ways = crate::certainty::Ways::default();
            let certainty = Certainty { scene, faces: vec![scene], mean_square: 1.0, freedom: 7.0, ways };
            Solution { certainty: Some(certainty), ..solution(&problem, [10.0, 1.0], [20.0, 1.0]) }
        };
        let c = compare(&problem, &certain(10.0, 3.0), &problem, &certain(20.0, 4.0)).unwrap();
        assert!(close(c.mean.unwrap().z, -2.0) && c.objects[0].name == "sheet" && close(c.objects[0].means.z, -2.0));
    }

    #[test]
    fn light_of_other_elements_is_averaged_and_another_scene_is_refused() {
        let first = problem();
        let a = solution(&first, [10.0, 3.0], [20.0, 0.0]);
        let mut scene = first.scene.clone();
        let finer = Problem::new(scene.clone(), Resolution::MaxEdge(0.5)).unwrap();
        // The small triangle is darker on one side than on the other.
        let mut b = solution(&finer, [15.0, 4.0], [20.0, 0.0]);
        let small: Vec<u32> = finer.mesh.elements().filter(|&e| finer.mesh.triangle(e) == 0).collect();
        small[..small.len() / 2].iter().for_each(|&e| b.irradiance[e as usize] = Rgb::grey(9.0));
        let dark: f64 = small[..small.len() / 2].iter().map(|&e| f64::from(finer.mesh.area(e))).sum();
        assert!(small.len() >= 16 && dark > 0.3 && dark < 0.7, "{} {dark}", small.len());
        let c = compare(&first, &a, &finer, &b).unwrap();
        let (small, mean) = (15.0 - 6.0 * dark, |small: f64| (0.5 * (10.0 + small) + 60.0) / 4.0);
        assert!(c.elements == 2 && c.other_elements == Some(finer.mesh.len()), "{c:?}");
        assert!((c.rms * mean(small) - (small - 10.0) / 2.0).abs() < 0.1, "{c:?}");
        assert!(close(c.power[0], 35.0) && (c.power[1] - 0.5 * small - 30.0).abs() < 1e-4);
        assert!(c.z.is_none() && c.expected_rms.is_nan());
        let c = compare(&finer, &b, &first, &a).unwrap();
        // Each element by itself differs by 1 or by 5 lux.
        assert!(close(c.rms * mean(small), ((dark + 25.0 * (1.0 - dark)) / 4.0).sqrt()), "{c:?}");
        assert_eq!(c.elements, finer.mesh.len());
        scene.materials[0].reflectivity = Rgb::grey(0.6);
        let whiter = Problem::new(scene, Resolution::Elements(2)).unwrap();
        let refused = compare(&first, &a, &whiter, &a).unwrap_err().to_string();
        assert!(refused.contains("different scenes"));
    }
}
