//! No seam and no crack where patches with different divisions meet.
//!
//! A T-vertex of one side lies between two vertices of the other. Values are interpolated linearly between vertices, so it
//! would bend the light along the edge on its own side only, which shows as a seam across a flat wall. So it takes the
//! value that the piece of edge has where it lies ([`t_vertices`]), the longest if there are several, unless something stands at it. And a program that draws triangles leaves pinholes
//! along such an edge, whatever the angle, unless both sides have the same vertices there ([`EdgePoints`]).

use super::contacts;
use super::crease::CREASE_ANGLE;
use super::grid::{self, Side};
use super::vertices::{Vertices, group_by};
use crate::Problem;
use crate::math::weld;
use glam::{IVec3, Vec3};
use std::collections::{BTreeMap, BTreeSet};

/// A vertex that takes the value `(1 - t) value[from] + t value[to]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TVertex {
    pub vertex: u32,
    pub from: u32,
    pub to: u32,
    pub t: f32,
}

/// All T-vertices on smooth surfaces, in an order in which every one comes after those it depends on.
pub fn t_vertices(problem: &Problem, vertices: &Vertices) -> Vec<TVertex> {
    let sides = vertices.grid.sides(&problem.mesh);
    let is_open = |side: Side, ends| !contacts::divide_along(&problem.mesh, side.patch, ends);
    // What stands there may be thinner than the tolerance, with an edge of the other side beside it.
    let at_foot = contacts::at_foot(problem, vertices);
    let pieces = loose_pieces(problem, vertices, sides, is_open, |vertex| vertex);
    let mut found: Vec<(f32, TVertex)> = Vec::new();
    visit_crossings(
        problem,
        &pieces,
        |v| vertices.position(v),
        |piece, end, t| {
            if !at_foot[end.key as usize] && end.normal.dot(piece.normal) > CREASE_ANGLE.cos() {
                found.push((piece.length, TVertex { vertex: end.key, from: piece.from, to: piece.to, t }));
            }
        },
    );
    found.sort_by(|(long, x), (longer, y)| longer.total_cmp(long).then((x.vertex, x.from).cmp(&(y.vertex, y.from))));
    in_order(hanging(found.into_iter().map(|(_, t)| t)))
}

/// Of `found`, in the order of preference, one for each vertex, as long as none hangs on itself: where thirds meet quarters the quarters hang on the
/// thirds, and these stay where they are.
fn hanging(found: impl Iterator<Item = TVertex>) -> BTreeMap<u32, TVertex> {
    let mut hanging: BTreeMap<u32, TVertex> = BTreeMap::new();
    for t in found {
        let (mut below, mut seen) = (vec![t.from, t.to], BTreeSet::new());
        let mut is_free = !hanging.contains_key(&t.vertex);
        while let Some(vertex) = below.pop().filter(|_| is_free) {
            is_free = vertex != t.vertex;
            let on = hanging.get(&vertex).filter(|_| seen.insert(vertex));
            below.extend(on.into_iter().flat_map(|on| [on.from, on.to]));
        }
        if is_free {
            hanging.insert(t.vertex, t);
        }
    }
    hanging
}

/// Each after those on which it hangs.
fn in_order(mut hanging: BTreeMap<u32, TVertex>) -> Vec<TVertex> {
    let mut ordered = Vec::with_capacity(hanging.len());
    while let Some((&first, _)) = hanging.first_key_value() {
        let mut waiting = vec![first];
        while let Some(&vertex) = waiting.last() {
            let Some(&t) = hanging.get(&vertex) else {
                waiting.pop();
                continue;
            };
            let below = [t.from, t.to].into_iter().filter(|end| hanging.contains_key(end));
            let before = waiting.len();
            waiting.extend(below);
            if waiting.len() == before {
                hanging.remove(&vertex);
                ordered.push(t);
            }
        }
    }
    ordered
}

/// The places that lie on an edge of an element between its ends.
#[derive(Clone, Debug)]
pub struct EdgePoints {
    /// (from, to, t, place), sorted; `from < to` are places as well.
    points: Vec<(u32, u32, f32, u32)>,
}

impl EdgePoints {
    pub fn new(problem: &Problem, vertices: &Vertices) -> EdgePoints {
        let fronts = vertices.grid.sides(&problem.mesh).filter(|side| !side.back);
        let pieces = loose_pieces(problem, vertices, fronts, |_, _| true, |vertex| vertices.place(vertex));
        let mut points = Vec::new();
        let position = |place: u32| vertices.positions()[place as usize];
        visit_crossings(problem, &pieces, position, |piece, end, t| points.push((piece.from, piece.to, t, end.key)));
        points.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)).then(a.3.cmp(&b.3)));
        points.dedup_by_key(|p| (p.0, p.1, p.3));
        EdgePoints { points }
    }

    /// Points on the edge between places `a` and `b`, in the order from `a` to `b`: share of the way, and place.
    pub fn between(&self, a: u32, b: u32) -> Vec<(f32, u32)> {
        let edge = (a.min(b), a.max(b));
        let first = self.points.partition_point(|p| (p.0, p.1) < edge);
        let on_edge = self.points[first..].iter().take_while(|p| (p.0, p.1) == edge);
        let mut points: Vec<(f32, u32)> = on_edge.map(|p| (if a < b { p.2 } else { 1.0 - p.2 }, p.3)).collect();
        if a > b {
            points.reverse();
        }
        points
    }
}

/// A piece of a patch's edge that no other side shares, between two keys: vertices or places.
#[derive(Clone, Copy, Debug)]
struct Piece {
    from: u32,
    to: u32,
    normal: Vec3,
    length: f32,
}

/// A vertex or place where loose pieces end.
#[derive(Clone, Copy, Debug)]
struct End {
    key: u32,
    normal: Vec3,
    /// Length of the longest loose piece that ends here [m].
    longest: f32,
}

/// Pieces of edges that belong to one side only: borders, creases, and edges between different divisions. Those `of_interest`, by the grid points
/// at their ends.
fn loose_pieces(
    problem: &Problem,
    vertices: &Vertices,
    sides: impl Iterator<Item = Side>,
    of_interest: impl Fn(Side, [[u32; 2]; 2]) -> bool,
    key: impl Fn(u32) -> u32,
) -> Vec<Piece> {
    let mesh = &problem.mesh;
    let mut pieces = Vec::new();
    for side in sides {
        for ends in grid::border(mesh.divisions(side.patch)) {
            if !of_interest(side, ends) {
                continue;
            }
            let [a, b] = ends.map(|ij| vertices.of_grid_point(vertices.grid.number(mesh, side, ij)));
            let length = vertices.position(a).distance(vertices.position(b));
            let front = problem.geometry.surface(side.triangle(mesh), grid::on_triangle(mesh, side.patch, ends[0])).1;
            let normal = if side.back { -front } else { front };
            pieces.push(Piece { from: key(a).min(key(b)), to: key(a).max(key(b)), normal, length });
        }
    }
    pieces.sort_by_key(|piece| (piece.from, piece.to));
    let same = |a: &Piece, b: &Piece| (a.from, a.to) == (b.from, b.to);
    let loose = |chunk: &&[Piece]| chunk.len() == 1 && chunk[0].from != chunk[0].to;
    pieces.chunk_by(same).filter(loose).map(|chunk| chunk[0]).collect()
}

fn ends(pieces: &[Piece]) -> Vec<End> {
    let both = |p: &Piece| [p.from, p.to].map(|key| End { key, normal: p.normal, longest: p.length });
    let mut ends: Vec<End> = pieces.iter().flat_map(both).collect();
    ends.sort_by(|a, b| a.key.cmp(&b.key).then(b.longest.total_cmp(&a.longest)));
    ends.dedup_by_key(|end| end.key);
    ends
}

/// Calls `visit` for every end that lies on a piece between the piece's own ends, at `from + t (to - from)`; for some of them
/// more than once.
fn visit_crossings(
    problem: &Problem,
    pieces: &[Piece],
    position: impl Fn(u32) -> Vec3,
    mut visit: impl FnMut(&Piece, &End, f32),
) {
    let tolerance = 4.0 * weld::TOLERANCE * problem.geometry.bounding_sphere().1;
    let ends = ends(pieces);
    let buckets = Buckets::new(&position, &ends, pieces);
    for piece in pieces {
        let (a, b) = (position(piece.from), position(piece.to));
        buckets.near_segment(a, b, tolerance, |end| {
            let p = position(end.key);
            let t = (p - a).dot(b - a) / (piece.length * piece.length);
            // Vertices of both sides of a wall lie at the same place.
            let between = p != a && p != b && t > 0.0 && t < 1.0;
            if between && p.distance(a + t * (b - a)) <= tolerance {
                visit(piece, end, t);
            }
        });
    }
}

/// The ends of pieces in a hashed grid of cells.
struct Buckets<'a> {
    ends: &'a [End],
    cell: f32,
    first: Vec<usize>,
    sorted: Vec<usize>,
}

impl<'a> Buckets<'a> {
    /// Cells about as large as a typical piece, so that a piece crosses few of them.
    fn new(position: impl Fn(u32) -> Vec3, ends: &'a [End], pieces: &[Piece]) -> Buckets<'a> {
        let mean = pieces.iter().map(|p| f64::from(p.length)).sum::<f64>() / pieces.len().max(1) as f64;
        let cell = (mean as f32).max(f32::MIN_POSITIVE);
        let count = ends.len().next_power_of_two();
        let key = |k: usize| bucket(cell_of(position(ends[k].key), cell), count);
        let (first, sorted) = group_by(count, ends.len(), key);
        Buckets { ends, cell, first, sorted }
    }

    /// Calls `visit` for all ends near the segment from `a` to `b`, some of them more than once, and for some others.
    fn near_segment(&self, a: Vec3, b: Vec3, tolerance: f32, mut visit: impl FnMut(&End)) {
        // Boxes along the segment, each at most half a cell long, cover everything within the tolerance of it.
        let steps = (2.0 * a.distance(b) / self.cell).ceil().clamp(1.0, 1e5) as u32;
        let mut last = None;
        for k in 0..steps {
            let at = |k: u32| a + (b - a) * (k as f32 / steps as f32);
            let low = cell_of(at(k).min(at(k + 1)) - tolerance, self.cell);
            let high = cell_of(at(k).max(at(k + 1)) + tolerance, self.cell);
            if last == Some((low, high)) {
                continue;
            }
            last = Some((low, high));
            for x in low.x..=high.x {
                for y in low.y..=high.y {
                    for z in low.z..=high.z {
                        let bucket = bucket(IVec3::new(x, y, z), self.first.len() - 1) as usize;
                        let members = &self.sorted[self.first[bucket]..self.first[bucket + 1]];
                        members.iter().for_each(|&end| visit(&self.ends[end]));
                    }
                }
            }
        }
    }
}

fn cell_of(position: Vec3, cell: f32) -> IVec3 {
    (position / cell).floor().as_ivec3()
}

/// Bucket of a cell among `count`, a power of two (Teschner et al. 2003).
fn bucket(cell: IVec3, count: usize) -> u32 {
    let hash = (cell.x as u32).wrapping_mul(73_856_093)
        ^ (cell.y as u32).wrapping_mul(19_349_663)
        ^ (cell.z as u32).wrapping_mul(83_492_791);
    (hash ^ (hash >> 15)) & (count as u32 - 1)
}
