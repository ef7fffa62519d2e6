//! The light of one complete solution: what has fallen on each element, and what waits to be shot.
//!
//! Light is kept as flux [lm], in parts that converge differently and are merged with gathered light separately.

use super::{LightPart, to_rgb};
use crate::math::Rgb;
use crate::math::hash::{mix, unit_f64};
use crate::mesh::ElementMesh;
use crate::solvers::Part;
use crate::transport::{Footprint, Leaving};

/// Where light on an element comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Straight from a light without extent, which nothing can gather.
    Lamps,
    /// Straight from an emitting surface.
    Emission,
    /// From a reflection.
    Reflection,
}

/// What a step of shooting did with the light that landed [lm, luminance].
#[derive(Clone, Copy, Debug, Default)]
pub struct Landed {
    pub absorbed: f64,
    pub reflected: f64,
}

/// Flux on every element, 96 bytes each (108 in a scene with lights without extent).
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Light {
    lamps: Vec<Rgb>,
    pub direct: Vec<Rgb>,
    pub indirect: Vec<Rgb>,
    /// What waits to be shot; while elements gather, the radiosity [lm/m²] they see (see [`Light::show`]).
    unshot: Vec<Rgb>,
    /// The elements that have unshot flux, in order.
    active: Vec<u32>,
    /// What has landed in the running step.
    landed: Vec<[f64; 3]>,
    /// Where light lies on each element, and where it has landed in the running step; empty if it lies on the whole element.
    footprint: Vec<Footprint>,
    fresh: Vec<Footprint>,
    /// Landings marked so far: a source of random numbers.
    marked: u64,
    /// In a step of few rays, the elements on which something has landed: late steps must not cost as much as early ones.
    touched: Option<Vec<u32>>,
}

impl Light {
    pub fn new(elements: usize, has_lamps: bool, leaving: Leaving) -> Light {
        let tracked = if leaving == Leaving::WhereLanded { elements } else { 0 };
        let dark = || vec![Rgb::BLACK; elements];
        Light {
            lamps: if has_lamps { dark() } else { Vec::new() },
            direct: dark(),
            indirect: dark(),
            unshot: dark(),
            active: Vec::with_capacity(elements),
            landed: vec![[0.0; 3]; elements],
            footprint: vec![Footprint::WHOLE; tracked],
            fresh: vec![Footprint::WHOLE; tracked],
            marked: 0,
            touched: None,
        }
    }

    /// Whether it is the light on so many elements.
    pub fn fits(&self, elements: usize, has_lamps: bool) -> bool {
        let of_all = [self.direct.len(), self.indirect.len(), self.unshot.len(), self.landed.len()];
        of_all == [elements; 4]
            && self.lamps.len() == if has_lamps { elements } else { 0 }
            && [0, elements].contains(&self.footprint.len())
            && self.fresh.len() == self.footprint.len()
            && self.active.iter().chain(self.touched.iter().flatten()).all(|&e| (e as usize) < elements)
    }

    pub fn clear(&mut self) {
        for flux in [&mut self.lamps, &mut self.direct, &mut self.indirect, &mut self.unshot] {
            flux.fill(Rgb::BLACK);
        }
        self.active.clear();
        self.landed.fill([0.0; 3]);
        self.footprint.fill(Footprint::WHOLE);
        self.fresh.fill(Footprint::WHOLE);
        self.marked = 0;
    }

    /// Flux [lm] on element `e` straight from lights without extent.
    pub fn lamp_flux(&self, e: u32) -> Rgb {
        self.lamps.get(e as usize).copied().unwrap_or_default()
    }

    /// Flux [lm] on element `e` straight from all lights that have shot.
    pub fn shot_first(&self, e: u32) -> Rgb {
        self.lamp_flux(e) + self.direct[e as usize]
    }

    /// All flux [lm] on element `e`.
    pub fn on(&self, e: u32) -> Rgb {
        self.shot_first(e) + self.indirect[e as usize]
    }

    /// That part of the flux [lm] on element `e`.
    pub fn part_on(&self, part: LightPart, e: u32) -> Rgb {
        match part {
            LightPart::All => self.on(e),
            LightPart::Indirect => self.indirect[e as usize],
        }
    }

    /// Radiosity [lm/m²] that element `e` reflects.
    pub fn reflected_radiosity(&self, mesh: &ElementMesh, e: u32) -> Rgb {
        mesh.reflectivity(e) * self.on(e) / mesh.area(e)
    }

    /// The part of element `e` on which its light lies.
    pub fn footprint(&self, e: u32) -> Footprint {
        self.footprint.get(e as usize).copied().unwrap_or(Footprint::WHOLE)
    }

    /// Shows the reflected radiosity of all elements to those that gather. What has not been shot is given up: its memory is
    /// used.
    pub fn show(&mut self, mesh: &ElementMesh) {
        self.active.clear();
        for e in mesh.elements() {
            self.unshot[e as usize] = self.reflected_radiosity(mesh, e);
        }
    }

    /// Reflected radiosity [lm/m²] of element `e`, as it was when it was shown.
    #[inline]
    pub fn shown(&self, e: u32) -> Rgb {
        self.unshot[e as usize]
    }

    /// Flux [lm] that element `e` has yet to shoot.
    pub fn unshot(&self, e: u32) -> Rgb {
        self.unshot[e as usize]
    }

    /// The elements that have unshot flux.
    pub fn active(&self) -> impl Iterator<Item = u32> + '_ {
        self.active.iter().copied()
    }

    /// Luminous flux [lm] yet to be shot.
    pub fn unshot_total(&self) -> f64 {
        self.active().map(|e| self.unshot(e).luminance_f64()).sum()
    }

    /// What has landed on element `e` in the running step.
    pub fn landed(&self, e: u32) -> Rgb {
        to_rgb(&self.landed[e as usize])
    }

    /// Prepares for a shooting step of `rays` rays.
    pub fn expect(&mut self, rays: u64) {
        self.touched = (rays < self.landed.len() as u64 / 4).then(Vec::new);
    }

    /// Takes in what landed in one part of the running step.
    pub fn land(&mut self, part: &Part) {
        for landing in &part.landings {
            let landed = &mut self.landed[landing.element as usize];
            landed.iter_mut().zip(landing.light).for_each(|(sum, light)| *sum += f64::from(light));
        }
        if let Some(touched) = &mut self.touched {
            touched.extend(part.landings.iter().map(|landing| landing.element));
        }
    }

    /// Notes where in the running shooting step light has landed: with this `share` of the landings where the rays of other steps carry
    /// more, so that notes count light. An element's first landing is always noted.
    pub fn mark(&mut self, part: &Part, share: f64) {
        if !self.fresh.is_empty() {
            for landing in &part.landings {
                self.marked += 1;
                let (k, noise) = (landing.element as usize, mix(self.marked));
                let is_first = || self.fresh[k] == Footprint::WHOLE && self.footprint[k] == Footprint::WHOLE;
                if share >= 1.0 || unit_f64(mix(!noise)) < share || is_first() {
                    self.fresh[k].add(landing.spot, noise);
                }
            }
        }
    }

    /// Joins where light has landed in the running step to where it lay before.
    fn settle(&mut self, e: usize) {
        if let (Some(footprint), Some(fresh)) = (self.footprint.get_mut(e), self.fresh.get_mut(e)) {
            footprint.join(std::mem::take(fresh), mix(self.marked ^ e as u64));
        }
    }

    /// The unshot flux has been shot.
    pub fn spend_unshot(&mut self) {
        self.active.drain(..).for_each(|e| self.unshot[e as usize] = Rgb::BLACK);
    }

    /// Ends a shooting step: what has landed falls on its element, and what the element reflects waits to be shot.
    pub fn reflect(&mut self, mesh: &ElementMesh, origin: Origin) -> Landed {
        let mut total = Landed::default();
        match self.touched.take() {
            None => mesh.elements().for_each(|e| self.reflect_element(mesh, origin, e, &mut total)),
            Some(mut touched) => {
                touched.sort_unstable();
                touched.dedup();
                touched.into_iter().for_each(|e| self.reflect_element(mesh, origin, e, &mut total));
            }
        }
        // Light of an earlier step may still wait on the same elements.
        self.active.sort_unstable();
        self.active.dedup();
        total
    }

    fn reflect_element(&mut self, mesh: &ElementMesh, origin: Origin, e: u32, total: &mut Landed) {
        let k = e as usize;
        let landed = std::mem::take(&mut self.landed[k]);
        self.settle(k);
        if landed == [0.0; 3] {
            return;
        }
        let flux = match origin {
            Origin::Lamps => &mut self.lamps[k],
            Origin::Emission => &mut self.direct[k],
            Origin::Reflection => &mut self.indirect[k],
        };
        *flux += to_rgb(&landed);
        let rho = mesh.reflectivity(e);
        let reflected = rho * to_rgb(&landed);
        self.unshot[k] += reflected;
        self.active.push(e);
        let absorbed: [f64; 3] = std::array::from_fn(|c| landed[c] - f64::from(reflected.to_array()[c]));
        total.absorbed += 0.2126 * absorbed[0] + 0.7152 * absorbed[1] + 0.0722 * absorbed[2];
        total.reflected += reflected.luminance_f64();
    }

    /// Multiplies all light by `factor`.
    pub fn scale(&mut self, factor: f32) {
        for flux in [&mut self.lamps, &mut self.direct, &mut self.indirect, &mut self.unshot] {
            flux.iter_mut().for_each(|flux| *flux = *flux * factor);
        }
    }

    /// Takes the flux [lm] that waits on element `e`.
    pub fn take_unshot(&mut self, e: u32) -> Rgb {
        std::mem::take(&mut self.unshot[e as usize])
    }

    /// Light [lm] lands on element `e`, and what it reflects waits there.
    pub fn land_and_wait(&mut self, mesh: &ElementMesh, e: u32, light: Rgb) -> Landed {
        let reflected = mesh.reflectivity(e) * light;
        self.indirect[e as usize] += light;
        self.unshot[e as usize] += reflected;
        Landed { absorbed: (light.luminance_f64() - reflected.luminance_f64()), reflected: reflected.luminance_f64() }
    }

    /// Finds the elements that have unshot flux.
    pub fn find_active(&mut self) {
        self.active.clear();
        self.active.extend((0..self.unshot.len() as u32).filter(|&e| !self.unshot[e as usize].is_black()));
    }

    /// Merges `gathered` light [lm] on element `e` into what was shot, with these weights of direct and indirect light. All of it
    /// counts as indirect, as it is if the weight of direct light is 0.
    pub fn merge(&mut self, e: u32, gathered: Rgb, [direct, indirect]: [f32; 2]) {
        let k = e as usize;
        self.direct[k] = self.direct[k] * (1.0 - direct);
        self.indirect[k] = self.indirect[k] * (1.0 - indirect) + gathered;
    }

    /// Merges an estimate of the flux [lm] on element `e` straight from all lights with what they have shot, with this weight.
    pub fn merge_direct(&mut self, e: u32, estimate: Rgb, weight: f32) {
        let merged = self.shot_first(e) * (1.0 - weight) + estimate * weight;
        if let Some(lamp) = self.lamps.get_mut(e as usize) {
            *lamp = Rgb::BLACK;
        }
        self.direct[e as usize] = merged;
    }

    /// Merges an estimate of the indirect flux [lm] on element `e` with what was shot, with this weight.
    pub fn merge_indirect(&mut self, e: u32, estimate: Rgb, weight: f32) {
        let indirect = &mut self.indirect[e as usize];
        *indirect = *indirect * (1.0 - weight) + estimate * weight;
    }

    /// Merges what has landed in the running step, an estimate of the indirect irradiance [lux] of element `e` of this `area` [m²].
    pub fn merge_landed(&mut self, e: u32, area: f32, weight: f32) {
        let landed = self.take_landed(e);
        self.merge_indirect(e, landed * area, weight);
    }

    /// Takes what has landed on element `e` in the running step.
    pub fn take_landed(&mut self, e: u32) -> Rgb {
        to_rgb(&std::mem::take(&mut self.landed[e as usize]))
    }

    /// Ends a regular iteration: what has landed is another estimate of all reflected light, averaged in with weight `share`.
    pub fn average_in(&mut self, share: f32) {
        self.touched = None;
        (0..self.landed.len()).for_each(|e| self.settle(e));
        for (flux, landed) in self.indirect.iter_mut().zip(&mut self.landed) {
            *flux = *flux * (1.0 - share) + to_rgb(&std::mem::take(landed)) * share;
        }
    }
}
