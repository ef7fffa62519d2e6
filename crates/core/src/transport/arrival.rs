//! Where lines arrive.

use super::Spot;
use crate::Problem;
use crate::geometry::{Hit, Ray};
use crate::mesh::{Point, TOGETHER};

/// What lies at the end of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Arrival {
    /// An element, and where on it.
    Element { element: u32, spot: Spot },
    /// The back of a one-sided surface, which is black.
    BackFace,
    /// Nothing: the line leaves the scene.
    Escaped,
}

impl Arrival {
    /// The element, if it is one.
    pub fn element(self) -> Option<u32> {
        if let Arrival::Element { element, .. } = self { Some(element) } else { None }
    }
}

/// Traces `rays` and hands each ray's number and arrival to `each`, in order. `hits` is working memory.
pub fn arrivals(problem: &Problem, rays: &[Ray], hits: &mut Vec<Hit>, mut each: impl FnMut(usize, Arrival)) {
    hits.clear();
    hits.resize(rays.len(), Hit::MISS);
    problem.geometry.closest(rays, hits);
    for (chunk, first) in hits.chunks(TOGETHER).zip((0..).step_by(TOGETHER)) {
        let point = |k: usize| Point { triangle: chunk[k].triangle, uv: chunk[k].uv, back: chunk[k].back };
        problem.mesh.locate_together(chunk.len(), point, |k, found| {
            let arrival = match found {
                _ if chunk[k].is_miss() => Arrival::Escaped,
                Some((element, uv)) => Arrival::Element { element, spot: Spot::at(uv) },
                None => Arrival::BackFace,
            };
            each(first + k, arrival);
        });
    }
}
