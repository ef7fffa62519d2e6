//! Where other surfaces stand on triangles or pass through them.
//!
//! Rooms are made of things that stand on floors and walls that pass through ceilings. An element that such a wall runs through belongs to
//! both sides: it carries light from the bright one to the dark one, and its mean is right on neither. So elements are cut along the
//! segments found here by the mesh (discontinuity meshing: Lischinski, Tampieri & Greenberg 1992, here of contacts alone).
//!
//! Exact up to the rounding of coordinates. What is smaller than a given detail is left out. Cost: a tree over the triangles, and a few
//! looks at the neighbours of every large one.

mod flat;
mod near;
mod segments;

use super::{Scene, Shape};
pub use flat::{Flat, Plane, Segment};
use near::Near;
use rayon::prelude::*;

/// Points closer than this share of the scene's diagonal are one.
const TOLERANCE: f64 = 2e-6;

/// All that touches or crosses the triangles of a scene.
#[derive(Clone, Debug)]
pub struct Contacts {
    /// In ascending order, those that are touched.
    pub triangles: Vec<Touched>,
    /// Points closer than this are one [m].
    pub tolerance: f64,
}

/// A triangle that others touch or cross.
#[derive(Clone, Debug)]
pub struct Touched {
    pub triangle: u32,
    pub plane: Plane,
    /// Segments inside of it, in the coordinates of its plane [m]; end points are not shared exactly.
    pub inner: Vec<Segment>,
    /// Whether something stands on each of its edges, all along.
    pub borders: [bool; 3],
}

impl Contacts {
    /// As if nothing touched anything.
    pub const NONE: Contacts = Contacts { triangles: Vec::new(), tolerance: 0.0 };

    /// The contacts of the large triangles of `scene`: those with an edge of at least twice `detail` [m], with what is longer than it. Balls
    /// have none.
    pub fn of(scene: &Scene, detail: f32) -> Contacts {
        let (low, high) = scene.bounds();
        let tolerance = TOLERANCE * f64::from(low.distance(high));
        let detail = f64::from(detail);
        let near = Near::new(scene, tolerance as f32);
        let of_triangle = |triangle: u32| {
            let plane =
                Plane::new(scene.corners(triangle)).filter(|plane| plane.whole.longest_edge() >= 2.0 * detail)?;
            let (inner, borders) = segments::of_triangle(scene, triangle, &plane, &near, tolerance, detail);
            (!inner.is_empty() || borders.contains(&true)).then_some(Touched { triangle, plane, inner, borders })
        };
        let all = if scene.shape == Shape::Triangles { scene.triangles.len() as u32 } else { 0 };
        Contacts { triangles: (0..all).into_par_iter().filter_map(of_triangle).collect(), tolerance }
    }
}

#[cfg(test)]
mod tests;
