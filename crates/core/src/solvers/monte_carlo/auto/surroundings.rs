//! How much of their surroundings elements see: what that leaves of the noise in the radiosities they gather.
//!
//! An element that gathers along ever more lines ends with `Σ_j F_ij² Var(B_j)`: what it sees of each other is always the same. Where
//! each element shoots rays of flux Φ the variance of a radiosity is ρ² E Φ / A_j. With `F_ij = K A_j`, and K [1/m²] the kernel of
//! the radiosity equation between the two, the mean of K over local lines says what is left of it: multiplied by the mean area of
//! elements it is the share of `Var(B)` that no number of lines takes away. (K is at most 1 / A_j: no form factor is above 1.)

use crate::Problem;
use crate::geometry::Hit;
use crate::sampling::{OwenSobol, Sequence};
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
        let before = area;
        area += f64::from(mesh.area(e));
        let upto = |area: f64| (area / total * LINES as f64) as u64;
        for number in upto(before)..upto(area).min(LINES) {
            let mut sample = [[0.0; 4]];
            sequence.fill(0, number, &mut sample);
            rays.push(Departure::new(problem, e, Footprint::WHOLE).ray(sample[0]));
            from.push(e);
        }
    }
    let (mut hits, mut met): (Vec<Hit>, Vec<Arrival>) = (Vec::new(), Vec::new());
    arrivals(problem, &rays, &mut hits, |_, arrival| met.push(arrival));
    let kernel = |k: usize| {
        let seen = met[k].element()?;
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

    fn noise_of(name: &str, elements: u64) -> f64 {
        lasting_noise(&Problem::new(builtin(name).unwrap(), Resolution::Elements(elements)).unwrap())
    }

    /// In a sphere of radius R the kernel is 1 / (4 π R²) everywhere: of N elements each sees of every other one N-th.
    #[test]
    fn in_a_sphere_it_is_one_over_the_number_of_elements() {
        let lasting = noise_of("sphere", 5000);
        assert!((lasting * 5000.0 - 1.0).abs() < 0.1, "{lasting}");
    }

    #[test]
    fn it_is_large_where_surfaces_are_near_to_each_other() {
        assert!(noise_of("office", 20_000) > 3.0 * noise_of("cornell-box", 20_000));
    }
}
