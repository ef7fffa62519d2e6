//! Sample numbers: points of the unit hypercube by stream and index, one sequence a file.
//!
//! A line needs four numbers: two for its point on the element, two for its direction. [`address`] decides which index of
//! which stream a line draws.

pub mod address;
mod owen_sobol;

pub use owen_sobol::OwenSobol;

/// Four sample numbers in [0, 1).
pub type Sample = [f32; 4];

/// A family of four-dimensional point sequences, one for each stream, with random access.
pub trait Sequence: Send + Sync {
    /// Points `first, first + 1, ...` of `stream` into `points`.
    fn fill(&self, stream: u64, first: u64, points: &mut [Sample]);
}
