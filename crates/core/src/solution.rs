//! The result: how much light falls on every element, how sure that is, and where all the light went.

use crate::math::Rgb;
use crate::scene::LightGroup;
use crate::{Certainty, Problem};

/// Irradiance of every element with its standard error. The default is that of a scene without elements.
///
/// Irradiance `E = b / rho` [lm/m² = lux] does not contain the texture and is defined where the reflectivity is zero; the
/// radiosity is `B = Be + rho E` ([`Solution::radiosity`]).
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Solution {
    /// Irradiance [lux] per element.
    pub irradiance: Vec<Rgb>,
    /// Standard error of the irradiance [lux] per element and channel; NaN while there are fewer than two replicates.
    pub std_error: Vec<Rgb>,
    /// How sure the sums are; `None` while there are fewer than two replicates, and of deterministic methods.
    pub certainty: Option<Certainty>,
    pub work: Work,
    pub balance: Balance,
    pub provenance: Provenance,
    /// The light of each group of sources, if they were solved apart; `self` is their sum.
    #[serde(skip)]
    pub groups: Vec<GroupLight>,
}

/// The light of a group of sources, solved for itself. See [`crate::superposition`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct GroupLight {
    pub group: LightGroup,
    /// What the group emits [lm], by channel, at factor 1.
    pub flux: [f64; 3],
    /// How many times so much it emits in the sum.
    pub factor: Rgb,
    /// At factor 1, in the scene without any other source.
    pub solution: Solution,
}

/// What it cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Work {
    pub rays: u64,
    /// Independent replicates the standard errors come from.
    pub replicates: u32,
}

/// Where the emitted light went [lm, luminance]. `emitted = absorbed + escaped + back_face + unshot`, to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Balance {
    /// Sent out by all sources.
    pub emitted: f64,
    /// Absorbed by surfaces.
    pub absorbed: f64,
    /// Left the scene without hitting anything.
    pub escaped: f64,
    /// Absorbed by the backs of one-sided surfaces: gaps in the model or flipped normals.
    pub back_face: f64,
    /// Still on its way when the solver stopped.
    pub unshot: f64,
}

/// Where a solution comes from: enough to compute it again, bit for bit.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Provenance {
    pub scene: String,
    /// [`crate::scene::Scene::hash`].
    pub scene_hash: u64,
    pub method: String,
    /// Parameters of the method, as `name = value`.
    pub parameters: Vec<(String, String)>,
    pub seed: u64,
    /// Version of isolux.
    pub version: String,
}

impl Provenance {
    /// The value of the parameter called `name`, if there is one.
    pub fn parameter(&self, name: &str) -> Option<&str> {
        self.parameters.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }
}

impl Solution {
    /// Radiosity `B = Be + rho E` [lm/m²] of element `e`.
    pub fn radiosity(&self, problem: &Problem, e: u32) -> Rgb {
        problem.mesh.emission(e) + problem.mesh.reflectivity(e) * self.irradiance[e as usize]
    }

    /// The area-weighted RMS error that is expected of luminance irradiance, relative to its mean: [`Certainty::rms`]. NaN while it is
    /// unknown, and in the dark.
    pub fn rms_error(&self) -> f64 {
        self.certainty.as_ref().map_or(f64::NAN, Certainty::rms)
    }
}

/// Standard error of the luminance, its channels taken as fully correlated (they ride on the same rays).
pub fn luminance_error(std_error: Rgb) -> f32 {
    std_error.luminance()
}

impl Balance {
    /// What is missing from the balance, relative to the emitted flux; rounding only, in a correct solver.
    pub fn residual(&self) -> f64 {
        (self.emitted - self.absorbed - self.escaped - self.back_face - self.unshot)
            / self.emitted.max(f64::MIN_POSITIVE)
    }
}

impl std::ops::Add for Balance {
    type Output = Balance;
    fn add(self, other: Balance) -> Balance {
        Balance {
            emitted: self.emitted + other.emitted,
            absorbed: self.absorbed + other.absorbed,
            escaped: self.escaped + other.escaped,
            back_face: self.back_face + other.back_face,
            unshot: self.unshot + other.unshot,
        }
    }
}

impl std::ops::Mul<f64> for Balance {
    type Output = Balance;
    fn mul(self, k: f64) -> Balance {
        Balance {
            emitted: self.emitted * k,
            absorbed: self.absorbed * k,
            escaped: self.escaped * k,
            back_face: self.back_face * k,
            unshot: self.unshot * k,
        }
    }
}

impl std::ops::Div<f64> for Balance {
    type Output = Balance;
    fn div(self, k: f64) -> Balance {
        Balance {
            emitted: self.emitted / k,
            absorbed: self.absorbed / k,
            escaped: self.escaped / k,
            back_face: self.back_face / k,
            unshot: self.unshot / k,
        }
    }
}
