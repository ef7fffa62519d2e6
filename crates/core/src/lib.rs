//! All the mathematics of isolux: view-independent diffuse global illumination by Monte Carlo radiosity.
//!
//! The crate opens no file, prints nothing and reads no clock. Imports run one way:
//! `math -> {scene, sampling} -> mesh -> geometry -> transport -> form_factors -> solvers -> solution -> view`
//! (see ARCHITECTURE.md). Units are SI and photometric throughout: metres, lumens, lux (lm/m²), candela.

mod accuracy;
pub mod adaptive;
mod certainty;
pub mod choice;
pub mod compare;
mod error;
pub mod form_factors;
pub mod geometry;
pub mod lightmap;
pub mod math;
pub mod merge;
pub mod mesh;
pub mod precision;
pub mod problem;
pub mod report;
pub mod run;
pub mod sampling;
pub mod scene;
pub mod solution;
pub mod solvers;
pub mod superposition;
pub mod transport;
pub mod view;

pub use accuracy::{Accuracy, Quantity};
pub use certainty::Certainty;
pub use error::Error;
pub use problem::Problem;
pub use solution::Solution;

/// The version of isolux, as written into every solution's provenance.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
