//! How much of their surroundings elements see: what that leaves of the noise in the radiosities they gather.
//!
//! An element that gathers along ever more lines ends with `Σ_j F_ij² Var(B_j)`: what it sees of each other is always the same. Where
//! each element shoots rays of flux Φ the variance of a radiosity is ρ² E Φ / A_j. A local line meets j with probability F_ij, and
//! `F_ij / A_j` is the mean of the kernel K [1/m²] of the radiosity equation over both. So the mean of K between the ends of local lines,
//! multiplied by the mean area of elements, is the share of `Var(B)` that no number of lines takes away. (K is taken as 1 / A_j at most,
//! for no form factor is above 1.)
//!
//! That is rather too much, for points of two elements that share an edge may be nearer to each other than their lines are in the
//! mean; and noise lies on points, where light has landed, and is handed on from one to the next. Measured in two furnished rooms it is
//! about right.

use crate::Problem;
use crate::sampling::{OwenSobol, Sample, Sequence};
use crate::transport::{Arrival, Departure, Footprint, arrivals};

/// Lines that are traced; those of a scene are always the same.
const LINES: u64 = 4096;
const SEED: u64 = 1;

/// The share of the noise of its surroundings that an element cannot average out, in the mean over all surfaces; in [0, 1].
pub fn lasting_noise(problem: &Problem) -> f64 {
    let mesh = &problem.mesh;
    let total = mesh.total_area();
    let sequence = OwenSobol::new(SEED);
    let (mut rays, mut from) = (Vec::new(), Vec::new());
    let mut area = 0.0;
    for e in mesh.elements() {
        let before = rays.len() as u64;
        area += f64::from(mesh.area(e));
        for number in before..((area / total * LINES as f64) as u64).min(LINES) {
            let mut samples: [Sample; 1] = Default::default();
            sequence.fill(0, number, &mut samples);
            rays.push(Departure::new(problem, e, Footprint::WHOLE).ray(samples[0]));
        }
        from.resize(rays.len(), e);
    }
    let (mut hits, mut met) = (Vec::new(), Vec::new());
    arrivals(problem, &rays, &mut hits, |_, arrival: Arrival| met.push(arrival.element()));
    let kernel = |k: usize| {
        let seen = met[k]?;
        let cosine = |e| f64::from(mesh.normal(e).dot(rays[k].direction).abs());
        let squared = f64::from(hits[k].t).powi(2).max(f64::MIN_POSITIVE);
        let kernel = cosine(from[k]) * cosine(seen) / (std::f64::consts::PI * squared);
        Some(kernel.min(1.0 / f64::from(mesh.area(seen))))
    };
    let mean = (0..rays.len()).filter_map(kernel).sum::<f64>() / rays.len().max(1) as f64;
    (mean * total / mesh.len() as f64).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Resolution;
    use crate::scene::builtin::builtin;

    fn problem(name: &str, elements: u64) -> Problem {
        Problem::new(builtin(name).unwrap(), Resolution::Elements(elements)).unwrap()
    }

    /// In a sphere of radius R the kernel is 1 / (4 π R²) everywhere: of N elements each sees of every other one N-th. Between the
    /// flat triangles that stand for it some is larger, at their edges.
    #[test]
    fn in_a_sphere_it_is_about_one_over_the_number_of_elements() {
        for elements in [1500, 6000, 24_000] {
            let lasting = lasting_noise(&problem("sphere", elements)) * elements as f64;
            assert!((0.9..2.2).contains(&lasting), "{lasting} with {elements} elements");
        }
    }

    #[test]
    fn it_is_large_where_surfaces_are_near_to_each_other() {
        let [office, box_] = ["office", "cornell-box"].map(|name| lasting_noise(&problem(name, 20_000)));
        assert!(office > 3.0 * box_, "{office} and {box_}");
    }
}
