//! The radiosity system in double precision: form factors, and what elements emit and reflect.

use crate::Problem;
use crate::form_factors::FormFactors;
use crate::math::Rgb;
use crate::solution::Balance;

/// Three channels in double precision.
pub type Light = [f64; 3];

/// `B = Be + rho E`, `E = F B`.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct System {
    pub factors: FormFactors,
    pub surfaces: Surfaces,
}

/// What elements emit [lm/m²] and reflect, and their areas [m²].
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Surfaces {
    pub emission: Vec<Light>,
    pub reflectivity: Vec<Light>,
    pub area: Vec<f64>,
}

impl Surfaces {
    pub fn of(problem: &Problem) -> Surfaces {
        let mesh = &problem.mesh;
        Surfaces {
            emission: mesh.elements().map(|e| to_light(mesh.emission(e))).collect(),
            reflectivity: mesh.elements().map(|e| to_light(mesh.reflectivity(e))).collect(),
            area: mesh.elements().map(|e| f64::from(mesh.area(e))).collect(),
        }
    }

    /// Whether they are those of so many elements.
    pub fn fits(&self, elements: usize) -> bool {
        [self.emission.len(), self.reflectivity.len(), self.area.len()] == [elements; 3]
    }

    /// Radiosity [lm/m²] of element `i` under the irradiance `e` [lux].
    pub fn radiosity(&self, i: usize, e: Light) -> Light {
        std::array::from_fn(|c| self.emission[i][c] + self.reflectivity[i][c] * e[c])
    }

    /// Luminous flux [lm] of one light [lm/m²] on each element.
    pub fn flux(&self, lights: impl Iterator<Item = Light>) -> f64 {
        lights.zip(&self.area).map(|(light, area)| area * luminance(light)).sum()
    }

    pub fn emitted(&self) -> f64 {
        self.flux(self.emission.iter().copied())
    }

    /// Flux [lm] that surfaces absorb under `irradiance` [lux].
    pub fn absorbed(&self, irradiance: &[Light]) -> f64 {
        let share = |(e, rho): (&Light, &Light)| std::array::from_fn(|c| (1.0 - rho[c]) * e[c]);
        self.flux(irradiance.iter().zip(&self.reflectivity).map(share))
    }
}

impl System {
    /// Whether it is that of so many elements.
    pub fn fits(&self, elements: usize) -> bool {
        self.factors.len() == elements && self.surfaces.fits(elements)
    }

    /// `(F B)_i` [lux] for the radiosities `b`.
    pub fn gathered(&self, i: usize, b: &[Light]) -> Light {
        self.factors.row(i).fold([0.0; 3], |sum, (j, f)| std::array::from_fn(|c| sum[c] + f * b[j][c]))
    }

    /// Where the light of `irradiance` E went. Unshot is what arrives from the radiosities Be + rho E beyond E: the residual
    /// of the system. What rows lack to one has escaped. Closes because form factors are reciprocal.
    pub fn balance(&self, irradiance: &[Light]) -> Balance {
        let surfaces = &self.surfaces;
        let b: Vec<Light> = irradiance.iter().enumerate().map(|(i, &e)| surfaces.radiosity(i, e)).collect();
        let beyond = |(i, e): (usize, &Light)| minus(self.gathered(i, &b), *e);
        let sent = |i: usize| surfaces.area[i] * luminance(b[i]);
        let back_face: f64 = (0..b.len()).map(|i| sent(i) * self.factors.back_face(i)).sum();
        let lost: f64 = (0..b.len()).map(|i| sent(i) * (1.0 - self.factors.row_sum(i))).sum();
        Balance {
            emitted: surfaces.emitted(),
            absorbed: surfaces.absorbed(irradiance),
            escaped: lost - back_face,
            back_face,
            unshot: surfaces.flux(irradiance.iter().enumerate().map(beyond)),
        }
    }
}

pub fn to_light(color: Rgb) -> Light {
    color.to_array().map(f64::from)
}

pub fn to_rgb(light: Light) -> Rgb {
    Rgb::from(light.map(|v| v as f32))
}

/// Luminance of linear Rec. 709, as [`Rgb::luminance_f64`].
pub fn luminance([r, g, b]: Light) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

pub fn minus(a: Light, b: Light) -> Light {
    std::array::from_fn(|c| a[c] - b[c])
}

pub fn plus(a: Light, b: Light) -> Light {
    std::array::from_fn(|c| a[c] + b[c])
}

/// `light` times `factors`, channel by channel.
pub fn times(light: Light, factors: Light) -> Light {
    std::array::from_fn(|c| light[c] * factors[c])
}
