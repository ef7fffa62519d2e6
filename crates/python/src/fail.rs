//! Errors become exceptions: one class of `isolux.errors` for each kind, with what it knows as attributes.

use isolux_core::scene::Fault;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Whatever can go wrong on the way to Python.
#[derive(Debug)]
pub enum Fail {
    Core(isolux_core::Error),
    Io(isolux_io::Error),
    Study(isolux_studies::Error),
    Fault(Fault),
    Json(serde_json::Error),
    Threads(rayon::ThreadPoolBuildError),
    Python(PyErr),
}

macro_rules! from {
    ($($kind:ident of $error:ty),+ $(,)?) => {
        $(impl From<$error> for Fail {
            fn from(error: $error) -> Fail {
                Fail::$kind(error)
            }
        })+
    };
}

from! {
    Core of isolux_core::Error,
    Io of isolux_io::Error,
    Study of isolux_studies::Error,
    Fault of Fault,
    Json of serde_json::Error,
    Threads of rayon::ThreadPoolBuildError,
    Python of PyErr,
}

impl From<Fail> for PyErr {
    fn from(fail: Fail) -> PyErr {
        Python::attach(|py| match fail {
            Fail::Core(error) => core(py, &error),
            Fail::Io(error) => io(py, &error),
            Fail::Study(error) => study(py, &error),
            Fail::Fault(fault) => {
                raise(py, "InvalidScene", &fault.to_string(), &[("place", &fault.place), ("what", &fault.what)])
            }
            Fail::Json(error) => PyRuntimeError::new_err(format!("isolux failed inside: {error}")),
            Fail::Threads(error) => PyRuntimeError::new_err(format!("no thread can be started: {error}")),
            Fail::Python(error) => error,
        })
    }
}

/// The exception `class` of `isolux.errors` with this message and attributes.
fn raise(py: Python, class: &str, message: &str, attributes: &[(&str, &dyn ToAttribute)]) -> PyErr {
    let made = || {
        let known = PyDict::new(py);
        attributes.iter().try_for_each(|(name, value)| known.set_item(name, value.to_attribute(py)?))?;
        py.import("isolux.errors")?.getattr(class)?.call((message,), Some(&known))
    };
    made().map_or_else(|error| error, PyErr::from_value)
}

/// What an exception can know.
trait ToAttribute {
    fn to_attribute<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>>;
}

macro_rules! to_attribute {
    ($($type:ty),+) => {
        $(impl ToAttribute for $type {
            fn to_attribute<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                Ok(self.into_pyobject(py)?.into_any())
            }
        })+
    };
}

to_attribute!(&str, String, u32, u64, f32, Option<i32>);

fn core(py: Python, error: &isolux_core::Error) -> PyErr {
    use isolux_core::Error::*;
    let text = error.to_string();
    let raise = |class: &str, attributes: &[(&str, &dyn ToAttribute)]| raise(py, class, &text, attributes);
    match error {
        NoSurface => raise("EmptyScene", &[]),
        TooManyElements { asked, limit } => raise("TooManyElements", &[("asked", asked), ("limit", limit)]),
        Parameter { name, value, allowed } => {
            raise("ParameterError", &[("name", name), ("value", value), ("allowed", allowed)])
        }
        UnknownName { kind, name, nearest } => {
            raise("UnknownName", &[("kind", kind), ("name", name), ("nearest", nearest)])
        }
        Meaningless { what, nearest } => raise("Meaningless", &[("what", what), ("nearest", nearest)]),
        Unused { method, option, why } => {
            raise("UnusedOption", &[("method", method), ("option", option), ("why", why)])
        }
        NotComparable { what } => raise("NotComparable", &[("what", what)]),
        NotMergeable { what } => raise("NotMergeable", &[("what", what)]),
        Lightmap { what } => raise("LightmapError", &[("what", what)]),
        NotFinite { element, what, value } => {
            raise("NotFinite", &[("element", element), ("what", what), ("value", value)])
        }
    }
}

fn io(py: Python, error: &isolux_io::Error) -> PyErr {
    use isolux_io::Error::*;
    let text = error.to_string();
    match error {
        File { path, source, action } => {
            let class = if source.kind() == std::io::ErrorKind::NotFound { "MissingFile" } else { "FileError" };
            let (path, code) = (path.display().to_string(), source.raw_os_error());
            raise(py, class, &text, &[("path", &path), ("action", action), ("code", &code)])
        }
        Invalid { file, place, what } => {
            raise(py, "InvalidFile", &text, &[("file", file), ("place", place), ("what", what)])
        }
        UnknownFormat { path, .. } => raise(py, "UnknownFormat", &text, &[("path", &path.display().to_string())]),
        NoViewer => raise(py, "NoViewer", &text, &[]),
        Core(error) => core(py, error),
    }
}

fn study(py: Python, error: &isolux_studies::Error) -> PyErr {
    use isolux_studies::Error::*;
    let text = error.to_string();
    match error {
        Core(error) => core(py, error),
        Io(error) => io(py, error),
        Spec { study, what } => raise(py, "InvalidStudy", &text, &[("study", study), ("what", what)]),
        OtherRun { path, what } => {
            raise(py, "OtherRun", &text, &[("path", &path.display().to_string()), ("what", what)])
        }
        Table { path, line, what } => {
            let (file, place) = (path.display().to_string(), format!("line {line}"));
            raise(py, "InvalidFile", &text, &[("file", &file), ("place", &place), ("what", what)])
        }
        Thread(_) | Plot { .. } => PyRuntimeError::new_err(text),
    }
}
