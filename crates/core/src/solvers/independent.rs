//! The solution that independent complete solutions tell, whoever computed them: solvers that are not written here.
//!
//! Their mean is the estimate, and their spread its error bar, as for the solvers of this crate. Where the light went follows from the
//! irradiance: `emitted = sum A Be`, `absorbed = sum A (1 - rho) E`; what is left of the emitted has escaped, is lost, or is still to be shot,
//! and nobody knows which.

use super::replicates::Replicates;
use super::totals::Totals;
use crate::math::Rgb;
use crate::solution::{Balance, Provenance, Work};
use crate::{Error, Problem, Solution};

/// The mean of complete solutions, the irradiance [lux] of every element of `problem`, which took `rays` together. Two of them or more tell
/// standard errors.
///
/// # Errors
/// [`Error::Parameter`] without any, or for one with another number of elements; [`Error::NotFinite`].
pub fn mean_of_independent(
    problem: &Problem,
    solutions: &[Vec<Rgb>],
    rays: u64,
    provenance: Provenance,
) -> Result<Solution, Error> {
    let mesh = &problem.mesh;
    let mut replicates = Replicates::new(mesh.len());
    let mut totals = Totals::default();
    for irradiance in solutions {
        check(problem, irradiance)?;
        let square = replicates.push(1, irradiance.iter().copied(), |e| mesh.area(e));
        totals.push(problem, |e| irradiance[e as usize], square);
    }
    if solutions.is_empty() {
        let allowed = "at least one complete solution";
        return Err(Error::Parameter { name: "solutions", value: "none".to_owned(), allowed });
    }
    let (irradiance, variance): (Vec<Rgb>, Vec<Rgb>) = mesh.elements().map(|e| replicates.estimate(e)).unzip();
    Ok(Solution {
        balance: balance(problem, &irradiance),
        irradiance,
        std_error: variance.into_iter().map(|variance| variance.map(f32::sqrt)).collect(),
        certainty: totals.certainty(1.0),
        work: Work { rays, replicates: solutions.len() as u32 },
        provenance,
        groups: Vec::new(),
    })
}

fn check(problem: &Problem, irradiance: &[Rgb]) -> Result<(), Error> {
    if irradiance.len() != problem.mesh.len() {
        let allowed = "one irradiance for each element of the problem";
        return Err(Error::Parameter { name: "irradiance", value: irradiance.len().to_string(), allowed });
    }
    match (0..).zip(irradiance).find(|(_, irradiance)| !irradiance.is_finite()) {
        Some((element, irradiance)) => {
            let value = irradiance.to_array().into_iter().find(|value| !value.is_finite()).unwrap_or_default();
            Err(Error::NotFinite { element, what: "irradiance", value })
        }
        None => Ok(()),
    }
}

fn balance(problem: &Problem, irradiance: &[Rgb]) -> Balance {
    let mesh = &problem.mesh;
    let absorbed = |e: u32| {
        let kept = mesh.reflectivity(e).map(|rho| 1.0 - rho);
        f64::from(mesh.area(e)) * (kept * irradiance[e as usize]).luminance_f64()
    };
    let radius = problem.geometry.bounding_sphere().1;
    let lamps: f64 = problem.scene.lights.iter().map(|light| light.flux(radius).luminance_f64()).sum();
    let emitted = lamps + mesh.elements().map(|e| mesh.emitted_flux(e).luminance_f64()).sum::<f64>();
    let absorbed = mesh.elements().map(absorbed).sum::<f64>();
    Balance { emitted, absorbed, unshot: emitted - absorbed, ..Balance::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Resolution;
    use crate::scene::builtin::builtin;

    #[test]
    fn three_solutions_by_hand() {
        let problem = Problem::new(builtin("sphere").unwrap(), Resolution::Elements(8)).unwrap();
        let all = |value: f32| vec![Rgb::grey(value); problem.mesh.len()];
        let of = |solutions: &[Vec<Rgb>]| mean_of_independent(&problem, solutions, 7, Provenance::default());
        let solution = of(&[all(1.0), all(2.0), all(6.0)]).unwrap();
        // Mean 3, sample variance 7.
        assert_eq!((solution.irradiance[0], solution.work.replicates), (Rgb::grey(3.0), 3));
        assert!((solution.std_error[0].g - (7f32 / 3.0).sqrt()).abs() < 1e-6);
        let scene = solution.certainty.unwrap().scene;
        assert!((scene.mean - 3.0).abs() < 1e-6 && (scene.variance - 7.0 / 3.0).abs() < 1e-6 && scene.freedom == 2.0);
        let alone = of(&[all(1.0)]).unwrap();
        assert!(alone.certainty.is_none() && alone.std_error[0].g.is_nan() && alone.balance.residual().abs() < 1e-12);
        assert!(matches!(of(&[]), Err(Error::Parameter { .. })));
        assert!(matches!(of(&[vec![Rgb::BLACK; 3]]), Err(Error::Parameter { .. })));
        assert!(matches!(of(&[all(f32::NAN)]), Err(Error::NotFinite { element: 0, .. })));
    }
}
