//! What neighbouring elements have learned together about the rays that look for lights.
//!
//! A ray of an element has the variance v, and shooting with Φ lumens a ray `V_s = E Φ / A`. With
//!
//! ```text
//! n = (k sqrt(a v) - v / V_s)+
//! ```
//!
//! rays for each element the sum of `a V` over all elements is least (Neyman 1934), where V is the merged variance. With a = A that
//! would be the area-weighted mean square error, with a = 1 the plain one; `a = A^(1/2)` serves both.

use super::{COSINE_SHARES, LEAST_WANTED};
use crate::mesh::ElementMesh;
use crate::solvers::allocation::{importance, level};

/// Elements that learn from each other, one after the other in the mesh.
const NEIGHBOURS: usize = 64;
/// Number in [`COSINE_SHARES`] of the first share.
const FIRST_SHARE: u8 = 1;
/// Rays of the mean of all elements that count as the neighbours' own, as long as these have sent few.
const RAYS_OF_PRIOR: f32 = 4.0;
/// Least variance of a ray, relative to the square of the mean: few rays cannot tell that there is less.
const EVEN: f32 = 0.01;

/// All neighbours.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Neighbours {
    learned: Vec<Learned>,
    /// What the running round teaches, with what was learned before.
    fresh: Vec<Learned>,
}

/// What some neighbours have learned: sums over their rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
struct Learned {
    rays: f32,
    irradiance: f32,
    variances: [f32; COSINE_SHARES.len()],
    /// Number in [`COSINE_SHARES`] of their share of cosine rays.
    share: u8,
}

impl Learned {
    /// Adds what `weight` times the rays of others have told.
    fn add(&mut self, other: &Learned, weight: f32) {
        self.rays += weight * other.rays;
        self.irradiance += weight * other.irradiance;
        self.variances.iter_mut().zip(other.variances).for_each(|(sum, variance)| *sum += weight * variance);
    }
}

impl Neighbours {
    /// Nothing learned yet about so many elements.
    pub fn new(elements: usize) -> Neighbours {
        let learned = Learned { share: FIRST_SHARE, ..Learned::default() };
        let of_all = vec![learned; elements.div_ceil(NEIGHBOURS)];
        Neighbours { learned: of_all.clone(), fresh: of_all }
    }

    /// Whether they are of so many elements.
    pub fn fits(&self, elements: usize) -> bool {
        [self.learned.len(), self.fresh.len()] == [elements.div_ceil(NEIGHBOURS); 2]
    }

    /// Takes in what `rays` rays of element `e` tell: its irradiance [lux], and the variance of a ray with each share [lux²].
    pub fn learn(&mut self, e: u32, rays: u32, irradiance: f32, variances: [f32; COSINE_SHARES.len()]) {
        let told = Learned { rays: 1.0, irradiance, variances, share: FIRST_SHARE };
        self.fresh[e as usize / NEIGHBOURS].add(&told, rays as f32);
    }

    /// The share of cosine rays that suits element `e`.
    pub fn cosine_share(&self, e: u32) -> f32 {
        COSINE_SHARES[usize::from(self.of(e).share)]
    }

    /// What the round taught holds from now on. Where few rays were sent the mean over all elements stands in.
    pub fn end_round(&mut self) {
        let mut all = Learned::default();
        self.fresh.iter().for_each(|fresh| all.add(fresh, 1.0));
        let few = if all.rays > 0.0 { RAYS_OF_PRIOR / all.rays } else { 0.0 };
        for (learned, fresh) in self.learned.iter_mut().zip(&self.fresh) {
            *learned = *fresh;
            learned.add(&all, few);
            let best = (0..).zip(learned.variances).min_by(|a, b| a.1.total_cmp(&b.1));
            learned.share = best.map_or(FIRST_SHARE, |(share, _)| share);
        }
    }

    /// What the sum of `A^(1/2) V` over `elements` would be if they had `rays` rays together, merged with rays of so much flux [lm].
    pub fn expected_variance(
        &self,
        mesh: &ElementMesh,
        elements: impl Iterator<Item = u32> + Clone,
        rays: f64,
        ray_flux: f64,
    ) -> f64 {
        let each = self.rays_for_need(mesh, elements.clone(), rays, ray_flux);
        let of_element = |e| {
            let (own, worth) = (self.wanted(mesh, e, each, ray_flux), self.worth_of_shooting(mesh, e, ray_flux));
            let own = if own < LEAST_WANTED { 0.0 } else { own };
            let variance = self.expected(e).1;
            if variance > 0.0 { importance(mesh.area(e).into()) * variance / (own + worth) } else { 0.0 }
        };
        elements.map(of_element).sum()
    }

    /// The k with which `elements` want `rays` rays together.
    pub fn rays_for_need(
        &self,
        mesh: &ElementMesh,
        elements: impl Iterator<Item = u32> + Clone,
        rays: f64,
        ray_flux: f64,
    ) -> f64 {
        level(|each| elements.clone().map(|e| self.wanted(mesh, e, each, ray_flux)).sum(), rays)
    }

    /// Mean irradiance of the neighbours of element `e` [lux], and variance of a ray [lux²].
    fn expected(&self, e: u32) -> (f64, f64) {
        let Learned { rays, irradiance, variances, share } = *self.of(e);
        if rays <= 0.0 {
            return (0.0, 0.0);
        }
        let mean = irradiance / rays;
        (f64::from(mean), f64::from((variances[usize::from(share)] / rays).max(EVEN * mean * mean)))
    }

    /// `v / V_s`: rays that would tell as much as was shot.
    pub fn worth_of_shooting(&self, mesh: &ElementMesh, e: u32, ray_flux: f64) -> f64 {
        let (irradiance, variance) = self.expected(e);
        if irradiance <= 0.0 || ray_flux.is_infinite() {
            return 0.0;
        }
        variance * f64::from(mesh.area(e)) / (irradiance * ray_flux)
    }

    /// Rays that element `e` wants: `(k sqrt(a v) - v / V_s)+` with k = `each` and a its [`importance`].
    pub fn wanted(&self, mesh: &ElementMesh, e: u32, each: f64, ray_flux: f64) -> f64 {
        let need = (importance(mesh.area(e).into()) * self.expected(e).1).sqrt();
        (each * need - self.worth_of_shooting(mesh, e, ray_flux)).max(0.0)
    }

    fn of(&self, e: u32) -> &Learned {
        &self.learned[e as usize / NEIGHBOURS]
    }
}
