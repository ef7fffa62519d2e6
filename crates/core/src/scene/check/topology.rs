//! How triangles meet: edges after merging vertices with exactly the same position.

use super::{Finding, Severity, finding, places};
use crate::scene::{Scene, Shape};
use glam::{DVec3, Vec3};

/// Edges and triangles by the positions of their corners, sorted so that those that coincide are neighbours.
pub(super) struct Topology {
    edges: Vec<Edge>,
    /// Corners in ascending order, whether that is an odd permutation of the triangle's own, and the triangle.
    triangles: Vec<([u32; 3], bool, u32)>,
}

/// One use of an edge by a triangle.
struct Edge {
    /// The two positions, in ascending order.
    ends: [u32; 2],
    /// Whether the triangle runs along it from the first to the second.
    forward: bool,
    triangle: u32,
}

/// `(b - a) x (c - a)` of a triangle's corners: twice its area, along its normal.
pub(super) fn cross(scene: &Scene, t: u32) -> DVec3 {
    let [a, b, c] = scene.corners(t).map(Vec3::as_dvec3);
    (b - a).cross(c - a)
}

/// The object of triangle `t`, as findings name it.
pub(super) fn object_name(scene: &Scene, t: u32) -> String {
    format!("object '{}'", scene.objects[scene.triangles[t as usize].object as usize].name)
}

impl Topology {
    pub fn of(scene: &Scene) -> Topology {
        let position = merged_positions(scene);
        let mut edges = Vec::with_capacity(3 * scene.triangles.len());
        let mut triangles = Vec::with_capacity(scene.triangles.len());
        for (t, triangle) in (0u32..).zip(&scene.triangles) {
            let corners = triangle.vertices.map(|v| position[v as usize]);
            let [a, b, c] = corners;
            if a == b || b == c || c == a {
                continue;
            }
            for (from, to) in [(a, b), (b, c), (c, a)] {
                edges.push(Edge { ends: [from.min(to), from.max(to)], forward: from < to, triangle: t });
            }
            let mut sorted = corners;
            sorted.sort_unstable();
            let odd = ![[a, b, c], [b, c, a], [c, a, b]].contains(&sorted);
            triangles.push((sorted, odd, t));
        }
        edges.sort_by_key(|edge| (edge.ends, edge.triangle));
        triangles.sort_unstable();
        Topology { edges, triangles }
    }

    /// Edges of one-sided surfaces at which no other triangle begins.
    pub fn open_edges(&self, scene: &Scene) -> Option<Finding> {
        let open = self.unbalanced_edges(scene, |uses| uses.len() % 2 == 1);
        let what = format!(
            "{} edges of one-sided surfaces are open: light may leave there or fall on backs, which are black. Close the \
             gap, weld the vertices, or make the material two-sided (doubleSided).",
            open.len()
        );
        if open.is_empty() { None } else { finding(Severity::Warning, what, edge_places(scene, &open)) }
    }

    /// Edges along which two neighbours run in the same direction: the front of one continues as the back of the other.
    pub fn flipped_normals(&self, scene: &Scene) -> Option<Finding> {
        let flipped = self.unbalanced_edges(scene, |uses| uses.len() % 2 == 0);
        let what = format!(
            "{} edges join triangles of which one is flipped: its black back continues the front of the other. \
             Recalculate the normals, or make the material two-sided (doubleSided).",
            flipped.len()
        );
        if flipped.is_empty() { None } else { finding(Severity::Warning, what, edge_places(scene, &flipped)) }
    }

    /// Edges that one-sided triangles run along more often in one direction than in the other, of those `selected`.
    fn unbalanced_edges(&self, scene: &Scene, selected: impl Fn(&[Edge]) -> bool) -> Vec<&Edge> {
        let one_sided = |edge: &Edge| !scene.is_two_sided(edge.triangle);
        let unbalanced = |uses: &&[Edge]| 2 * uses.iter().filter(|edge| edge.forward).count() != uses.len();
        let uses = self.edges.chunk_by(|a, b| a.ends == b.ends).filter(unbalanced);
        uses.filter(|uses| selected(uses) && uses.iter().all(one_sided)).map(|uses| &uses[0]).collect()
    }

    /// Triangles with the same three corners that look to the same side.
    pub fn coincident_triangles(&self, scene: &Scene) -> Option<Finding> {
        if scene.shape != Shape::Triangles {
            return None;
        }
        let two_sided = |t: u32| scene.is_two_sided(t);
        let same = self.triangles.windows(2).filter(|pair| {
            let [(corners, odd, t), (others, other_odd, other)] = [pair[0], pair[1]];
            corners == others && (odd == other_odd || two_sided(t) || two_sided(other))
        });
        let same: Vec<u32> = same.map(|pair| pair[1].2).collect();
        let what = format!(
            "{} triangle(s) lie exactly on another one: only one of the two is ever hit. Remove one, or move it by a millimetre.",
            same.len()
        );
        let place = places(same.iter().map(|&t| object_name(scene, t)));
        if same.is_empty() { None } else { finding(Severity::Warning, what, place) }
    }
}

fn edge_places(scene: &Scene, edges: &[&Edge]) -> String {
    places(edges.iter().map(|edge| {
        let [a, b, c] = scene.corners(edge.triangle);
        let Vec3 { x, y, z } = (a + b + c) / 3.0;
        format!("{} near ({x:.3}, {y:.3}, {z:.3})", object_name(scene, edge.triangle))
    }))
}

/// For every vertex a number that it shares with the vertices at exactly the same position.
fn merged_positions(scene: &Scene) -> Vec<u32> {
    // Adding zero turns -0 into 0.
    let key = |v: &u32| scene.vertices[*v as usize].position.to_array().map(|x| (x + 0.0).to_bits());
    let mut order: Vec<u32> = (0..scene.vertices.len() as u32).collect();
    order.sort_unstable_by_key(key);
    let mut position = vec![0; order.len()];
    for (number, same) in (0u32..).zip(order.chunk_by(|a, b| key(a) == key(b))) {
        same.iter().for_each(|&v| position[v as usize] = number);
    }
    position
}
