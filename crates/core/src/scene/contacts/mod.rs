//! Surfaces are cut where other surfaces stand on them or pass through them.
//!
//! Rooms are made of things that stand on floors and walls that pass through ceilings. An element that such a wall runs through belongs to
//! both sides: it carries light from the bright one to the dark one, and its mean is right on neither. So triangles are cut along the
//! segments in which others touch or cross them, before there are any elements (discontinuity meshing: Lischinski, Tampieri & Greenberg
//! 1992, here of contacts alone): then every element lies on one side, and no light passes. The pieces are a constrained Delaunay
//! triangulation, refined until no piece is thin (Ruppert 1995).
//!
//! Exact up to the rounding of coordinates. What is smaller than a given detail is left as it is. Cost: a tree over the triangles, and a few
//! looks at the neighbours of every large one.

mod near;
mod pieces;
mod segments;

use super::{Scene, Shape, Triangle, Vertex};
use glam::{DVec2, DVec3, Vec3};
use near::Near;
use rayon::prelude::*;
use segments::Contacts;

/// Points closer than this share of the scene's diagonal are one.
const TOLERANCE: f64 = 2e-6;
/// More segments than this on one triangle: it is left whole.
const MOST_SEGMENTS: usize = 4000;

/// `scene` with its large triangles cut where others stand on them or pass through them: those with an edge of at least twice `detail` [m],
/// by contacts that are longer than it. Pieces keep the [`source`](Triangle::source) of their triangle, and take its place in the order; the
/// edges along contacts are remembered in [`Scene::contacts`]. Balls are left as they are, and scenes that were cut before.
pub fn cut_at_contacts(mut scene: Scene, detail: f32) -> Scene {
    if scene.shape != Shape::Triangles || !scene.contacts.is_empty() {
        return scene;
    }
    let (low, high) = scene.bounds();
    let tolerance = TOLERANCE * f64::from(low.distance(high));
    let detail = f64::from(detail);
    let near = Near::new(&scene, tolerance as f32);
    let of_triangle = |t: u32| {
        let plane = Plane::new(scene.corners(t))?;
        if plane.longest_edge() < 2.0 * detail {
            return None;
        }
        let contacts = Contacts::of(&scene, t, &plane, &near, tolerance, detail);
        let cut = !contacts.inner.is_empty() && contacts.inner.len() <= MOST_SEGMENTS;
        let pieces = if cut { pieces::pieces(&plane, &contacts.inner, tolerance, detail) } else { None };
        (pieces.is_some() || contacts.borders != [false; 3]).then_some((t, plane, pieces, contacts.borders))
    };
    let found: Vec<_> = (0..scene.triangles.len() as u32).into_par_iter().filter_map(of_triangle).collect();
    let mut triangles = Vec::with_capacity(scene.triangles.len());
    // Of which triangle each is a piece.
    let mut wholes: Vec<usize> = Vec::with_capacity(scene.triangles.len());
    let mut copied = 0;
    for (t, plane, pieces, borders) in found {
        triangles.extend_from_slice(&scene.triangles[copied..t as usize]);
        wholes.extend(copied..t as usize);
        copied = t as usize + 1;
        let whole = scene.triangles[t as usize];
        let border = |k: usize| [whole.vertices[k], whole.vertices[(k + 1) % 3]];
        scene.contacts.extend((0..3).filter(|&k| borders[k]).map(border).map(sorted));
        let Some(pieces) = pieces else {
            triangles.push(whole);
            wholes.push(t as usize);
            continue;
        };
        let numbers: Vec<u32> =
            (0..).zip(&pieces.points).map(|(k, &point)| vertex(&mut scene, whole, &plane, k, point)).collect();
        let cut = pieces.triangles.iter().map(|piece| Triangle { vertices: piece.map(|k| numbers[k]), ..whole });
        triangles.extend(cut);
        wholes.resize(triangles.len(), t as usize);
        scene.contacts.extend(pieces.contacts.iter().map(|edge| sorted(edge.map(|k| numbers[k]))));
    }
    triangles.extend_from_slice(&scene.triangles[copied..]);
    wholes.extend(copied..scene.triangles.len());
    if !scene.hidden_backs.is_empty() {
        scene.hidden_backs = wholes.iter().map(|&t| scene.hidden_backs[t]).collect();
    }
    scene.triangles = triangles;
    scene.contacts.sort_unstable();
    scene.contacts.dedup();
    scene
}

/// The vertex of point number `k` of the pieces of `whole`, the first three of which are its corners.
fn vertex(scene: &mut Scene, whole: Triangle, plane: &Plane, k: usize, point: DVec2) -> u32 {
    if k < 3 {
        return whole.vertices[k];
    }
    let [a, b, c] = whole.vertices.map(|v| scene.vertices[v as usize]);
    let (u, v) = plane.barycentric(point);
    let w = 1.0 - u - v;
    let (u, v, w) = (u as f32, v as f32, w as f32);
    if let [Some(a), Some(b), Some(c)] = whole.vertices.map(|v| scene.lightmap_uvs.get(v as usize).copied()) {
        scene.lightmap_uvs.push(a * w + b * u + c * v);
    }
    scene.vertices.push(Vertex {
        position: plane.on_surface(point),
        color: a.color * w + b.color * u + c.color * v,
        uv: a.uv * w + b.uv * u + c.uv * v,
        emission_uv: a.emission_uv * w + b.emission_uv * u + c.emission_uv * v,
    });
    scene.vertices.len() as u32 - 1
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The plane of a triangle, with coordinates [m] along its first edge and across.
struct Plane {
    origin: DVec3,
    along: DVec3,
    across: DVec3,
    normal: DVec3,
    /// The triangle's corners.
    corners: [DVec2; 3],
}

impl Plane {
    /// `None` for a triangle without area.
    fn new(corners: [Vec3; 3]) -> Option<Plane> {
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        let normal = (b - a).cross(c - a).try_normalize()?;
        let along = (b - a).try_normalize()?;
        let mut plane = Plane { origin: a, along, across: normal.cross(along), normal, corners: [DVec2::ZERO; 3] };
        plane.corners = [a, b, c].map(|corner| plane.flat(corner));
        Some(plane)
    }

    fn flat(&self, point: DVec3) -> DVec2 {
        DVec2::new((point - self.origin).dot(self.along), (point - self.origin).dot(self.across))
    }

    fn height(&self, point: DVec3) -> f64 {
        (point - self.origin).dot(self.normal)
    }

    fn on_surface(&self, point: DVec2) -> Vec3 {
        (self.origin + point.x * self.along + point.y * self.across).as_vec3()
    }

    /// (u, v) of `(1 - u - v) a + u b + v c`.
    fn barycentric(&self, point: DVec2) -> (f64, f64) {
        let [a, b, c] = self.corners;
        let area = (b - a).perp_dot(c - a);
        ((point - a).perp_dot(c - a) / area, (b - a).perp_dot(point - a) / area)
    }

    /// Ends of edge `k`.
    fn edge(&self, k: usize) -> [DVec2; 2] {
        [self.corners[k], self.corners[(k + 1) % 3]]
    }

    /// How far `point` lies off the line of edge `k`, positive inside of the triangle.
    fn off_edge(&self, k: usize, point: DVec2) -> f64 {
        let [a, b] = self.edge(k);
        (b - a).normalize_or_zero().perp_dot(point - a)
    }

    fn longest_edge(&self) -> f64 {
        (0..3).map(|k| self.edge(k)).map(|[a, b]| a.distance(b)).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests;
