//! How well indirect light is known, from each of the ways to it.
//!
//! For an element of area A, as variances of its irradiance in one complete solution:
//!
//! - shooting: `E Φ / A`, with Φ [lm] the flux of each ray;
//! - D bundles that cross it N times, and the surplus that bright elements shoot: `(V + n) / N + V_s / A + 2 V / D`, with V, its noise n
//!   and V_s those of [`Split`]. The element has seen N points, but from D / 2 directions only. An element that is hardly ever crossed
//!   is told by the sum of what it sees, not by the mean: it has the mean square instead of the variance;
//! - m local lines: `V' / m`, where V' is the variance of all radiosity. It has more noise, for these lines see light only where it has
//!   landed.
//!
//! Over many lines noise averages out, but for that of its [`surroundings`](super::surroundings), `l n`. All that gathers sees the same
//! surroundings, so this is left however much gathers: it decides how much shall shoot, not what shall gather.
//!
//! Scene-wide means stand for E and V: weights that depended on an element's own noise would pull it towards low values.

use super::spread::{RayFlux, Reflecting, Split, Spread};
use crate::Problem;
use crate::solvers::allocation::{importance, level};
use crate::solvers::monte_carlo::relaxation::Relaxation;

/// So often an element is crossed at least where crossings are counted.
const FEW: f64 = 1.0;

/// What a complete solution tells of the indirect light of a scene.
#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Indirect {
    /// Mean irradiance E [lux], and mean radiosity [lm/m²].
    irradiance: f64,
    radiosity: f64,
    spread: Spread,
    /// How much more the noise is to lines that see light only where it has landed.
    spots: f64,
    /// The share of the noise that lasts.
    lasting: f64,
}

/// How well indirect light is known before local lines gather it, but for the area of an element.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Precision {
    split: Split,
    /// V' [lux²].
    variance_of_spots: f64,
    /// `E Φ`, and V_s for 1 m² [lux lm].
    shooting: f64,
    surplus: f64,
    /// `l n` [lux²].
    lasting: f64,
    bundles: f64,
    /// Crossings by all bundles together [1/m²].
    crossings: f64,
}

impl Indirect {
    /// What the light tells that was `shot` by such rays; `lasting` is the share of noise that no number of lines takes away.
    pub fn of(problem: &Problem, shot: &Relaxation, ray_flux: RayFlux, lasting: f64) -> Indirect {
        let (mesh, light) = (&problem.mesh, shot.light());
        let area = mesh.total_area();
        let (mut irradiance, mut power, mut noise, mut excess) = (0.0, 0.0, 0.0, 0.0);
        let reflecting = |e| {
            let rho = mesh.reflectivity(e).luminance_f64();
            let radiosity = light.reflected_radiosity(mesh, e).luminance_f64();
            let area = f64::from(mesh.area(e));
            let noise =
                [light.shot_first(e), light.indirect[e as usize]].map(|flux| rho * rho * flux.luminance_f64() / area);
            Reflecting { area, radiosity, noise }
        };
        for e in mesh.elements() {
            let Reflecting { area, radiosity, noise: [of_direct, of_reflected] } = reflecting(e);
            irradiance += light.indirect[e as usize].luminance_f64();
            power += area * radiosity;
            noise += of_direct * ray_flux[0] + of_reflected * ray_flux[1];
            excess += area * radiosity * radiosity * (light.footprint(e).mean_square() - 1.0);
        }
        let mean = power / area;
        Indirect {
            irradiance: irradiance / area,
            radiosity: mean,
            spread: Spread::of(mesh.elements().map(reflecting), area, mean, ray_flux),
            spots: if noise > 0.0 { 1.0 + excess / noise } else { 1.0 },
            lasting,
        }
    }

    /// How well it is known when such rays have shot, and `bundles` have crossed and so many rays of surplus have left so
    /// often [1/m²].
    pub fn precision(&self, ray_flux: RayFlux, bundles: f64, crossings: f64, surplus: f64) -> Precision {
        let split = self.spread.split(crossings, surplus, ray_flux);
        let all = self.spread.split(0.0, 0.0, ray_flux);
        let received = if self.radiosity > 0.0 { self.irradiance / self.radiosity } else { 0.0 };
        Precision {
            split,
            variance_of_spots: all.variance + self.spots * all.noise,
            shooting: self.irradiance * ray_flux[1],
            surplus: split.variance_of_surplus * received,
            lasting: self.lasting * all.noise,
            bundles,
            crossings,
        }
    }
}

impl Precision {
    /// Local lines that would gather as well as an element of `area` [m²] was shot.
    fn shot(&self, area: f64) -> f64 {
        if self.shooting > 0.0 { self.variance_of_spots * area / self.shooting } else { 0.0 }
    }

    /// Local lines that would gather as well as bundles do.
    fn bundled(&self, area: f64) -> f64 {
        if self.bundles <= 0.0 || self.split.variance <= 0.0 {
            return 0.0;
        }
        let Split { mean, variance, noise, .. } = self.split;
        let crossings = area * self.crossings;
        let of_crossings = match self.crossings_of_rarely_crossed(area) {
            Some(_) => (variance + noise + mean * mean) / crossings,
            None => (variance + noise) / crossings * (1.0 + 1.0 / crossings),
        };
        self.variance_of_spots / (of_crossings + self.surplus / area + 2.0 * variance / self.bundles)
    }

    /// Crossings that are expected of an element of `area` [m²], if they are so few that what they see had better be divided by that
    /// number, not by theirs: some of such elements are not crossed at all.
    pub fn crossings_of_rarely_crossed(&self, area: f64) -> Option<f64> {
        let crossings = area * self.crossings;
        let mean_square = self.split.mean * self.split.mean;
        ((crossings - FEW) * mean_square < self.split.variance + self.split.noise).then_some(crossings)
    }

    /// Both together.
    pub fn lines(&self, area: f64) -> f64 {
        self.shot(area) + self.bundled(area)
    }

    /// The level [lm/m²] up to which bundles gather; what is beyond it is shot.
    pub fn level(&self) -> f64 {
        self.split.level
    }

    /// Weight of what bundles gathered on an element of `area` [m²], against what was shot.
    pub fn weight_of_bundles(&self, area: f64) -> f32 {
        let lines = self.lines(area);
        if lines > 0.0 { (self.bundled(area) / lines) as f32 } else { 0.0 }
    }

    /// The number of lines that elements of these `areas` [m²] shall be known to, so that they lack `rays` of them together.
    pub fn limit(&self, areas: impl Iterator<Item = f64> + Clone, rays: f64) -> f64 {
        level(|limit| areas.clone().map(|area| (limit - self.lines(area)).max(0.0)).sum(), rays)
    }

    /// What the sum of `A^(1/2) V` over elements of these `areas` [m²] would be if `rays` local lines gathered for them.
    pub fn expected_variance(&self, areas: impl Iterator<Item = f64> + Clone, rays: f64) -> f64 {
        let limit = self.limit(areas.clone(), rays);
        let variance = |area| self.variance_of_spots / self.lines(area).max(limit) + self.lasting;
        areas.map(|area| importance(area) * variance(area)).sum()
    }
}
