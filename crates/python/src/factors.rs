//! Form factors as the arrays of a sparse matrix.

use crate::background::in_background;
use crate::fail::Fail;
use crate::problem::Problem;
use crate::view::view;
use isolux_core::Error;
use isolux_core::form_factors::{Correction, FormFactors as Matrix, Reciprocity, Settings, compute, way};
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

#[pyclass(frozen, module = "isolux._native")]
pub struct FormFactors {
    inner: Matrix,
}

/// How finely they are computed: the entries of a dict.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Fineness {
    rays: u32,
    resolution: u16,
    hemicubes: u16,
    visibility: u16,
    seed: u64,
}

/// The form factors between all elements; `watch(done, all)` is told how many rows there are.
#[pyfunction]
pub fn form_factors(
    problem: &Bound<Problem>,
    by: &str,
    fineness: Fineness,
    correct: &str,
    threads: Option<usize>,
    watch: &Bound<PyAny>,
) -> Result<FormFactors, Fail> {
    let py = problem.py();
    let problem = &*problem.get().inner;
    let Fineness { rays, resolution, hemicubes, visibility, seed } = fineness;
    let settings = Settings { rays, resolution, hemicubes, visibility, seed };
    let all = Correction::ALL;
    let correction = all.into_iter().find(|correction| correction.name() == correct);
    let correction =
        correction.ok_or_else(|| Error::unknown_name("correction", correct, all.iter().map(|known| known.name())))?;
    let way = way(by, problem, &settings)?;

    let (done, rows, is_stopped) = (AtomicU64::new(0), problem.mesh.len() as u64, AtomicBool::new(false));
    let look = || {
        let looked = py.check_signals().and_then(|()| watch.call1((done.load(Ordering::Relaxed), rows)).map(drop));
        is_stopped.fetch_or(looked.is_err(), Ordering::Relaxed);
        looked
    };
    let work = || {
        let computed = compute(problem, &*way, |now, _| {
            done.store(now, Ordering::Relaxed);
            if is_stopped.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        computed.map(|factors| correction.apply(factors))
    };
    let inner = in_background(py, threads, look, work)?;
    Ok(FormFactors { inner: inner.ok_or_else(|| PyKeyboardInterrupt::new_err("interrupted"))? })
}

#[pymethods]
impl FormFactors {
    #[getter]
    fn values<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<f64>> {
        view(slf, |factors| factors.inner.values())
    }

    /// Of each value; empty if there are none.
    #[getter]
    fn std_errors<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<f32>> {
        view(slf, |factors| factors.inner.std_errors())
    }

    #[getter]
    fn areas<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<f64>> {
        view(slf, |factors| factors.inner.areas())
    }

    /// The column of each value, as SciPy counts.
    fn indices<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i32>> {
        self.inner.columns().iter().map(|&column| column as i32).collect::<Vec<_>>().into_pyarray(py)
    }

    /// Where each row starts, and the end of the last.
    fn starts<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i32>> {
        self.inner.starts().iter().map(|&start| start as i32).collect::<Vec<_>>().into_pyarray(py)
    }

    /// Largest difference [m²] between `A_i F_ij` and `A_j F_ji`, and the RMS difference over the RMS exchange area.
    fn reciprocity(&self, py: Python) -> (f64, f64) {
        let Reciprocity { largest, relative_rms } = py.detach(|| self.inner.reciprocity());
        (largest, relative_rms)
    }
}
