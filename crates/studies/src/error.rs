//! Everything that can go wrong in a study.

use std::path::PathBuf;

#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// What is asked for does not exist or cannot be solved.
    #[error(transparent)]
    Core(#[from] isolux_core::Error),

    /// A file cannot be read or written.
    #[error(transparent)]
    Io(#[from] isolux_io::Error),

    /// A `study.toml`, or one of its series, says something wrong.
    #[error("study '{study}': {what}")]
    Spec { study: String, what: String },

    /// The folder holds something else than the first part of this study.
    #[error("{path}: {what}; choose another folder, or empty this one", path = path.display())]
    OtherRun { path: PathBuf, what: String },

    /// A table of results that cannot be read.
    #[error("{path}: line {line}: {what}", path = path.display())]
    Table { path: PathBuf, line: u64, what: String },

    /// The thread on which time is measured.
    #[error("no thread can be started: {0}")]
    Thread(#[from] rayon::ThreadPoolBuildError),

    #[error("the plot '{file}': {what}")]
    Plot { file: String, what: String },
}
