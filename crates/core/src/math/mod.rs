//! Small mathematics that everything else stands on: colour, error bars, frames, warps, moments, spherical triangles, which points are one, what hangs together, whole
//! parts.

pub mod color;
pub mod disjoint_sets;
pub mod estimate;
pub mod frame;
pub mod hash;
pub mod moments;
pub mod spherical_triangle;
pub mod warp;
pub mod weld;
pub mod whole;

pub use color::Rgb;
pub use disjoint_sets::DisjointSets;
pub use estimate::Estimate;
pub use frame::Frame;
pub use spherical_triangle::SphericalTriangle;
