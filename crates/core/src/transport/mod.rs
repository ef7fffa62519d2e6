//! How light gets from one element to another: the lines, and where they arrive.

pub mod arrival;
pub mod footprint;
pub mod lamp;
pub mod local_line;

pub use arrival::{Arrival, arrivals};
pub use footprint::{Footprint, Leaving, Spot};
pub use local_line::Departure;
