//! Elements as plane polygons in double precision.

use crate::Problem;
use crate::mesh::cells;
use glam::{DVec3, Vec2};

/// A plane: the points x with `normal · x = offset`.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Plane {
    pub normal: DVec3,
    pub offset: f64,
}

impl Plane {
    /// Through `point` with the unit `normal`.
    pub fn through(point: DVec3, normal: DVec3) -> Plane {
        Plane { normal, offset: normal.dot(point) }
    }

    /// Distance of `point`, positive in front [m].
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }
}

/// The part of a convex polygon that lies in front of `plane`; points within `tolerance` [m] of it lie on it. Empty if no
/// point is clearly in front.
pub fn clip(polygon: &[DVec3], plane: Plane, tolerance: f64) -> Vec<DVec3> {
    let heights: Vec<f64> = polygon.iter().map(|&p| plane.height(p)).collect();
    if heights.iter().all(|&h| h <= tolerance) {
        return Vec::new();
    }
    if heights.iter().all(|&h| h >= -tolerance) {
        return polygon.to_vec();
    }
    let mut part = Vec::with_capacity(polygon.len() + 1);
    for k in 0..polygon.len() {
        let next = (k + 1) % polygon.len();
        let (p, q, hp, hq) = (polygon[k], polygon[next], heights[k], heights[next]);
        if hp >= 0.0 {
            part.push(p);
        }
        if (hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0) {
            part.push(p + (q - p) * (hp / (hp - hq)));
        }
    }
    part
}

/// Corners [m] of an element of flat triangles, counter-clockwise seen from the side on which it lies.
pub fn element_corners(problem: &Problem, e: u32) -> [DVec3; 3] {
    let [a, b, c] = problem.scene.corners(problem.mesh.triangle(e)).map(|p| p.as_dvec3());
    let [p, q, r] = problem.mesh.corners(e).map(|uv| a + (b - a) * f64::from(uv.x) + (c - a) * f64::from(uv.y));
    if problem.mesh.place(e).back { [p, r, q] } else { [p, q, r] }
}

/// The congruent cells of a triangle with `divisions` along its edges, in its orientation.
pub fn grid([a, b, c]: [DVec3; 3], divisions: u16) -> impl Iterator<Item = [DVec3; 3]> {
    let at = move |uv: Vec2| a + (b - a) * f64::from(uv.x) + (c - a) * f64::from(uv.y);
    (0..cells::count(divisions)).map(move |cell| cells::corners(cell, divisions).map(at))
}

/// The centroid of a triangle.
pub fn centroid([a, b, c]: [DVec3; 3]) -> DVec3 {
    (a + b + c) / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_cuts_a_triangle_into_its_front_part() {
        let triangle = [[0.0, 0.0, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]].map(DVec3::from);
        let floor = Plane::through(DVec3::ZERO, DVec3::Z);
        let part = clip(&triangle, floor, 1e-9);
        assert_eq!(part.len(), 4);
        assert!(part.iter().all(|p| p.z >= 0.0));
        assert!(clip(&triangle, Plane::through(2.0 * DVec3::Z, DVec3::Z), 1e-9).is_empty());
        assert_eq!(clip(&triangle, Plane::through(-DVec3::Z, DVec3::Z), 1e-9), triangle);
    }
}
