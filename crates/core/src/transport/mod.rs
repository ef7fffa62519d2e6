//! How light gets from one element to another: the lines, and where they arrive.

pub mod arrival;
pub mod bundle;
pub mod bundle_gather;
pub mod crossing;
pub mod direct_light;
pub mod footprint;
pub mod global_line;
pub mod lamp;
pub mod light_sampling;
pub mod local_line;
pub mod span;

pub use arrival::{Arrival, arrivals};
pub use bundle::Bundle;
pub use crossing::{Crossing, End, Met};
pub use direct_light::DirectEstimator;
pub use footprint::{Footprint, Leaving, Spot};
pub use light_sampling::LightSampler;
pub use local_line::{Departure, Start};
pub use span::{Span, spans};
