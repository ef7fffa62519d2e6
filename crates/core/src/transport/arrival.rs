//! Where lines arrive.

use super::Spot;
use crate::Problem;
use crate::geometry::{Hit, Ray};
use glam::Vec2;

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
    /// At barycentric coordinates `uv` of `triangle`, on its front or its back.
    #[inline]
    pub fn at(problem: &Problem, triangle: u32, uv: Vec2, back: bool) -> Arrival {
        let element = |(element, uv)| Arrival::Element { element, spot: Spot::at(uv) };
        problem.mesh.locate(triangle, uv, back).map_or(Arrival::BackFace, element)
    }
}

/// Traces `rays` and hands each ray's number and arrival to `each`, in order. `hits` is working memory.
pub fn arrivals(problem: &Problem, rays: &[Ray], hits: &mut Vec<Hit>, mut each: impl FnMut(usize, Arrival)) {
    hits.clear();
    hits.resize(rays.len(), Hit::MISS);
    problem.geometry.closest(rays, hits);
    for (k, hit) in hits.iter().enumerate() {
        let met = || Arrival::at(problem, hit.triangle, hit.uv, hit.back);
        each(k, if hit.is_miss() { Arrival::Escaped } else { met() });
    }
}
