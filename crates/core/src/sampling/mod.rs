//! Sample numbers: points of the unit hypercube by stream and index, one sequence a file.
//!
//! A line needs four numbers: two for its point on the element, two for its direction. [`address`] decides which index of
//! which stream a line draws; [`SEQUENCES`] is the table of all sequences, and `construction` holds what they are built of.
//!
//! Every sequence is randomised anew for each seed and stream. So each point is uniform on its own (estimates are unbiased),
//! streams are independent (replicates give standard errors), and the points of one stream keep the evenness of their
//! sequence. Any index below 2^63 can be drawn first, and no stream repeats itself within 2^40 points.

pub mod address;
mod construction;
mod faure;
mod generalised_faure;
mod halton;
mod niederreiter;
mod owen_sobol;
mod random;
mod scrambled_halton;
mod sobol;
mod table;

pub use owen_sobol::OwenSobol;
pub use table::{Entry, SEQUENCES, SequenceName};

/// Four sample numbers in [0, 1).
pub type Sample = [f32; 4];

/// A family of point sequences, one for each stream, with random access and as many dimensions as are asked for.
pub trait Sequence: Send + Sync {
    /// The first four numbers of points `first, first + 1, ...` of `stream` into `points`.
    fn fill(&self, stream: u64, first: u64, points: &mut [Sample]);

    /// Number `dimension`, from 0, of point `index` of `stream`, in [0, 1); `fill` gives 0 to 3. A random walk decides
    /// survival by number 4; Keller's walks take their whole path from one point.
    fn number(&self, stream: u64, index: u64, dimension: u32) -> f32;
}
