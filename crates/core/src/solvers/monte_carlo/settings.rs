//! How much work, and which random numbers.

use super::method::{Method, STOCHASTIC_JACOBI};
use crate::Accuracy;
use crate::transport::Leaving;

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Settings {
    pub method: Method,
    pub seed: u64,
    pub budget: Budget,
    /// Independent complete solutions in a round, from 8, or 1 without an error bar; there are more if there are very many rays for
    /// each element.
    pub replicates: u32,
    /// From where pooled light leaves an element.
    pub leaving: Leaving,
    /// What the estimate holds. The balance is always that of all light.
    pub light: LightPart,
}

/// Which light on an element is wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum LightPart {
    /// All that falls on it.
    #[default]
    All,
    /// What was reflected at least once, for those who compute direct light by themselves.
    Indirect,
}

impl LightPart {
    pub const ALL: [LightPart; 2] = [LightPart::All, LightPart::Indirect];

    pub fn name(self) -> &'static str {
        match self {
            LightPart::All => "all",
            LightPart::Indirect => "indirect",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Budget {
    /// The number of rays that [`crate::solvers::budget::rays`] recommends.
    Heuristic,
    /// This many rays, give or take the rays of one iteration.
    Rays(u64),
    /// Until the driver stops: rounds of replicates, each round with twice the rays of the one before.
    Endless,
    /// Rounds of replicates until the solution is accurate enough, or so many rays are spent.
    Accuracy { accuracy: Accuracy, most_rays: Option<u64> },
}

impl Budget {
    /// Until the `accuracy` is reached or so many `rays` are spent, if they are asked for; without either the driver ends it if it `is_timed`.
    pub fn asked(accuracy: Option<Accuracy>, rays: Option<u64>, is_timed: bool) -> Option<Budget> {
        match (accuracy, rays) {
            (Some(accuracy), most_rays) => Some(Budget::Accuracy { accuracy, most_rays }),
            (None, Some(rays)) => Some(Budget::Rays(rays)),
            (None, None) => is_timed.then_some(Budget::Endless),
        }
    }

    /// For the provenance, as `name = value`.
    pub fn parameters(&self) -> Vec<(String, String)> {
        let named = |name: &str, value: String| (name.to_owned(), value);
        match self {
            Budget::Heuristic => vec![named("rays", "heuristic".to_owned())],
            Budget::Rays(rays) => vec![named("rays", rays.to_string())],
            Budget::Endless => vec![named("rounds", "doubling".to_owned())],
            Budget::Accuracy { accuracy: Accuracy { error, confidence, of }, most_rays } => {
                let mut parameters = vec![
                    named("error", error.to_string()),
                    named("confidence", confidence.to_string()),
                    named("error of", of.name()),
                ];
                parameters.extend(most_rays.map(|rays| named("most rays", rays.to_string())));
                parameters
            }
        }
    }

    /// The number of rays, if it is one.
    pub fn rays(self) -> Option<u64> {
        if let Budget::Rays(rays) = self { Some(rays) } else { None }
    }

    /// The most rays that it allows, if it says so.
    pub fn most_rays(self) -> Option<u64> {
        match self {
            Budget::Rays(rays) => Some(rays),
            Budget::Accuracy { most_rays, .. } => most_rays,
            Budget::Heuristic | Budget::Endless => None,
        }
    }

    /// The accuracy that is asked for, if one is.
    pub fn accuracy(self) -> Option<Accuracy> {
        if let Budget::Accuracy { accuracy, .. } = self { Some(accuracy) } else { None }
    }
}

/// Those of stochastic Jacobi: a program chooses the method, and the replicates that suit it ([`Method::natural_replicates`]).
impl Default for Settings {
    fn default() -> Settings {
        Settings {
            method: STOCHASTIC_JACOBI,
            seed: 1,
            budget: Budget::Heuristic,
            replicates: 16,
            leaving: Leaving::default(),
            light: LightPart::default(),
        }
    }
}
