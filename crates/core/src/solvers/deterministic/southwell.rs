//! Southwell relaxation, known as progressive refinement: the element with most unshot power shoots next.
//!
//! ```text
//! i = argmax A_i D_i;      for all j:  E_j += D_i A_i F_ij / A_j,   D_j += rho_j D_i A_i F_ij / A_j;      D_i = 0
//! ```
//!
//! The row `F_ij` comes from hemicubes over element i and is forgotten again. Good pictures soon, a full solution late.
//! Cohen, Chen, Wallace & Greenberg 1988; that it is Southwell's method showed Gortler, Cohen & Slusallek 1994. For display
//! the unshot light may be added as if it were everywhere: the ambient term `Σ A D / Σ A · 1 / (1 - mean rho)`; the balance
//! leaves it out.
//!
//! Biased: small elements fall between the pixels, and share the error of hemicubes. No light is lost: delta form factors sum
//! to one. Cost: 3 R² rays a shot and O(n) memory.

use super::system::{Light, Surfaces, luminance, plus, times, to_rgb};
use super::{Settings, check, provenance};
use crate::form_factors::Hemicube;
use crate::math::Rgb;
use crate::solution::{Balance, Solution, Work};
use crate::solvers::{Landing, Part, Progress, Solver};
use crate::transport::{Arrival, Spot};
use crate::{Error, Problem};
use std::ops::Range;

/// The name of the method.
pub const NAME: &str = "southwell";
/// Rays of a piece.
const RAYS_PER_PIECE: u64 = 2048;
/// Shots for each element after which light that nothing absorbs is given up, and so many more.
const PATIENCE: (u64, u64) = (1000, 100_000);

/// The state of the relaxation, 100 bytes an element.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Southwell {
    settings: Settings,
    hemicube: Hemicube,
    surfaces: Surfaces,
    irradiance: Vec<Light>,
    /// Unshot radiosity D [lm/m²].
    unshot: Vec<Light>,
    /// Unshot radiosity that the running shot has brought so far: element and light.
    arrived: Vec<(usize, Light)>,
    /// The element that shoots, if there is enough left to shoot.
    shooter: Option<u32>,
    absorbed_pieces: u64,
    shots: u64,
    rays: u64,
    /// Unshot luminous flux [lm], escaped, and lost on backs.
    flux: Balance,
}

impl Southwell {
    /// # Errors
    /// [`Error::Parameter`] for settings that are refused.
    pub fn new(problem: &Problem, settings: &Settings) -> Result<Southwell, Error> {
        check(problem, settings)?;
        let surfaces = Surfaces::of(problem);
        let emitted = surfaces.emitted();
        let mut southwell = Southwell {
            settings: settings.clone(),
            hemicube: Hemicube::new(&settings.factors)?,
            irradiance: vec![[0.0; 3]; surfaces.area.len()],
            unshot: surfaces.emission.clone(),
            surfaces,
            arrived: Vec::new(),
            shooter: None,
            absorbed_pieces: 0,
            shots: 0,
            rays: 0,
            flux: Balance { emitted, unshot: emitted, ..Balance::default() },
        };
        southwell.choose();
        Ok(southwell)
    }

    fn pieces(&self) -> u64 {
        self.hemicube.rays().div_ceil(RAYS_PER_PIECE)
    }

    /// Sums up the unshot power and chooses who shoots next: the first of those with most.
    fn choose(&mut self) {
        let power = |i: usize| self.surfaces.area[i] * luminance(self.unshot[i]);
        let powers: Vec<f64> = (0..self.unshot.len()).map(power).collect();
        self.flux.unshot = powers.iter().sum();
        let most = (0..powers.len()).fold(0, |best, i| if powers[i] > powers[best] { i } else { best });
        let patience = PATIENCE.0 * powers.len() as u64 + PATIENCE.1;
        let share = self.flux.unshot / self.flux.emitted.max(f64::MIN_POSITIVE);
        let goes_on = share > self.settings.unshot && share < 2.0 && self.shots < patience;
        self.shooter = goes_on.then_some(most as u32);
    }

    /// What the unshot light will add everywhere [lux], on average.
    fn ambient(&self) -> Light {
        let area: f64 = self.surfaces.area.iter().sum();
        let mean = |values: &[Light], c: usize| {
            values.iter().zip(&self.surfaces.area).map(|(v, a)| v[c] * a).sum::<f64>() / area
        };
        std::array::from_fn(|c| {
            mean(&self.unshot, c) / (1.0 - mean(&self.surfaces.reflectivity, c)).max(f64::MIN_POSITIVE)
        })
    }
}

#[typetag::serde]
impl Solver for Southwell {
    fn step(&self) -> Option<Range<u64>> {
        self.shooter.map(|_| self.absorbed_pieces..self.pieces())
    }

    /// Landings are fluxes [lm].
    fn part(&self, problem: &Problem, piece: u64) -> Part {
        let Some(shooter) = self.shooter else { return Part::default() };
        let range = piece * RAYS_PER_PIECE..((piece + 1) * RAYS_PER_PIECE).min(self.hemicube.rays());
        let mut part = Part { rays: range.end - range.start, ..Part::default() };
        let power = self.unshot[shooter as usize].map(|d| d * self.surfaces.area[shooter as usize]);
        let luminous = luminance(power);
        self.hemicube.look(problem, shooter, range, |arrival, share| match arrival {
            Arrival::Element { element, .. } => {
                let light = power.map(|p| (p * share) as f32);
                part.landings.push(Landing { element, spot: Spot::default(), light });
            }
            Arrival::BackFace => part.back_face += luminous * share,
            Arrival::Escaped => part.escaped += luminous * share,
        });
        part
    }

    fn absorb(&mut self, _: &Problem, part: Part) {
        let Some(shooter) = self.shooter else { return };
        self.rays += part.rays;
        self.flux.escaped += part.escaped;
        self.flux.back_face += part.back_face;
        for Landing { element, light, .. } in part.landings {
            let j = element as usize;
            let more: Light = light.map(|flux| f64::from(flux) / self.surfaces.area[j]);
            self.irradiance[j] = plus(self.irradiance[j], more);
            self.arrived.push((j, times(more, self.surfaces.reflectivity[j])));
        }
        self.absorbed_pieces += 1;
        if self.absorbed_pieces == self.pieces() {
            self.absorbed_pieces = 0;
            self.shots += 1;
            self.unshot[shooter as usize] = [0.0; 3];
            for (j, more) in std::mem::take(&mut self.arrived) {
                self.unshot[j] = plus(self.unshot[j], more);
            }
            self.choose();
        }
    }

    fn solution(&self, problem: &Problem) -> Solution {
        let ambient = if self.settings.ambient { self.ambient() } else { [0.0; 3] };
        let Settings { factors, unshot, ambient: with_ambient, .. } = &self.settings;
        let parameters = vec![
            ("resolution", factors.resolution.to_string()),
            ("hemicubes", factors.hemicubes.to_string()),
            ("unshot", unshot.to_string()),
            ("ambient", with_ambient.to_string()),
            ("shots", self.shots.to_string()),
        ];
        Solution {
            irradiance: self.irradiance.iter().map(|&e| to_rgb(plus(e, ambient))).collect(),
            std_error: vec![Rgb::grey(f32::NAN); self.irradiance.len()],
            certainty: None,
            work: Work { rays: self.rays, replicates: 0 },
            balance: Balance { absorbed: self.surfaces.absorbed(&self.irradiance), ..self.flux },
            provenance: provenance(problem, NAME, parameters, factors.seed),
            groups: Vec::new(),
        }
    }

    fn fits(&self, problem: &Problem) -> bool {
        let elements = problem.mesh.len();
        let shooter = self.shooter.is_none_or(|shooter| (shooter as usize) < elements);
        shooter && [self.irradiance.len(), self.unshot.len()] == [elements; 2] && self.surfaces.fits(elements)
    }

    fn progress(&self) -> Progress {
        let unshot = self.flux.unshot / self.flux.emitted.max(f64::MIN_POSITIVE);
        Progress {
            stage: "shooting",
            rays: self.rays,
            rays_in_all: None,
            unshot,
            rms_error: None,
            asked: None,
            bias: None,
            excess: None,
        }
    }
}
