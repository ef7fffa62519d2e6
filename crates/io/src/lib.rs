//! Bytes to scenes, and solutions to bytes. The only place in isolux that knows file formats; [`files`] is the only one
//! that opens a file.

pub mod checkpoint_file;
mod container;
mod error;
pub mod export;
pub mod files;
#[cfg(test)]
mod fixture;
pub mod import;
pub mod solution_file;

pub use error::Error;
