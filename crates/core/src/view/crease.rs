//! Which surfaces run smoothly into each other: at a point, grid points of sides whose normals agree share a vertex.
//!
//! Object and material do not matter: irradiance does not contain the reflectivity, so it is smooth across a change of
//! paint on a flat wall. The angle does: across an edge between two walls it jumps.

use crate::math::DisjointSets;
use glam::Vec3;

/// Sides whose normals differ by less than this meet smoothly. Furniture is commonly modelled with 15 to 30 degrees
/// between the facets of what shall look round, and edges that shall look sharp start at 45 degrees.
pub const CREASE_ANGLE: f32 = 36.0 * std::f32::consts::PI / 180.0;

/// Normals closer than a degree count as one, so that the many facets about the tip of a fan stay cheap.
const SAME: f32 = 0.999_85;

/// For the normals of all sides at one point, the smooth group of each: numbers from 0 in the order of first appearance.
/// Sides are in one group if a chain of steps below the crease angle leads from one to the other.
pub fn groups(normals: &[Vec3]) -> Vec<u32> {
    let smooth = CREASE_ANGLE.cos();
    let mut distinct: Vec<Vec3> = Vec::new();
    let mut groups = DisjointSets::default();
    let index: Vec<usize> = normals
        .iter()
        .map(|normal| {
            if let Some(same) = distinct.iter().position(|d| d.dot(*normal) > SAME) {
                return same;
            }
            let new = distinct.len();
            groups.push();
            for (k, other) in distinct.iter().enumerate() {
                if other.dot(*normal) > smooth {
                    groups.join(k as u32, new as u32);
                }
            }
            distinct.push(*normal);
            new
        })
        .collect();
    let (number, _) = groups.numbered();
    index.into_iter().map(|k| number[k]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tilted(degrees: f32) -> Vec3 {
        let (sin, cos) = degrees.to_radians().sin_cos();
        Vec3::new(sin, 0.0, cos)
    }

    #[test]
    fn chains_of_small_angles_are_smooth_and_large_angles_are_sharp() {
        assert_eq!(groups(&[tilted(0.0), tilted(60.0), tilted(30.0)]), [0, 0, 0]);
        assert_eq!(groups(&[tilted(0.0), tilted(90.0), tilted(0.0), tilted(180.0)]), [0, 1, 0, 2]);
    }
}
