//! Gathering: every element looks along local lines and averages the radiosity it sees.
//!
//! `E_i = Σ_j F_ij B_j`, estimated by the mean of `B_j` over the elements hit by `n_i` local lines. Its variance
//! `(Σ_j F_ij B_j² - E_i²) / n_i` does not depend on the area: it cleans the small elements that shooting rarely hits.
//! Unbiased for the given B. Cost: one ray each.

use super::allocation::Allocation;
use super::shooting::{BATCH, NO_SAMPLES, for_samples, ray_range};
use super::{Landing, Part};
use crate::Problem;
use crate::geometry::{Hit, Ray};
use crate::math::Rgb;
use crate::sampling::Sequence;
use crate::sampling::address::Counters;
use crate::transport::{Arrival, Departure, Footprint, Spot, arrivals};

/// One sweep of gathering, ready to be traced in pieces.
pub struct Sweep<'a> {
    pub problem: &'a Problem,
    pub sequence: &'a dyn Sequence,
    pub counters: &'a Counters,
    pub allocation: &'a Allocation,
}

impl Sweep<'_> {
    /// Traces the gathering rays of `piece`. `look(j)` is what there is to see on element j, and `light(i, n, seen, spot)` what a
    /// ray adds to element i, of whose n rays it is one, when it sees that spot of it; landings are the sums over the rays of each
    /// element in this piece.
    pub fn gather<Seen: Copy>(
        &self,
        piece: u64,
        look: impl Fn(u32) -> Seen,
        light: impl Fn(u32, u32, Seen, Spot) -> Rgb,
    ) -> Part {
        let range = ray_range(piece, self.allocation.rays());
        let mut part = Part { rays: range.end - range.start, ..Part::default() };
        let mut batch =
            Batch { rays: Vec::new(), receivers: Vec::new(), hits: Vec::new(), met: Vec::new(), seen: Vec::new() };
        let mut samples = NO_SAMPLES;
        for share in self.allocation.shares(range) {
            let departure = Departure::new(self.problem, share.source, Footprint::WHOLE);
            let first = self.counters.next(share.source) + u64::from(share.before);
            for_samples(self.sequence, share.source, first, share.count, &mut samples, |sample| {
                batch.rays.push(departure.ray(sample));
                batch.receivers.push((share.source, share.rays));
                if batch.rays.len() == BATCH {
                    batch.look(self.problem, &look, &light, &mut part);
                }
            });
        }
        batch.look(self.problem, &look, &light, &mut part);
        part
    }
}

/// Rays on their way, for whom (element, number of its rays), and what they met.
struct Batch<Seen> {
    rays: Vec<Ray>,
    receivers: Vec<(u32, u32)>,
    hits: Vec<Hit>,
    met: Vec<Arrival>,
    seen: Vec<Seen>,
}

impl<Seen: Copy> Batch<Seen> {
    /// Traces the rays, adds what they see to the landings, and empties the batch.
    fn look(
        &mut self,
        problem: &Problem,
        look: &impl Fn(u32) -> Seen,
        light: &impl Fn(u32, u32, Seen, Spot) -> Rgb,
        part: &mut Part,
    ) {
        self.met.clear();
        arrivals(problem, &self.rays, &mut self.hits, |_, arrival| self.met.push(arrival));
        // All look, those too that met nothing, and before anything is done with what they see: so memory answers many at once.
        self.seen.clear();
        self.seen.extend(self.met.iter().map(|arrival| look(arrival.element().unwrap_or(0))));
        for ((&(element, rays), &arrival), &seen) in self.receivers.iter().zip(&self.met).zip(&self.seen) {
            let seen = match arrival {
                Arrival::Element { spot, .. } => light(element, rays, seen, spot),
                Arrival::BackFace | Arrival::Escaped => Rgb::BLACK,
            };
            match part.landings.last_mut() {
                Some(landing) if landing.element == element => {
                    landing.light = (Rgb::from(landing.light) + seen).to_array()
                }
                _ => part.landings.push(Landing { element, spot: Spot::default(), light: seen.to_array() }),
            }
        }
        self.rays.clear();
        self.receivers.clear();
    }
}
