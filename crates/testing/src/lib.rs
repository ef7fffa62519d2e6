//! What isolux is tested with: statistics under one false-alarm budget, exact answers, projections of errors.
//!
//! A sampled result is judged by its own error bar, never by a tolerance chosen by eye.

pub mod battery;
pub mod budget;
pub mod contour;
pub mod ensemble;
pub mod exact;
pub mod honesty;
pub mod mutants;
pub mod projections;
pub mod random;
pub mod reference;
pub mod scenes;
pub mod statistics;
