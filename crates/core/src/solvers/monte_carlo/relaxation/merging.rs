//! Shooting and gathering merged by inverse variance, element by element.
//!
//! For the irradiance of element i with area `A_i` (Bekaert 1999, divided by `rho_i²`):
//!
//! - shooting: `V_s = E_i Φ / A_i`, with Φ [lm] the flux each ray carries;
//! - gathering with `n_i` rays: `V_g = Var(B) / n_i`, with the variance of the radiosities that a line may meet.
//!
//! The weight of gathering is `V_s / (V_s + V_g)`. Scene-wide means stand for `E_i` and `Var(B)`: weights that depended on the
//! element's own noise would pull its estimate towards low values. Direct and indirect light are merged separately,
//! for few lines meet an emitter and all meet a wall.

use crate::Problem;
use crate::math::Rgb;
use crate::solvers::allocation::{Allocation, level};
use crate::solvers::monte_carlo::light::Light;
use crate::transport::Footprint;

/// The two variances of one kind of light, but for area and rays of the element: `V_s = shooting / A`, `V_g = gathering / n`.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Variances {
    pub shooting: f64,
    pub gathering: f64,
}

/// Variances of direct and indirect light in one complete solution.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Merging {
    pub direct: Variances,
    pub indirect: Variances,
}

impl Variances {
    /// Variances of light that falls with mean irradiance `mean_irradiance` [lux], shot with `ray_flux` [lm] a ray, where
    /// gathering meets radiosities of variance `radiosity_variance` [lux²].
    pub fn new(mean_irradiance: f64, ray_flux: f64, radiosity_variance: f64) -> Variances {
        Variances { shooting: mean_irradiance * ray_flux, gathering: radiosity_variance }
    }

    /// Weight of gathering with `n` rays on an element of `area` [m²].
    pub fn weight(self, area: f32, n: u32) -> f32 {
        let (s, g) = (self.shooting * f64::from(n), self.gathering * f64::from(area));
        if s > 0.0 { (s / (s + g)) as f32 } else { 0.0 }
    }
}

impl Merging {
    /// What to expect of an element of a scene so lit, whose emitted and reflected light was shot with so much flux [lm] a ray.
    pub fn expect(problem: &Problem, light: &Light, emission_ray_flux: f64, reflected_ray_flux: f64) -> Merging {
        let mesh = &problem.mesh;
        // A line meets radiosity Be with probability E / Be: variance E Be, averaged over the emitted power.
        let (mut power, mut power_exitance) = (0.0, 0.0);
        for e in mesh.elements().filter(|&e| !mesh.emission(e).is_black()) {
            let emitted = mesh.emitted_flux(e).luminance_f64();
            power += emitted;
            power_exitance += emitted * mesh.emission(e).luminance_f64();
        }
        let exitance = if power > 0.0 { power_exitance / power } else { 0.0 };
        let (direct, indirect) = (mean_irradiance(problem, &light.direct), mean_irradiance(problem, &light.indirect));
        let variance = radiosity_variance(problem, |e| (light.reflected_radiosity(mesh, e), light.footprint(e)));
        Merging {
            direct: Variances::new(direct, emission_ray_flux, direct * exitance),
            indirect: Variances::new(indirect, reflected_ray_flux, variance),
        }
    }

    /// Where direct light is of no interest: nothing of it is gathered.
    pub fn of_indirect_light(self) -> Merging {
        Merging { direct: Variances::default(), ..self }
    }

    /// Weights of gathering for direct and indirect light.
    pub fn weights(&self, area: f32, n: u32) -> [f32; 2] {
        [self.direct.weight(area, n), self.indirect.weight(area, n)]
    }

    /// Distributes `rays` gathering rays so that the sum over all elements of the merged variances is least; `u` in [0, 1).
    ///
    /// By Lagrange's rule the merged variance `1 / (A_i / s + n_i / g)` is then the same for all elements that gather:
    /// `n_i` is proportional to `(A* - A_i)+`, and elements larger than some `A*` are left to shooting.
    pub fn allocate(&self, problem: &Problem, rays: u64, u: f64) -> Allocation {
        let shooting = self.direct.shooting + self.indirect.shooting;
        let gathering = self.direct.gathering + self.indirect.gathering;
        if shooting <= 0.0 || gathering <= 0.0 {
            // Nothing to clean, or every line sees the same: any distribution does.
            let equal = problem.mesh.elements().map(|e| (e, 1.0));
            return Allocation::systematic(equal, problem.mesh.len() as f64, rays, u);
        }
        let areas = problem.mesh.areas().map(|(area, count)| (f64::from(area), f64::from(count)));
        let wanted = |limit: f64| areas.clone().map(|(area, count)| count * (limit - area).max(0.0)).sum::<f64>();
        let target = rays as f64 * shooting / gathering;
        let limit = level(wanted, target);
        let weights = problem.mesh.elements().map(|e| (e, (limit - f64::from(problem.mesh.area(e))).max(0.0)));
        Allocation::systematic(weights, wanted(limit), rays, u)
    }
}

/// Variance over the scene's area of the luminance of `radiosity(e)` [lux²], which lies on a part of each element.
fn radiosity_variance(problem: &Problem, radiosity: impl Fn(u32) -> (Rgb, Footprint)) -> f64 {
    let (mut area, mut sum, mut sum_sq) = (0.0, 0.0, 0.0);
    for e in problem.mesh.elements() {
        let (radiosity, footprint) = radiosity(e);
        let (a, b) = (f64::from(problem.mesh.area(e)), radiosity.luminance_f64());
        area += a;
        sum += a * b;
        sum_sq += a * b * b * footprint.mean_square();
    }
    (sum_sq / area - (sum / area).powi(2)).max(0.0)
}

/// Area-weighted mean irradiance [lux, luminance] of a `flux` [lm] on every element.
fn mean_irradiance(problem: &Problem, flux: &[Rgb]) -> f64 {
    flux.iter().map(|f| f.luminance_f64()).sum::<f64>() / problem.mesh.total_area()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_those_of_the_inverse_variances() {
        let v = Variances::new(2.0, 3.0, 5.0);
        let (area, n) = (0.5, 7);
        let (shooting, gathering) = (2.0 * 3.0 / 0.5, 5.0 / 7.0);
        assert!((f64::from(v.weight(area, n)) - shooting / (shooting + gathering)).abs() < 1e-6);
        assert_eq!(v.weight(area, 0), 0.0);
        assert_eq!(Variances::default().weight(area, n), 0.0);
    }
}
