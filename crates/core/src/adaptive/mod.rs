//! Elements that follow the light: small where irradiance changes, at the edges of shadows and beside lamps, large where it does not, and long
//! where it changes in one direction only.
//!
//! For a given number of constant elements the mean square error over the area is least if each has the same share of it
//! (equidistribution; Carey & Dinh 1985). So the patch with the largest error is bisected, again and again, from the corner that takes most of its error away:
//!
//! ```text
//! error of a patch    ∫ (E - mean E)² dA
//! ```
//!
//! where E is the brightness of light ([`light::Brightness`]). It is known before, well enough ([`light`]): direct light of every element of a uniform
//! mesh, with the same random numbers in all, and indirect light of a *pilot*, a quick solution on large elements. Where triangles are smaller than elements should be
//! they are put together ([`merge`]), up to the same error. [`grow`] says where to bisect, by [`samples`] of the light, [`forest`] keeps the patches, [`counts`] tells how large the error is with so many elements, [`balance`] keeps neighbours
//! within one level of each other. What a mesh becomes depends on the light alone, not on textures, and is always the same for the same effort.
//! Cost: a fifth of the rays of a solve, and some 15 microseconds an element.

mod balance;
mod borders;
mod counts;
mod forest;
mod grow;
mod light;
mod merge;
mod samples;
mod wish;

pub use self::wish::{Meshed, PATIENCE, Spread, Wish};

use self::borders::Borders;
use self::counts::Counts;
use self::forest::Forest;
use self::grow::Rule;
use self::light::{Brightness, Indirect, Light};
use self::merge::Merges;
use crate::math::Rgb;
use crate::mesh::{Cut, MOST_ELEMENTS, Resolution};
use crate::scene::{Contacts, Scene};
use crate::solvers::monte_carlo::{Budget, LightPart, METHODS, Settings};
use crate::transport::direct_light::Rays;
use crate::{Error, Problem, Solution};
use rayon::prelude::*;

/// Share of the elements of the mesh at last that the pilot has.
const PILOT: f64 = 0.25;
/// Share of the whole work that the pilot may take.
const SHARE: f64 = 0.08;
/// Elements on which light is known, for each one of the mesh; at least as many as the mesh has, beside one for each side of a triangle.
const KNOWN: u64 = 2;
/// Rays of one of them for its direct light, as a share of those of an element of the mesh.
const DIRECT: f64 = 0.08;
/// Fewest and most rays of an element for direct light.
const FEWEST_RAYS: f64 = 4.0;
const MOST_RAYS: f64 = 12.0;
/// Replicates that a pilot needs: fewer have no error bars.
const LEAST_REPLICATES: u32 = 2;
/// Elements have at most so many times the mean area, and at least this share of it: else the deepest shadows would take all elements.
const LARGEST: f64 = 4.0;
const SMALLEST: f64 = 1.0 / 512.0;
/// A mesh is close enough to the number of elements that was asked for from this share of it on.
const CLOSE: f64 = 0.97;
/// Share of the elements that stay for the light, however many contacts there are.
const LEAST_BEFORE_CONTACTS: f64 = 0.5;
/// Trials to meet the number of elements.
const TRIALS: usize = 8;
/// Trees grow to an error this share of the one that is expected at first, and to this share of the last one after that.
const EASILY: f32 = 1.5;
const MUCH_LESS: f32 = 0.5;

/// What a mesh may cost, and which light it follows.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Rays of the whole solve.
    pub rays: u64,
    pub seed: u64,
    pub light: LightPart,
}

/// A mesh that follows the light.
pub struct Followed {
    pub problem: Problem,
    /// Rays that it took.
    pub rays: u64,
}

/// Cuts `scene` into at most `elements` elements where the light asks for them and along `contacts`, or as few as there can be if these are more. `solve` solves the
/// pilot with the settings it is given; if it gives nothing, elements are equal.
///
/// # Errors
/// Those of [`Problem::new`] and of `solve`.
pub fn follow_light<E: From<Error>>(
    scene: Scene,
    elements: u64,
    contacts: &Contacts,
    effort: Effort,
    solve: impl FnOnce(&Problem, Settings) -> Result<Option<Solution>, E>,
) -> Result<Followed, E> {
    if elements > MOST_ELEMENTS {
        return Err(Error::TooManyElements { asked: elements, limit: MOST_ELEMENTS }.into());
    }
    let few = ((PILOT * elements as f64) as u64).max(1);
    let pilot = Problem::new(scene.clone(), Resolution::Clustered(few))?;
    let solution = solve(&pilot, effort.of_pilot())?;
    let Some(solution) = solution.filter(|solution| solution.work.replicates >= LEAST_REPLICATES) else {
        let cut = Resolution::Clustered(elements).cut_along(&scene, contacts)?;
        return Ok(Followed { problem: pilot.cut_anew(&cut)?, rays: 0 });
    };
    let mut rays = solution.work.rays;
    let many = (KNOWN * elements).max(Resolution::least(&scene) + elements).min(MOST_ELEMENTS);
    let known = pilot.clone().cut_anew(&Resolution::Elements(many).cut(&scene)?)?;
    let indirect = Indirect::new(pilot, &solution);
    let mut irradiance: Vec<Rgb> = known.mesh.elements().into_par_iter().map(|e| indirect.on(&known, e)).collect();
    if effort.light == LightPart::All {
        let (direct, traced) = light::direct(&known, effort.of_direct_light(elements), effort.seed);
        irradiance.iter_mut().zip(direct).for_each(|(light, direct)| *light += direct);
        rays += traced;
    }
    let cut = adapt(&known, &irradiance, elements, contacts)?;
    let problem = known.cut_anew(&cut)?;
    Ok(Followed { problem, rays })
}

impl Effort {
    /// How the pilot is solved: by the default method, whichever solves the mesh at last.
    fn of_pilot(self) -> Settings {
        let method = METHODS[0].method;
        let replicates = method.natural_replicates();
        let budget = Budget::Rays(((SHARE * self.rays as f64) as u64).max(u64::from(replicates)));
        Settings { method, seed: self.seed, budget, replicates, light: LightPart::Indirect, ..Settings::default() }
    }

    /// Rays of an element for direct light, for a mesh of so many `elements`.
    fn of_direct_light(self, elements: u64) -> Rays {
        let rays = (DIRECT * self.rays as f64 / elements as f64).clamp(FEWEST_RAYS, MOST_RAYS);
        Rays { light: (0.75 * rays) as u32, cosine: (0.25 * rays) as u32 }
    }
}

/// How to cut the scene of `problem` into at most `elements` elements, or as few as there can be if these are more, for the
/// `irradiance` [lux] of its elements and along `contacts`, as far as half of the elements allow.
///
/// # Errors
/// [`Error::TooManyElements`].
pub fn adapt(problem: &Problem, irradiance: &[Rgb], elements: u64, contacts: &Contacts) -> Result<Cut, Error> {
    let brightness = Brightness::among(problem, irradiance);
    let bright: Vec<Rgb> = irradiance.iter().map(|light| Rgb::grey(brightness.of(light.luminance()))).collect();
    let light = Light::new(problem, &bright);
    let borders = Borders::of(&problem.scene, problem.geometry.as_ref());
    let mut largest = LARGEST;
    loop {
        let cut = cut_for_target(problem, &light, &borders, elements, contacts, largest)?;
        largest *= 2.0;
        // Where many small things stand between large walls these have to do with fewer.
        if cut.element_count(&problem.scene)? as u64 <= elements || largest > elements as f64 {
            return Ok(cut.along(&problem.scene, contacts, elements));
        }
    }
}

/// A cut that has about `elements` elements once it goes along `contacts` as well, more of them only if there cannot be so few, none of them more than `largest`
/// times as large as the mean.
fn cut_for_target(
    problem: &Problem,
    light: &Light,
    borders: &Borders,
    elements: u64,
    contacts: &Contacts,
    largest: f64,
) -> Result<Cut, Error> {
    let mean = problem.mesh.total_area() / elements as f64;
    let merges = Merges::of(&problem.scene, light, largest * mean);
    let mut forest = Forest::new(light);
    let error = EASILY * forest.error_with(elements);
    let mut rule = Rule { error, smallest: SMALLEST * mean, largest: largest * mean };
    forest.grow(problem, light, &rule);
    let mut best: Option<(u64, Cut)> = None;
    // Balancing bisects some more, how many is learned.
    let mut aim = (CLOSE * elements as f64) as u64;
    for _ in 0..TRIALS {
        let error = grow_for(&mut forest, &mut rule, problem, light, &merges, aim);
        let (mut balanced, leaders) = (forest.pruned(error), merges.leaders(error));
        balance::balance(problem, borders, &mut balanced, &leaders);
        let cut = balanced.cut(leaders);
        let count = cut.along(&problem.scene, contacts, u64::MAX).element_count(&problem.scene)? as u64;
        let fits = count <= elements;
        if best.as_ref().is_none_or(|&(most, _)| if fits { most > elements || count > most } else { count < most }) {
            best = Some((count, cut));
        }
        if fits && count as f64 >= CLOSE * elements as f64 {
            break;
        }
        let fewer = aim as f64 * 0.5 * (1.0 + CLOSE) * elements as f64 / count as f64;
        let next = fewer.max(LEAST_BEFORE_CONTACTS * elements as f64) as u64;
        if next == aim {
            break;
        }
        aim = next;
    }
    best.map(|(_, cut)| cut).ok_or(Error::NoSurface)
}

/// The error [lux² m²] for which there are at most `aim` elements. Trees are grown no further than that takes.
fn grow_for(forest: &mut Forest, rule: &mut Rule, problem: &Problem, light: &Light, merges: &Merges, aim: u64) -> f32 {
    loop {
        let error = Counts::of(problem, merges, forest).error_of(aim);
        if error > rule.error || rule.error <= 0.0 {
            return error;
        }
        rule.error *= MUCH_LESS;
        let before = forest.len();
        forest.grow(problem, light, rule);
        if forest.len() == before {
            return error;
        }
    }
}

#[cfg(test)]
mod tests;
