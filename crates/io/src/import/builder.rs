//! Puts a scene together from what a reader finds, and checks every number on the way in.

use super::images;
use crate::Error;
use glam::{DVec3, Vec3};
use isolux_core::math::Rgb;
use isolux_core::scene::{Material, Object, Scene, Triangle, Vertex};
use std::path::Path;

/// More triangles than this, instances counted, or more vertices are taken for a mistake: they would need more than 10 GB.
const MOST: usize = 1 << 27;
const UNUSED: u32 = u32::MAX;

/// A scene in the making.
pub struct SceneBuilder<'a> {
    path: &'a Path,
    pub scene: Scene,
    /// Triangles seen so far, dropped ones included.
    seen: u32,
    dropped: u32,
}

/// A mesh with one material, as a reader hands it over.
pub struct Surface<'a> {
    /// Where in the file it stands.
    pub place: &'a str,
    pub name: String,
    /// Index into the materials of the scene.
    pub material: u32,
    pub vertex_count: usize,
}

impl<'a> SceneBuilder<'a> {
    pub fn new(path: &'a Path) -> SceneBuilder<'a> {
        SceneBuilder { path, scene: Scene::default(), seen: 0, dropped: 0 }
    }

    /// Adds an object: `triangles` are indices of vertices, and `vertex` gives the vertex of an index below
    /// `surface.vertex_count`. Only vertices that are used are asked for, each once, so that many surfaces can share one
    /// long list. Triangles without area are dropped and counted; an object of which nothing is left is no object.
    ///
    /// # Errors
    /// [`Error::Invalid`] for an index out of range, a number that is not finite, a negative colour, or too much of all.
    pub fn surface(
        &mut self,
        surface: Surface,
        triangles: impl Iterator<Item = [u32; 3]>,
        mut vertex: impl FnMut(u32) -> Vertex,
    ) -> Result<(), Error> {
        let place = surface.place;
        let object = self.scene.objects.len() as u32;
        let first_triangle = self.scene.triangles.len();
        let mut numbers = vec![UNUSED; surface.vertex_count];
        for corners in triangles {
            let source = self.seen;
            self.seen += 1;
            if self.seen as usize > MOST || self.scene.vertices.len() + 3 > MOST {
                return Err(
                    self.error(place, format!("with this, the scene has more than {MOST} triangles or vertices"))
                );
            }
            let mut vertices = [0; 3];
            for (number, corner) in vertices.iter_mut().zip(corners) {
                let Some(known) = numbers.get_mut(corner as usize) else {
                    let count = surface.vertex_count;
                    return Err(
                        self.error(place, format!("a triangle uses vertex {corner}, but there are only {count}"))
                    );
                };
                if *known == UNUSED {
                    let vertex = vertex(corner);
                    check(&vertex)
                        .map_err(|what| Error::invalid(self.path, place, format!("vertex {corner}: {what}")))?;
                    *known = self.scene.vertices.len() as u32;
                    self.scene.vertices.push(vertex);
                }
                *number = *known;
            }
            if has_area(vertices.map(|v| self.scene.vertices[v as usize].position)) {
                self.scene.triangles.push(Triangle { vertices, object, source });
            } else {
                self.dropped += 1;
            }
        }
        if self.scene.triangles.len() > first_triangle {
            self.scene.objects.push(Object { name: surface.name, material: surface.material });
        }
        Ok(())
    }

    /// Adds a material and returns its number.
    ///
    /// # Errors
    /// [`Error::Invalid`] if a factor is negative or not finite. A reflectivity of 1 or more is no error here.
    pub fn material(&mut self, material: Material, place: &str) -> Result<u32, Error> {
        for (what, color) in [("reflectivity", material.reflectivity), ("emission", material.emission)] {
            if !is_color(color) {
                let values = color.to_array();
                return Err(self.error(place, format!("{what} {values:?} must not be negative and must be finite")));
            }
        }
        self.scene.materials.push(material);
        Ok(self.scene.materials.len() as u32 - 1)
    }

    /// Decodes an image file, adds the image and returns its number.
    ///
    /// # Errors
    /// [`Error::Invalid`] if it cannot be decoded.
    pub fn image(&mut self, bytes: &[u8], name: &str, place: &str) -> Result<u32, Error> {
        self.scene.images.push(images::decode(bytes, name).map_err(|what| self.error(place, what))?);
        Ok(self.scene.images.len() as u32 - 1)
    }

    /// Says something to people; sentences that are there already are not repeated.
    pub fn remark(&mut self, sentence: impl Into<String>) {
        let sentence = sentence.into();
        if !self.scene.remarks.contains(&sentence) {
            self.scene.remarks.push(sentence);
        }
    }

    pub fn error(&self, place: &str, what: impl Into<String>) -> Error {
        Error::invalid(self.path, place, what)
    }

    /// A name for the next object that has none.
    pub fn default_name(&self) -> String {
        format!("object {}", self.scene.objects.len() + 1)
    }

    pub fn finish(mut self) -> Scene {
        if self.dropped > 0 {
            let (dropped, seen) = (self.dropped, self.seen);
            self.remark(format!("{dropped} of {seen} triangles have no area and were dropped"));
        }
        self.scene
    }
}

/// Whether the area of a triangle is a positive number that single precision can hold.
fn has_area([a, b, c]: [Vec3; 3]) -> bool {
    let [a, b, c]: [DVec3; 3] = [a, b, c].map(Vec3::as_dvec3);
    let area = (0.5 * (b - a).cross(c - a).length()) as f32;
    area > 0.0 && area.is_finite()
}

fn check(vertex: &Vertex) -> Result<(), String> {
    if !vertex.position.is_finite() {
        Err(format!("position {} is not finite", vertex.position))
    } else if !vertex.uv.is_finite() || !vertex.emission_uv.is_finite() {
        Err("texture coordinates are not finite".to_owned())
    } else if !is_color(vertex.color) {
        Err(format!("colour {:?} must not be negative and must be finite", vertex.color.to_array()))
    } else {
        Ok(())
    }
}

fn is_color(color: Rgb) -> bool {
    color.to_array().into_iter().all(|v| v.is_finite() && v >= 0.0)
}
