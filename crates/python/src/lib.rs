//! `isolux._native`: core, io, studies and the command line, as Python sees them.
//!
//! Thin: it converts, lets go of the interpreter while something is computed, and turns errors into exceptions. What is made for people
//! is in `python/isolux`, in Python. Where an array is large it is a view on memory that Rust owns ([`view`]); where something is
//! small and has many parts it crosses as JSON.

mod background;
mod factors;
mod fail;
mod problem;
mod request;
mod scene;
mod solution;
mod solve;
mod study;
mod tables;
mod transport;
mod view;

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the command line `args`, the first of which is the program's name; the exit code.
#[pyfunction]
fn run(py: Python, args: Vec<OsString>) -> u8 {
    py.detach(|| isolux_cli::run(args))
}

#[pymodule]
fn _native(module: &Bound<PyModule>) -> PyResult<()> {
    module.add("__version__", isolux_core::VERSION)?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<problem::Problem>()?;
    module.add_class::<request::Request>()?;
    module.add_class::<solution::Solution>()?;
    module.add_class::<factors::FormFactors>()?;
    module.add_function(wrap_pyfunction!(solve::solve, module)?)?;
    module.add_function(wrap_pyfunction!(factors::form_factors, module)?)?;
    module.add_function(wrap_pyfunction!(study::study, module)?)?;
    module.add_function(wrap_pyfunction!(tables::names, module)?)?;
    module.add_function(wrap_pyfunction!(tables::student, module)?)?;
    module.add_function(wrap_pyfunction!(run, module)?)?;
    Ok(())
}
