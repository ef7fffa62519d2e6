//! The segments in which other triangles touch or cross a triangle.

use super::flat::{Plane, Segment};
use super::near::Near;
use crate::scene::Scene;
use glam::DVec2;

/// Cosine of the angle from which surfaces that meet do not run smoothly into each other: 36 degrees, as in pictures.
const CREASE: f64 = 0.809;

/// Segments inside of triangle `t`, which lies in `plane`, with end points not shared exactly, and whether something stands on each of its edges, all
/// along. Groups of segments that hang together count if they reach over `detail` [m].
pub fn of_triangle(
    scene: &Scene,
    t: u32,
    plane: &Plane,
    near: &Near,
    tolerance: f64,
    detail: f64,
) -> (Vec<Segment>, [bool; 3]) {
    let whole = &plane.whole;
    let (mut inner, mut on_edges) = (Vec::new(), [const { Vec::new() }; 3]);
    let two_sided = scene.is_two_sided(t);
    for other in near.of(t) {
        let corners = scene.corners(other).map(|corner| corner.as_dvec3());
        let heights = corners.map(|corner| plane.height(corner));
        // What stands behind a one-sided surface is out of sight.
        if !two_sided && heights.iter().all(|&height| height <= tolerance) {
            continue;
        }
        let Some(segment) = meeting(heights, corners.map(|corner| plane.flat(corner)), tolerance) else { continue };
        let is_long = |[p, q]: &Segment| p.distance(*q) > 4.0 * tolerance;
        let Some(segment) = whole.clipped(segment, tolerance).filter(is_long) else { continue };
        match whole.edge_along(segment, 2.0 * tolerance) {
            None => inner.push(segment),
            Some(k) => {
                let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
                if normal.dot(plane.normal).abs() < CREASE {
                    on_edges[k].push(segment);
                }
            }
        }
    }
    let inner = large_groups(inner, 4.0 * tolerance, detail);
    (inner, [0, 1, 2].map(|k| whole.is_covered(k, &on_edges[k], 8.0 * tolerance)))
}

/// Where a triangle with these `heights` above the plane and `flat` positions meets it: an edge that lies in it, or a cut across.
fn meeting(heights: [f64; 3], flat: [DVec2; 3], tolerance: f64) -> Option<Segment> {
    let is_on = heights.map(|height| height.abs() <= tolerance);
    let mut ends: Vec<DVec2> = (0..3).filter(|&k| is_on[k]).map(|k| flat[k]).collect();
    for k in 0..3 {
        let next = (k + 1) % 3;
        if !is_on[k] && !is_on[next] && (heights[k] > 0.0) != (heights[next] > 0.0) {
            ends.push(flat[k].lerp(flat[next], heights[k] / (heights[k] - heights[next])));
        }
    }
    ends.try_into().ok()
}

/// The segments of groups that hang together and reach over `detail`.
fn large_groups(segments: Vec<Segment>, tolerance: f64, detail: f64) -> Vec<Segment> {
    let mut group: Vec<usize> = (0..segments.len()).collect();
    let mut ends: Vec<(DVec2, usize)> = (0..).zip(&segments).flat_map(|(k, s)| s.map(|end| (end, k))).collect();
    ends.sort_by(|(p, _), (q, _)| p.x.total_cmp(&q.x));
    for (k, (p, mine)) in ends.iter().enumerate() {
        for (_, other) in ends[k + 1..]
            .iter()
            .take_while(|(q, _)| q.x - p.x <= tolerance)
            .filter(|(q, _)| p.distance(*q) <= tolerance)
        {
            let (mine, other) = (root(&group, *mine), root(&group, *other));
            group[mine.max(other)] = mine.min(other);
        }
    }
    let mut boxes = vec![(DVec2::INFINITY, DVec2::NEG_INFINITY); segments.len()];
    for (k, [p, q]) in segments.iter().enumerate() {
        let (low, high) = &mut boxes[root(&group, k)];
        (*low, *high) = (low.min(*p).min(*q), high.max(*p).max(*q));
    }
    let is_large = |k: usize| {
        let (low, high) = boxes[root(&group, k)];
        low.distance(high) > detail
    };
    segments.iter().enumerate().filter(|(k, _)| is_large(*k)).map(|(_, segment)| *segment).collect()
}

fn root(group: &[usize], mut k: usize) -> usize {
    while group[k] != k {
        k = group[k];
    }
    k
}
