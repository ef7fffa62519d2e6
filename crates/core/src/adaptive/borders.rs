//! Which triangles go on smoothly beyond an edge of a triangle.

use crate::geometry::Geometry;
use crate::math::weld::{self, Weld};
use crate::scene::Scene;
use crate::view::crease::CREASE_ANGLE;
use glam::Vec2;

/// All edges that triangles share from corner to corner.
#[derive(Clone, Debug)]
pub struct Borders {
    /// Welded corners of every triangle.
    corners: Vec<[u32; 3]>,
    /// (welded ends in ascending order, triangle, its corner opposite the edge), sorted.
    edges: Vec<([u32; 2], u32, usize)>,
}

impl Borders {
    pub fn of(scene: &Scene, geometry: &dyn Geometry) -> Borders {
        let mut weld = Weld::new((weld::TOLERANCE * geometry.bounding_sphere().1).max(f32::MIN_POSITIVE));
        let triangles = 0..scene.triangles.len() as u32;
        let corners: Vec<[u32; 3]> = triangles.map(|t| scene.corners(t).map(|p| weld.number(p))).collect();
        let edge = |(t, corners): (u32, &[u32; 3])| [0, 1, 2].map(|k| (ends(corners, k), t, k));
        let mut edges: Vec<([u32; 2], u32, usize)> = (0..).zip(&corners).flat_map(edge).collect();
        edges.sort_unstable();
        Borders { corners, edges }
    }

    /// The points of other triangles a little beyond that edge of `triangle` which is nearest to the point `inside`, as far beyond it as
    /// `beyond` is. Both are in barycentric coordinates.
    pub fn across<'a>(
        &'a self,
        geometry: &'a dyn Geometry,
        triangle: u32,
        inside: Vec2,
        beyond: Vec2,
    ) -> impl Iterator<Item = (u32, Vec2)> + 'a {
        let (weights, outside) = (barycentric(inside), barycentric(beyond));
        let edge = (1..3).fold(0, |least, k| if outside[k] < outside[least] { k } else { least });
        let corners = &self.corners[triangle as usize];
        let ends = ends(corners, edge);
        let first = self.edges.partition_point(|other| other.0 < ends);
        let sharing = self.edges[first..].iter().take_while(move |other| other.0 == ends);
        let normal = geometry.surface(triangle, inside).1;
        let is_smooth = move |t: u32| geometry.surface(t, Vec2::splat(1.0 / 3.0)).1.dot(normal) > CREASE_ANGLE.cos();
        sharing.filter(move |&&(_, t, _)| t != triangle && is_smooth(t)).map(move |&(_, t, opposite)| {
            let depth = -outside[edge];
            let weight =
                |corner: &u32| corners.iter().position(|c| c == corner).map_or(0.0, |same| weights[same] - 0.5 * depth);
            let mut point = self.corners[t as usize].each_ref().map(weight);
            point[opposite] = depth;
            (t, Vec2::new(point[1], point[2]))
        })
    }
}

/// Welded ends of the edge opposite corner `k`.
fn ends(corners: &[u32; 3], k: usize) -> [u32; 2] {
    let (a, b) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
    [a.min(b), a.max(b)]
}

fn barycentric(uv: Vec2) -> [f32; 3] {
    [1.0 - uv.x - uv.y, uv.x, uv.y]
}
