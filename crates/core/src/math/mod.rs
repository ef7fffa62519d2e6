//! Small mathematics that everything else stands on: colour, frames, warps, moments, spherical triangles, whole parts.

pub mod color;
pub mod frame;
pub mod hash;
pub mod moments;
pub mod spherical_triangle;
pub mod warp;
pub mod whole;

pub use color::Rgb;
pub use frame::Frame;
pub use spherical_triangle::SphericalTriangle;
