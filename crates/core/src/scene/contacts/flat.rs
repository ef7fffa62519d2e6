//! Triangles in their plane, and segments on them.

use glam::{DVec2, DVec3, Vec3};

/// A segment, from point to point [m].
pub type Segment = [DVec2; 2];

/// The plane of a triangle, with coordinates [m] along its first edge and across.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    origin: DVec3,
    along: DVec3,
    across: DVec3,
    pub normal: DVec3,
    /// The triangle.
    pub whole: Flat,
}

impl Plane {
    /// `None` for a triangle without area.
    pub fn new(corners: [Vec3; 3]) -> Option<Plane> {
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        let normal = (b - a).cross(c - a).try_normalize()?;
        let along = (b - a).try_normalize()?;
        let mut plane = Plane { origin: a, along, across: normal.cross(along), normal, whole: Flat([DVec2::ZERO; 3]) };
        plane.whole = Flat([a, b, c].map(|corner| plane.flat(corner)));
        Some(plane)
    }

    /// Coordinates of the point below `point`.
    pub fn flat(&self, point: DVec3) -> DVec2 {
        DVec2::new((point - self.origin).dot(self.along), (point - self.origin).dot(self.across))
    }

    /// How far `point` lies above the plane [m].
    pub fn height(&self, point: DVec3) -> f64 {
        (point - self.origin).dot(self.normal)
    }
}

/// Corners of a triangle [m], counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub struct Flat(pub [DVec2; 3]);

impl Flat {
    /// Ends of edge `k`, from corner k to the next.
    pub fn edge(&self, k: usize) -> Segment {
        [self.0[k], self.0[(k + 1) % 3]]
    }

    /// How far `point` lies off the line of edge `k`, positive inside of the triangle.
    pub fn off_edge(&self, k: usize, point: DVec2) -> f64 {
        let [a, b] = self.edge(k);
        (b - a).normalize_or_zero().perp_dot(point - a)
    }

    pub fn longest_edge(&self) -> f64 {
        (0..3).map(|k| self.edge(k)).map(|[a, b]| a.distance(b)).fold(0.0, f64::max)
    }

    /// `4 √3 A / (a² + b² + c²)`: 1 for an equilateral triangle, 0 for a splinter (Bank 1990).
    pub fn quality(&self) -> f64 {
        let [a, b, c] = self.0;
        let edges = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
        if edges > 0.0 { 2.0 * 3f64.sqrt() * (b - a).perp_dot(c - a) / edges } else { 0.0 }
    }

    /// The part of a segment that lies on the triangle, or beyond its borders by `tolerance` at most: many lie along them.
    pub fn clipped(&self, [p, q]: Segment, tolerance: f64) -> Option<Segment> {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for k in 0..3 {
            let (start, end) = (self.off_edge(k, p), self.off_edge(k, q));
            match (start < -tolerance, end < -tolerance) {
                _ if start.max(end) < -tolerance => return None,
                (true, _) => from = from.max(start / (start - end)),
                (_, true) => to = to.min(start / (start - end)),
                (false, false) => {}
            }
        }
        (from < to).then(|| [p.lerp(q, from), p.lerp(q, to)])
    }

    /// The edge along which a segment lies, if it does.
    pub fn edge_along(&self, segment: Segment, tolerance: f64) -> Option<usize> {
        (0..3).find(|&k| segment.iter().all(|&point| self.off_edge(k, point).abs() <= tolerance))
    }

    /// Whether `segments` along edge `k` leave no gap longer than `tolerance` on it.
    pub fn is_covered(&self, k: usize, segments: &[Segment], tolerance: f64) -> bool {
        let [a, b] = self.edge(k);
        let (along, length) = ((b - a).normalize_or_zero(), a.distance(b));
        let place = |point: DVec2| (point - a).dot(along);
        let mut spans: Vec<(f64, f64)> =
            segments.iter().map(|s| s.map(place)).map(|[p, q]| (p.min(q), p.max(q))).collect();
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        let covered = spans.iter().try_fold(0.0f64, |end, &(from, to)| (from <= end + tolerance).then(|| end.max(to)));
        covered.is_some_and(|end| end >= length - tolerance)
    }
}
