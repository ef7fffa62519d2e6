//! The global lines of one step, one by one or in bundles, and what leaves elements along them.
//!
//! Element i is crossed `N_i` times on average, in proportion to its area; with every crossing it sends off `D_i / N_i` of its flux
//! `D_i` (Sbert 1993). Unbiased: it sends `D_i` on average, in a single step more or less of it.

use crate::Problem;
use crate::math::Rgb;
use crate::sampling::Sequence;
use crate::solvers::monte_carlo::axes::Lines;
use crate::solvers::{Landing, Part};
use crate::transport::bundle::{self, Bundle};
use crate::transport::global_line;
use crate::transport::{End, Span, Spot};
use std::f64::consts::TAU;

/// Lines of a piece.
const LINES_PER_PIECE: u64 = 1 << 11;
/// Least and most samples of a bundle: more bundles are better, but each costs a look at every triangle.
const SAMPLES_OF_BUNDLE: [u64; 2] = [1 << 14, 1 << 18];

/// Lines of a step.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LineSet {
    kind: Kind,
    /// Expected crossings of an element for each square metre of it.
    crossings_per_area: f64,
    /// Expected number of crossings of all elements.
    samples: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
enum Kind {
    /// So many lines.
    Single(u64),
    /// So many bundles of so many lines squared.
    Bundles { count: u64, cells: u32 },
}

impl LineSet {
    /// Lines with about `samples` crossings of elements.
    pub fn new(problem: &Problem, lines: Lines, samples: u64) -> LineSet {
        let area = problem.mesh.total_area();
        let (kind, crossings_per_area) = if lines == Lines::Bundle {
            let least = SAMPLES_OF_BUNDLE[0].max(2 * problem.scene.triangles.len() as u64);
            let of_bundle = least.min(SAMPLES_OF_BUNDLE[1]).min(samples.max(1));
            let of_one_cell = area * bundle::crossings_per_area(problem, 1);
            let cells = (of_bundle as f64 / of_one_cell).sqrt().ceil().clamp(1.0, 8192.0) as u32;
            let crossings = bundle::crossings_per_area(problem, cells);
            let count = (samples as f64 / (crossings * area)).ceil();
            (Kind::Bundles { count: count as u64, cells }, crossings * count)
        } else {
            let radius = f64::from(problem.geometry.bounding_sphere().1);
            let lines = (samples as f64 * TAU * radius.powi(2) / area).ceil() as u64;
            (Kind::Single(lines), global_line::expected_crossings(lines, 1.0, radius as f32))
        };
        LineSet { kind, crossings_per_area, samples: (crossings_per_area * area) as u64 }
    }

    pub fn pieces(&self) -> u64 {
        match self.kind {
            Kind::Single(lines) => lines.div_ceil(LINES_PER_PIECE),
            Kind::Bundles { count, .. } => count,
        }
    }

    /// Expected number of samples: crossings of elements.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Expected crossings for each square metre of an element.
    pub fn crossings_per_area(&self) -> f64 {
        self.crossings_per_area
    }

    /// What leaves along the lines of `piece`, where `flux(i)` [lm] shall leave element i with all lines together.
    pub fn shoot(&self, problem: &Problem, sequence: &dyn Sequence, piece: u64, flux: impl Fn(u32) -> Rgb) -> Part {
        let mut part = Part::default();
        // Light leaves from all of an element along global lines: where it has landed is of no meaning.
        let spot = Spot::default();
        let mut send = |from: End, to: End| {
            let Some(element) = from.element() else { return };
            part.rays += 1;
            let light = flux(element) / (f64::from(problem.mesh.area(element)) * self.crossings_per_area) as f32;
            match to.element() {
                _ if light.is_black() => {}
                Some(element) => part.landings.push(Landing { element, spot, light: light.to_array() }),
                None if to == End::BACK_FACE => part.back_face += light.luminance_f64(),
                None => part.escaped += light.luminance_f64(),
            }
        };
        self.for_spans(problem, sequence, piece, |Span { from, to }| {
            send(from, to);
            send(to, from);
        });
        part
    }

    /// The spans of `piece`, for those who send light along one after the other.
    pub fn collect(&self, problem: &Problem, sequence: &dyn Sequence, piece: u64) -> Part {
        let mut part = Part::default();
        self.for_spans(problem, sequence, piece, |span| part.spans.push(span));
        part.rays =
            part.spans.iter().flat_map(|span| [span.from, span.to]).filter(|end| end.is_element()).count() as u64;
        part
    }

    fn for_spans(&self, problem: &Problem, sequence: &dyn Sequence, piece: u64, each: impl FnMut(Span)) {
        match self.kind {
            Kind::Single(lines) => {
                let first = piece * LINES_PER_PIECE;
                global_line::trace(problem, sequence, first..(first + LINES_PER_PIECE).min(lines), each);
            }
            Kind::Bundles { cells, .. } => {
                // The number of cells is within the limit by the way it was made.
                let Ok(bundle) = Bundle::nth(problem, sequence, piece, cells) else { return };
                bundle.spans(0..bundle.tiles(), each);
            }
        }
    }
}
