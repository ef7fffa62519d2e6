//! Shooting: every source sends its flux along local lines, and elements count what lands.
//!
//! Source i with flux `D_i` [lm] and luminance `s_i` shoots `n_i` of the N rays, `n_i ~ N s_i / S`; each carries
//! `D_i S / (N s_i)`, luminance S / N. The expected flux that lands on j is `Σ_i D_i F_ij`. Unbiased. Cost: one ray each.

use super::allocation::{Allocation, Share};
use super::{Landing, Part};
use crate::Problem;
use crate::geometry::{Hit, Ray};
use crate::math::Rgb;
use crate::sampling::address::Counters;
use crate::sampling::{Sample, Sequence};
use crate::transport::{Arrival, Departure, Footprint, arrivals, lamp};

/// Rays of one piece: large enough to hide the cost of handing out work, small enough to share well.
pub const RAYS_PER_PIECE: u64 = 1 << 12;
/// Rays traced at once; origins within a batch are neighbours.
pub(super) const BATCH: usize = 512;

/// One sweep of shooting, ready to be traced in pieces.
pub struct Sweep<'a> {
    pub problem: &'a Problem,
    pub sequence: &'a dyn Sequence,
    pub counters: &'a Counters,
    pub allocation: &'a Allocation,
    /// Luminous flux of all sources together, S [lm].
    pub total: f64,
}

/// Number of pieces that `rays` make.
pub fn pieces(rays: u64) -> u64 {
    rays.div_ceil(RAYS_PER_PIECE)
}

/// The rays of `piece`, of `rays` in all.
pub(super) fn ray_range(piece: u64, rays: u64) -> std::ops::Range<u64> {
    piece * RAYS_PER_PIECE..((piece + 1) * RAYS_PER_PIECE).min(rays)
}

impl Sweep<'_> {
    /// Shoots the rays of `piece`; `source(i)` is the flux [lm] that source i sends out, and from
    /// which part of it. Landings are fluxes [lm].
    ///
    /// Sources from the number of elements on are the scene's lights without extent.
    pub fn shoot(&self, piece: u64, source: impl Fn(u32) -> (Rgb, Footprint)) -> Part {
        let luminance = self.total / self.allocation.rays() as f64;
        self.shoot_each(piece, |share| {
            let (flux, footprint) = source(share.source);
            (flux * (luminance / flux.luminance_f64()) as f32, footprint)
        })
    }

    /// As [`Sweep::shoot`]; `ray(share)` is the flux [lm] of each ray of a source's share, whose luminance is the same for all
    /// rays.
    pub fn shoot_each(&self, piece: u64, ray: impl Fn(Share) -> (Rgb, Footprint)) -> Part {
        let range = ray_range(piece, self.allocation.rays());
        let luminance = self.total / self.allocation.rays() as f64;
        let mut part = Part { rays: range.end - range.start, ..Part::default() };
        part.landings.reserve(part.rays as usize);
        let mut batch = Batch::default();
        let mut samples = NO_SAMPLES;
        for share in self.allocation.shares(range) {
            let (color, footprint) = ray(share);
            self.depart(share, footprint, &mut samples, |ray| {
                batch.push(ray, color);
                if batch.rays.len() == BATCH {
                    batch.land(self.problem, luminance, &mut part);
                }
            });
        }
        batch.land(self.problem, luminance, &mut part);
        part
    }

    /// Hands the rays of `share` to `each`.
    fn depart(&self, share: Share, footprint: Footprint, samples: &mut Samples, mut each: impl FnMut(Ray)) {
        let Share { source, before, count, rays } = share;
        let elements = self.problem.mesh.len() as u32;
        let first = self.counters.next(source) + u64::from(before);
        if source < elements {
            let departure = Departure::new(self.problem, source, footprint.for_lines(rays));
            for_samples(self.sequence, source, first, count, samples, |sample| each(departure.ray(sample)));
        } else {
            let light = &self.problem.scene.lights[(source - elements) as usize];
            let sphere = self.problem.geometry.bounding_sphere();
            for_samples(self.sequence, source, first, count, samples, |sample| each(lamp::ray(light, sample, sphere)));
        }
    }
}

/// Working memory for sample numbers: most sources need few of them, so it is made once for many.
pub(super) type Samples = [Sample; 64];
pub(super) const NO_SAMPLES: Samples = [[0.0; 4]; 64];

/// Hands points `first, first + 1, ...`, `count` of them, of the stream of `source` to `each`.
pub(super) fn for_samples(
    sequence: &dyn Sequence,
    source: u32,
    first: u64,
    count: u32,
    samples: &mut Samples,
    mut each: impl FnMut(Sample),
) {
    let mut done = 0;
    while done < count {
        let now = (count - done).min(samples.len() as u32);
        let block = &mut samples[..now as usize];
        sequence.fill(u64::from(source), first + u64::from(done), block);
        block.iter().for_each(|&sample| each(sample));
        done += now;
    }
}

/// Rays on their way, and what each carries [lm].
#[derive(Default)]
struct Batch {
    rays: Vec<Ray>,
    light: Vec<Rgb>,
    hits: Vec<Hit>,
}

impl Batch {
    fn push(&mut self, ray: Ray, light: Rgb) {
        self.rays.push(ray);
        self.light.push(light);
    }

    /// Traces the rays, tallies where they land, and empties the batch.
    fn land(&mut self, problem: &Problem, luminance: f64, part: &mut Part) {
        arrivals(problem, &self.rays, &mut self.hits, |k, arrival| match arrival {
            Arrival::Element { element, spot } => {
                part.landings.push(Landing { element, spot, light: self.light[k].to_array() });
            }
            Arrival::BackFace => part.back_face += luminance,
            Arrival::Escaped => part.escaped += luminance,
        });
        self.rays.clear();
        self.light.clear();
    }
}
