//! The solutions that errors are measured against, and the errors.

use crate::Error;
use crate::bench::single;
use isolux_core::mesh::ElementMesh;
use isolux_core::sampling::SequenceName;
use isolux_core::solution::luminance_error;
use isolux_core::solvers::monte_carlo::axes::Walk;
use isolux_core::solvers::monte_carlo::{Budget, LightPart, Method, Settings};
use isolux_core::transport::Leaving;
use isolux_core::{Problem, Solution};
use std::f64::consts::SQRT_2;

/// Elements darker than this share of the mean count as if they were as bright: nobody sees their relative error.
const DARK: f64 = 0.01;
/// Elements whose reference has a larger relative error than this are left out where elements count alike.
const UNKNOWN: f64 = 0.2;
/// Median of the absolute value of a normal deviate of variance one.
const NORMAL_MEDIAN: f64 = 0.674_489_750_196_081_7;
/// Seed of all references, far from those of what is held against them.
const SEED: u64 = 1_000_000;

/// Which solution a reference is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// That of methods of such a walk, to the letter: of the system with constant elements, or of the radiosity equation.
    Of(Walk),
    /// That light of a scene, by the system with constant elements, to the letter: there all methods that pool light have the same answer.
    Light(LightPart),
}

impl Kind {
    /// In names of files.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Of(Walk::Discrete) => "shirley",
            Kind::Of(Walk::Continuous) => "particle-tracing",
            Kind::Light(LightPart::All) => "all-light",
            Kind::Light(LightPart::Indirect) => "reflected-light",
        }
    }

    /// How it is computed: in 16 complete solutions.
    ///
    /// # Errors
    /// None, as long as its method is in the table.
    pub fn settings(self, rays: u64) -> Result<Settings, Error> {
        let method = |name| Method::named(name).map(|method| Method { sequence: SequenceName::OWEN_SOBOL, ..method });
        Ok(match self {
            Kind::Of(_) => Settings { replicates: 16, ..single(method(self.name())?, rays, SEED) },
            Kind::Light(light) => Settings {
                method: method("auto")?,
                seed: SEED,
                budget: Budget::Rays(rays),
                replicates: 16,
                light,
                leaving: Leaving::WholeElement,
            },
        })
    }
}

/// The solution that errors are measured against.
#[derive(Debug)]
pub struct Reference {
    /// Irradiance [lux], luminance, of every element, and its standard error.
    irradiance: Vec<f64>,
    std_error: Vec<f64>,
    /// Whether an irradiance without any error is an exact one. In a Monte Carlo solution it says that no light was found.
    exact: bool,
}

/// Relative errors of luminance irradiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// RMS over the area, relative to the mean.
    pub weighted: f64,
    /// RMS over the elements, each relative to its own irradiance.
    pub unweighted: f64,
    /// Median over the elements of the same.
    pub median: f64,
}

impl Reference {
    pub fn new(solution: &Solution) -> Reference {
        Reference {
            irradiance: solution.irradiance.iter().map(|lux| lux.luminance_f64()).collect(),
            std_error: solution.std_error.iter().map(|&lux| f64::from(luminance_error(lux))).collect(),
            exact: false,
        }
    }

    /// The same irradiance [lux] on all of so many elements, known without error.
    pub fn exact(irradiance: f64, elements: usize) -> Reference {
        Reference { irradiance: vec![irradiance; elements], std_error: vec![0.0; elements], exact: true }
    }

    /// Irradiance [lux] of element `e`.
    pub fn on(&self, e: u32) -> f64 {
        self.irradiance[e as usize]
    }

    /// Area-weighted RMS error of luminance irradiance, relative to the reference's mean; the reference's own error is taken off.
    pub fn error(&self, problem: &Problem, solution: &Solution) -> f64 {
        self.weighted(&problem.mesh, |e| (solution.irradiance[e as usize].luminance_f64() - self.on(e)).powi(2))
    }

    /// All errors of `irradiance(e)` [lux]. The variance of the reference is taken off the squares element by element, and off the
    /// square of the median as if errors were normal.
    ///
    /// Where elements count alike, dark ones count as if they had a hundredth of the mean irradiance, and those that the reference
    /// itself does not know to a fifth are left out. So are those where it found no light at all, 0 ± 0.
    pub fn errors(&self, mesh: &ElementMesh, irradiance: impl Fn(u32) -> f64) -> Errors {
        let difference = |e: u32| irradiance(e) - self.on(e);
        let least = self.least(mesh);
        let relative = |e: u32, lux: f64| lux / self.on(e).max(least);
        let known = || mesh.elements().filter(|&e| self.is_known(e, least));
        let squares = known().map(|e| relative(e, difference(e)).powi(2) - relative(e, self.std_error(e)).powi(2));
        let unweighted = (squares.sum::<f64>() / known().count() as f64).max(0.0).sqrt();
        let own = NORMAL_MEDIAN * median(known().map(|e| relative(e, self.std_error(e))));
        let both = median(known().map(|e| relative(e, difference(e)).abs()));
        Errors {
            weighted: self.weighted(mesh, |e| difference(e).powi(2)),
            unweighted,
            median: (both.powi(2) - own.powi(2)).max(0.0).sqrt(),
        }
    }

    /// Its own errors, as it states them.
    pub fn own(&self, mesh: &ElementMesh) -> Errors {
        // What is off by the root of two standard errors has twice the variance, and once it is taken off.
        let errors = self.errors(mesh, |e| self.on(e) + SQRT_2 * self.std_error(e));
        Errors { median: errors.median * NORMAL_MEDIAN / (2.0 - NORMAL_MEDIAN.powi(2)).sqrt(), ..errors }
    }

    /// Share of the elements that it does not know well enough where elements count alike.
    pub fn unknown(&self, mesh: &ElementMesh) -> f64 {
        let least = self.least(mesh);
        mesh.elements().filter(|&e| !self.is_known(e, least)).count() as f64 / mesh.len() as f64
    }

    /// Relative RMS over the area of what has these squares [lux²]; the reference's own variance is taken off.
    fn weighted(&self, mesh: &ElementMesh, square: impl Fn(u32) -> f64) -> f64 {
        let sum =
            mesh.elements().map(|e| f64::from(mesh.area(e)) * (square(e) - self.std_error(e).powi(2))).sum::<f64>();
        (sum / mesh.total_area()).max(0.0).sqrt() / self.mean(mesh)
    }

    fn mean(&self, mesh: &ElementMesh) -> f64 {
        mesh.elements().map(|e| f64::from(mesh.area(e)) * self.on(e)).sum::<f64>() / mesh.total_area()
    }

    fn least(&self, mesh: &ElementMesh) -> f64 {
        DARK * self.mean(mesh)
    }

    fn std_error(&self, e: u32) -> f64 {
        self.std_error[e as usize]
    }

    fn is_known(&self, e: u32, least: f64) -> bool {
        (self.exact || self.std_error(e) > 0.0) && self.std_error(e) <= UNKNOWN * self.on(e).max(least)
    }
}

/// The middle one of `values`; not a number if there are none.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    let middle = values.len() / 2;
    if values.is_empty() { f64::NAN } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolux_core::mesh::Resolution;
    use isolux_core::scene::builtin::builtin;

    /// Twelve triangles of a box, of three sizes.
    fn mesh() -> ElementMesh {
        ElementMesh::new(&builtin("box").unwrap(), Resolution::Elements(12)).unwrap()
    }

    #[track_caller]
    fn assert_near(found: f64, exact: f64) {
        assert!((found - exact).abs() < 1e-12, "{found} instead of {exact}");
    }

    #[test]
    fn a_tenth_too_bright_is_an_error_of_a_tenth() {
        let (mesh, reference) = (mesh(), Reference::exact(5.0, 12));
        let Errors { weighted, unweighted, median } = reference.errors(&mesh, |_| 5.5);
        [weighted, unweighted, median].into_iter().for_each(|error| assert_near(error, 0.1));
        assert_eq!(reference.own(&mesh), Errors { weighted: 0.0, unweighted: 0.0, median: 0.0 });
    }

    #[test]
    fn large_elements_count_more_by_area_only() {
        let (mesh, reference) = (mesh(), Reference::exact(5.0, 12));
        let Errors { weighted, unweighted, median } = reference.errors(&mesh, |e| if e == 3 { 10.0 } else { 5.0 });
        assert_near(weighted, (f64::from(mesh.area(3)) / mesh.total_area()).sqrt());
        assert_near(unweighted, (1.0f64 / 12.0).sqrt());
        assert_eq!(median, 0.0);
    }

    #[test]
    fn what_the_reference_does_not_know_is_taken_off() {
        let (mesh, mut reference) = (mesh(), Reference::exact(5.0, 12));
        reference.std_error = vec![0.3; 12];
        let Errors { weighted, unweighted, median } = reference.errors(&mesh, |_| 5.0 + 0.5);
        [weighted, unweighted].into_iter().for_each(|error| assert_near(error, 0.4 / 5.0));
        assert_near(median.powi(2), (0.25 - (NORMAL_MEDIAN * 0.3).powi(2)) / 25.0);
        let own = reference.own(&mesh);
        [own.weighted, own.unweighted].into_iter().for_each(|error| assert_near(error, 0.3 / 5.0));
        assert_near(own.median, NORMAL_MEDIAN * 0.3 / 5.0);
        let none = Errors { weighted: 0.0, unweighted: 0.0, median: 0.0 };
        assert_eq!(reference.errors(&mesh, |e| reference.on(e)), none, "no roots of negative numbers");
    }

    #[test]
    fn a_black_element_counts_as_one_of_a_hundredth_of_the_mean() {
        let (mesh, mut reference) = (mesh(), Reference::exact(5.0, 12));
        reference.irradiance[0] = 0.0;
        let least = 0.01 * reference.mean(&mesh);
        let errors = reference.errors(&mesh, |e| if e == 0 { 2.0 * least } else { 5.0 });
        assert_near(errors.unweighted, 2.0 / 12f64.sqrt());
    }

    #[test]
    fn an_element_that_the_reference_does_not_know_is_left_out_where_elements_count_alike() {
        let (mesh, mut reference) = (mesh(), Reference::exact(5.0, 12));
        reference.std_error[0] = 1.1;
        assert_near(reference.unknown(&mesh), 1.0 / 12.0);
        let errors = reference.errors(&mesh, |e| if e == 0 { 50.0 } else { 5.0 });
        assert_eq!((errors.unweighted, errors.median), (0.0, 0.0));
        assert!(errors.weighted > 1.0, "by area it counts: {errors:?}");
    }

    #[test]
    fn so_is_one_where_it_found_no_light() {
        let (mesh, mut reference) = (mesh(), Reference { exact: false, ..Reference::exact(5.0, 12) });
        (reference.irradiance[0], reference.std_error) = (0.0, vec![0.1; 12]);
        reference.std_error[0] = 0.0;
        assert_near(reference.unknown(&mesh), 1.0 / 12.0);
        let dark = |e| if e == 0 { 5.0 } else { reference.on(e) };
        assert_eq!(reference.errors(&mesh, dark).unweighted, 0.0);
    }
}
