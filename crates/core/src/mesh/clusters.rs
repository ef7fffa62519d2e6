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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;
    use crate::mesh::{Division, Resolution};
    use crate::scene::Material;
    use crate::scene::builtin::shapes::Builder;
    use glam::Vec3;

    /// A ball and a bent sheet with two sides, in clusters of some ten triangles.
    fn mesh() -> (Scene, ElementMesh) {
        let mut builder = Builder::new("round");
        let material = builder.material(Material { two_sided: true, ..Material::diffuse("", Rgb::new(0.2, 0.5, 0.8)) });
        builder.object("ball", material);
        builder.ball(Vec3::ZERO, 1.0, 48);
        builder.object("sheet", material);
        let steps: Vec<f32> = (0..=30).map(|k| (k as f32 / 30.0).powi(2)).collect();
        builder.grid(&steps, &steps, |u, v| Vec3::new(2.0 + u, v, 0.2 * u * u), |_, _| true);
        let scene = builder.finish();
        let mesh = ElementMesh::new(&scene, Resolution::Clustered(800)).unwrap();
        let clusters = mesh.elements().filter(|&e| mesh.cluster(e).is_some()).count();
        assert!(clusters > 400 && mesh.len() <= 800, "{clusters} of {}", mesh.len());
        (scene, mesh)
    }

    fn squares(n: u32) -> impl Iterator<Item = Vec2> {
        (0..n * n).map(move |k| Vec2::new((k % n) as f32 + 0.5, (k / n) as f32 + 0.5) / n as f32)
    }

    #[test]
    fn points_of_a_cluster_lead_back_to_it_and_to_their_place_on_it() {
        let (_, mesh) = mesh();
        for e in mesh.elements() {
            for s in squares(7) {
                let within = square_to_triangle(s);
                let (triangle, uv) = mesh.on_element(e, within);
                let (element, back) = mesh.locate(triangle, uv, mesh.place(e).back).unwrap();
                assert!(element == e && back.distance(within) < 1e-4, "{e} {within}: {element} {back}");
            }
        }
    }

    #[test]
    fn every_triangle_of_a_cluster_gets_its_share_of_points_evenly() {
        const N: u32 = 200;
        let (scene, mesh) = mesh();
        for e in mesh.elements().step_by(41) {
            let pieces: Vec<Place> = mesh.pieces(e).collect();
            let area = |t: u32| triangle::surface_area(&scene, t);
            let total: f64 = pieces.iter().map(|piece| area(piece.triangle)).sum();
            assert!((total / f64::from(mesh.area(e)) - 1.0).abs() < 1e-5);
            let points: Vec<(u32, Vec2)> = squares(N).map(|s| mesh.point(e, s)).collect();
            for Place { triangle, .. } in pieces {
                let here = points.iter().filter(|(t, _)| *t == triangle);
                let (count, sum) = here.fold((0.0, Vec2::ZERO), |(count, sum), (_, uv)| (count + 1.0, sum + *uv));
                let share = count / f64::from(N * N);
                // A strip has whole columns of points.
                assert!(
                    (share - area(triangle) / total).abs() < 1.01 / f64::from(N),
                    "{share} {}",
                    area(triangle) / total
                );
                let off = (sum / count as f32 - 1.0 / 3.0).abs().max_element();
                assert!(count == 0.0 || off < 4.0 / (share as f32 * N as f32), "{off} of {share}");
            }
        }
    }

    #[test]
    fn areas_and_colours_are_those_of_the_triangles() {
        let (scene, mesh) = mesh();
        let whole = ElementMesh::new(&scene, Resolution::Elements(1)).unwrap();
        assert!((mesh.total_area() / whole.total_area() - 1.0).abs() < 1e-6);
        let counted: u32 = mesh.areas().map(|(_, count)| count).sum();
        assert_eq!(counted as usize, mesh.len());
        let close = |a: Rgb, b: Rgb| a.to_array().iter().zip(b.to_array()).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(mesh.elements().all(|e| close(mesh.reflectivity(e), Rgb::new(0.2, 0.5, 0.8))));
        assert_eq!(ElementMesh::with_cut(&scene, &mesh.cut()).unwrap().cut(), mesh.cut());
    }

    #[test]
    fn cuts_with_impossible_clusters_are_refused() {
        let (scene, mesh) = mesh();
        let cut = mesh.cut();
        let last = scene.triangles.len() - 1;
        let refused = |t: usize, leader: u32| {
            let mut cut = cut.clone();
            cut.leaders[t] = leader;
            ElementMesh::with_cut(&scene, &cut).is_err()
        };
        let follower = (0..last).find(|&t| cut.leaders[t] != t as u32).unwrap();
        // Of another object, beyond itself, of one that follows itself, of nothing.
        assert!(refused(last, 0) && refused(0, 1) && refused(follower + 1, follower as u32) && refused(last, u32::MAX));
        assert!(!refused(follower, follower as u32));
        let mut short = cut.clone();
        short.leaders.pop();
        assert!(ElementMesh::with_cut(&scene, &short).is_err());
        let mut cut_finer = cut.clone();
        cut_finer.divisions[follower] = Division::Cells(2);
        assert!(ElementMesh::with_cut(&scene, &cut_finer).is_err());
    }
}
