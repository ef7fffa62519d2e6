//! How an element is cut along the contacts that meet it.
//!
//! One contact after the other, by bisections; what is left of the others is cut in each part:
//!
//! ```text
//! from a corner to a border       bisected along it: two elements
//! from border to border           to where it meets the one border, then from there along it: three
//! with an end inside              through the end, and each part as above
//! ```

use super::super::bisection::{Division, MOST_DEPTH};
use super::super::cells;
use crate::scene::{Flat, Segment, Touched};
use glam::DVec2;

/// Cuts a triangle along its contacts.
pub struct Knife<'a, I> {
    pub touched: &'a Touched,
    /// Points closer than this are one, and points so close to an edge lie on it [m].
    pub near: f64,
    /// How it was cut before: what is still to come.
    pub from: I,
    /// How it is cut now.
    pub cut: Vec<Division>,
}

impl<I: Iterator<Item = Division>> Knife<'_, I> {
    /// Cuts the patch whose divisions come next, which `segments` meet.
    pub fn walk(&mut self, patch: Flat, segments: &[Segment], depth: usize) {
        match self.from.next() {
            None => {}
            // It is known anew.
            Some(Division::Beside(_)) => self.walk(patch, segments, depth),
            Some(Division::Cells(m)) => self.split(patch, m, segments, depth),
            Some(Division::Bisected { from, share }) => {
                self.cut.push(Division::Bisected { from, share });
                parts(patch, from, share)
                    .into_iter()
                    .for_each(|part| self.walk(part, &self.on(part, segments), depth + 1));
            }
            Some(Division::Split(m)) => {
                self.cut.push(Division::Split(m));
                cells_of(patch, m).for_each(|cell| self.walk(cell, &self.on(cell, segments), depth + 1));
            }
        }
    }

    /// Cuts a patch of m² cells.
    fn split(&mut self, patch: Flat, m: u16, segments: &[Segment], depth: usize) {
        if !self.is_met(patch, segments) {
            return self.leave(patch, m, segments);
        }
        if m == 1 {
            return self.bisect(patch, &self.joined(segments), depth);
        }
        // In the least factor first: large parts stay together.
        let factor = (2..m).find(|factor| m.is_multiple_of(*factor)).unwrap_or(m);
        self.cut.push(Division::Split(factor));
        cells_of(patch, factor).for_each(|cell| self.split(cell, m / factor, &self.on(cell, segments), depth + 1));
    }

    /// Cuts an element.
    fn bisect(&mut self, element: Flat, segments: &[Segment], depth: usize) {
        let next = if depth + 2 < MOST_DEPTH { self.next_bisection(element, segments) } else { None };
        let Some((from, share)) = next else { return self.leave(element, 1, segments) };
        self.cut.push(Division::Bisected { from, share });
        parts(element, from, share).into_iter().for_each(|part| self.bisect(part, &self.on(part, segments), depth + 1));
    }

    /// Leaves a patch as m² cells.
    fn leave(&mut self, patch: Flat, m: u16, segments: &[Segment]) {
        let covered = self.covered(patch, segments);
        let bits = (0..3).filter(|&k| covered[k] || self.is_on_border(patch, k)).map(|k| 1 << k).sum();
        self.cut.extend((bits != 0).then_some(Division::Beside(bits)));
        self.cut.push(Division::Cells(m));
    }

    /// The parts of `segments` that lie on `patch`.
    fn on(&self, patch: Flat, segments: &[Segment]) -> Vec<Segment> {
        let is_long = |[p, q]: &Segment| p.distance(*q) > 2.0 * self.near;
        let is_along = |segment: &Segment| patch.edge_along(*segment, self.near).is_some();
        let on_patch = |&segment: &Segment| {
            let along = patch.clipped(segment, 0.5 * self.near).filter(is_along);
            along.or_else(|| patch.clipped(segment, 0.0)).filter(is_long)
        };
        segments.iter().filter_map(on_patch).collect()
    }

    /// Segments, those that continue each other made one.
    fn joined(&self, segments: &[Segment]) -> Vec<Segment> {
        let mut joined: Vec<Segment> = Vec::with_capacity(segments.len());
        for &segment in segments {
            let mut whole = segment;
            joined.retain(|&other| {
                let both = self.both(whole, other);
                whole = both.unwrap_or(whole);
                both.is_none()
            });
            joined.push(whole);
        }
        joined
    }

    /// Two segments as one, if they lie on one line and leave no gap.
    fn both(&self, one: Segment, other: Segment) -> Option<Segment> {
        let ([p, q], [r, s]) =
            if one[0].distance(one[1]) >= other[0].distance(other[1]) { (one, other) } else { (other, one) };
        let (way, length) = ((q - p).normalize_or_zero(), p.distance(q));
        let is_on_line = [r, s].iter().all(|&end| way.perp_dot(end - p).abs() <= 0.5 * self.near);
        let (from, to) = ((r - p).dot(way), (s - p).dot(way));
        let (from, to) = (from.min(to), from.max(to));
        let meets = is_on_line && from <= length + 2.0 * self.near && to >= -2.0 * self.near;
        meets.then(|| [p + way * from.min(0.0), p + way * to.max(length)])
    }

    /// Whether a segment runs through `patch`, or ends on an edge of it.
    fn is_met(&self, patch: Flat, segments: &[Segment]) -> bool {
        let covered = self.covered(patch, segments);
        segments.iter().any(|segment| patch.edge_along(*segment, self.near).is_none_or(|k| !covered[k]))
    }

    /// Which edges of `patch` are wholly covered by `segments`.
    fn covered(&self, patch: Flat, segments: &[Segment]) -> [bool; 3] {
        let along = |k: usize| -> Vec<Segment> {
            segments.iter().copied().filter(|segment| patch.edge_along(*segment, self.near) == Some(k)).collect()
        };
        if segments.is_empty() {
            [false; 3]
        } else {
            [0, 1, 2].map(|k| patch.is_covered(k, &along(k), 2.0 * self.near))
        }
    }

    /// Whether edge `k` of `patch` lies on one of the triangle's own on which something stands.
    fn is_on_border(&self, patch: Flat, k: usize) -> bool {
        let Touched { plane, borders, .. } = self.touched;
        (0..3).any(|border| {
            borders[border] && patch.edge(k).iter().all(|&p| plane.whole.off_edge(border, p).abs() <= self.near)
        })
    }

    /// From which corner, and to which share of the edge opposite, to bisect an element next.
    fn next_bisection(&self, element: Flat, segments: &[Segment]) -> Option<(u8, f32)> {
        let covered = self.covered(element, segments);
        let is_along = |segment: &Segment| element.edge_along(*segment, self.near);
        let to_cut: Vec<Segment> =
            segments.iter().copied().filter(|segment| is_along(segment).is_none_or(|k| !covered[k])).collect();
        let through = to_cut.iter().filter(|segment| is_along(segment).is_none());
        let out_of_corner = through.clone().find_map(|&segment| self.out_of_corner(element, segment));
        let length = |segment: &&Segment| segment[0].distance(segment[1]);
        let across = || {
            let crossing = through.clone().filter_map(|segment| Some((segment, self.across(element, *segment)?)));
            crossing.max_by(|(a, _), (b, _)| length(a).total_cmp(&length(b))).map(|(_, bisection)| bisection)
        };
        let ends = to_cut.iter().flat_map(|&segment| segment.map(|end| (end, is_along(&segment))));
        let through_ends = ends.filter_map(|(end, edge)| self.through_end(element, end, edge));
        let through_end = || through_ends.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(bisection, _)| bisection);
        out_of_corner.or_else(across).or_else(through_end)
    }

    /// The bisection along a segment that runs from a corner to the edge opposite.
    fn out_of_corner(&self, element: Flat, [p, q]: Segment) -> Option<(u8, f32)> {
        let ends = [(p, q), (q, p)].into_iter();
        ends.flat_map(|ends| (0..3).map(move |k| (ends, k))).find_map(|((p, q), k)| {
            let is_it = p.distance(element.0[k]) <= self.near && self.is_between(element, (k + 1) % 3, q);
            is_it.then(|| (k as u8, share(element.edge((k + 1) % 3), q)))
        })
    }

    /// The bisection through the `end` of a segment inside the element, or on the `edge` along which it runs, with the quality of the worse part.
    fn through_end(&self, element: Flat, end: DVec2, edge: Option<usize>) -> Option<((u8, f32), f64)> {
        let on_edge = (0..3).find(|&k| element.off_edge(k, end).abs() <= self.near);
        let candidates = match (on_edge, edge) {
            (None, _) => 0..3,
            (Some(_), Some(k)) if self.is_between(element, k, end) => (k + 2) % 3..(k + 2) % 3 + 1,
            _ => return None,
        };
        let bisection = |from: usize| {
            let [a, b] = element.edge((from + 1) % 3);
            let way = end - element.0[from];
            let share = (a - element.0[from]).perp_dot(way) / way.perp_dot(b - a);
            let quality =
                parts(element, from as u8, share as f32).map(|part| part.quality()).into_iter().fold(1.0, f64::min);
            ((from as u8, share as f32), quality)
        };
        let is_one = |&((from, share), _): &((u8, f32), f64)| {
            let [a, b] = element.edge((usize::from(from) + 1) % 3);
            self.is_between(element, (usize::from(from) + 1) % 3, a.lerp(b, f64::from(share)))
        };
        candidates.map(bisection).filter(is_one).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The first of two bisections for a segment from border to border: of the two that there are, the one with the better parts.
    fn across(&self, element: Flat, [p, q]: Segment) -> Option<(u8, f32)> {
        let edge_of = |point: DVec2| (0..3).find(|&k| self.is_between(element, k, point));
        let (first, second) = (edge_of(p)?, edge_of(q)?);
        if first == second {
            return None;
        }
        // The corner that both edges share.
        let (p, q, k) = if (first + 1) % 3 == second { (p, q, second) } else { (q, p, first) };
        let [after, before] = [1, 2].map(|step| element.0[(k + step) % 3]);
        // With p on the edge before the corner and q on that after it, the part at the corner is the same either way.
        let worse = |parts: [[DVec2; 3]; 2]| parts.map(|part| Flat(part).quality()).into_iter().fold(1.0, f64::min);
        let (to_p, to_q) = (worse([[p, q, after], [p, after, before]]), worse([[p, q, before], [q, after, before]]));
        Some(if to_p > to_q {
            (((k + 1) % 3) as u8, share(element.edge((k + 2) % 3), p))
        } else {
            (((k + 2) % 3) as u8, share(element.edge(k), q))
        })
    }

    /// Whether `point` lies on edge `k`, away from its ends.
    fn is_between(&self, element: Flat, k: usize, point: DVec2) -> bool {
        let [a, b] = element.edge(k);
        let is_away = |from: DVec2, to: DVec2| (point - from).dot((to - from).normalize_or_zero()) > self.near;
        element.off_edge(k, point).abs() <= self.near && is_away(a, b) && is_away(b, a)
    }
}

/// At which share of an edge a point lies on it.
fn share([a, b]: Segment, point: DVec2) -> f32 {
    ((point - a).dot(b - a) / (b - a).length_squared()) as f32
}

/// As the mesh bisects it.
fn parts(Flat(corners): Flat, from: u8, share: f32) -> [Flat; 2] {
    let [apex, after, before] = [0, 1, 2].map(|k| corners[(usize::from(from) + k) % 3]);
    let foot = after.lerp(before, f64::from(share));
    [Flat([apex, after, foot]), Flat([apex, foot, before])]
}

fn cells_of(whole: Flat, m: u16) -> impl Iterator<Item = Flat> {
    let [a, b, c] = whole.0;
    let place = move |[i, j]: [u32; 2]| a + (f64::from(i) * (b - a) + f64::from(j) * (c - a)) / f64::from(m);
    (0..cells::count(m)).map(move |cell| Flat(cells::grid_corners(cell, m).map(place)))
}
