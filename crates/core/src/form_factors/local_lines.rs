//! Form factors by local lines: the share of the cosine-distributed lines from an element that end on another.
//!
//! `F_ij ≈ N_ij / N`. Unbiased. The standard error is that of N independent lines, `sqrt(F (1 - F) / N)`; lines of an
//! Owen-scrambled Sobol' sequence are better distributed than that, so it is on the safe side. Where a single line landed it
//! is no more than a guess, and what no line has met is missing from the row. Cost: N rays an element.

use super::{Row, Settings, Way};
use crate::sampling::{OwenSobol, Sequence};
use crate::transport::{Arrival, Departure, Footprint, arrivals};
use crate::{Error, Problem};

/// Rays traced at once.
const BATCH: u64 = 512;

#[derive(Clone, Copy, Debug)]
pub struct LocalLines {
    rays: u32,
    sequence: OwenSobol,
}

impl LocalLines {
    /// # Errors
    /// [`Error::Parameter`] without rays.
    pub fn new(settings: &Settings) -> Result<LocalLines, Error> {
        if settings.rays == 0 {
            return Err(Error::Parameter { name: "rays", value: "0".into(), allowed: "ask for at least one line" });
        }
        Ok(LocalLines { rays: settings.rays, sequence: OwenSobol::new(settings.seed) })
    }
}

impl Way for LocalLines {
    fn row(&self, problem: &Problem, element: u32) -> Row {
        let departure = Departure::new(problem, element, Footprint::WHOLE);
        let lines = u64::from(self.rays);
        let (mut landed, mut back_face) = (Vec::with_capacity(lines as usize), 0u32);
        let (mut samples, mut hits) = ([[0.0; 4]; BATCH as usize], Vec::new());
        for first in (0..lines).step_by(BATCH as usize) {
            let samples = &mut samples[..(lines - first).min(BATCH) as usize];
            self.sequence.fill(u64::from(element), first, samples);
            let rays: Vec<_> = samples.iter().map(|&sample| departure.ray(sample)).collect();
            arrivals(problem, &rays, &mut hits, |_, arrival| match arrival {
                Arrival::Element { element, .. } => landed.push((element, 1.0)),
                Arrival::BackFace => back_face += 1,
                Arrival::Escaped => {}
            });
        }
        let n = f64::from(self.rays);
        let mut row = Row { back_face: f64::from(back_face) / n, ..Row::collect(element, landed) };
        row.entries.iter_mut().for_each(|(_, count)| *count /= n);
        row.std_errors = row.entries.iter().map(|&(_, f)| (f * (1.0 - f) / n).sqrt() as f32).collect();
        row
    }

    fn most_entries(&self, elements: u64) -> u64 {
        elements.min(u64::from(self.rays))
    }
}
