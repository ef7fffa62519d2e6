//! How unevenly surfaces reflect, and up to which level of radiosity elements had better be gathered from.
//!
//! Bright elements tell more by the rays that they shoot, all others by the lines that cross them. So the radiosity of an element
//! is cut in two at a level L: others gather `min(B, L)`, and the surplus `B - min(B, L)` is shot. Both are linear in
//! light, whatever L is: their sum is without bias.
//!
//! c crossings and s rays of surplus leave a square metre of all surfaces, in the mean. For an element of area A the variance is
//! then
//!
//! ```text
//! V(L) / (c A)  +  E_s P(L) / (s A),
//! ```
//!
//! with V the variance over all surfaces of what is gathered, P [lm/m²] the mean surplus, and E_s the irradiance by it. The best L
//! does not depend on A. It lies where a crossing carries as much as a ray: `L / c = P / s`.
//!
//! Radiosities are counted in bins of half an octave. Cost: one look at each element.

/// Bins, around the mean radiosity.
const BINS: usize = 64;
const MIDDLE: f64 = 32.0;
const BINS_OF_OCTAVE: f64 = 2.0;
/// Least variance of radiosities, relative to the square of their mean: no room is lit evenly. What looks so is noise.
const EVEN: f64 = 0.25;

/// Flux [lm] of the rays that shoot direct light, and of those that shoot reflected light.
pub type RayFlux = [f64; 2];

/// An element, as it counts here.
pub struct Reflecting {
    /// [m²].
    pub area: f64,
    /// [lm/m²].
    pub radiosity: f64,
    /// Variance of the radiosity for each lumen of a ray, times the area [lm/m²]: of direct and of reflected light.
    pub noise: [f64; 2],
}

/// Sums over elements, of radiosities up to one level.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
struct Sums {
    /// Share of the area.
    area: f64,
    /// Mean radiosity [lm/m²], with 0 for the others, and mean square.
    power: f64,
    square: f64,
    /// What noise adds to the mean square for each lumen of a ray [lm/m⁴].
    noise: [f64; 2],
}

impl Sums {
    fn add(&mut self, other: &Sums) {
        self.area += other.area;
        self.power += other.power;
        self.square += other.square;
        self.noise.iter_mut().zip(other.noise).for_each(|(sum, noise)| *sum += noise);
    }

    /// What noise adds to the mean square.
    fn noise_of(&self, ray_flux: RayFlux) -> f64 {
        self.noise.iter().zip(ray_flux).map(|(noise, flux)| noise * flux).sum()
    }
}

/// How radiosities are spread over the surfaces of a scene.
#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Spread {
    mean: f64,
    /// Of the rays by which they were measured.
    ray_flux: RayFlux,
    /// Up to the level of each bin.
    up_to: Vec<Sums>,
}

/// A way to tell what is gathered from what is shot.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Split {
    /// L [lm/m²].
    pub level: f64,
    /// Mean of what is gathered [lm/m²], and its variance but for its noise, which is apart.
    pub mean: f64,
    pub variance: f64,
    pub noise: f64,
    /// Variance by the rays of the surplus, for an element of 1 m² [lux²].
    pub variance_of_surplus: f64,
}

impl Spread {
    /// Of elements whose mean radiosity is `mean` [lm/m²] over `area` [m²], measured by such rays.
    pub fn of(elements: impl Iterator<Item = Reflecting>, area: f64, mean: f64, ray_flux: RayFlux) -> Spread {
        let mut up_to = vec![Sums::default(); BINS];
        for Reflecting { area: a, radiosity, noise } in elements {
            let share = a / area;
            let (power, square) = (share * radiosity, share * radiosity * radiosity);
            let noise = noise.map(|noise| noise / area);
            up_to[bin_of(radiosity / mean)].add(&Sums { area: share, power, square, noise });
        }
        for k in 1..BINS {
            let before = up_to[k - 1];
            up_to[k].add(&before);
        }
        Spread { mean, ray_flux, up_to }
    }

    /// The best way to split what elements reflect, where so many `crossings` and `rays` of surplus leave a square metre, and what they
    /// reflect is known from such rays. Without rays all is gathered.
    pub fn split(&self, crossings: f64, rays: f64, ray_flux: RayFlux) -> Split {
        let all = self.at(BINS - 1, 0.0, ray_flux);
        if rays <= 0.0 || crossings <= 0.0 {
            return all;
        }
        let cost = |split: &Split| (split.variance + split.noise) / crossings + split.variance_of_surplus;
        let ways = (0..BINS).map(|k| self.at(k, rays, ray_flux));
        ways.min_by(|a, b| cost(a).total_cmp(&cost(b))).unwrap_or(all)
    }

    /// The split at the level of bin `k`.
    fn at(&self, k: usize, rays: f64, ray_flux: RayFlux) -> Split {
        let Some(below) = self.up_to.get(k) else { return Split::default() };
        if k + 1 == BINS {
            let (level, mean, variance) = (f64::INFINITY, self.mean, self.variance(below, 0.0, self.mean));
            return Split { level, mean, variance, noise: below.noise_of(ray_flux), variance_of_surplus: 0.0 };
        }
        let level = self.mean * ((k as f64 + 1.0 - MIDDLE) / BINS_OF_OCTAVE).exp2();
        let above = (1.0 - below.area).max(0.0);
        let mean = below.power + above * level;
        let surplus = (self.mean - mean).max(0.0);
        Split {
            level,
            mean,
            variance: self.variance(below, above * level * level, mean),
            noise: below.noise_of(ray_flux),
            variance_of_surplus: surplus * surplus / rays,
        }
    }

    /// The variance where those `below` the level are seen in full, and the others add that much to the mean square.
    fn variance(&self, below: &Sums, square_above: f64, mean: f64) -> f64 {
        let measured = below.square + square_above - mean * mean - below.noise_of(self.ray_flux);
        measured.max(EVEN * mean * mean)
    }
}

/// The bin of a radiosity relative to the mean.
fn bin_of(relative: f64) -> usize {
    if relative > 0.0 { (BINS_OF_OCTAVE * relative.log2() + MIDDLE).clamp(0.0, BINS as f64 - 1.0) as usize } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NO_NOISE: RayFlux = [0.0; 2];

    /// A hundredth of the area a hundred times as bright as the rest.
    fn spotted() -> Spread {
        let elements = (0..1000).map(|k| {
            let radiosity = if k % 100 == 0 { 100.0 } else { 1.0 };
            Reflecting { area: 0.5, radiosity, noise: [0.5 * radiosity, 0.0] }
        });
        Spread::of(elements, 500.0, 1.99, NO_NOISE)
    }

    #[test]
    fn all_is_gathered_without_rays_for_the_surplus() {
        let all = spotted().split(1000.0, 0.0, [2.0, 9.0]);
        assert!(all.level.is_infinite() && (all.mean - 1.99).abs() < 1e-9 && all.variance_of_surplus == 0.0);
        assert!((all.variance - (0.99 + 0.01 * 1e4 - 1.99 * 1.99)).abs() < 1e-9, "{}", all.variance);
        // Rays of 2 lm: the sum of rho B over the area, 2 lm each.
        assert!((all.noise - 2.0 * 0.5 * 1000.0 * 1.99 / 500.0).abs() < 1e-9, "{}", all.noise);
    }

    #[test]
    fn bright_spots_shoot_and_a_crossing_carries_as_much_as_a_ray() {
        let (crossings, rays) = (1000.0, 200.0);
        let split = spotted().split(crossings, rays, NO_NOISE);
        let (of_crossing, of_ray) = (split.level / crossings, (1.99 - split.mean) / rays);
        assert!((of_crossing / of_ray).log2().abs() < 1.0, "{split:?}");
        let gathered = spotted().split(crossings + 8.0 * rays, 0.0, NO_NOISE).variance / (crossings + 8.0 * rays);
        let gain = gathered / (split.variance / crossings + split.variance_of_surplus);
        assert!(gain > 3.0, "{gain}");
    }
}
