//! The names that can be asked for, and quantiles.

use crate::fail::Fail;
use isolux_core::Error;
use isolux_core::form_factors::WAYS;
use isolux_core::math::estimate;
use isolux_core::sampling::SEQUENCES;
use isolux_core::scene::builtin::BUILT_IN;
use isolux_core::solvers::deterministic::DETERMINISTIC;
use isolux_core::solvers::monte_carlo::METHODS;
use isolux_core::solvers::monte_carlo::orders::ORDERS;
use isolux_io::{export, import};
use isolux_studies::STUDIES;
use pyo3::prelude::*;

/// The names in a table: scenes, methods, orders, sequences, ways, studies, readers or writers.
#[pyfunction]
pub fn names(table: &str) -> Result<Vec<&'static str>, Fail> {
    Ok(match table {
        "scenes" => BUILT_IN.iter().map(|scene| scene.name).collect(),
        "methods" => {
            METHODS.iter().map(|entry| entry.name).chain(DETERMINISTIC.iter().map(|entry| entry.name)).collect()
        }
        "orders" => ORDERS.iter().map(|entry| entry.name).collect(),
        "sequences" => SEQUENCES.iter().map(|entry| entry.name).collect(),
        "ways" => WAYS.iter().map(|entry| entry.name).collect(),
        "studies" => STUDIES.iter().map(|study| study.name).collect(),
        "readers" => import::FORMATS.iter().flat_map(|format| format.extensions.iter().copied()).collect(),
        "writers" => export::FORMATS.iter().map(|format| format.ending.trim_start_matches('.')).collect(),
        _ => {
            let tables = ["scenes", "methods", "orders", "sequences", "ways", "studies", "readers", "writers"];
            return Err(Error::unknown_name("table", table, tables).into());
        }
    })
}

/// Student's t with so much freedom is within plus or minus this with probability `confidence`.
#[pyfunction]
pub fn student(confidence: f64, freedom: f64) -> f64 {
    estimate::student(confidence, freedom)
}
