//! Where lines arrive.

use super::Spot;
use crate::Problem;
use crate::geometry::{Hit, Ray};

/// What lies at the end of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// An element, and where on it.
    Element { element: u32, spot: Spot },
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
            let located = problem.mesh.locate(hit.triangle, hit.uv, hit.back);
            located.map_or(Arrival::BackFace, |(element, uv)| {
                let spot = Spot::at(uv);
                Arrival::Element { element, spot }
            })
        };
        each(k, arrival);
    }
}
