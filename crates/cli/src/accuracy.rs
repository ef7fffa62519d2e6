//! `--error`: how accurate a solution shall be, as people say it.

use crate::failure::Failure;
use crate::numbers::{decimals_for, parse_share, percent};
use isolux_core::scene::Scene;
use isolux_core::{Accuracy, Certainty, Problem, Quantity, Solution};

/// What a bound holds with unless said otherwise, and everywhere where nobody asks.
pub const CONFIDENCE: f64 = 0.95;

/// An error above this gets a hint how to make it smaller [1].
const LARGE_ERROR: f64 = 0.05;

#[derive(Clone, Debug, clap::Args)]
pub struct AccuracyArguments {
    /// Solve until the error is at most this, like 2% of the mean irradiance; --rays and --time limit it
    #[arg(long, value_name = "SHARE", value_parser = parse_share)]
    error: Option<f64>,

    /// How sure that shall be: the share of all solves that keep it
    #[arg(long, value_name = "SHARE", default_value = "95%", value_parser = parse_share, requires = "error")]
    confidence: f64,

    /// Which error: rms over all elements by area; max, of the worst element; mean, of the scene's mean irradiance; or object:NAME, of
    /// that object's
    #[arg(long, value_name = "WHAT", default_value = "rms", value_parser = parse_of, requires = "error")]
    error_of: Of,
}

/// What is named before the scene is read.
#[derive(Clone, Debug, PartialEq)]
enum Of {
    Whole(Quantity),
    Object(String),
}

fn parse_of(text: &str) -> Result<Of, String> {
    match (text, text.strip_prefix("object:")) {
        ("rms", _) => Ok(Of::Whole(Quantity::Rms)),
        ("max", _) => Ok(Of::Whole(Quantity::Max)),
        ("mean", _) => Ok(Of::Whole(Quantity::Mean)),
        (_, Some(name)) if !name.is_empty() => Ok(Of::Object(name.to_owned())),
        _ => Err("it is rms, max, mean, or object:NAME with the name of an object of the scene".to_owned()),
    }
}

impl AccuracyArguments {
    pub fn is_asked(&self) -> bool {
        self.error.is_some()
    }

    /// What is asked for in `scene`, if anything is.
    ///
    /// # Errors
    /// If it has no such object, or several.
    pub fn accuracy(&self, scene: &Scene) -> Result<Option<Accuracy>, Failure> {
        let Some(error) = self.error else { return Ok(None) };
        let of = match &self.error_of {
            Of::Whole(quantity) => *quantity,
            Of::Object(name) => object_called(scene, name)?,
        };
        Ok(Some(Accuracy { error, confidence: self.confidence, of }))
    }
}

fn object_called(scene: &Scene, name: &str) -> Result<Quantity, Failure> {
    let failed = |error| {
        Failure::usage(format!("--error-of: {error}"))
            .with_help("the table of 'isolux solve --objects all' has all names")
    };
    Quantity::of_object(scene, name).map_err(failed)
}

/// The error that a solution has, beside the one that was asked for.
#[derive(Clone, Copy, Debug)]
pub struct Reached {
    /// What was asked for, or else what people like to know.
    pub accuracy: Accuracy,
    /// At most this is the error [1]; NaN while it is unknown.
    pub bound: f64,
    replicates: u32,
}

impl Reached {
    /// By `solution` of `problem`, where this was `asked`.
    pub fn by(problem: &Problem, solution: &Solution, asked: Option<Accuracy>) -> Reached {
        let usual = Accuracy { error: LARGE_ERROR, confidence: CONFIDENCE, of: Quantity::Rms };
        let accuracy = asked.unwrap_or(usual);
        let bound = accuracy.of.error_bound(problem, solution, accuracy.confidence);
        Reached { accuracy, bound, replicates: solution.work.replicates }
    }

    /// Whether it is what was asked for, or better.
    pub fn is_enough(&self) -> bool {
        self.bound <= self.accuracy.error
    }

    /// A line, or nothing while the error is unknown.
    pub fn in_words(&self, problem: &Problem) -> String {
        if !self.bound.is_finite() {
            return String::new();
        }
        let (what, confidence) =
            (in_words(self.accuracy.of, &problem.scene), with_confidence(self.accuracy.confidence));
        format!("Error at most {} {confidence} ({what}, {} replicates)\n", percent(self.bound), self.replicates)
    }
}

/// A line: the scene's mean irradiance with its error bar.
pub fn mean_in_words(certainty: &Certainty) -> String {
    let margin = certainty.scene.margin(CONFIDENCE);
    let decimals = decimals_for(margin, 2);
    format!("Mean irradiance {:.decimals$} ± {margin:.decimals$} lx (95 %)\n", certainty.scene.mean)
}

/// `RMS over all elements`, `mean irradiance of 'Floor'`.
pub fn in_words(of: Quantity, scene: &Scene) -> String {
    match of {
        Quantity::Rms => "RMS over all elements".to_owned(),
        Quantity::Max => "the worst element".to_owned(),
        Quantity::Mean => "mean irradiance of the scene".to_owned(),
        Quantity::Object(k) => {
            let name = scene.objects.get(k as usize).map_or("", |object| &object.name);
            format!("mean irradiance of '{}'", crate::terminal::harmless(name))
        }
    }
}

/// `with 95 % confidence`
fn with_confidence(confidence: f64) -> String {
    format!("with {} confidence", percent(confidence).replace(".0 %", " %"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolux_core::scene::builtin::builtin;

    #[test]
    fn what_is_meant_is_told_by_name() {
        assert_eq!(parse_of("max"), Ok(Of::Whole(Quantity::Max)));
        assert_eq!(parse_of("object:a b"), Ok(Of::Object("a b".to_owned())));
        assert!(parse_of("object:").is_err() && parse_of("worst").is_err());
        assert_eq!(with_confidence(0.95), "with 95 % confidence");
        assert_eq!(with_confidence(0.999), "with 99.9 % confidence");
    }

    #[test]
    fn objects_that_are_not_there_or_there_twice_are_refused() {
        let mut scene = builtin("cornell-box").unwrap();
        assert_eq!(object_called(&scene, "floor").ok(), Some(Quantity::Object(0)));
        let message = |scene: &Scene, name| object_called(scene, name).unwrap_err().what;
        assert!(message(&scene, "flor").contains("did you mean 'floor'"));
        scene.objects[1].name = "floor".to_owned();
        assert!(message(&scene, "floor").contains("several objects"));
    }
}
