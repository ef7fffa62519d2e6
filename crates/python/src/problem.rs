//! A scene that is cut into elements: what is known of each, and the geometry.

use crate::background::to_its_end;
use crate::fail::Fail;
use crate::scene::{Scene, two_dimensional};
use crate::transport;
use crate::view::{numbers, rows, view, view_of_triples};
use isolux_core::mesh::Resolution;
use isolux_core::solvers::DETERMINISTIC_ELEMENTS;
use isolux_core::view::{ViewOptions, elements};
use isolux_io::export::elements as export;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use std::sync::{Arc, OnceLock};

#[pyclass(frozen, module = "isolux._native")]
pub struct Problem {
    pub inner: Arc<isolux_core::Problem>,
    known: OnceLock<Known>,
}

/// What is known of every element, in its order.
struct Known {
    areas: Vec<f32>,
    centres: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    reflectivity: Vec<[f32; 3]>,
    emission: Vec<[f32; 3]>,
    objects: Vec<u32>,
    triangles: Vec<u32>,
    backs: Vec<bool>,
}

impl Known {
    fn of(problem: &isolux_core::Problem) -> Known {
        let mesh = &problem.mesh;
        let places = mesh.elements().map(|e| problem.centre(e));
        let (centres, normals) = places.map(|(centre, normal)| (centre.to_array(), normal.to_array())).unzip();
        Known {
            areas: mesh.elements().map(|e| mesh.area(e)).collect(),
            centres,
            normals,
            reflectivity: mesh.elements().map(|e| mesh.reflectivity(e).to_array()).collect(),
            emission: mesh.elements().map(|e| mesh.emission(e).to_array()).collect(),
            objects: mesh.elements().map(|e| problem.object(e)).collect(),
            triangles: mesh.elements().map(|e| mesh.triangle(e)).collect(),
            backs: mesh.elements().map(|e| mesh.place(e).back).collect(),
        }
    }
}

impl Problem {
    pub fn new(inner: isolux_core::Problem) -> Problem {
        Problem { inner: Arc::new(inner), known: OnceLock::new() }
    }

    /// Cuts `scene`, along what stands on its surfaces, too, if `contacts` says so.
    ///
    /// # Errors
    /// Those of the core.
    pub fn cut(py: Python, scene: &Scene, resolution: Resolution, contacts: bool) -> Result<Problem, Fail> {
        let scene = scene.inner.clone();
        let problem = to_its_end(py, || {
            if contacts {
                let detail = resolution.typical_edge(&scene);
                isolux_core::Problem::cut_along_contacts(scene, resolution, detail)
            } else {
                isolux_core::Problem::new(scene, resolution)
            }
        })?;
        Ok(Problem::new(problem))
    }

    fn known(&self) -> &Known {
        self.known.get_or_init(|| Known::of(&self.inner))
    }
}

#[pymethods]
impl Problem {
    /// Cuts `scene` into flat elements, each a part of one triangle.
    #[new]
    fn of_flat_elements(
        py: Python,
        scene: &Scene,
        elements: Option<u64>,
        max_edge: Option<f32>,
        contacts: bool,
    ) -> Result<Problem, Fail> {
        let resolution =
            max_edge.map_or(Resolution::Elements(elements.unwrap_or(DETERMINISTIC_ELEMENTS)), Resolution::MaxEdge);
        Problem::cut(py, scene, resolution, contacts)
    }

    fn __len__(&self) -> usize {
        self.inner.mesh.len()
    }

    fn scene(&self) -> Scene {
        Scene { inner: self.inner.scene.clone() }
    }

    #[getter]
    fn scene_name(&self) -> &str {
        &self.inner.scene.name
    }

    #[getter]
    fn has_clusters(&self) -> bool {
        self.inner.mesh.has_clusters()
    }

    #[getter]
    fn object_names(&self) -> Vec<String> {
        self.inner.scene.objects.iter().map(|object| object.name.clone()).collect()
    }

    #[getter]
    fn areas<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<f32>> {
        view(slf, |problem| &problem.known().areas)
    }

    #[getter]
    fn centres<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f32>> {
        view_of_triples(slf, |problem| &problem.known().centres)
    }

    #[getter]
    fn normals<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f32>> {
        view_of_triples(slf, |problem| &problem.known().normals)
    }

    #[getter]
    fn reflectivity<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f32>> {
        view_of_triples(slf, |problem| &problem.known().reflectivity)
    }

    #[getter]
    fn emission<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f32>> {
        view_of_triples(slf, |problem| &problem.known().emission)
    }

    #[getter]
    fn objects<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<u32>> {
        view(slf, |problem| &problem.known().objects)
    }

    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<u32>> {
        view(slf, |problem| &problem.known().triangles)
    }

    #[getter]
    fn backs<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<bool>> {
        view(slf, |problem| &problem.known().backs)
    }

    /// The triangles that show the elements: their corners (p, 3, 3), and the element of each (p,).
    #[expect(clippy::type_complexity)]
    fn pieces<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyArray3<f32>>, Bound<'py, PyArray1<u32>>)> {
        let problem = &*self.inner;
        let (corners, elements): (Vec<[[f32; 3]; 3]>, Vec<u32>) = export::pieces(problem)
            .map(|(e, place)| (export::corners(problem, place).map(|corner| corner.to_array()), e))
            .unzip();
        let count = corners.len();
        let corners = corners.into_flattened().into_flattened().into_pyarray(py).reshape([count, 3, 3])?;
        Ok((corners, elements.into_pyarray(py)))
    }

    /// The element in the middle of every pixel, -1 where there is none.
    fn seen<'py>(
        &self,
        py: Python<'py>,
        camera: Option<String>,
        width: u32,
        height: Option<u32>,
    ) -> Result<Bound<'py, PyArray2<i64>>, Fail> {
        let options = ViewOptions { camera, width, height, ..ViewOptions::default() };
        let picture = to_its_end(py, || elements(&self.inner, &options))?;
        let shape = [picture.height as usize, picture.width as usize];
        let numbers: Vec<i64> = picture.elements.into_iter().map(transport::number).collect();
        Ok(numbers.into_pyarray(py).reshape(shape)?)
    }

    /// The element that each ray meets first (-1 for none, -2 for the back of a one-sided surface), and at what distance [m].
    #[expect(clippy::type_complexity)]
    fn trace<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray2<f32>,
        directions: PyReadonlyArray2<f32>,
        leaving: Option<PyReadonlyArray1<i64>>,
    ) -> Result<(Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<f32>>), Fail> {
        let (origins, directions) = (rows(&origins, "origins")?, rows(&directions, "directions")?);
        let leaving = leaving.as_ref().map(|leaving| numbers(leaving, "leaving")).transpose()?;
        let rays = transport::rays(&self.inner, origins, directions, leaving)?;
        let (elements, distances) = py.detach(|| transport::trace(&self.inner, &rays));
        Ok((elements.into_pyarray(py), distances.into_pyarray(py)))
    }

    /// Cosine-distributed rays from uniform points: origins and unit vectors, (n, 3) each.
    #[expect(clippy::type_complexity)]
    fn local_lines<'py>(
        &self,
        py: Python<'py>,
        elements: PyReadonlyArray1<i64>,
        samples: PyReadonlyArray2<f32>,
    ) -> Result<(Bound<'py, PyArray2<f32>>, Bound<'py, PyArray2<f32>>), Fail> {
        let (elements, samples) = (numbers(&elements, "elements")?, rows(&samples, "samples")?);
        let (origins, directions) = transport::local_lines(&self.inner, elements, samples)?;
        Ok((two_dimensional(py, origins)?, two_dimensional(py, directions)?))
    }

    /// Uniform points, and the unit normals there, (n, 3) each.
    #[expect(clippy::type_complexity)]
    fn points<'py>(
        &self,
        py: Python<'py>,
        elements: PyReadonlyArray1<i64>,
        samples: PyReadonlyArray2<f32>,
    ) -> Result<(Bound<'py, PyArray2<f32>>, Bound<'py, PyArray2<f32>>), Fail> {
        let (elements, samples) = (numbers(&elements, "elements")?, rows(&samples, "samples")?);
        let (points, normals) = transport::points(&self.inner, elements, samples)?;
        Ok((two_dimensional(py, points)?, two_dimensional(py, normals)?))
    }
}
