//! No seam where triangles with different divisions meet: the finer side follows the coarser one along their edge.
//!
//! Values are interpolated linearly between the vertices along an edge. A vertex of one side that lies between two
//! vertices of the other (a T-vertex) would bend the light on its own side only, which shows as a seam across a flat
//! wall. So a T-vertex takes the value that the longer piece of edge has where it lies.

use super::crease::CREASE_ANGLE;
use super::grid;
use super::vertices::{Vertices, WELD_TOLERANCE, group_by};

use crate::Problem;
use glam::{IVec3, Vec3};

/// A vertex that takes the value `(1 - t) value[from] + t value[to]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TVertex {
    pub vertex: u32,
    pub from: u32,
    pub to: u32,
    pub t: f32,
}

/// A piece of a triangle's edge, from vertex to vertex, that no other side shares.
#[derive(Clone, Copy, Debug)]
struct Piece {
    from: u32,
    to: u32,
    normal: Vec3,
    length: f32,
}

/// All T-vertices, in an order in which every one comes after those it depends on.
pub fn t_vertices(problem: &Problem, vertices: &Vertices) -> Vec<TVertex> {
    let pieces = loose_pieces(problem, vertices);
    let ends = ends(&pieces);
    let tolerance = 4.0 * WELD_TOLERANCE * problem.geometry.bounding_sphere().1;
    let buckets = Buckets::new(vertices, &ends, &pieces);
    let mut found: Vec<(f32, TVertex)> = Vec::new();
    for piece in &pieces {
        let (a, b) = (vertices.position(piece.from), vertices.position(piece.to));
        buckets.near_segment(a, b, tolerance, |end| {
            // Strictly longer than any piece at the vertex: so what a vertex depends on hangs on a longer piece yet, and
            // going from long to short settles all of them.
            let smooth = end.normal.dot(piece.normal) > CREASE_ANGLE.cos();
            if piece.length > 1.001 * end.longest && smooth && end.vertex != piece.from && end.vertex != piece.to {
                let t = (vertices.position(end.vertex) - a).dot(b - a) / (piece.length * piece.length);
                let off = (a + t * (b - a)).distance(vertices.position(end.vertex));
                if off <= tolerance && t > 0.0 && t < 1.0 {
                    found.push((piece.length, TVertex { vertex: end.vertex, from: piece.from, to: piece.to, t }));
                }
            }
        });
    }
    found.sort_by(|(long, x), (longer, y)| {
        longer.total_cmp(long).then(x.vertex.cmp(&y.vertex)).then(x.from.cmp(&y.from))
    });
    let mut taken = vec![false; vertices.len()];
    found.retain(|(_, t)| !std::mem::replace(&mut taken[t.vertex as usize], true));
    found.into_iter().map(|(_, t)| t).collect()
}

/// Pieces of edges that belong to one side only: borders, creases, and edges between different divisions.
fn loose_pieces(problem: &Problem, vertices: &Vertices) -> Vec<Piece> {
    let mesh = &problem.mesh;
    let mut pieces = Vec::new();
    for side in vertices.grid.sides(mesh) {
        let m = mesh.divisions(side.triangle);
        for ends in grid::border(m) {
            let [from, to] = ends.map(|ij| vertices.of_grid_point(vertices.grid.number(mesh, side, ij)));
            let length = vertices.position(from).distance(vertices.position(to));
            let front = problem.geometry.surface(side.triangle, grid::barycentric(ends[0], m)).1;
            let normal = if side.back { -front } else { front };
            pieces.push(Piece { from: from.min(to), to: from.max(to), normal, length });
        }
    }
    pieces.sort_by_key(|piece| (piece.from, piece.to));
    let shared = |pair: &[Piece]| pair.len() > 1 || pair[0].from == pair[0].to;
    let same = |a: &Piece, b: &Piece| (a.from, a.to) == (b.from, b.to);
    pieces.chunk_by(same).filter(|chunk| !shared(chunk)).map(|chunk| chunk[0]).collect()
}

/// A vertex where loose pieces end.
#[derive(Clone, Copy, Debug)]
struct End {
    vertex: u32,
    normal: Vec3,
    /// Length of the longest loose piece that ends here [m].
    longest: f32,
}

fn ends(pieces: &[Piece]) -> Vec<End> {
    let both = |p: &Piece| [p.from, p.to].map(|vertex| End { vertex, normal: p.normal, longest: p.length });
    let mut ends: Vec<End> = pieces.iter().flat_map(both).collect();
    ends.sort_by(|a, b| a.vertex.cmp(&b.vertex).then(b.longest.total_cmp(&a.longest)));
    ends.dedup_by_key(|end| end.vertex);
    ends
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
    fn new(vertices: &Vertices, ends: &'a [End], pieces: &[Piece]) -> Buckets<'a> {
        let mean = pieces.iter().map(|p| f64::from(p.length)).sum::<f64>() / pieces.len().max(1) as f64;
        let cell = (mean as f32).max(f32::MIN_POSITIVE);
        let count = ends.len().next_power_of_two();
        let key = |k: usize| bucket(cell_of(vertices.position(ends[k].vertex), cell), count);
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
