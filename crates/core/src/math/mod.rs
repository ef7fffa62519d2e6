//! Small mathematics that everything else stands on: colour, frames, warps, moments.

pub mod color;
pub mod frame;
pub mod hash;
pub mod moments;
pub mod warp;

pub use color::Rgb;
pub use frame::Frame;
