//! How light gets from one element to another: the lines, and where they arrive.

pub mod arrival;
pub mod bundle;
pub mod bundle_gather;
pub mod crossing;
pub mod footprint;
pub mod global_line;
pub mod lamp;
pub mod local_line;
pub mod span;

pub use arrival::{Arrival, arrivals};
pub use bundle::Bundle;
pub use crossing::{Crossing, End, Met};
pub use footprint::{Footprint, Leaving, Spot};
pub use local_line::Departure;
pub use span::{Span, spans};
