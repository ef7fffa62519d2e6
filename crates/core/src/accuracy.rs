//! The accuracy that somebody asks for, and whether a solution has it.
//!
//! All errors are of luminance irradiance, relative to a mean, and hold with a confidence: 0.95 means that the true error is within
//! the bound in 95 of 100 solves. They are those of chance: what elements of finite size cost is not in them.

use crate::math::Estimate;
use crate::math::estimate::student;
use crate::scene::Scene;
use crate::solution::luminance_error;
use crate::{Error, Problem, Solution};

/// How accurate a solution shall be.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Accuracy {
    /// Largest error, relative to the mean irradiance of the scene, or of the object [1].
    pub error: f64,
    /// Probability with which it must hold, between 0 and 1.
    pub confidence: f64,
    pub of: Quantity,
}

/// Whose error is meant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Quantity {
    /// The RMS over all elements, by area.
    #[default]
    Rms,
    /// The largest of any element, relative to the scene's mean.
    Max,
    /// That of the mean irradiance of the scene.
    Mean,
    /// That of the mean irradiance of an object, by its number: of the side that gets more light, if it has two.
    Object(u32),
}

impl Quantity {
    /// `rms`, `max`, `mean`, or `object` and its number.
    pub fn name(self) -> String {
        match self {
            Quantity::Rms => "rms".to_owned(),
            Quantity::Max => "max".to_owned(),
            Quantity::Mean => "mean".to_owned(),
            Quantity::Object(object) => format!("object {object}"),
        }
    }

    /// The object of `scene` called `name`.
    ///
    /// # Errors
    /// [`Error::UnknownName`] if there is none, [`Error::Parameter`] if there are several.
    pub fn of_object(scene: &Scene, name: &str) -> Result<Quantity, Error> {
        let mut found = (0..).zip(&scene.objects).filter(|(_, object)| object.name == name).map(|(k, _)| k);
        match (found.next(), found.next()) {
            (Some(object), None) => Ok(Quantity::Object(object)),
            (Some(_), Some(_)) => {
                let allowed = "several objects have this name; give each a name of its own";
                Err(Error::Parameter { name: "object", value: name.to_owned(), allowed })
            }
            (None, _) => {
                Err(Error::unknown_name("object", name, scene.objects.iter().map(|object| object.name.as_str())))
            }
        }
    }

    /// What `solution` of `problem` is off by at most with this `confidence`; NaN while it is unknown, and in the dark.
    ///
    /// - RMS: Fisher's F ([`Certainty::rms_bound`](crate::Certainty::rms_bound));
    /// - means: Student's t;
    /// - the largest of N: Student's t with confidence `1 - (1 - confidence) / N` (Bonferroni), by the largest standard error. It
    ///   takes many replicates to be as sure of the worst of many elements.
    pub fn error_bound(self, problem: &Problem, solution: &Solution, confidence: f64) -> f64 {
        let Some(certainty) = &solution.certainty else { return f64::NAN };
        match self {
            Quantity::Rms => certainty.rms_bound(confidence),
            Quantity::Max => {
                let errors = solution.std_error.iter().map(|&error| f64::from(luminance_error(error)));
                let doubt = (1.0 - confidence) / problem.mesh.len() as f64;
                errors.fold(0.0, f64::max) * student(1.0 - doubt, certainty.freedom) / certainty.scene.mean
            }
            Quantity::Mean => relative_margin(&certainty.scene, confidence),
            Quantity::Object(object) => {
                let first = 2 * object as usize;
                let sides = certainty.faces.iter().skip(first).take(2);
                let brighter = sides.max_by(|front, back| front.mean.total_cmp(&back.mean));
                brighter.map_or(f64::NAN, |side| relative_margin(side, confidence))
            }
        }
    }
}

/// What no light has reached is sure to be dark.
fn relative_margin(mean: &Estimate, confidence: f64) -> f64 {
    if mean.mean == 0.0 && mean.variance == 0.0 { 0.0 } else { mean.margin(confidence) / mean.mean }
}

impl Accuracy {
    /// The error bound of `solution` over the one that is asked for: at most 1 if it is accurate enough; NaN while it is unknown.
    pub fn excess(&self, problem: &Problem, solution: &Solution) -> f64 {
        self.of.error_bound(problem, solution, self.confidence) / self.error
    }
}
