//! How well indirect light is known, from each of the ways to it.
//!
//! For an element of area A, as variances of its irradiance in one complete solution:
//!
//! - shooting: `E Φ / A`, with Φ [lm] the flux of each ray;
//! - D bundles that cross it N times: `V / N + 2 S / D`, with V the variance of the radiosity that a line may meet. The noise of what was
//!   shot is a part of it: `V = V_0 + Φ Σ rho² E / A_T`, a sum over all elements. The element has seen N points, but from D / 2 directions
//!   only; over a direction noise averages out, and the square of the mean radiosity stands for what is left, S;
//! - n local lines: `V' / n`, where V' has more noise, for these lines see light only where it has landed.
//!
//! Scene-wide means stand for E and V: weights that depended on an element's own noise would pull it towards low values.

use crate::Problem;
use crate::solvers::monte_carlo::relaxation::Relaxation;

/// Least variance of radiosities, relative to the square of their mean.
const EVEN: f64 = 0.25;

/// What a complete solution tells of the indirect light of a scene.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Indirect {
    /// Mean irradiance E [lux].
    irradiance: f64,
    /// V_0 [lux²].
    variance: f64,
    /// What noise adds to V, and to V', for each lumen of a ray [lux²/lm].
    noise: f64,
    noise_of_spots: f64,
    /// S [lux²].
    smooth: f64,
}

/// How well indirect light is known before local lines gather it, but for the area of an element.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Precision {
    /// V and V' [lux²].
    variance: f64,
    variance_of_spots: f64,
    /// `E Φ` [lux lm].
    shooting: f64,
    smooth: f64,
    bundles: f64,
    /// Crossings by all bundles together [1/m²].
    crossings_per_area: f64,
}

impl Indirect {
    /// What the light tells that was `shot` by rays of so much flux [lm].
    pub fn of(problem: &Problem, shot: &Relaxation, ray_flux: f64) -> Indirect {
        let (mesh, light) = (&problem.mesh, shot.light());
        let area = mesh.total_area();
        let (mut irradiance, mut noise, mut sum, mut sum_sq, mut sum_sq_spots) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for e in mesh.elements() {
            let (a, rho) = (f64::from(mesh.area(e)), mesh.reflectivity(e).luminance_f64());
            let radiosity = light.reflected_radiosity(mesh, e).luminance_f64();
            irradiance += light.indirect[e as usize].luminance_f64();
            noise += rho * radiosity;
            sum += a * radiosity;
            sum_sq += a * radiosity * radiosity;
            sum_sq_spots += a * radiosity * radiosity * light.footprint(e).mean_square();
        }
        let (irradiance, noise, mean) = (irradiance / area, noise / area, sum / area);
        // Where there is hardly anything but noise, it is not taken for all: no room is lit evenly.
        let variance = (sum_sq / area - mean * mean - noise * ray_flux).max(EVEN * mean * mean);
        let noise_of_spots = noise + (sum_sq_spots - sum_sq) / area / ray_flux.max(f64::MIN_POSITIVE);
        Indirect { irradiance, variance, noise, noise_of_spots, smooth: mean * mean }
    }

    /// How well it is known when rays of so much flux [lm] have shot, and `bundles` have crossed so often [1/m²].
    pub fn precision(&self, ray_flux: f64, bundles: f64, crossings_per_area: f64) -> Precision {
        Precision {
            variance: self.variance + self.noise * ray_flux,
            variance_of_spots: self.variance + self.noise_of_spots * ray_flux,
            shooting: self.irradiance * ray_flux,
            smooth: self.smooth,
            bundles,
            crossings_per_area,
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
        if self.bundles <= 0.0 || self.variance <= 0.0 {
            return 0.0;
        }
        let variance = self.variance / (area * self.crossings_per_area) + 2.0 * self.smooth / self.bundles;
        self.variance_of_spots / variance
    }

    /// Both together.
    pub fn lines(&self, area: f64) -> f64 {
        self.shot(area) + self.bundled(area)
    }

    /// Weight of what bundles gathered on an element of `area` [m²], against what was shot.
    pub fn weight_of_bundles(&self, area: f64) -> f32 {
        let lines = self.lines(area);
        if lines > 0.0 { (self.bundled(area) / lines) as f32 } else { 0.0 }
    }

    /// The number of lines that elements of these `areas` [m²] shall be known to, so that they lack `rays` of them together.
    pub fn limit(&self, areas: impl Iterator<Item = f64> + Clone, rays: f64) -> f64 {
        let lacking = |limit: f64| areas.clone().map(|area| (limit - self.lines(area)).max(0.0)).sum::<f64>();
        let (mut low, mut high) = (0.0, 1.0);
        while lacking(high) < rays && high < 1e30 {
            (low, high) = (high, 4.0 * high);
        }
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if lacking(middle) > rays { high = middle } else { low = middle }
        }
        high
    }

    /// What the sum of `sqrt(A) V` over elements of these `areas` [m²] would be if `rays` local lines gathered for them.
    pub fn expected_variance(&self, areas: impl Iterator<Item = f64> + Clone, rays: f64) -> f64 {
        let limit = if rays > 0.0 { self.limit(areas.clone(), rays) } else { 0.0 };
        areas.map(|area| area.sqrt() * self.variance_of_spots / self.lines(area).max(limit)).sum()
    }
}
