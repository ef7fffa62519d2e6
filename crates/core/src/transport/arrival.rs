//! Where lines arrive.

use super::Footprint;
use crate::Problem;
use crate::geometry::{Hit, Ray};

/// What lies at the end of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// An element, and on which of its cells (see [`Footprint`]).
    Element { element: u32, cell: u8 },
    /// The back of a one-sided surface, which is black.
    BackFace,
    /// Nothing: the line leaves the scene.
    Escaped,
}

/// Traces `rays` and hands each ray's number and arrival to `each`, in order. `hits` is working memory.
pub fn arrivals(problem: &Problem, rays: &[Ray], hits: &mut Vec<Hit>, mut each: impl FnMut(usize, Arrival)) {
    hits.clear();
    hits.resize(rays.len(), Hit::MISS);
    problem.geometry.closest(rays, hits);
    for (k, hit) in hits.iter().enumerate() {
        let arrival = if hit.is_miss() {
            Arrival::Escaped
        } else {
            problem.mesh.at(hit.triangle, hit.uv, hit.back).map_or(Arrival::BackFace, |element| Arrival::Element {
                element,
                cell: Footprint::cell_at(problem.mesh.within(hit.triangle, hit.uv)),
            })
        };
        each(k, arrival);
    }
}
