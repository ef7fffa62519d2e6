//! Deterministic baselines: the radiosity system solved without random numbers. What the stochastic solvers are measured
//! against.
//!
//! ```text
//! B_i = Be_i + rho_i E_i,      E_i = Σ_j F_ij B_j
//! ```
//!
//! The first five work on a matrix of form factors, which grows like the square of the number of elements; the last two do
//! not need one. All have elements of constant radiosity. They know no error bars ([`crate::Solution::std_error`] is NaN) and
//! no lights without extent.
//!
//! Form factors are made reciprocal (see [`Settings::correction`]), so that no light is made or lost between two
//! elements. What a row of them lacks to one has escaped, be it through an opening or by the error of the form factors.

pub mod direct;
pub mod gauss_seidel;
pub mod hierarchical;
pub mod jacobi;
pub mod lu;
mod matrix_solver;
pub mod southwell;
mod system;

use super::Solver;
use crate::form_factors::{self, Correction};
use crate::solution::Provenance;
use crate::{Error, Problem};
use jacobi::Form;

/// What the deterministic solvers are told. Each uses what concerns it.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Settings {
    /// The way to form factors, a name of [`form_factors::WAYS`].
    pub way: String,
    /// How finely form factors are computed.
    pub factors: form_factors::Settings,
    /// Which laws form factors are made to obey; without reciprocity the balance does not close.
    pub correction: Correction,
    /// Iterations end when less than this share of the emitted power is unshot.
    pub unshot: f64,
    /// Whether [`southwell`] adds what the unshot light will do on average, for display.
    pub ambient: bool,
    /// Most power [share of the emitted] that a link of [`hierarchical`] may carry without being refined.
    pub link_power: f64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            way: "contour".to_owned(),
            factors: form_factors::Settings::default(),
            correction: Correction::Reciprocity,
            unshot: 1e-5,
            ambient: false,
            link_power: 1e-5,
        }
    }
}

/// A deterministic solver.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    pub name: &'static str,
    /// What it does, two lines for people.
    pub what: [&'static str; 2],
    pub source: &'static str,
    /// The settings that concern it, as the command line calls them.
    pub uses: &'static [&'static str],
    pub make: Make,
}

/// Makes a solver for a problem.
pub type Make = fn(&Problem, &Settings) -> Result<Box<dyn Solver>, Error>;

/// All deterministic solvers. A new one is a file in this folder and a line here.
pub const DETERMINISTIC: &[Entry] = &[
    Entry {
        name: "jacobi-gather",
        what: ["every element gathers what all others sent in the iteration before;", "matrix of form factors"],
        source: "Goral, Torrance, Greenberg & Battaile 1984",
        uses: &["factors", "unshot"],
        make: |problem, settings| Ok(Box::new(jacobi::solver(problem, settings, Form::Gather)?)),
    },
    Entry {
        name: "jacobi-shoot",
        what: ["every element shoots all its power, again and again;", "matrix of form factors"],
        source: "Neumann et al. 1995, without the random numbers",
        uses: &["factors", "unshot"],
        make: |problem, settings| Ok(Box::new(jacobi::solver(problem, settings, Form::Shoot)?)),
    },
    Entry {
        name: "jacobi-incremental",
        what: ["every element shoots what it has not shot yet;", "matrix of form factors"],
        source: "Shirley 1991, without the random numbers",
        uses: &["factors", "unshot"],
        make: |problem, settings| Ok(Box::new(jacobi::solver(problem, settings, Form::Incremental)?)),
    },
    Entry {
        name: "gauss-seidel",
        what: ["one element after the other gathers, from the newest radiosities;", "matrix of form factors"],
        source: "Cohen & Greenberg 1985",
        uses: &["factors", "unshot"],
        make: |problem, settings| Ok(Box::new(gauss_seidel::solver(problem, settings)?)),
    },
    Entry {
        name: "southwell",
        what: ["progressive refinement: the element with most unshot power shoots next;", "one hemicube at a time"],
        source: "Cohen, Chen, Wallace & Greenberg 1988; Gortler, Cohen & Slusallek 1994",
        uses: &["unshot", "ambient"],
        make: |problem, settings| Ok(Box::new(southwell::Southwell::new(problem, settings)?)),
    },
    Entry {
        name: "direct",
        what: ["the dense system by LU decomposition, the reference for small scenes;", "matrix of form factors"],
        source: "Goral, Torrance, Greenberg & Battaile 1984",
        uses: &["factors"],
        make: |problem, settings| Ok(Box::new(direct::solver(problem, settings)?)),
    },
    Entry {
        name: "hierarchical",
        what: ["links between clusters of elements, as fine as the power they carry asks for;", "without a matrix"],
        source: "Hanrahan, Salzman & Aupperle 1991",
        uses: &["unshot", "link-power"],
        make: |problem, settings| Ok(Box::new(hierarchical::Hierarchical::new(problem, settings)?)),
    },
];

/// The solver called `name`.
///
/// # Errors
/// [`Error::UnknownName`], and those of the solver.
pub fn solver(name: &str, problem: &Problem, settings: &Settings) -> Result<Box<dyn Solver>, Error> {
    let found = DETERMINISTIC.iter().find(|entry| entry.name == name);
    let entry =
        found.ok_or_else(|| Error::unknown_name("method", name, DETERMINISTIC.iter().map(|entry| entry.name)))?;
    (entry.make)(problem, settings)
}

/// What all of them ask of a problem and of settings.
fn check(problem: &Problem, settings: &Settings) -> Result<(), Error> {
    if !problem.scene.lights.is_empty() {
        let value = format!("{} lights", problem.scene.lights.len());
        let allowed = "deterministic methods know no point, spot or directional lights; use stochastic-jacobi";
        return Err(Error::Parameter { name: "scene", value, allowed });
    }
    if problem.mesh.has_clusters() {
        let allowed = "deterministic methods take flat elements; cut the scene without clusters";
        return Err(Error::Parameter { name: "elements", value: "clusters of triangles".to_owned(), allowed });
    }
    for (name, value) in [("unshot", settings.unshot), ("link-power", settings.link_power)] {
        if !(value > 0.0 && value < 1.0) {
            let allowed = "a share of the emitted power, above 0 and below 1";
            return Err(Error::Parameter { name, value: value.to_string(), allowed });
        }
    }
    Ok(())
}

fn provenance(problem: &Problem, method: &str, parameters: Vec<(&str, String)>, seed: u64) -> Provenance {
    Provenance {
        scene: problem.scene.name.clone(),
        scene_hash: problem.scene.hash(),
        method: method.to_owned(),
        parameters: parameters.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
        seed,
        version: crate::VERSION.to_owned(),
    }
}
