//! How much of the light between two elements gets through what stands between them.
//!
//! A first look joins the middles of four cells of either: if all 16 rays are clear, or all blocked, so are the elements.
//! Else both are cut into `divisions²` cells, a ray joins the middles of each pair, and the share is the sum of the form
//! factors of the clear pairs over that of all. Biased: what is narrower than a cell may be missed. Cost: 16 or `divisions⁴`
//! rays.

use super::contour::point_to_polygon;
use super::polygon::{Plane, centroid, clip, grid};
use crate::geometry::Ray;
use crate::{Error, Problem};
use glam::DVec3;

/// Divisions of the first look.
const FIRST_LOOK: u16 = 2;
/// Most divisions: 65,536 rays a pair.
const MOST_DIVISIONS: u16 = 16;
/// A ray stops this share of its length before its target.
const SHORTER: f32 = 1e-4;

#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub struct Visibility {
    divisions: u16,
}

impl Visibility {
    /// # Errors
    /// [`Error::Parameter`] for a number of divisions outside 1 to 16.
    pub fn new(divisions: u16) -> Result<Visibility, Error> {
        if (1..=MOST_DIVISIONS).contains(&divisions) {
            return Ok(Visibility { divisions });
        }
        let allowed = "the divisions of elements for visibility are from 1 to 16";
        Err(Error::Parameter { name: "visibility", value: divisions.to_string(), allowed })
    }

    /// Share, from 0 to 1, of the light between two elements that nothing blocks. They are given by their triangles, corners
    /// and planes; only parts in front of the other's plane count.
    pub fn share(
        self,
        problem: &Problem,
        triangles: [u32; 2],
        [first, second]: [[DVec3; 3]; 2],
        planes: [Plane; 2],
    ) -> f64 {
        let pairs = Pairs { problem, from: triangles[0], planes };
        match pairs.clear(first, second, FIRST_LOOK) {
            (clear, all) if clear == all || clear == 0.0 => f64::from(u8::from(clear > 0.0)),
            _ => match pairs.clear(first, second, self.divisions) {
                (_, 0.0) => 0.0,
                (clear, all) => clear / all,
            },
        }
    }
}

struct Pairs<'a> {
    problem: &'a Problem,
    /// Triangle that the rays leave.
    from: u32,
    planes: [Plane; 2],
}

impl Pairs<'_> {
    /// Sum of the form factors of the clear pairs of cells, and of all pairs.
    fn clear(&self, first: [DVec3; 3], second: [DVec3; 3], divisions: u16) -> (f64, f64) {
        let [plane, other_plane] = self.planes;
        let lift = f64::from(self.problem.geometry.lift());
        let (mut rays, mut reach, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        for x in grid(first, divisions).map(centroid).filter(|&x| other_plane.height(x) > 0.0) {
            let origin = x + plane.normal * lift;
            for cell in grid(second, divisions) {
                let part = clip(&cell, plane, lift);
                let weight = if part.is_empty() { 0.0 } else { point_to_polygon(x, plane.normal, &part) };
                let way = centroid(cell) - origin;
                if weight <= 0.0 || plane.height(centroid(cell)) <= 0.0 {
                    continue;
                }
                let direction = way.normalize_or_zero().as_vec3().normalize_or_zero();
                rays.push(Ray { origin: origin.as_vec3(), direction, from: self.from });
                reach.push(way.length() as f32 * (1.0 - SHORTER));
                weights.push(weight);
            }
        }
        let mut blocked = vec![false; rays.len()];
        self.problem.geometry.any(&rays, &reach, &mut blocked);
        let clear = weights.iter().zip(&blocked).filter(|(_, blocked)| !**blocked).map(|(weight, _)| weight);
        (clear.sum(), weights.iter().sum())
    }
}
