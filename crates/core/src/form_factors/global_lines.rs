//! Form factors by global lines: each span between two elements counts for both (Sbert 1993).
//!
//! Of N lines `N_i = N A_i / (2 pi R²)` are expected to cross element i, and `F_ij ≈ N_ij / N_i` with the number of spans `N_ij =
//! N_ji`: reciprocal by construction, rows sum to one on average only. Unbiased. The standard error is that of counts,
//! `sqrt(N_ij) / N_i`; it falls like `1 / sqrt(A_i)`, for a small element is crossed by few lines. All lines are traced before
//! the first row. Cost: one ray of all hits a line.

use super::{MOST_ENTRIES, Row, Settings, Way};
use crate::sampling::OwenSobol;
use crate::transport::{End, Span, global_line};
use crate::{Error, Problem};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Lines traced by one thread at a time.
const CHUNK: u64 = 1 << 14;

/// Spans counted, for each element.
#[derive(Clone, Debug)]
pub struct GlobalLines {
    /// Elements seen, as often as they were.
    seen: Vec<Vec<u32>>,
    back_faces: Vec<u32>,
    /// Expected crossings for each square metre.
    crossings_per_area: f64,
}

impl GlobalLines {
    /// Traces so many lines that an element of mean area is crossed `settings.rays` times.
    ///
    /// # Errors
    /// [`Error::Parameter`] without rays, and for more crossings in all than [`MOST_ENTRIES`].
    pub fn new(problem: &Problem, settings: &Settings) -> Result<GlobalLines, Error> {
        let mesh = &problem.mesh;
        let parameter = |allowed| Err(Error::Parameter { name: "rays", value: settings.rays.to_string(), allowed });
        if settings.rays == 0 {
            return parameter("ask for at least one line");
        }
        let crossings = u64::from(settings.rays) * mesh.len() as u64;
        if crossings > MOST_ENTRIES {
            return parameter(
                "all elements together can be crossed 100 million times; ask for fewer lines or elements",
            );
        }
        let radius = f64::from(problem.geometry.bounding_sphere().1);
        let lines = (crossings as f64 * TAU * radius.powi(2) / mesh.total_area()).ceil() as u64;
        let sequence = OwenSobol::new(settings.seed);
        let trace = |chunk: u64| {
            let mut spans = Vec::new();
            let first = chunk * CHUNK;
            global_line::trace(problem, &sequence, first..(first + CHUNK).min(lines), |span| spans.push(span));
            spans
        };
        let spans: Vec<Vec<Span>> = (0..lines.div_ceil(CHUNK)).into_par_iter().map(trace).collect();
        let mut counted = GlobalLines {
            seen: vec![Vec::new(); mesh.len()],
            back_faces: vec![0; mesh.len()],
            crossings_per_area: global_line::expected_crossings(lines, 1.0, radius as f32),
        };
        for Span { from, to } in spans.into_iter().flatten() {
            counted.count(from, to);
            counted.count(to, from);
        }
        Ok(counted)
    }

    fn count(&mut self, from: End, to: End) {
        let Some(from) = from.element() else { return };
        match to.element() {
            Some(to) => self.seen[from as usize].push(to),
            None if to == End::BACK_FACE => self.back_faces[from as usize] += 1,
            None => {}
        }
    }
}

impl Way for GlobalLines {
    fn row(&self, problem: &Problem, element: u32) -> Row {
        let k = element as usize;
        let expected = f64::from(problem.mesh.area(element)) * self.crossings_per_area;
        let seen = self.seen[k].iter().map(|&element| (element, 1.0)).collect();
        let mut row = Row { back_face: f64::from(self.back_faces[k]) / expected, ..Row::collect(element, seen) };
        row.std_errors = row.entries.iter().map(|&(_, count)| (f64::sqrt(count) / expected) as f32).collect();
        row.entries.iter_mut().for_each(|(_, count)| *count /= expected);
        row
    }

    fn most_entries(&self, elements: u64) -> u64 {
        let most = self.seen.iter().map(Vec::len).max().unwrap_or(0) as u64;
        elements.min(most)
    }
}
