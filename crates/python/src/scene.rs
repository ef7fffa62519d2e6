//! Scenes: read, made of arrays, looked at and edited.
//!
//! Materials, objects, lights and cameras cross as JSON, as serde writes them in the core.

use crate::background::to_its_end;
use crate::fail::Fail;
use crate::view::{numbers, rows};
use glam::Vec2;
use isolux_core::lightmap::pieces;
use isolux_core::mesh::Resolution;
use isolux_core::scene::builtin::{builtin, is_builtin};
use isolux_core::scene::check::check;
use isolux_core::scene::{self, Fault, Material, Object, Triangle, Vertex};
use isolux_core::{Error, Problem};
use isolux_io::export::scene_glb;
use isolux_io::files::OutputFile;
use isolux_io::import::{ImportOptions, Insides, LightUnits, read_scene};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::mem::take;
use std::path::PathBuf;

#[pyclass(module = "isolux._native")]
pub struct Scene {
    pub inner: scene::Scene,
}

/// The lists that are edited part by part.
const LISTS: [&str; 4] = ["materials", "objects", "lights", "cameras"];

#[pymethods]
impl Scene {
    /// Reads a file, or makes a built-in scene; a file of that name wins.
    #[staticmethod]
    fn load(py: Python, name: PathBuf, light_units: &str, insides: &str) -> Result<Scene, Fail> {
        let light_units = match light_units {
            "spec" => LightUnits::Spec,
            "compat" => LightUnits::Compat,
            "raw" => LightUnits::Raw,
            other => return Err(Error::unknown_name("light unit", other, ["spec", "compat", "raw"]).into()),
        };
        let known = Insides::ALL.into_iter().find(|known| known.name() == insides);
        let insides = known.ok_or_else(|| {
            Error::unknown_name("way with insides", insides, Insides::ALL.iter().map(|known| known.name()))
        })?;
        let text = name.to_string_lossy().into_owned();
        let looks_like_a_name = !text.contains(['.', '/', '\\']) || is_builtin(&text);
        if !name.exists() && looks_like_a_name {
            return Ok(Scene { inner: builtin(&text)? });
        }
        let inner = to_its_end(py, || read_scene(&name, &ImportOptions { light_units, insides }))?;
        Ok(Scene { inner })
    }

    /// `objects` says on which object each triangle lies; each object has a name and the JSON of its material.
    #[staticmethod]
    fn from_arrays(
        name: String,
        vertices: PyReadonlyArray2<f32>,
        triangles: PyReadonlyArray2<u32>,
        objects: PyReadonlyArray1<u32>,
        names: Vec<String>,
        materials: Vec<String>,
    ) -> Result<Scene, Fail> {
        let vertices: &[[f32; 3]] = rows(&vertices, "vertices")?;
        let corners: &[[u32; 3]] = rows(&triangles, "triangles")?;
        let triangles = (0..).zip(corners.iter().zip(numbers(&objects, "objects")?));
        let materials: Result<Vec<Material>, _> = materials.iter().map(|text| serde_json::from_str(text)).collect();
        let mut inner = scene::Scene {
            name,
            vertices: vertices.iter().map(|&position| Vertex::at(position.into())).collect(),
            triangles: triangles.map(|(source, (&vertices, &object))| Triangle { vertices, object, source }).collect(),
            objects: (0..).zip(names).map(|(material, name)| Object { name, material }).collect(),
            materials: materials?,
            ..scene::Scene::default()
        };
        inner.validate()?;
        let has_area = |corners: [glam::Vec3; 3]| {
            let [a, b, c] = corners.map(|corner| corner.as_dvec3());
            (b - a).cross(c - a).length_squared() > 0.0
        };
        let given = inner.triangles.len();
        let kept: Vec<bool> = (0..given as u32).map(|t| has_area(inner.corners(t))).collect();
        let mut kept = kept.into_iter();
        inner.triangles.retain(|_| kept.next().unwrap_or(true));
        if inner.triangles.len() < given {
            inner.remarks.push(format!("{} triangles without area were dropped", given - inner.triangles.len()));
        }
        Ok(Scene { inner })
    }

    fn copy(&self) -> Scene {
        Scene { inner: self.inner.clone() }
    }

    #[getter]
    fn name(&self) -> &str {
        &self.inner.name
    }

    #[setter]
    fn set_name(&mut self, name: String) {
        self.inner.name = name;
    }

    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.inner.remarks.clone()
    }

    #[getter]
    fn hash(&self) -> u64 {
        self.inner.hash()
    }

    #[getter]
    fn bounds(&self) -> [[f32; 3]; 2] {
        let (low, high) = self.inner.bounds();
        [low.to_array(), high.to_array()]
    }

    /// Number of parts in a list.
    fn count(&self, list: &str) -> Result<usize, Fail> {
        let scene::Scene { materials, objects, lights, cameras, .. } = &self.inner;
        Ok(match list {
            "materials" => materials.len(),
            "objects" => objects.len(),
            "lights" => lights.len(),
            "cameras" => cameras.len(),
            _ => return Err(unknown(list)),
        })
    }

    /// Part number `k` of a list.
    fn get(&self, list: &str, k: usize) -> Result<String, Fail> {
        let scene::Scene { materials, objects, lights, cameras, .. } = &self.inner;
        match list {
            "materials" => text(materials, k),
            "objects" => text(objects, k),
            "lights" => text(lights, k),
            "cameras" => text(cameras, k),
            _ => Err(unknown(list)),
        }
    }

    /// Puts `part` into place `k` of a list; behind its end it is added.
    fn set(&mut self, list: &str, k: usize, part: &str) -> Result<(), Fail> {
        self.edit(|scene| match list {
            "materials" => put(&mut scene.materials, k, part),
            "objects" => put(&mut scene.objects, k, part),
            "lights" => put(&mut scene.lights, k, part),
            "cameras" => put(&mut scene.cameras, k, part),
            _ => Err(unknown(list)),
        })
    }

    /// Takes part `k` out of a list on which nothing else depends.
    fn remove(&mut self, list: &str, k: usize) -> Result<(), Fail> {
        match list {
            "lights" if k < self.inner.lights.len() => drop(self.inner.lights.remove(k)),
            "cameras" if k < self.inner.cameras.len() => drop(self.inner.cameras.remove(k)),
            _ => return Err(unknown(list)),
        }
        Ok(())
    }

    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Rows<'py, f32>> {
        let positions: Vec<[f32; 3]> = self.inner.vertices.iter().map(|vertex| vertex.position.to_array()).collect();
        two_dimensional(py, positions)
    }

    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Rows<'py, u32>> {
        two_dimensional(py, self.inner.triangles.iter().map(|triangle| triangle.vertices).collect())
    }

    fn triangle_objects<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        self.inner.triangles.iter().map(|triangle| triangle.object).collect::<Vec<_>>().into_pyarray(py)
    }

    /// Coordinates in the lightmap, those of the three corners of a triangle in each row.
    fn lightmap_uvs<'py>(&self, py: Python<'py>) -> PyResult<Option<Rows<'py, f32>>> {
        let numbers = |[a, b, c]: [Vec2; 3]| [a.x, a.y, b.x, b.y, c.x, c.y];
        let corners = self.inner.lightmap_corners();
        corners.map(|corners| two_dimensional(py, corners.into_iter().map(numbers).collect())).transpose()
    }

    /// Likewise; vertices are split where corners differ.
    fn set_lightmap_uvs(&mut self, corners: Option<PyReadonlyArray2<f32>>) -> Result<(), Fail> {
        let Some(corners) = corners else {
            self.inner.lightmap_uvs.clear();
            return Ok(());
        };
        let corners = rows::<f32, 6>(&corners, "lightmap_uvs")?;
        let pairs = |&[a, b, c, d, e, f]: &[f32; 6]| [Vec2::new(a, b), Vec2::new(c, d), Vec2::new(e, f)];
        Ok(self.inner.set_lightmap_corners(&corners.iter().map(pairs).collect::<Vec<_>>())?)
    }

    /// Positions and corners of the pieces that end where charts of a lightmap do, when it is cut as it is by default.
    fn pieces<'py>(&self, py: Python<'py>) -> Result<(Rows<'py, f32>, Rows<'py, u32>), Fail> {
        let scene = self.inner.clone();
        let pieces = to_its_end(py, || {
            let resolution = Resolution::default();
            let detail = resolution.typical_edge(&scene);
            pieces(&Problem::cut_along_contacts(scene, resolution, detail)?)
        })?;
        Ok((two_dimensional(py, pieces.positions)?, two_dimensional(py, pieces.corners)?))
    }

    /// What is in it and what is wrong with it.
    fn check(&self, py: Python) -> Result<String, Fail> {
        Ok(serde_json::to_string(&py.detach(|| check(&self.inner)))?)
    }

    /// Writes it as `.glb`.
    fn save(&self, py: Python, path: PathBuf) -> Result<(), Fail> {
        let is_glb = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb"));
        if !is_glb {
            return Err(isolux_io::Error::UnknownFormat { path, known: "a scene is written as .glb".to_owned() }.into());
        }
        to_its_end(py, || OutputFile::create(&path)?.finish(&scene_glb::write(&self.inner)?))
    }
}

impl Scene {
    /// Changes parts, if what comes out makes sense; otherwise nothing.
    fn edit(&mut self, change: impl FnOnce(&mut scene::Scene) -> Result<(), Fail>) -> Result<(), Fail> {
        let scene::Scene { materials, objects, lights, cameras, .. } = &self.inner;
        let before = (materials.clone(), objects.clone(), lights.clone(), cameras.clone());
        // What belongs to vertices and triangles is as it was, and there may be much of it.
        let surfaces = scene::Scene {
            vertices: take(&mut self.inner.vertices),
            triangles: take(&mut self.inner.triangles),
            shape: take(&mut self.inner.shape),
            hidden_backs: take(&mut self.inner.hidden_backs),
            lightmap_uvs: take(&mut self.inner.lightmap_uvs),
            ..scene::Scene::default()
        };
        let changed = change(&mut self.inner).and_then(|()| Ok(self.inner.validate()?));
        let scene::Scene { vertices, triangles, shape, hidden_backs, lightmap_uvs, .. } = surfaces;
        self.inner = scene::Scene { vertices, triangles, shape, hidden_backs, lightmap_uvs, ..take(&mut self.inner) };
        if changed.is_err() {
            (self.inner.materials, self.inner.objects, self.inner.lights, self.inner.cameras) = before;
        }
        changed
    }
}

fn unknown(list: &str) -> Fail {
    Error::unknown_name("list of the scene", list, LISTS).into()
}

fn text<T: Serialize>(list: &[T], k: usize) -> Result<String, Fail> {
    let part = list.get(k).ok_or_else(|| no_part(k, list.len()))?;
    Ok(serde_json::to_string(part)?)
}

fn put<T: DeserializeOwned>(list: &mut Vec<T>, k: usize, part: &str) -> Result<(), Fail> {
    let part = serde_json::from_str(part)?;
    match list.get_mut(k) {
        Some(place) => *place = part,
        None => list.push(part),
    }
    Ok(())
}

fn no_part(k: usize, count: usize) -> Fail {
    Fault { place: k.to_string(), what: format!("there are only {count}") }.into()
}

/// A two-dimensional array.
pub type Rows<'py, T> = Bound<'py, PyArray2<T>>;

/// An array with a row for each.
pub fn two_dimensional<'py, T: numpy::Element, const N: usize>(
    py: Python<'py>,
    rows: Vec<[T; N]>,
) -> PyResult<Rows<'py, T>> {
    use numpy::PyArrayMethods;
    let count = rows.len();
    rows.into_flattened().into_pyarray(py).reshape([count, N])
}
