//! Elements larger than a triangle: whole triangles put together, where a mesh is finer than the light on it.
//!
//! A cluster has barycentric coordinates like any element, so rays leave it and land on it as they do on a cell:
//!
//! ```text
//! unit triangle -> unit square -> the strip of a triangle, as wide as its share of the area -> unit square -> that triangle
//! ```
//!
//! Every arrow preserves area up to a factor that is the same for all triangles, so the whole does. The strips follow each other along a
//! space-filling curve: what is near on the unit triangle is mostly near on the cluster. Which triangles make a cluster is for
//! [`super::grow`] to say. O(log n) from a cluster of n triangles to a point, O(1) back; 20 bytes a triangle.

use super::{ElementMesh, Place, morton, triangle};
use crate::math::warp::{square_to_triangle, triangle_to_square};
use crate::scene::Scene;
use glam::Vec2;

/// "In no cluster".
const NONE: u32 = u32::MAX;

/// All clusters of a mesh.
#[derive(Clone, Debug, Default)]
pub struct Clusters {
    /// Number of each triangle's piece, or [`NONE`]; nothing if there is no cluster.
    piece: Vec<u32>,
    /// Those of cluster k are `pieces[first[k]..first[k + 1]]`.
    pieces: Vec<Piece>,
    first: Vec<u32>,
}

/// A triangle of a cluster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    pub triangle: u32,
    cluster: u32,
    /// Its strip of the unit square, in the first coordinate.
    begin: f32,
    end: f32,
}

/// The triangles of one cluster.
#[derive(Clone, Copy, Debug)]
pub struct Cluster<'a>(&'a [Piece]);

impl Clusters {
    /// `leaders[t]` is the least triangle in the cluster of triangle t, or t; nothing if there are no clusters.
    pub fn new(scene: &Scene, leaders: &[u32]) -> Clusters {
        let mut clustered: Vec<(u32, u32)> = leaders.iter().copied().zip(0..).collect();
        clustered.sort_unstable();
        let mut clusters = Clusters { piece: vec![NONE; leaders.len()], pieces: Vec::new(), first: vec![0] };
        for cluster in clustered.chunk_by(|a, b| a.0 == b.0).filter(|cluster| cluster.len() > 1) {
            clusters.push(scene, cluster.iter().map(|&(_, t)| t).collect());
        }
        if clusters.pieces.is_empty() { Clusters::default() } else { clusters }
    }

    fn push(&mut self, scene: &Scene, mut triangles: Vec<u32>) {
        morton::sort(scene, &mut triangles);
        let area = |t: u32| triangle::surface_area(scene, t);
        let total = triangles.iter().map(|&t| area(t)).sum::<f64>().max(f64::MIN_POSITIVE);
        let (cluster, mut begin, mut sum) = (self.first.len() as u32 - 1, 0.0, 0.0);
        for &triangle in &triangles {
            sum += area(triangle);
            let end = (sum / total) as f32;
            self.piece[triangle as usize] = self.pieces.len() as u32;
            self.pieces.push(Piece { triangle, cluster, begin, end });
            begin = end;
        }
        self.first.push(self.pieces.len() as u32);
    }

    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// The piece that `triangle` is, if it belongs to a cluster.
    #[inline]
    pub fn piece(&self, triangle: u32) -> Option<&Piece> {
        self.pieces.get(*self.piece.get(triangle as usize)? as usize)
    }

    /// The cluster to which `triangle` belongs, if there is one.
    #[inline]
    pub fn with(&self, triangle: u32) -> Option<Cluster<'_>> {
        let cluster = self.piece(triangle)?.cluster as usize;
        Some(Cluster(&self.pieces[self.first[cluster] as usize..self.first[cluster + 1] as usize]))
    }

    /// As they were given to [`Clusters::new`].
    pub fn leaders(&self) -> Vec<u32> {
        let of = |t: u32| self.with(t).map_or(t, |cluster| cluster.triangles().min().unwrap_or(t));
        (0..self.piece.len() as u32).map(of).collect()
    }
}

impl Piece {
    /// Share of the cluster's area.
    pub fn share(&self) -> f32 {
        self.end - self.begin
    }

    /// Barycentric coordinates on the cluster of the point `uv` of the triangle.
    #[inline]
    pub fn within(&self, uv: Vec2) -> Vec2 {
        let s = triangle_to_square(uv);
        square_to_triangle(Vec2::new(self.begin + s.x * self.share(), s.y))
    }
}

impl<'a> Cluster<'a> {
    pub fn pieces(self) -> &'a [Piece] {
        self.0
    }

    /// Along the space-filling curve.
    pub fn triangles(self) -> impl Iterator<Item = u32> + Clone + use<'a> {
        self.0.iter().map(|piece| piece.triangle)
    }

    /// The triangle of the greatest area, which stands for the cluster where one must.
    pub fn largest(self) -> u32 {
        self.0.iter().fold(self.0[0], |largest, &p| if p.share() > largest.share() { p } else { largest }).triangle
    }

    /// The triangle, and the barycentric coordinates on it, of the point with coordinates `within` the cluster.
    #[inline]
    pub fn point(self, within: Vec2) -> (u32, Vec2) {
        let s = triangle_to_square(within).clamp(Vec2::ZERO, Vec2::splat(1.0 - f32::EPSILON));
        let piece = &self.0[self.0.partition_point(|piece| piece.end <= s.x).min(self.0.len() - 1)];
        let x = ((s.x - piece.begin) / piece.share()).clamp(0.0, 1.0);
        (piece.triangle, square_to_triangle(Vec2::new(x, s.y)))
    }
}

impl ElementMesh {
    /// The triangles of element `e` if it is a cluster.
    #[inline]
    pub fn cluster(&self, e: u32) -> Option<Cluster<'_>> {
        self.clusters.with(self.triangle(e))
    }

    /// Whether any element is a cluster.
    pub fn has_clusters(&self) -> bool {
        !self.clusters.is_empty()
    }

    /// All places on which element `e` lies: one, or each triangle of a cluster.
    pub fn pieces(&self, e: u32) -> impl Iterator<Item = Place> + Clone {
        let (place, cluster) = (self.place(e), self.cluster(e));
        let on = move |triangle| Place { triangle, patch: self.surfaces[triangle as usize].first_patch, ..place };
        let cell = cluster.is_none().then_some(place);
        cell.into_iter().chain(cluster.into_iter().flat_map(Cluster::triangles).map(on))
    }

    /// Triangle, and barycentric coordinates on it, of the point with barycentric coordinates `within` element `e`.
    pub fn on_element(&self, e: u32, within: Vec2) -> (u32, Vec2) {
        if let Some(cluster) = self.cluster(e) {
            return cluster.point(within);
        }
        let (place, [corner, along, across]) = self.place_and_edges(e);
        (place.triangle, corner + within.x * along + within.y * across)
    }
}
