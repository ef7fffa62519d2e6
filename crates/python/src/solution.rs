//! Solutions: numbers, files and pictures.

use crate::background::to_its_end;
use crate::fail::Fail;
use crate::problem::Problem;
use crate::scene::two_dimensional;
use crate::solve::quantity;
use crate::view::{triples, view_of_triples};
use isolux_core::compare::compare;
use isolux_core::math::Rgb;
use isolux_core::merge::merge;
use isolux_core::solution::Provenance;
use isolux_core::solvers::mean_of_independent;
use isolux_core::superposition::{alone, mix};
use isolux_core::view::{Exposure, VertexField, ViewOptions, render_field};
use isolux_core::{Error, VERSION};
use isolux_io::export::{ExportOptions, LitScene, Smoothing, for_path, json};
use isolux_io::files::{self, OutputFile};
use isolux_io::solution_file;
use numpy::{IntoPyArray, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::OnceLock;

#[pyclass(frozen, module = "isolux._native")]
pub struct Solution {
    problem: Py<Problem>,
    inner: isolux_core::Solution,
    /// Made when the first asks for it.
    radiosity: OnceLock<Vec<Rgb>>,
    /// The light as it is looked at.
    field: OnceLock<VertexField>,
}

/// What a picture and a file are told: the entries of a dict.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Picture {
    camera: Option<String>,
    width: u32,
    height: Option<u32>,
    samples: u32,
    exposure: Option<f32>,
    smooth: String,
}

impl Picture {
    fn options(self) -> Result<ExportOptions, Error> {
        let Picture { camera, width, height, samples, exposure, smooth } = self;
        let all = Smoothing::ALL;
        let smoothing = all.into_iter().find(|smoothing| smoothing.name() == smooth);
        let smoothing =
            smoothing.ok_or_else(|| Error::unknown_name("smoothing", &smooth, all.iter().map(|known| known.name())))?;
        Ok(ExportOptions { camera, width, height, samples, exposure, smoothing, ..ExportOptions::default() })
    }
}

impl Solution {
    pub fn new(problem: Py<Problem>, inner: isolux_core::Solution) -> Solution {
        Solution { problem, inner, radiosity: OnceLock::new(), field: OnceLock::new() }
    }

    fn problem(&self) -> &isolux_core::Problem {
        &self.problem.get().inner
    }
}

#[pymethods]
impl Solution {
    /// Reads a `.isolux` file.
    #[staticmethod]
    fn open(py: Python, path: PathBuf) -> Result<Solution, Fail> {
        let read = || solution_file::read(&path.to_string_lossy(), &files::read(&path)?);
        let (problem, inner) = to_its_end(py, read)?;
        Ok(Solution::new(Py::new(py, Problem::new(problem))?, inner))
    }

    /// The mean of independent complete solutions, shape (r, n, 3).
    #[staticmethod]
    fn of_independent(
        problem: &Bound<Problem>,
        solutions: PyReadonlyArray3<f32>,
        rays: u64,
        method: String,
        seed: u64,
    ) -> Result<Solution, Fail> {
        let inner = &problem.get().inner;
        let [count, elements, channels] = [solutions.shape()[0], solutions.shape()[1], solutions.shape()[2]];
        let values = solutions.as_slice().ok().filter(|_| channels == 3);
        let values = values.ok_or(Error::Parameter {
            name: "solutions",
            value: format!("shape ({count}, {elements}, {channels})"),
            allowed: "irradiance of shape (solutions, elements, 3), in C order",
        })?;
        let colors: Vec<Rgb> = values.as_chunks::<3>().0.iter().map(|&color| Rgb::from(color)).collect();
        let solutions: Vec<Vec<Rgb>> = colors.chunks(elements.max(1)).map(<[Rgb]>::to_vec).collect();
        let provenance = Provenance {
            scene: inner.scene.name.clone(),
            scene_hash: inner.scene.hash(),
            method,
            seed,
            version: VERSION.to_owned(),
            ..Provenance::default()
        };
        let solution = mean_of_independent(inner, &solutions, rays, provenance)?;
        Ok(Solution::new(problem.clone().unbind(), solution))
    }

    /// One better solution of several.
    #[staticmethod]
    fn merge(py: Python, solutions: Vec<Py<Solution>>) -> Result<Solution, Fail> {
        let Some(first) = solutions.first().map(Py::get) else {
            return Err(Error::NotMergeable { what: "there is none".to_owned() }.into());
        };
        let parts: Vec<isolux_core::Solution> = solutions.iter().map(|solution| solution.get().inner.clone()).collect();
        let merged = py.detach(|| merge(first.problem(), &parts))?;
        Ok(Solution::new(first.problem.clone_ref(py), merged))
    }

    #[getter(problem)]
    fn problem_of(&self, py: Python) -> Py<Problem> {
        self.problem.clone_ref(py)
    }

    #[getter]
    fn irradiance<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f32>> {
        view_of_triples(slf, |solution| triples(&solution.inner.irradiance))
    }

    #[getter]
    fn std_error<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f32>> {
        view_of_triples(slf, |solution| triples(&solution.inner.std_error))
    }

    #[getter]
    fn radiosity<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f32>> {
        view_of_triples(slf, |solution| {
            let problem = solution.problem();
            let of_all = || problem.mesh.elements().map(|e| solution.inner.radiosity(problem, e)).collect();
            triples(solution.radiosity.get_or_init(of_all))
        })
    }

    /// Totals, balance, provenance, and light on each object, as the `.json` file has them.
    fn summary(&self, py: Python) -> String {
        py.detach(|| json::summary(self.problem(), &self.inner, &serde_json::Map::new()).to_string())
    }

    /// What it is off by at most with such `confidence`, relative to a mean; `of` is rms, max, mean, or object:NAME.
    fn error_bound(&self, confidence: f64, of: &str) -> Result<f64, Fail> {
        Ok(quantity(&self.problem().scene, of)?.error_bound(self.problem(), &self.inner, confidence))
    }

    /// The best estimate of the scene's RMS error, relative to the mean irradiance; NaN if it is not known.
    #[getter]
    fn rms_error(&self) -> f64 {
        self.inner.rms_error()
    }

    /// Writes a file in the format of its extension.
    fn save(&self, py: Python, path: PathBuf, picture: Picture) -> Result<(), Fail> {
        let options = picture.options()?;
        let format = for_path(&path)?;
        to_its_end(py, || {
            let file = OutputFile::create(&path)?;
            let lit = LitScene::smoothed(self.problem(), &self.inner, options.smoothing);
            file.finish(&(format.write)(&lit, &options)?)
        })
    }

    /// A picture: what a screen shows (h, w, 3), its luminance [cd/m²] (h, w, 3), and its exposure [stops].
    #[expect(clippy::type_complexity)]
    fn render<'py>(
        &self,
        py: Python<'py>,
        picture: Picture,
    ) -> Result<(Bound<'py, PyArray3<u8>>, Bound<'py, PyArray3<f32>>, f32), Fail> {
        let ExportOptions { camera, width, height, samples, exposure, smoothing, .. } = picture.options()?;
        let options =
            ViewOptions { camera, width, height, samples, exposure: exposure.map(|stops| Exposure { stops }) };
        let picture = to_its_end(py, || {
            if smoothing == Smoothing::None {
                return render_field(self.problem(), &VertexField::as_computed(self.problem(), &self.inner), &options);
            }
            let field = self.field.get_or_init(|| VertexField::new(self.problem(), &self.inner));
            render_field(self.problem(), field, &options)
        })?;
        let shape = [picture.height as usize, picture.width as usize, 3];
        let display = picture.to_srgb8().into_flattened().into_pyarray(py).reshape(shape)?;
        let luminance = two_dimensional(py, triples(&picture.luminance).to_vec())?.reshape(shape)?;
        Ok((display, luminance, picture.exposure.stops))
    }

    /// The names of the light groups that were solved apart, if any were.
    #[getter]
    fn groups(&self) -> Vec<String> {
        self.inner.groups.iter().map(|part| part.group.name.clone()).collect()
    }

    /// The factor of each light group.
    #[getter]
    fn factors(&self) -> Vec<[f32; 3]> {
        self.inner.groups.iter().map(|part| part.factor.to_array()).collect()
    }

    /// The light of group number `k` at its factor, in the same problem.
    fn alone(&self, py: Python, k: usize) -> Result<Solution, Fail> {
        if k >= self.inner.groups.len() {
            let allowed = "the number of a light group";
            return Err(Error::Parameter { name: "group", value: k.to_string(), allowed }.into());
        }
        let alone = py.detach(|| alone(self.problem(), &self.inner, k));
        Ok(Solution::new(self.problem.clone_ref(py), alone))
    }

    /// The same with other factors.
    fn mix(&self, py: Python, factors: Vec<[f32; 3]>) -> Result<Solution, Fail> {
        let factors: Vec<Rgb> = factors.into_iter().map(Rgb::from).collect();
        let (problem, mixed) = py.detach(|| mix(self.problem(), self.inner.clone(), &factors))?;
        Ok(Solution::new(Py::new(py, Problem::new(problem))?, mixed))
    }

    /// How it differs from another one, as JSON.
    fn compare(&self, py: Python, other: Py<Solution>) -> Result<String, Fail> {
        let other = other.get();
        let compared = py.detach(|| compare(self.problem(), &self.inner, other.problem(), &other.inner))?;
        Ok(serde_json::to_string(&compared)?)
    }
}
