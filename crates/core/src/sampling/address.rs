//! Which points of which stream a line draws: an axis of its own, for it decides bias and convergence.
//!
//! In the first two every source owns a stream and a counter, so its lines are well distributed whatever the order in which an
//! algorithm shoots.
//!
//! - *Per element* (Bekaert, Cools & Willems 1999): the counter runs on from iteration to iteration. The k-th line
//!   that ever leaves a source uses the k-th point of its stream. **Biased** where lines are few: later points of a stream avoid
//!   the earlier ones, while the power they carry depends on where the earlier ones went.
//! - *Per iteration*: the stream is scrambled anew at the start of each iteration and the counter starts at zero. Points
//!   are independent of the power they carry, so the estimate is unbiased.
//! - *Per particle*: the k-th line of a random walk uses the numbers 5k to 5k + 4 of the point of its particle, so a path needs as
//!   many dimensions as it is long. Unbiased, but the lines that leave an element are hardly better distributed than chance.

use crate::math::hash::derive;

/// How the lines of an iteration are addressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Address {
    PerElement,
    #[default]
    PerIteration,
    PerParticle,
}

/// The counters of all streams: 4 bytes a source for [`Address::PerElement`], none for the others.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Counters {
    drawn: Vec<u32>,
}

impl Address {
    pub const ALL: [Address; 3] = [Address::PerIteration, Address::PerElement, Address::PerParticle];

    pub fn name(self) -> &'static str {
        match self {
            Address::PerElement => "per-element",
            Address::PerIteration => "per-iteration",
            Address::PerParticle => "per-particle",
        }
    }

    /// Counters of `sources` streams, all at zero.
    pub fn counters(self, sources: usize) -> Counters {
        Counters { drawn: if self == Address::PerElement { vec![0; sources] } else { Vec::new() } }
    }

    /// Seed of the sequence for `iteration` of a run with `seed`.
    pub fn sequence_seed(self, seed: u64, iteration: u64) -> u64 {
        if self == Address::PerElement { seed } else { derive(seed, iteration) }
    }
}

impl Counters {
    /// Index of the next point of `source`.
    pub fn next(&self, source: u32) -> u64 {
        self.drawn.get(source as usize).map_or(0, |&drawn| u64::from(drawn))
    }

    /// Notes that an iteration has used `count` points of `source`. A counter that would pass 2^32 starts again.
    pub fn advance(&mut self, source: u32, count: u32) {
        if let Some(drawn) = self.drawn.get_mut(source as usize) {
            *drawn = drawn.wrapping_add(count);
        }
    }

    /// Starts every stream again.
    pub fn reset(&mut self) {
        self.drawn.fill(0);
    }
}
