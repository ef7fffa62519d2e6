//! Light adds up: the solution of a mixture of lamps, out of those of each group alone.
//!
//! ```text
//! E = Σ_g f_g E_g,    V = Σ_g f_g² V_g        by channel
//! ```
//!
//! Radiosity is linear in the emission, and groups are solved with random numbers of their own. Unbiased if the solutions are, for
//! any factors that are chosen without looking at the noise. Exact for irradiance and standard errors. What is known of luminance only is taken
//! to change with what belongs to it: error bars of means with the means, the mean square error with the variances of the
//! elements, the balance with the emitted flux. So these are exact for factors without colour.
//! Cost: a look at each element and group.

use crate::math::Rgb;
use crate::solution::{Balance, GroupLight, Provenance, Work};
use crate::{Certainty, Error, Problem, Solution};

/// The parameter of a solution that says what its groups were mixed with.
const MIX: &str = "mix";

/// The sum of `groups` of `problem`, each times its factor. They are not kept in it.
pub fn sum(problem: &Problem, groups: &[GroupLight], provenance: Provenance) -> Solution {
    let mut irradiance = vec![Rgb::BLACK; problem.mesh.len()];
    let mut variance = vec![Rgb::BLACK; problem.mesh.len()];
    // What is dark is known to be dark, however little is known of the lamp.
    let lit = || groups.iter().filter(|part| !part.factor.is_black() && part.flux != [0.0; 3]);
    for GroupLight { factor, solution, .. } in lit() {
        irradiance.iter_mut().zip(&solution.irradiance).for_each(|(sum, &light)| *sum += light * *factor);
        let errors = solution.std_error.iter().map(|&error| (error * *factor).map(|error| error * error));
        variance.iter_mut().zip(errors).for_each(|(sum, variance)| *sum += variance);
    }
    let certainties: Option<Vec<Certainty>> = lit().map(|part| certainty(problem, part)).collect();
    Solution {
        irradiance,
        std_error: variance.into_iter().map(|variance| variance.map(f32::sqrt)).collect(),
        certainty: certainties.and_then(|all| all.into_iter().reduce(|sum, other| sum.plus(&other))),
        work: Work {
            rays: groups.iter().map(|part| part.solution.work.rays).sum(),
            replicates: groups.iter().map(|part| part.solution.work.replicates).min().unwrap_or_default(),
        },
        balance: lit().fold(Balance::default(), |sum, part| sum + part.solution.balance * brightness(part)),
        provenance,
        groups: Vec::new(),
    }
}

/// How many times as much luminous flux a group emits [1].
fn brightness(part: &GroupLight) -> f64 {
    let emitted = Rgb::from(part.flux.map(|flux| flux as f32));
    ratio((emitted * part.factor).luminance_f64(), emitted.luminance_f64())
}

/// How sure the sums over the light of a group are, times its factor; `None` if nothing is known.
fn certainty(problem: &Problem, part: &GroupLight) -> Option<Certainty> {
    let GroupLight { factor, solution: Solution { irradiance, std_error, certainty, .. }, .. } = part;
    let known = certainty.as_ref()?;
    let mesh = &problem.mesh;
    // Flux on the whole scene and on each face, and squares of errors, as they are and times the factor.
    let mut flux = vec![[0.0; 2]; 1 + problem.faces()];
    let mut square = [0.0; 2];
    for e in mesh.elements() {
        let area = f64::from(mesh.area(e));
        let face = problem.face(e) as usize;
        for (k, factor) in [Rgb::WHITE, *factor].into_iter().enumerate() {
            let light = area * (irradiance[e as usize] * factor).luminance_f64();
            flux[0][k] += light;
            flux[1 + face][k] += light;
            square[k] += area * (std_error[e as usize] * factor).luminance_f64().powi(2);
        }
    }
    let change = |[before, after]: [f64; 2]| ratio(after, before);
    Some(Certainty {
        scene: known.scene.times(change(flux[0])),
        faces: known.faces.iter().zip(&flux[1..]).map(|(face, &flux)| face.times(change(flux))).collect(),
        mean_square: known.mean_square * change(square),
        freedom: known.freedom,
        ways: known.ways,
    })
}

/// 1 where there is nothing, before and after.
fn ratio(after: f64, before: f64) -> f64 {
    if before == 0.0 { 1.0 } else { after / before }
}

/// The light of number `group` alone, at the factor it has in `solution`.
pub fn alone(problem: &Problem, solution: &Solution, group: usize) -> Solution {
    let part = &solution.groups[group];
    sum(problem, std::slice::from_ref(part), part.solution.provenance.clone())
}

/// `problem` with its lamps dimmed and coloured, and its solution: a factor for each of the solution's groups, by channel, of what
/// the group emitted when it was solved. The groups are kept, so they can be mixed again.
///
/// # Errors
/// [`Error::Parameter`] for another number of factors than groups, or one that is negative or not finite; those of
/// [`Problem::with_cut`].
pub fn mix(problem: &Problem, solution: Solution, factors: &[Rgb]) -> Result<(Problem, Solution), Error> {
    let mut groups = solution.groups;
    if factors.len() != groups.len() {
        let (value, allowed) = (factors.len().to_string(), "one for each light group");
        return Err(Error::Parameter { name: "factors", value, allowed });
    }
    let is_wrong = |factor: &&Rgb| !factor.is_finite() || factor.to_array().iter().any(|&channel| channel < 0.0);
    if let Some(wrong) = factors.iter().find(is_wrong) {
        let (value, allowed) = (format!("{:?}", wrong.to_array()), "a factor is zero or more");
        return Err(Error::Parameter { name: "factor", value, allowed });
    }
    groups.iter_mut().zip(factors).for_each(|(part, &factor)| part.factor = factor);
    let mut scene = problem.scene.clone();
    scene.relight(groups.iter().map(|part| (&part.group, part.factor)));
    let mixed = Problem::with_cut(scene, &problem.mesh.cut())?;

    let mut provenance = Provenance { scene_hash: mixed.scene.hash(), ..solution.provenance };
    provenance.parameters.retain(|(name, _)| name != MIX);
    if factors.iter().any(|&factor| factor != Rgb::WHITE) {
        let named = |part: &GroupLight| format!("{} = {:?}", part.group.name, part.factor.to_array());
        let factors: Vec<String> = groups.iter().map(named).collect();
        provenance.parameters.push((MIX.to_owned(), factors.join("; ")));
    }
    let solution = sum(&mixed, &groups, provenance);
    Ok((mixed, Solution { groups, ..solution }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Estimate;
    use crate::mesh::Resolution;
    use crate::scene::builtin::builtin;
    use crate::scene::{Grouping, LightGroup};

    fn problem() -> Problem {
        Problem::new(builtin("box").unwrap(), Resolution::Elements(60)).unwrap()
    }

    /// A lamp that lights everything the same, with error bars, unless `error` is not a number.
    fn part(problem: &Problem, name: &str, light: Rgb, error: f32) -> GroupLight {
        let group = Grouping::Objects.groups(&problem.scene).unwrap().remove(0);
        let count = problem.mesh.len();
        let estimate = Estimate { mean: light.luminance_f64(), variance: 0.04, freedom: 7.0 };
        let certainty = Certainty {
            scene: estimate,
            faces: vec![estimate; problem.faces()],
            mean_square: 0.25,
            freedom: 7.0,
            ways: Default::default(),
        };
        let solution = Solution {
            irradiance: vec![light; count],
            std_error: vec![Rgb::grey(error); count],
            certainty: (!error.is_nan()).then_some(certainty),
            work: Work { rays: 10, replicates: 8 },
            balance: Balance { emitted: 10.0, absorbed: 7.0, escaped: 3.0, ..Balance::default() },
            ..Solution::default()
        };
        let group = LightGroup { name: name.to_owned(), ..group };
        GroupLight { group, flux: [10.0; 3], factor: Rgb::WHITE, solution }
    }

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-5 * b.abs().max(1e-3)
    }

    #[test]
    fn light_adds_up_and_errors_add_in_squares() {
        let problem = problem();
        let mut parts = [part(&problem, "a", Rgb::new(2.0, 1.0, 0.0), 0.3), part(&problem, "b", Rgb::grey(1.0), 0.4)];
        let provenance = Provenance::default();
        let both = sum(&problem, &parts, provenance.clone());
        assert_eq!((both.irradiance[3], both.work.rays, both.work.replicates), (Rgb::new(3.0, 2.0, 1.0), 20, 8));
        assert!(near(both.std_error[3].g.into(), 0.5) && near(both.balance.escaped, 6.0));
        let certainty = both.certainty.unwrap();
        assert!(near(certainty.scene.variance, 0.08) && near(certainty.mean_square, 0.5), "{certainty:?}");

        parts[0].factor = Rgb::new(0.5, 0.0, 2.0);
        parts[1].factor = Rgb::grey(3.0);
        let mixed = sum(&problem, &parts, provenance.clone());
        assert_eq!(mixed.irradiance[3], Rgb::new(4.0, 3.0, 3.0));
        assert!(near(mixed.std_error[3].r.into(), 0.15f64.hypot(1.2)) && near(mixed.std_error[3].g.into(), 1.2));
        // Lamp b, which has no colour: three times the error. Lamp a: as its mean.
        let of_a = 0.2126 / (2.0 * 0.2126 + 0.7152);
        assert!(near(mixed.certainty.unwrap().scene.variance, 0.04 * (9.0 + of_a * of_a)));
        assert!(near(mixed.balance.emitted, 30.0 + 10.0 * (0.5 * 0.2126 + 2.0 * 0.0722)));
        assert!(mixed.balance.residual().abs() < 1e-12);
    }

    #[test]
    fn a_lamp_that_is_off_needs_no_error_bar() {
        let problem = problem();
        let mut parts = [part(&problem, "a", Rgb::grey(1.0), 0.3), part(&problem, "b", Rgb::grey(1.0), f32::NAN)];
        let provenance = Provenance::default();
        let on = sum(&problem, &parts, provenance.clone());
        assert!(on.certainty.is_none() && on.std_error[0].r.is_nan());
        parts[1].factor = Rgb::BLACK;
        let off = sum(&problem, &parts, provenance);
        assert!(off.certainty.is_some() && near(off.std_error[0].r.into(), 0.3));
    }

    #[test]
    fn factors_without_meaning_are_refused() {
        let problem = problem();
        let parts = vec![part(&problem, "a", Rgb::grey(1.0), 0.3)];
        let solution = Solution { groups: parts.clone(), ..parts[0].solution.clone() };
        let refused = |factors: &[Rgb]| mix(&problem, solution.clone(), factors).unwrap_err().to_string();
        assert!(refused(&[]).contains("one for each"));
        assert!(refused(&[Rgb::new(1.0, -0.1, 1.0)]).contains("zero or more"));
        assert!(refused(&[Rgb::grey(f32::NAN)]).contains("zero or more"));
    }
}
