//! Sides of surfaces that nobody can see.
//!
//! Modellers write most materials as two-sided, and most things are closed: the inside of a sofa or of a lamp's globe is dark, or lit
//! by nothing but itself. There elements and rays are lost, a lamp sends half of its light into itself, and the mean over a thing is half of what
//! falls on it. So closed surfaces get one side where it is clear which one:
//!
//! - A solid holds no whole other surface, no camera and no lamp, and shines everywhere or nowhere: it is seen from outside.
//! - A room holds part of every other surface, and all cameras and lamps: it is seen from inside.
//!
//! What is a room by its own light alone is left as it is, and so is what is the only surface of a scene. Light elsewhere does not change, for none passes a closed
//! surface.

use super::shells::{Surface, surfaces};
use super::{LightKind, Scene, Shape};
use glam::Vec3;
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Corners of a surface that are looked at to tell where it is.
const SAMPLES: usize = 6;
/// No more looks at triangles than this for one surface: it is left as it is.
const MOST_LOOKS: usize = 1 << 26;

/// The side of a closed surface that is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Seen {
    Outside,
    Inside,
}

impl Scene {
    /// Hides the sides of two-sided triangles that nobody can see ([`Scene::hidden_backs`]); the other becomes the front. The names of the objects that they are
    /// of, each once.
    pub fn hide_insides(&mut self) -> Vec<String> {
        if self.shape != Shape::Triangles {
            return Vec::new();
        }
        let all = surfaces(self);
        let largest = largest(&all);
        let seen: Vec<Option<Seen>> =
            (0..all.len()).into_par_iter().map(|k| seen(self, &all, k, Some(k) == largest)).collect();
        let mut hidden = vec![false; self.triangles.len()];
        for (surface, seen) in all.iter().zip(seen) {
            let (Some(outward), Some(seen)) = (&surface.outward, seen) else { continue };
            for (&t, &outward) in surface.triangles.iter().zip(outward) {
                if self.material_of(t).two_sided {
                    hidden[t as usize] = true;
                    if outward != (seen == Seen::Outside) {
                        self.triangles[t as usize].vertices.swap(1, 2);
                    }
                }
            }
        }
        if !hidden.contains(&true) {
            return Vec::new();
        }
        let of_hidden = self.triangles.iter().zip(&hidden).filter(|(_, hidden)| **hidden).map(|(t, _)| t.object);
        let objects: BTreeSet<u32> = of_hidden.collect();
        self.hidden_backs = hidden;
        objects.into_iter().map(|object| self.objects[object as usize].name.clone()).collect()
    }
}

/// The surface that would be the room.
fn largest(all: &[Surface]) -> Option<usize> {
    let size = |k: &usize| all[*k].low.distance(all[*k].high);
    (0..all.len()).max_by(|a, b| size(a).total_cmp(&size(b)))
}

/// Which side of surface `k` of `all` is seen, if it is closed and that is clear.
fn seen(scene: &Scene, all: &[Surface], k: usize, is_largest: bool) -> Option<Seen> {
    let surface = &all[k];
    if surface.outward.is_none() || !surface.triangles.iter().any(|&t| scene.material_of(t).two_sided) {
        return None;
    }
    let others = || all.iter().enumerate().filter(|(j, _)| *j != k).map(|(_, other)| other);
    if others().next().is_none() || surface.triangles.len() * all.len() * SAMPLES > MOST_LOOKS {
        return None;
    }
    let observers: Vec<Vec3> = scene.cameras.iter().map(|c| c.position).chain(lamps(scene)).collect();
    let holds = |point: &Vec3| surface.encloses(scene, *point, false);
    let touches = |point: &Vec3| surface.encloses(scene, *point, true);
    if is_largest && observers.iter().all(holds) && others().all(|other| samples(scene, other).any(|p| holds(&p))) {
        return Some(Seen::Inside);
    }
    let shining = surface.triangles.iter().filter(|&&t| scene.material_of(t).is_emitter()).count();
    let is_empty = !observers.iter().any(touches)
        && !others().any(|other| surface.spans(other) && samples(scene, other).all(|p| touches(&p)));
    (is_empty && [0, surface.triangles.len()].contains(&shining)).then_some(Seen::Outside)
}

fn lamps(scene: &Scene) -> impl Iterator<Item = Vec3> {
    scene.lights.iter().filter_map(|light| match light.kind {
        LightKind::Point { position } | LightKind::Spot { position, .. } => Some(position),
        LightKind::Directional { .. } => None,
    })
}

/// A few corners of `surface`, evenly over its list.
fn samples<'a>(scene: &'a Scene, surface: &'a Surface) -> impl Iterator<Item = Vec3> + 'a {
    let count = surface.triangles.len();
    let step = count.div_ceil(SAMPLES);
    surface.triangles.iter().step_by(step).enumerate().map(|(k, &t)| scene.corners(t)[k % 3])
}

impl Surface {
    /// Whether the box around it holds that around the other.
    fn spans(&self, other: &Surface) -> bool {
        let margin = 1e-4 * self.low.distance(self.high);
        (self.low - margin).cmple(other.low).all() && (self.high + margin).cmpge(other.high).all()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;
    use crate::scene::builtin::shapes::Builder;
    use crate::scene::{Camera, Light, Material};

    /// Two-sided boxes: the names and opposite corners.
    fn boxes(list: &[(&str, f32, f32)]) -> Scene {
        let mut builder = Builder::new("boxes");
        for &(name, low, high) in list {
            let material = Material { two_sided: true, ..Material::diffuse(name, Rgb::grey(0.5)) };
            let material = builder.material(material);
            builder.object(name, material);
            builder.cuboid(Vec3::splat(low), Vec3::splat(high));
        }
        builder.finish()
    }

    /// Whether the only side of the first triangle of `object` looks away from the box's middle.
    fn looks_out(scene: &Scene, object: u32) -> bool {
        let t = scene.triangles.iter().position(|t| t.object == object).unwrap();
        assert!(!scene.is_two_sided(t as u32), "both sides are there");
        let [a, b, c] = scene.corners(t as u32);
        let own = scene.triangles.iter().filter(|t| t.object == object);
        let corners: Vec<Vec3> = own.flat_map(|t| t.vertices).map(|v| scene.vertices[v as usize].position).collect();
        let middle = corners.iter().sum::<Vec3>() / corners.len() as f32;
        (b - a).cross(c - a).dot(a - middle) > 0.0
    }

    #[test]
    fn a_room_is_seen_from_inside_and_what_stands_in_it_from_outside() {
        let mut scene = boxes(&[("room", 0.0, 9.0), ("sofa", 1.0, 3.0), ("lamp", 6.0, 7.0)]);
        scene.materials[2].emission = Rgb::WHITE;
        // However their triangles run.
        scene.triangles.iter_mut().step_by(3).for_each(|t| t.vertices.swap(0, 1));
        let flux_before = crate::scene::check::check(&scene).emitters[0].flux.g;
        assert_eq!(scene.hide_insides(), ["room", "sofa", "lamp"]);
        assert_eq!([0, 1, 2].map(|object| looks_out(&scene, object)), [false, true, true]);
        assert!(scene.hidden_backs.iter().all(|hidden| *hidden));
        let flux = crate::scene::check::check(&scene).emitters[0].flux.g;
        assert!((flux_before / flux - 2.0).abs() < 1e-5, "a lamp does not shine into itself");
    }

    #[test]
    fn what_may_be_looked_into_keeps_both_sides() {
        let alone = |scene: &mut Scene| scene.hide_insides().is_empty() && scene.is_two_sided(0);
        assert!(alone(&mut boxes(&[("box", 0.0, 1.0)])), "it is all there is");
        let two = [("crate", 0.0, 3.0), ("ball", 8.0, 9.0)];
        let mut scene = boxes(&two);
        scene.cameras.push(Camera::looking_at("eye", Vec3::ONE, Vec3::ZERO, 1.0));
        assert_eq!(scene.hide_insides(), ["ball"], "there is a camera in the crate");
        let mut scene = boxes(&two);
        let kind = LightKind::Point { position: Vec3::splat(8.5) };
        scene.lights.push(Light { name: "bulb".to_owned(), intensity: Rgb::WHITE, kind });
        assert_eq!(scene.hide_insides(), ["crate"], "there is a bulb in the ball");
        let mut scene = boxes(&[("room", 0.0, 3.0), ("box", 1.0, 2.0), ("garden", 8.0, 9.0)]);
        assert_eq!(scene.hide_insides(), ["box", "garden"], "the room has an outside, and something in it");
        let mut scene = boxes(&two);
        scene.objects.push(scene.objects[0].clone());
        scene.materials.push(Material { emission: Rgb::WHITE, ..scene.materials[0].clone() });
        scene.objects[2].material = 2;
        scene.triangles[0].object = 2;
        assert_eq!(scene.hide_insides(), ["ball"], "the crate is lit by its own ceiling");
        let mut open = boxes(&two);
        open.triangles.remove(0);
        assert_eq!(open.hide_insides(), ["ball"]);
    }

    #[test]
    fn a_rod_that_ends_in_a_lamp_leaves_it_a_solid() {
        let mut scene = boxes(&[("room", 0.0, 9.0), ("lamp", 4.0, 5.0), ("rod", 4.9, 8.0)]);
        assert_eq!(scene.hide_insides(), ["room", "lamp", "rod"]);
        assert_eq!([0, 1, 2].map(|object| looks_out(&scene, object)), [false, true, true]);
    }
}
