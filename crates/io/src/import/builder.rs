//! Puts a scene together from what a reader finds, and checks every number on the way in.

use super::images;
use crate::Error;
use glam::{DVec3, Vec2, Vec3};
use isolux_core::math::Rgb;
use isolux_core::scene::{Material, Object, Scene, Triangle, Vertex};
use std::collections::BTreeMap;
use std::path::Path;

/// More triangles than this, instances counted, or more vertices are taken for a mistake: they would need more than 10 GB.
const MOST: usize = 1 << 27;

/// A scene in the making.
pub struct SceneBuilder<'a> {
    pub path: &'a Path,
    pub scene: Scene,
    /// Triangles seen so far, dropped ones included.
    seen: u32,
    dropped: u32,
    /// For each vertex of a reader's list: the last surface that used it, and its number in the scene. One list for all
    /// surfaces, so that many small ones can share a long list of vertices without clearing it each time.
    numbers: Vec<(u32, u32)>,
    surfaces: u32,
    /// Objects that later surfaces may join, by name and material.
    open: BTreeMap<(String, u32), u32>,
    /// Coordinates in a lightmap of every vertex of the scene, where the file has them.
    lightmap_uvs: Vec<Option<Vec2>>,
}

/// A mesh with one material, as a reader hands it over.
pub struct Surface<'a> {
    /// Where in the file it stands.
    pub place: &'a str,
    pub name: String,
    /// Index into the materials of the scene.
    pub material: u32,
    pub vertex_count: usize,
    /// Whether it joins an earlier object of the same name and material.
    pub joins: bool,
}

impl<'a> SceneBuilder<'a> {
    pub fn new(path: &'a Path) -> SceneBuilder<'a> {
        SceneBuilder {
            path,
            scene: Scene::default(),
            seen: 0,
            dropped: 0,
            numbers: Vec::new(),
            surfaces: 0,
            open: BTreeMap::new(),
            lightmap_uvs: Vec::new(),
        }
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
        self.lightmapped_surface(surface, triangles, |corner| (vertex(corner), None))
    }

    /// As [`SceneBuilder::surface`], with coordinates in a lightmap for each vertex, if the file has them.
    ///
    /// # Errors
    /// Those of [`SceneBuilder::surface`].
    pub fn lightmapped_surface(
        &mut self,
        surface: Surface,
        triangles: impl Iterator<Item = [u32; 3]>,
        mut vertex: impl FnMut(u32) -> (Vertex, Option<Vec2>),
    ) -> Result<(), Error> {
        let place = surface.place;
        let key = (surface.name, surface.material);
        let known = self.open.get(&key).copied().filter(|_| surface.joins);
        let object = known.unwrap_or(self.scene.objects.len() as u32);
        let (first_vertex, first_triangle) = (self.scene.vertices.len(), self.scene.triangles.len());
        self.surfaces += 1;
        if self.numbers.len() < surface.vertex_count {
            self.numbers.resize(surface.vertex_count, (0, 0));
        }
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
                let count = surface.vertex_count;
                if corner as usize >= count {
                    return Err(
                        self.error(place, format!("a triangle uses vertex {corner}, but there are only {count}"))
                    );
                }
                if self.numbers[corner as usize].0 != self.surfaces {
                    let (vertex, lightmap_uv) = vertex(corner);
                    check(&vertex).map_err(|what| self.error(place, format!("vertex {corner}: {what}")))?;
                    self.numbers[corner as usize] = (self.surfaces, self.scene.vertices.len() as u32);
                    self.scene.vertices.push(vertex);
                    // Those that are no numbers are no coordinates of a map.
                    self.lightmap_uvs.push(lightmap_uv.filter(|uv| uv.is_finite()));
                }
                *number = self.numbers[corner as usize].1;
            }
            if has_area(vertices.map(|v| self.scene.vertices[v as usize].position)) {
                self.scene.triangles.push(Triangle { vertices, object, source });
            } else {
                self.dropped += 1;
            }
        }
        if self.scene.triangles.len() == first_triangle {
            self.scene.vertices.truncate(first_vertex);
            self.lightmap_uvs.truncate(first_vertex);
        } else if known.is_none() {
            self.scene.objects.push(Object { name: key.0.clone(), material: key.1 });
            self.open.insert(key, object);
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

    /// Adds what formats without materials get, and says so: grey of reflectivity 0.5, two-sided.
    ///
    /// # Errors
    /// None in practice; those of [`SceneBuilder::material`].
    pub fn default_material(&mut self) -> Result<u32, Error> {
        self.remark("surfaces without a material are taken as grey, reflectivity 0.5 on both sides");
        self.material(Material { two_sided: true, ..Material::diffuse("default", Rgb::grey(0.5)) }, "default material")
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
        let known = self.lightmap_uvs.iter().flatten().count();
        if known == self.scene.vertices.len() {
            self.scene.lightmap_uvs = self.lightmap_uvs.into_iter().flatten().collect();
        } else if known > 0 {
            let without = self.lightmap_uvs.len() - known;
            self.remark(format!("TEXCOORD_1 is no lightmap's: {without} vertices have none"));
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
