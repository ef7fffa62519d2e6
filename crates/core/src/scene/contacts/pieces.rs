//! The pieces into which segments cut a triangle.
//!
//! A Delaunay triangulation in which no edge crosses a segment, with more points where pieces would be thin (Ruppert, A Delaunay
//! Refinement Algorithm for Quality 2-Dimensional Mesh Generation, 1995), by the crate `spade`. Points on a border are not
//! known to the triangle beyond it; pictures are interpolated without a seam all the same (`view/seams.rs`).

use super::Plane;
use glam::DVec2;
use spade::handles::FixedVertexHandle;
use spade::{AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation};

/// Angles are at least this, where borders and segments allow it [degrees].
const LEAST_ANGLE: f64 = 22.0;
/// Points that refining may add for each that is there.
const MOST_ADDED: usize = 20;

/// What a triangle was cut into.
#[derive(Debug)]
pub struct Pieces {
    /// On its plane [m]; the first three are its corners.
    pub points: Vec<DVec2>,
    /// Corners, in its orientation.
    pub triangles: Vec<[usize; 3]>,
    /// Edges along segments.
    pub contacts: Vec<[usize; 2]>,
}

/// Pieces of the triangle of `plane`, none of them thin unless it is smaller than `detail` [m]; `None` if the segments cannot be
/// put in.
pub fn pieces(plane: &Plane, segments: &[[DVec2; 2]], tolerance: f64, detail: f64) -> Option<Pieces> {
    let mut points = Points { plane, tolerance, points: plane.corners.to_vec() };
    let ends: Vec<[usize; 2]> = segments.iter().map(|segment| segment.map(|point| points.number(point))).collect();
    let points = points.points;
    let mut mesh = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let handles: Vec<FixedVertexHandle> =
        points.iter().map(|p| mesh.insert(Point2::new(p.x, p.y)).ok()).collect::<Option<_>>()?;
    for [from, to] in ends.into_iter().filter(|[from, to]| from != to) {
        mesh.add_constraint_and_split(handles[from], handles[to], |point| point);
    }
    for k in 0..3 {
        for pair in along_edge(plane, &points, k, tolerance).windows(2) {
            if mesh.can_add_constraint(handles[pair[0]], handles[pair[1]]) {
                mesh.add_constraint(handles[pair[0]], handles[pair[1]]);
            }
        }
    }
    let limits = RefinementParameters::new()
        .with_angle_limit(AngleLimit::from_deg(LEAST_ANGLE))
        .with_min_required_area(0.5 * detail * detail)
        .with_max_additional_vertices(MOST_ADDED * mesh.num_vertices());
    mesh.refine(limits);
    let points: Vec<DVec2> = mesh.vertices().map(|v| DVec2::new(v.position().x, v.position().y)).collect();
    let triangles = mesh.inner_faces().map(|face| face.vertices().map(|v| v.index()));
    // Where borders bend by a rounding there are splinters beyond them.
    let triangles: Vec<[usize; 3]> = triangles.filter(|piece| !is_flat(piece.map(|k| points[k]), tolerance)).collect();
    let on_border = |k: usize, p: DVec2| plane.off_edge(k, p).abs() <= 2.0 * tolerance;
    let is_inside = |[a, b]: &[usize; 2]| !(0..3).any(|k| on_border(k, points[*a]) && on_border(k, points[*b]));
    let edges = mesh.undirected_edges().filter(|edge| edge.is_constraint_edge());
    let contacts = edges.map(|edge| edge.vertices().map(|v| v.index())).filter(is_inside).collect();
    Some(Pieces { points, triangles, contacts })
}

/// Numbered points, of which no two are the same.
struct Points<'a> {
    plane: &'a Plane,
    tolerance: f64,
    points: Vec<DVec2>,
}

impl Points<'_> {
    fn number(&mut self, point: DVec2) -> usize {
        let same = |other: &DVec2| other.distance(point) <= 2.0 * self.tolerance;
        if let Some(known) = self.points.iter().position(same) {
            return known;
        }
        self.points.push(self.on_border(point));
        self.points.len() - 1
    }

    /// The nearest point of a border that is hardly off.
    fn on_border(&self, point: DVec2) -> DVec2 {
        let foot = |k: usize| {
            let [a, b] = self.plane.edge(k);
            a + (b - a) * ((point - a).dot(b - a) / (b - a).length_squared())
        };
        (0..3).map(foot).find(|foot| foot.distance(point) <= 2.0 * self.tolerance).unwrap_or(point)
    }
}

/// Numbers of the points on edge `k`, from its one end to the other.
fn along_edge(plane: &Plane, points: &[DVec2], k: usize, tolerance: f64) -> Vec<usize> {
    let [a, b] = plane.edge(k);
    let along = (b - a).normalize_or_zero();
    let mut on: Vec<usize> = (0..points.len()).filter(|&n| plane.off_edge(k, points[n]).abs() <= tolerance).collect();
    on.sort_by(|&m, &n| (points[m] - a).dot(along).total_cmp(&(points[n] - a).dot(along)));
    on
}

fn is_flat([a, b, c]: [DVec2; 3], tolerance: f64) -> bool {
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    (b - a).perp_dot(c - a).abs() <= tolerance * longest
}
