//! A fingerprint of a scene: 64 bits of XXH3 over everything that light depends on.

use super::{LightKind, Scene, Shape, Texture};
use crate::math::Rgb;
use glam::Vec3;
use xxhash_rust::xxh3::Xxh3;

/// See [`Scene::hash`].
pub(super) fn scene_hash(scene: &Scene) -> u64 {
    let mut hasher = Hasher(Xxh3::new());
    hasher.count(scene.vertices.len());
    for v in &scene.vertices {
        hasher.vec3(v.position);
        hasher.rgb(v.color);
        hasher.floats(&[v.uv.x, v.uv.y, v.emission_uv.x, v.emission_uv.y]);
    }
    hasher.count(scene.triangles.len());
    for t in &scene.triangles {
        t.vertices.iter().chain([&scene.objects[t.object as usize].material]).for_each(|&k| hasher.count(k as usize));
    }
    scene.hidden_backs.iter().for_each(|&hidden| hasher.count(usize::from(hidden)));
    hasher.count(scene.materials.len());
    for m in &scene.materials {
        hasher.rgb(m.reflectivity);
        hasher.rgb(m.emission);
        hasher.count(usize::from(m.two_sided));
        hasher.texture(&m.reflectivity_texture);
        hasher.texture(&m.emission_texture);
    }
    for image in &scene.images {
        hasher.count(image.width as usize);
        hasher.0.update(image.texels.as_flattened());
    }
    for light in &scene.lights {
        hasher.rgb(light.intensity);
        match light.kind {
            LightKind::Point { position } => hasher.vec3(position),
            LightKind::Spot { position, direction, inner_angle, outer_angle } => {
                hasher.vec3(position);
                hasher.vec3(direction);
                hasher.floats(&[inner_angle, outer_angle]);
            }
            LightKind::Directional { direction } => {
                hasher.count(1);
                hasher.vec3(direction);
            }
        }
    }
    if let Shape::Sphere { center, radius } = scene.shape {
        hasher.vec3(center);
        hasher.floats(&[radius]);
    }
    hasher.0.digest()
}

struct Hasher(Xxh3);

impl Hasher {
    fn count(&mut self, n: usize) {
        self.0.update(&(n as u64).to_le_bytes());
    }

    fn floats(&mut self, values: &[f32]) {
        values.iter().for_each(|v| self.0.update(&v.to_le_bytes()));
    }

    fn vec3(&mut self, v: Vec3) {
        self.floats(&v.to_array());
    }

    fn rgb(&mut self, c: Rgb) {
        self.floats(&c.to_array());
    }

    fn texture(&mut self, texture: &Option<Texture>) {
        match texture {
            None => self.count(0),
            Some(t) => {
                [1, t.image as usize, t.wrap_u as usize, t.wrap_v as usize].into_iter().for_each(|k| self.count(k))
            }
        }
    }
}
