//! The connected surfaces of a scene, and which of them are closed.
//!
//! Triangles are connected where they share an edge, by position. A surface is closed if each of its edges joins exactly two of its triangles, and
//! if these can be told to run round it alike. A point is inside of it if its winding number is 1: the sum of the solid angles under
//! which it sees the triangles, over 4π (Van Oosterom & Strackee 1983). Costs a sort of the edges.

use super::Scene;
use crate::math::DisjointSets;
use crate::math::weld::{TOLERANCE, Weld};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Closed surfaces of less than this share of the cube over their diagonal hold nothing.
const FLAT: f64 = 1e-9;

/// A connected surface.
#[derive(Clone, Debug)]
pub struct Surface {
    /// In ascending order.
    pub triangles: Vec<u32>,
    /// For each of them, whether its front looks outwards; `None` if the surface is not closed.
    pub outward: Option<Vec<bool>>,
    /// Corners of the box around it [m].
    pub low: Vec3,
    pub high: Vec3,
}

/// One use of an edge by a triangle.
struct Edge {
    /// Numbers of its ends, in ascending order.
    ends: [u32; 2],
    /// Whether the triangle runs along it from the first to the second.
    forward: bool,
    /// Three times the triangle, and the number of the edge in it.
    side: u32,
}

impl Edge {
    fn triangle(&self) -> u32 {
        self.side / 3
    }
}

/// The triangle beyond an edge, and whether both run round alike.
type Beyond = Option<(u32, bool)>;

/// All surfaces of `scene`, in the order of their first triangles.
pub fn surfaces(scene: &Scene) -> Vec<Surface> {
    let edges = edges(scene);
    let count = scene.triangles.len();
    let mut groups = DisjointSets::new(count);
    let mut beyond: Vec<Beyond> = vec![None; 3 * count];
    for uses in edges.chunk_by(|a, b| a.ends == b.ends) {
        uses.windows(2).for_each(|pair| groups.join(pair[0].triangle(), pair[1].triangle()));
        if let [one, other] = uses {
            let alike = one.forward != other.forward;
            beyond[one.side as usize] = Some((other.triangle(), alike));
            beyond[other.side as usize] = Some((one.triangle(), alike));
        }
    }
    let (number, count) = groups.numbered();
    let mut surfaces: Vec<Vec<u32>> = vec![Vec::new(); count as usize];
    (0..).zip(number).for_each(|(t, number)| surfaces[number as usize].push(t));
    surfaces.into_iter().map(|triangles| surface(scene, triangles, &beyond)).collect()
}

fn edges(scene: &Scene) -> Vec<Edge> {
    let (low, high) = scene.bounds();
    let mut weld = Weld::new(0.5 * TOLERANCE * low.distance(high));
    let numbers: Vec<u32> = scene.vertices.iter().map(|v| weld.number(v.position)).collect();
    let mut edges = Vec::with_capacity(3 * scene.triangles.len());
    for (t, triangle) in (0u32..).zip(&scene.triangles) {
        let corners = triangle.vertices.map(|v| numbers[v as usize]);
        for k in 0..3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            edges.push(Edge { ends: [from.min(to), from.max(to)], forward: from < to, side: 3 * t + k as u32 });
        }
    }
    edges.sort_unstable_by_key(|edge| (edge.ends, edge.side));
    edges
}

fn surface(scene: &Scene, triangles: Vec<u32>, beyond: &[Beyond]) -> Surface {
    let points = || triangles.iter().flat_map(|&t| scene.corners(t));
    let low = points().fold(Vec3::INFINITY, Vec3::min);
    let high = points().fold(Vec3::NEG_INFINITY, Vec3::max);
    let outward = outward(scene, &triangles, beyond, low, f64::from(low.distance(high)));
    Surface { triangles, outward, low, high }
}

/// Whether the front of each of the connected `triangles` looks outwards; `None` if they are not closed.
fn outward(scene: &Scene, triangles: &[u32], beyond: &[Beyond], low: Vec3, diagonal: f64) -> Option<Vec<bool>> {
    let index = |t: u32| triangles.binary_search(&t).ok();
    // As the first one runs, or against it.
    let mut alike: Vec<Option<bool>> = vec![None; triangles.len()];
    alike[0] = Some(true);
    let mut waiting = vec![triangles[0]];
    while let Some(t) = waiting.pop() {
        let own = alike[index(t)?]?;
        for side in 3 * t..3 * t + 3 {
            let (other, agrees) = beyond[side as usize]?;
            let expected = own == agrees;
            match &mut alike[index(other)?] {
                Some(known) if *known != expected => return None,
                Some(_) => {}
                unknown => {
                    *unknown = Some(expected);
                    waiting.push(other);
                }
            }
        }
    }
    let alike: Vec<bool> = alike.into_iter().collect::<Option<_>>()?;
    let volume = |(&t, &alike): (&u32, &bool)| {
        let [a, b, c] = scene.corners(t).map(|corner| (corner - low).as_dvec3());
        a.dot(b.cross(c)) / if alike { 6.0 } else { -6.0 }
    };
    let volume: f64 = triangles.iter().zip(&alike).map(volume).sum();
    if volume.abs() <= FLAT * diagonal.powi(3) {
        return None;
    }
    Some(alike.into_iter().map(|alike| alike == (volume > 0.0)).collect())
}

impl Surface {
    /// Whether `point` [m] is inside. What is on the surface is half inside, and counts if `touching` does. Nothing is inside of an open surface.
    pub fn encloses(&self, scene: &Scene, point: Vec3, touching: bool) -> bool {
        let Some(outward) = &self.outward else { return false };
        let margin = 1e-4 * self.low.distance(self.high);
        if !self.reaches(point - margin, point + margin) {
            return false;
        }
        let angle = |(&t, &outward): (&u32, &bool)| {
            let angle = solid_angle(scene.corners(t).map(|corner| (corner - point).as_dvec3()));
            if outward { angle } else { -angle }
        };
        let winding = self.triangles.iter().zip(outward).map(angle).sum::<f64>() / (4.0 * PI);
        winding > if touching { 0.1 } else { 0.9 }
    }

    /// Whether the box around it meets another.
    fn reaches(&self, low: Vec3, high: Vec3) -> bool {
        self.low.cmple(high).all() && self.high.cmpge(low).all()
    }
}

/// Signed solid angle [sr] of a triangle seen from the origin: positive if it looks away.
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let (x, y, z) = (a.length(), b.length(), c.length());
    let under = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
    let over = a.dot(b.cross(c));
    if over == 0.0 { 0.0 } else { 2.0 * over.atan2(under) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;
    use crate::scene::Material;
    use crate::scene::builtin::shapes::Builder;

    fn boxes(list: &[(Vec3, Vec3)]) -> Scene {
        let mut builder = Builder::new("boxes");
        let grey = builder.material(Material::diffuse("grey", Rgb::grey(0.5)));
        for &(low, high) in list {
            builder.object("box", grey);
            builder.cuboid(low, high);
        }
        builder.finish()
    }

    #[test]
    fn boxes_are_closed_whatever_way_their_triangles_run() {
        let mut scene = boxes(&[(Vec3::ZERO, Vec3::ONE), (Vec3::splat(2.0), Vec3::splat(5.0))]);
        for t in [3, 4, 15] {
            scene.triangles[t].vertices.swap(0, 2);
        }
        let found = surfaces(&scene);
        assert_eq!(found.iter().map(|s| s.triangles.len()).collect::<Vec<_>>(), [12, 12]);
        let flipped = |s: &Surface| s.outward.as_ref().unwrap().iter().filter(|outward| !**outward).count();
        assert_eq!(found.iter().map(flipped).collect::<Vec<_>>(), [2, 1]);
        let inside = |k: usize, x| found[k].encloses(&scene, Vec3::splat(x), false);
        assert!(inside(0, 0.5) && inside(0, 0.99) && inside(1, 4.5));
        assert!(!inside(0, 1.01) && !inside(0, 3.0) && !inside(1, 0.5) && !inside(0, 1.0));
        assert!(found[0].encloses(&scene, Vec3::new(0.5, 0.5, 1.0), true));
    }

    #[test]
    fn what_lacks_a_triangle_or_shares_an_edge_is_not_closed() {
        let mut scene = boxes(&[(Vec3::ZERO, Vec3::ONE)]);
        scene.triangles.pop();
        assert!(surfaces(&scene)[0].outward.is_none());
        // Two boxes with an edge in common: nobody can tell what is inside of what.
        let scene = boxes(&[(Vec3::ZERO, Vec3::ONE), (Vec3::new(1.0, 1.0, 0.0), Vec3::new(2.0, 2.0, 1.0))]);
        let found = surfaces(&scene);
        assert!(found.len() == 1 && found[0].outward.is_none());
        assert!(surfaces(&Scene::default()).is_empty());
    }
}
