//! Form factors: the share of the light that leaves element i which reaches element j.
//!
//! ```text
//! F_ij = (1/A_i) ∫_Ai ∫_Aj  cos(tx) cos(ty) vis(x,y) / (pi r²)  dA dA,     A_i F_ij = A_j F_ji,     Σ_j F_ij <= 1
//! ```
//!
//! The stochastic solvers never compute them. They are what the deterministic solvers work on, and what other programs may want
//! to have. One way to compute them a file, and a line in [`WAYS`]; all give a sparse matrix ([`FormFactors`]).

pub mod contour;
mod correction;
mod global_lines;
pub mod hemicube;
mod local_lines;
mod matrix;
pub mod polygon;
mod visibility;

pub use contour::Contour;
pub use correction::Correction;
pub use global_lines::GlobalLines;
pub use hemicube::Hemicube;
pub use local_lines::LocalLines;
pub use matrix::{FormFactors, Reciprocity};

use crate::{Error, Problem};
use rayon::prelude::*;
use std::ops::ControlFlow;

/// Entries that a matrix may have at most: over a gigabyte, and a few times that while it is put together and corrected.
pub const MOST_ENTRIES: u64 = 100_000_000;
/// Rows computed at once by each thread.
const ROWS_PER_THREAD: usize = 16;

/// How finely form factors are computed. Each way uses what concerns it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Settings {
    /// Lines from each element.
    pub rays: u32,
    /// Pixels along the edge of a hemicube, an even number.
    pub resolution: u16,
    /// Divisions of an element along its edge; a hemicube stands on each of the cells.
    pub hemicubes: u16,
    /// Divisions of an element along its edge where something blocks the view.
    pub visibility: u16,
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { rays: 4096, resolution: 64, hemicubes: 1, visibility: 4, seed: 1 }
    }
}

/// One row of the matrix, as it was computed.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Row {
    pub element: u32,
    /// Columns and their form factors, in the order of columns.
    pub entries: Vec<(u32, f64)>,
    /// Standard error of each entry, or nothing.
    pub std_errors: Vec<f32>,
    /// Share that falls on the backs of one-sided surfaces, as far as the way knows.
    pub back_face: f64,
}

/// A way to compute form factors.
pub trait Way: Send + Sync {
    /// The row of `element`. Pure: the same bits at every call.
    fn row(&self, problem: &Problem, element: u32) -> Row;

    /// Entries that a row may have at most, for `elements` elements.
    fn most_entries(&self, elements: u64) -> u64;

    /// Whether rows hold only columns right of the diagonal; the others follow by reciprocity.
    fn is_upper_half(&self) -> bool {
        false
    }
}

/// An entry of [`WAYS`].
#[derive(Clone, Copy, Debug)]
pub struct WayEntry {
    pub name: &'static str,
    /// One line for people.
    pub what: &'static str,
    pub source: &'static str,
    pub make: Make,
}

/// Makes a way ready for a problem.
pub type Make = fn(&Problem, &Settings) -> Result<Box<dyn Way>, Error>;

/// All ways. A new one is a file in this folder and a line here.
pub const WAYS: &[WayEntry] = &[
    WayEntry {
        name: "contour",
        what: "contour integrals, exact where nothing blocks the view; visibility on a grid of points elsewhere",
        source: "Lambert 1760; Sparrow 1963; Baum, Rushmeier & Winget 1989",
        make: |problem, settings| Ok(Box::new(Contour::new(problem, settings)?)),
    },
    WayEntry {
        name: "hemicube",
        what: "rays through the pixels of half a cube over the middle of each element",
        source: "Cohen & Greenberg 1985",
        make: |_, settings| Ok(Box::new(Hemicube::new(settings)?)),
    },
    WayEntry {
        name: "local-lines",
        what: "cosine-distributed lines from uniform points of each element, with standard errors",
        source: "Malley 1988",
        make: |_, settings| Ok(Box::new(LocalLines::new(settings)?)),
    },
    WayEntry {
        name: "global-lines",
        what: "lines across the whole scene, each of whose spans counts for both its ends, with standard errors",
        source: "Sbert 1993",
        make: |problem, settings| Ok(Box::new(GlobalLines::new(problem, settings)?)),
    },
];

/// The way called `name`.
///
/// # Errors
/// [`Error::UnknownName`]; those of the way; [`Error::Parameter`] for clusters of triangles, or if the matrix could have more than
/// [`MOST_ENTRIES`].
pub fn way(name: &str, problem: &Problem, settings: &Settings) -> Result<Box<dyn Way>, Error> {
    let found = WAYS.iter().find(|way| way.name == name);
    let entry =
        found.ok_or_else(|| Error::unknown_name("way to form factors", name, WAYS.iter().map(|way| way.name)))?;
    if problem.mesh.has_clusters() {
        let allowed = "form factors are computed between flat elements; cut the scene without clusters";
        return Err(Error::Parameter { name: "elements", value: "clusters of triangles".to_owned(), allowed });
    }
    let way = (entry.make)(problem, settings)?;
    let elements = problem.mesh.len() as u64;
    if elements.saturating_mul(way.most_entries(elements)) > MOST_ENTRIES {
        return Err(Error::Parameter {
            name: "elements",
            value: elements.to_string(),
            allowed: "the matrix could have more than 100 million form factors; 10000 elements always fit",
        });
    }
    Ok(way)
}

/// Computes the whole matrix on the current rayon pool. `observe` is told how many of all rows are done; `None` if it breaks
/// off. The same bits for any number of threads.
pub fn compute(
    problem: &Problem,
    way: &dyn Way,
    mut observe: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Option<FormFactors> {
    let elements: Vec<u32> = problem.mesh.elements().collect();
    let mut rows = Vec::with_capacity(elements.len());
    for chunk in elements.chunks(ROWS_PER_THREAD * rayon::current_num_threads()) {
        rows.par_extend(chunk.par_iter().map(|&element| way.row(problem, element)));
        if observe(rows.len() as u64, elements.len() as u64).is_break() {
            return None;
        }
    }
    Some(assemble(problem, way, rows))
}

/// The matrix of all `rows` of `way`, in their order.
pub fn assemble(problem: &Problem, way: &dyn Way, rows: Vec<Row>) -> FormFactors {
    let areas = problem.mesh.elements().map(|e| f64::from(problem.mesh.area(e))).collect();
    let factors = FormFactors::from_rows(areas, rows);
    if way.is_upper_half() { factors.mirrored() } else { factors }
}

impl Row {
    /// The row of `element` from contributions in any order; those to the same column are added.
    pub fn collect(element: u32, mut contributions: Vec<(u32, f64)>) -> Row {
        contributions.sort_by_key(|&(column, _)| column);
        let mut row = Row { element, ..Row::default() };
        for (column, value) in contributions {
            match row.entries.last_mut() {
                Some((last, sum)) if *last == column => *sum += value,
                _ => row.entries.push((column, value)),
            }
        }
        row
    }
}
