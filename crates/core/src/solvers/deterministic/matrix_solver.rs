//! What the solvers on a matrix share: first its rows are computed, in pieces, then a method iterates on it.

use super::system::{Light, Surfaces, System, to_rgb};
use super::{Settings, check, provenance};
use crate::form_factors::{self, Row, Way};
use crate::math::Rgb;
use crate::solution::{Solution, Work};
use crate::solvers::{Landing, Part, Progress, Solver};
use crate::transport::Spot;
use crate::{Error, Problem};
use std::borrow::Cow;
use std::ops::Range;
use std::sync::OnceLock;

/// Rows of form factors of one piece.
const ROWS_PER_PIECE: u64 = 16;
/// An iteration that has not come to its end after so many sweeps over all elements never will.
pub const MOST_SWEEPS: u64 = 20_000;

/// What iterates on the system. Pieces of a step are computed on any threads and absorbed in order. State is saved with the name of its
/// type.
#[typetag::serde]
pub trait Method: Send + Sync {
    /// For people.
    fn stage(&self) -> &'static str;

    /// Pieces of the next step, or `None` when the work is done.
    fn pieces(&self, system: &System) -> Option<u64>;

    /// The landings of a piece; their meaning is the method's.
    fn part(&self, system: &System, piece: u64) -> Vec<Landing>;

    fn absorb(&mut self, system: &System, landings: Vec<Landing>);

    /// After the last piece of a step.
    fn end_step(&mut self, system: &System);

    /// Irradiance [lux] of every element so far.
    fn irradiance(&self) -> &[Light];

    /// Whether a loaded state has a value for each of so many elements.
    fn fits(&self, elements: usize) -> bool;

    /// Luminous flux [lm] that is not distributed yet, nearly.
    fn unshot(&self) -> f64;
}

/// A [`Method`] with the matrix it works on.
#[derive(serde::Serialize, serde::Deserialize)]
pub struct MatrixSolver {
    name: Cow<'static, str>,
    settings: Settings,
    /// Made from the settings, again if the state was loaded; `None` if that fails with another problem than before.
    #[serde(skip)]
    way: OnceLock<Option<Box<dyn Way>>>,
    elements: u64,
    /// Rows so far; empty when the system is complete.
    rows: Vec<Row>,
    surfaces: Surfaces,
    system: Option<System>,
    method: Box<dyn Method>,
    absorbed_pieces: u64,
}

impl MatrixSolver {
    /// # Errors
    /// [`Error::Parameter`] and [`Error::UnknownName`] for settings that are refused, or a matrix that is too large.
    pub fn new<M: Method + 'static>(
        problem: &Problem,
        settings: &Settings,
        name: &'static str,
        method: impl FnOnce(&Surfaces) -> M,
    ) -> Result<MatrixSolver, Error> {
        check(problem, settings)?;
        let surfaces = Surfaces::of(problem);
        Ok(MatrixSolver {
            name: name.into(),
            settings: settings.clone(),
            way: OnceLock::from(Some(form_factors::way(&settings.way, problem, &settings.factors)?)),
            elements: problem.mesh.len() as u64,
            rows: Vec::new(),
            method: Box::new(method(&surfaces)),
            surfaces,
            system: None,
            absorbed_pieces: 0,
        })
    }

    fn pieces(&self) -> Option<u64> {
        match &self.system {
            None => Some(self.elements.div_ceil(ROWS_PER_PIECE)),
            Some(system) => self.method.pieces(system),
        }
    }

    fn way(&self, problem: &Problem) -> Option<&dyn Way> {
        let make = || form_factors::way(&self.settings.way, problem, &self.settings.factors).ok();
        self.way.get_or_init(make).as_deref()
    }

    fn end_step(&mut self, problem: &Problem) {
        match &self.system {
            None => {
                let rows = std::mem::take(&mut self.rows);
                let Some(way) = self.way(problem) else { return };
                let factors = form_factors::assemble(problem, way, rows);
                let factors = self.settings.correction.apply(factors);
                self.system = Some(System { factors, surfaces: self.surfaces.clone() });
            }
            Some(system) => self.method.end_step(system),
        }
    }
}

#[typetag::serde]
impl Solver for MatrixSolver {
    fn step(&self) -> Option<Range<u64>> {
        self.pieces().map(|pieces| self.absorbed_pieces..pieces)
    }

    fn part(&self, problem: &Problem, piece: u64) -> Part {
        match &self.system {
            None => {
                let elements = piece * ROWS_PER_PIECE..((piece + 1) * ROWS_PER_PIECE).min(self.elements);
                let Some(way) = self.way(problem) else { return Part::default() };
                let rows = elements.map(|e| way.row(problem, e as u32)).collect();
                Part { rows, ..Part::default() }
            }
            Some(system) => Part { landings: self.method.part(system, piece), ..Part::default() },
        }
    }

    fn absorb(&mut self, problem: &Problem, part: Part) {
        let last = self.pieces();
        match &self.system {
            None => self.rows.extend(part.rows),
            Some(system) => self.method.absorb(system, part.landings),
        }
        self.absorbed_pieces += 1;
        if Some(self.absorbed_pieces) == last {
            self.absorbed_pieces = 0;
            self.end_step(problem);
        }
    }

    fn solution(&self, problem: &Problem) -> Solution {
        let irradiance = self.method.irradiance();
        let balance = match &self.system {
            Some(system) => system.balance(irradiance),
            None => {
                let emitted = self.surfaces.emitted();
                crate::solution::Balance { emitted, unshot: emitted, ..Default::default() }
            }
        };
        let form_factors::Settings { rays, resolution, hemicubes, visibility, seed } = self.settings.factors;
        let parameters = vec![
            ("form factors", self.settings.way.clone()),
            ("rays", rays.to_string()),
            ("resolution", resolution.to_string()),
            ("hemicubes", hemicubes.to_string()),
            ("visibility", visibility.to_string()),
            ("correction", self.settings.correction.name().to_owned()),
            ("unshot", self.settings.unshot.to_string()),
        ];
        Solution {
            irradiance: irradiance.iter().map(|&e| to_rgb(e)).collect(),
            std_error: vec![Rgb::grey(f32::NAN); irradiance.len()],
            certainty: None,
            work: Work::default(),
            balance,
            provenance: provenance(problem, &self.name, parameters, seed),
            groups: Vec::new(),
        }
    }

    fn fits(&self, problem: &Problem) -> bool {
        let elements = problem.mesh.len();
        let system = self.system.as_ref().is_none_or(|system| system.fits(elements));
        self.elements == elements as u64 && system && self.surfaces.fits(elements) && self.method.fits(elements)
    }

    /// The rows of the matrix are most of the work, so they stand for rays.
    fn progress(&self) -> Progress {
        let (stage, done, unshot) = match &self.system {
            None => ("computing form factors", self.rows.len() as u64, 1.0),
            Some(_) => {
                let unshot = self.method.unshot() / self.surfaces.emitted().max(f64::MIN_POSITIVE);
                (self.method.stage(), self.elements, unshot)
            }
        };
        Progress {
            stage,
            rays: done,
            rays_in_all: Some(self.elements),
            unshot,
            rms_error: None,
            asked: None,
            bias: None,
            excess: None,
        }
    }
}

/// A landing of `light` on element `e`; it rounds to single precision.
pub fn landing(e: usize, light: Light) -> Landing {
    Landing { element: e as u32, spot: Spot::default(), light: light.map(|v| v as f32) }
}

/// The light of a landing.
pub fn light_of(landing: &Landing) -> Light {
    landing.light.map(f64::from)
}
