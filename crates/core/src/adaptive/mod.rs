//! Elements that follow the light: small where irradiance changes, at the edges of shadows and beside lamps, large where it does not.
//!
//! With constant elements of size h, where the gradient of irradiance is g, the mean square error over the area is least for a given
//! number of elements if each has the same share of it (equidistribution; Carey & Dinh 1985):
//!
//! ```text
//! error of an element  ∫ g² dA h² ~ g² h⁴ = λ,    so h ~ g^(-1/2),    λ such that Σ elements = N
//! ```
//!
//! The error is then smaller than that of equal elements by `rms(g) / mean(g)`. The gradients are those of *pilots*, quick solutions on meshes of a
//! few elements, the first one uniform, each next one finer where the one before was steep ([`follow_light`]): so edges are found to within
//! ever smaller elements. [`gradient`] tells g, [`forest`] splits patches while their error is above λ, [`balance`] keeps
//! neighbours within one level of each other. What a mesh becomes depends on the light alone, not on textures, and is always the
//! same for the same pilots. Cost: a tenth of the rays, and about a second for a million elements.

mod balance;
mod borders;
mod forest;
mod gradient;

use self::forest::{Forest, Rule};
use self::gradient::Known;
use crate::mesh::{Cut, MOST_ELEMENTS, Resolution};
use crate::scene::Scene;
use crate::solvers::monte_carlo::{Budget, LightPart, METHODS, Settings};
use crate::{Error, Problem, Solution};

/// The pilots: each one's share of the elements of the mesh at last, and of the rays of all pilots.
const PILOTS: [(f64, f64); 2] = [(1.0 / 16.0, 0.15), (1.0 / 4.0, 0.85)];
/// Share of the whole work that the pilots may take.
pub const SHARE: f64 = 0.1;
/// Replicates that a pilot needs: fewer have no error bars.
pub const LEAST_REPLICATES: u32 = 2;
/// A mesh is close enough to the number of elements that was asked for from this share of it on.
const CLOSE: f64 = 0.98;
/// Trials to meet the number of elements, without balancing and with it.
const TRIALS: usize = 40;
const TRIALS_TO_BALANCE: usize = 6;

/// Cuts `scene` into at most `elements` elements, or one for each side of a triangle if these are more, where the light asks for them.
/// `solve` solves a pilot with a share of the pilots' work, in (0, 1]; if it gives nothing, the mesh is uniform.
///
/// # Errors
/// Those of [`Problem::new`] and of `solve`.
pub fn follow_light<E: From<Error>>(
    scene: Scene,
    elements: u64,
    mut solve: impl FnMut(&Problem, f64) -> Result<Option<Solution>, E>,
) -> Result<Problem, E> {
    if elements > MOST_ELEMENTS {
        return Err(Error::TooManyElements { asked: elements, limit: MOST_ELEMENTS }.into());
    }
    let least = Resolution::least(&scene);
    let more = elements.saturating_sub(least);
    let size = |share: f64| least + (share * more as f64) as u64;
    let mut problem = Problem::new(scene, Resolution::Elements(size(PILOTS[0].0)))?;
    if more == 0 {
        return Ok(problem);
    }
    let sizes = PILOTS.iter().skip(1).map(|pilot| pilot.0).chain([1.0]);
    for ((_, share), next) in PILOTS.into_iter().zip(sizes) {
        let Some(solution) = solve(&problem, share)? else {
            return Ok(Problem::new(problem.scene, Resolution::Elements(elements))?);
        };
        let cut = adapt(&problem, &solution, size(next))?;
        problem = problem.cut_anew(&cut)?;
    }
    Ok(problem)
}

/// How a pilot is solved with so many `rays`: by the default method, whichever solves the mesh at last.
pub fn pilot_settings(seed: u64, rays: u64, light: LightPart) -> Settings {
    let method = METHODS[0].method;
    let replicates = method.natural_replicates();
    let budget = Budget::Rays(rays.max(u64::from(replicates)));
    Settings { method, seed, budget, replicates, light, ..Settings::default() }
}

/// How to cut the scene of `problem` into at most `elements` elements, or one for each side of a triangle if these are more, for the light of
/// `solution`.
///
/// # Errors
/// [`Error::TooManyElements`].
pub fn adapt(problem: &Problem, solution: &Solution, elements: u64) -> Result<Cut, Error> {
    let known = Known::of(problem, solution);
    let mut best = Forest::grown(problem, &known, &Rule::coarsest(problem, elements));
    // Balancing splits some more, how many is learned.
    let mut aim = elements;
    for _ in 0..TRIALS_TO_BALANCE {
        let mut forest = closest(problem, &known, elements, aim);
        balance::balance(problem, &mut forest);
        let count = forest.element_count(problem);
        if (best.element_count(problem)..=elements).contains(&count) {
            best = forest;
        }
        if is_close(count, elements) {
            break;
        }
        aim = (aim as f64 * 0.5 * (1.0 + CLOSE) * elements as f64 / count as f64) as u64;
    }
    let cut = best.cut();
    cut.element_count(&problem.scene)?;
    Ok(cut)
}

/// The forest with at most `aim` elements and as close to them as it comes, not balanced.
fn closest(problem: &Problem, known: &Known, elements: u64, aim: u64) -> Forest {
    let rule = |error: f64| Rule { error, ..Rule::coarsest(problem, elements) };
    let count = |error: f64| Forest::count(problem, known, &rule(error));
    // From an error that nothing exceeds downwards, by steps that make twice as many elements.
    let mut high = known.error_of_one(problem);
    let mut low = 0.25 * high;
    for _ in 0..TRIALS {
        if count(low) > aim {
            break;
        }
        (low, high) = (0.25 * low, low);
    }
    for _ in 0..TRIALS {
        let middle = (low * high).sqrt();
        let counted = count(middle);
        *if counted > aim { &mut low } else { &mut high } = middle;
        if is_close(counted, aim) {
            break;
        }
    }
    Forest::grown(problem, known, &rule(high))
}

fn is_close(count: u64, aim: u64) -> bool {
    count <= aim && count as f64 >= CLOSE * aim as f64
}

#[cfg(test)]
mod tests;
