//! Light sampling: directions from a point of an element towards what lights it.
//!
//! An emitter is chosen in proportion to what it is believed to give the element (see [`cut`]), then a direction uniform in the
//! solid angle in which the point sees it (see [`crate::math::spherical_triangle`]). Unoccluded light of a distant lamp then
//! counts the same in every direction. Densities are known for every direction, so light rays combine with others by
//! multiple importance sampling. Each direction in which an emitter of luminance above zero could light the element has a
//! density above zero. Cost: [`LightSampler::cut`] a few microseconds an element, then a tenth of one a direction; memory 200 bytes
//! an emitter, and 4 an element.

pub mod cut;
pub mod emitter;
mod receiver;
mod tree;

pub use cut::Cut;
pub use emitter::{Aim, Emitter};
pub use receiver::Receiver;

use crate::Problem;
use crate::geometry::{Hit, NONE, Ray};
use crate::scene::Shape;
use emitter::emitters;
use glam::{Vec2, Vec3};
use tree::Node;

/// All emitting surfaces of a problem, ready to be sampled.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct LightSampler {
    emitters: Vec<Emitter>,
    nodes: Vec<Node>,
    /// Flux [lm] of all emitters before each, and of all at the end.
    flux_before: Vec<f64>,
    /// Emitter of each element, or [`NONE`].
    of_element: Vec<u32>,
}

impl LightSampler {
    pub fn new(problem: &Problem) -> LightSampler {
        let (mut emitters, mut of_element) = emitters(problem);
        let everything = problem.geometry.bounding_sphere();
        let around = |emitter: &Emitter| match problem.scene.shape {
            Shape::Triangles => sphere_around(emitter.corners),
            Shape::Sphere { .. } => everything,
        };
        let (nodes, order) = tree::build(&mut emitters, around);
        let mut number = vec![NONE; order.len()];
        order.iter().zip(0..).for_each(|(&old, new)| number[old as usize] = new);
        of_element.iter_mut().for_each(|emitter| *emitter = number.get(*emitter as usize).copied().unwrap_or(NONE));
        let mut flux_before = vec![0.0];
        flux_before.extend(emitters.iter().scan(0.0, |sum, emitter| {
            *sum += emitter.flux();
            Some(*sum)
        }));
        LightSampler { emitters, nodes, flux_before, of_element }
    }

    /// All emitters, neighbours in space mostly neighbours in number.
    pub fn emitters(&self) -> &[Emitter] {
        &self.emitters
    }

    /// Prepares `cut` for the light rays of `receiver`.
    pub fn cut(&self, receiver: &Receiver, cut: &mut Cut) {
        cut.make(&self.nodes, &self.emitters, receiver);
    }

    /// The direction from `eye`, a point of the receiver of `cut`, that belongs to `s` in the unit square, and the emitter at
    /// which it aims; `None` if there is nothing to see.
    pub fn aim(&self, problem: &Problem, cut: &Cut, eye: Vec3, s: Vec2) -> Option<(u32, Aim)> {
        let choice = cut.choose(&self.flux_before, s.x)?;
        let aim = self.emitters[choice.emitter as usize].aim(problem, eye, Vec2::new(choice.rest, s.y))?;
        Some((choice.emitter, Aim { density: aim.density * choice.probability as f32, ..aim }))
    }

    /// The emitter that a ray sees, or `None` if what it hits does not emit.
    pub fn emitter_at(&self, problem: &Problem, hit: &Hit) -> Option<u32> {
        if hit.is_miss() || self.emitters.is_empty() {
            return None;
        }
        let element = problem.mesh.at(hit.triangle, hit.uv, hit.back)?;
        Some(self.of_element[element as usize]).filter(|&emitter| emitter != NONE)
    }

    /// Density [1/sr] with which [`LightSampler::aim`] gives the direction of `ray`, which ends with `hit` on `emitter`.
    pub fn density(&self, problem: &Problem, cut: &Cut, ray: &Ray, hit: &Hit, emitter: u32) -> f32 {
        let probability = cut.probability(&self.flux_before, emitter) as f32;
        if probability == 0.0 {
            return 0.0;
        }
        let emitter = &self.emitters[emitter as usize];
        probability * emitter.density(problem, ray.origin, ray.direction, hit.t, hit.uv)
    }
}

/// A sphere around a triangle: centroid and radius [m].
fn sphere_around(corners: [Vec3; 3]) -> (Vec3, f32) {
    let center = (corners[0] + corners[1] + corners[2]) / 3.0;
    (center, corners.iter().map(|corner| corner.distance(center)).fold(0.0, f32::max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Resolution;
    use crate::scene::builtin::builtin;

    /// In a room of many lamps: the probabilities of all emitters sum to one, and each is the share of the numbers that choose it.
    #[test]
    fn emitters_are_chosen_with_the_probabilities_stated() {
        const NUMBERS: u32 = 1 << 14;
        let problem = Problem::new(builtin("office").unwrap(), Resolution::Elements(1)).unwrap();
        let sampler = LightSampler::new(&problem);
        assert!(sampler.emitters.len() > 1000);
        let mut cut = Cut::default();
        for e in problem.mesh.elements().step_by(1999) {
            sampler.cut(&Receiver::new(&problem, e), &mut cut);
            if cut.is_empty() {
                continue;
            }
            let mut chosen = vec![0; sampler.emitters.len()];
            for k in 0..NUMBERS {
                let choice = cut.choose(&sampler.flux_before, k as f32 / NUMBERS as f32).unwrap();
                assert!((0.0..1.0).contains(&choice.rest));
                let stated = cut.probability(&sampler.flux_before, choice.emitter);
                assert!((choice.probability / stated - 1.0).abs() < 1e-9, "{choice:?} {stated}");
                chosen[choice.emitter as usize] += 1;
            }
            let stated = (0..).zip(&chosen).map(|(k, _)| cut.probability(&sampler.flux_before, k));
            let mut total = 0.0;
            for (stated, &chosen) in stated.zip(&chosen) {
                total += stated;
                assert!(
                    (stated * f64::from(NUMBERS) - f64::from(chosen)).abs() <= 1.0,
                    "element {e}: {stated} {chosen}"
                );
            }
            assert!((total - 1.0).abs() < 1e-9, "element {e}: {total}");
        }
    }

    /// The other way round: seen from where it hits, a direction has the density with which it was chosen.
    #[test]
    fn rays_that_hit_what_they_aim_at_have_the_density_stated() {
        for name in ["box", "sphere"] {
            let problem = Problem::new(builtin(name).unwrap(), Resolution::Elements(200)).unwrap();
            let sampler = LightSampler::new(&problem);
            let mut cut = Cut::default();
            for e in problem.mesh.elements() {
                let receiver = Receiver::new(&problem, e);
                let eye = receiver.center + receiver.normal * problem.geometry.lift();
                sampler.cut(&receiver, &mut cut);
                for k in 0..32u8 {
                    let s = Vec2::new((f32::from(k) + 0.5) / 32.0, (f32::from(k) * 0.618).fract());
                    let Some((emitter, aim)) = sampler.aim(&problem, &cut, eye, s) else { continue };
                    let ray = Ray { origin: eye, direction: aim.direction, from: problem.mesh.triangle(e) };
                    let mut hit = [Hit::MISS];
                    problem.geometry.closest(&[ray], &mut hit);
                    let grazing = aim.direction.dot(receiver.normal) < 0.05;
                    if grazing || sampler.emitter_at(&problem, &hit[0]) != Some(emitter) {
                        continue;
                    }
                    let density = sampler.density(&problem, &cut, &ray, &hit[0], emitter);
                    assert!((density / aim.density - 1.0).abs() < 1e-3, "{name}, element {e}: {density} {aim:?}");
                }
            }
        }
    }
}
