//! Everything that can go wrong between bytes and scenes; each message names the file and the place in it.

use std::path::{Path, PathBuf};

#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The file cannot be opened, read or written.
    #[error("{path}: cannot {action}: {source}", path = path.display())]
    File { path: PathBuf, action: &'static str, source: std::io::Error },

    /// The file was read but what it says is wrong. `place` is a path inside it, like `meshes/3/primitives/0`.
    #[error("{file}: {place}: {what}")]
    Invalid { file: String, place: String, what: String },

    /// No reader or writer for this extension.
    #[error("{path}: unknown file type; {known}", path = path.display())]
    UnknownFormat { path: PathBuf, known: String },

    /// A page for browsers is asked for, and there is none to put the scene into.
    #[error(
        "pages cannot be written: this isolux was built without the viewer; 'make viewer' makes it (with npm), then build isolux again"
    )]
    NoViewer,

    /// What the file says makes no problem that can be solved.
    #[error(transparent)]
    Core(#[from] isolux_core::Error),
}

impl Error {
    /// The file at `path` says something wrong at `place`.
    pub fn invalid(path: &Path, place: impl Into<String>, what: impl Into<String>) -> Error {
        Error::Invalid { file: path.display().to_string(), place: place.into(), what: what.into() }
    }
}
