//! The vertices of the lit surface: grid points that are the same place on the same smooth surface, made one.

use super::grid::{self, Grid, Side};
use super::{contacts, crease};
use crate::Problem;
use crate::math::weld::{self, Weld};
use crate::mesh::Place;
use glam::Vec3;
use rayon::prelude::*;
use std::ops::Range;

/// Which grid points share a vertex, and which elements touch it. Edges between walls keep a vertex for each wall,
/// smooth surfaces share theirs, whatever objects and materials they belong to.
#[derive(Clone, Debug)]
pub struct Vertices {
    pub grid: Grid,
    /// Vertex of every grid point.
    of_grid_point: Vec<u32>,
    /// Position [m] of every place.
    positions: Vec<Vec3>,
    /// Place of every vertex; several vertices meet at the same place along an edge.
    places: Vec<u32>,
    /// Elements that touch vertex v: `touching[first[v]..first[v + 1]]`.
    first: Vec<usize>,
    touching: Vec<u32>,
}

impl Vertices {
    pub fn new(problem: &Problem) -> Vertices {
        let mesh = &problem.mesh;
        let grid = Grid::new(mesh);
        let (place_of_grid_point, normals, positions) = places(problem, &grid);
        let (mut of_grid_point, mut places) = split_at_creases(&place_of_grid_point, &normals, positions.len());
        contacts::divide(problem, &grid, &place_of_grid_point, &mut of_grid_point, &mut places);
        let mut vertices = Vertices { grid, of_grid_point, positions, places, first: Vec::new(), touching: Vec::new() };
        let touched = |e: u32| vertices.of_element(problem, e).into_iter().map(move |v| (v, e));
        let pairs: Vec<(u32, u32)> = mesh.elements().into_par_iter().flat_map_iter(touched).collect();
        let (first, sorted) = group_by(vertices.len(), pairs.len(), |k| pairs[k].0);
        vertices.first = first;
        vertices.touching = sorted.into_iter().map(|k| pairs[k].1).collect();
        vertices
    }

    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Number of the place where vertex `v` is.
    pub fn place(&self, v: u32) -> u32 {
        self.places[v as usize]
    }

    /// Position [m] of vertex `v`.
    pub fn position(&self, v: u32) -> Vec3 {
        self.positions[self.place(v) as usize]
    }

    /// Positions [m] of the places.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Vertex of a grid point.
    pub fn of_grid_point(&self, number: usize) -> u32 {
        self.of_grid_point[number]
    }

    /// Vertices at the corners of a place where an element lies, in the orientation of the triangle's front.
    pub fn at(&self, problem: &Problem, place: Place) -> [u32; 3] {
        self.grid.corners_at(&problem.mesh, place).map(|g| self.of_grid_point[g])
    }

    /// Vertices that element `e` touches: its three corners, or all at the corners of a cluster's triangles, each once.
    pub fn of_element(&self, problem: &Problem, e: u32) -> Vec<u32> {
        let mut touched: Vec<u32> = problem.mesh.pieces(e).flat_map(|place| self.at(problem, place)).collect();
        if problem.mesh.cluster(e).is_some() {
            touched.sort_unstable();
            touched.dedup();
        }
        touched
    }

    /// Elements that touch vertex `v`.
    pub fn touching(&self, v: u32) -> &[u32] {
        &self.touching[self.range(v)]
    }

    /// Where the elements that touch vertex `v` are in a list of those of all vertices.
    pub fn range(&self, v: u32) -> Range<usize> {
        self.first[v as usize]..self.first[v as usize + 1]
    }
}

/// Place (welded position) and normal of every grid point, and the positions [m] of the places.
fn places(problem: &Problem, grid: &Grid) -> (Vec<u32>, Vec<Vec3>, Vec<Vec3>) {
    let mesh = &problem.mesh;
    let fronts: Vec<Side> = grid.sides(mesh).filter(|side| !side.back).collect();
    let points = |side: &Side| {
        let (patch, triangle) = (side.patch, side.triangle(mesh));
        let at = move |point| problem.geometry.surface(triangle, grid::on_triangle(mesh, patch, point));
        grid::points(mesh.divisions(patch)).map(at)
    };
    let surface: Vec<(Vec3, Vec3)> = fronts.par_iter().flat_map_iter(points).collect();
    let radius = problem.geometry.bounding_sphere().1;
    let mut weld = Weld::new((weld::TOLERANCE * radius).max(f32::MIN_POSITIVE));
    let mut places = Vec::with_capacity(grid.len());
    let mut normals = Vec::with_capacity(grid.len());
    let mut left = &surface[..];
    for side in fronts {
        let (front, others) = left.split_at(grid::points_on_side(mesh.divisions(side.patch)));
        left = others;
        places.extend(front.iter().map(|&(position, _)| weld.number(position)));
        normals.extend(front.iter().map(|&(_, normal)| normal));
        if mesh.is_two_sided(side.triangle(mesh)) {
            places.extend_from_within(places.len() - front.len()..);
            normals.extend(front.iter().map(|&(_, normal)| -normal));
        }
    }
    (places, normals, weld.into_positions())
}

/// One vertex for every smooth group at every place: the vertex of every grid point, and the place of every vertex.
fn split_at_creases(places: &[u32], normals: &[Vec3], place_count: usize) -> (Vec<u32>, Vec<u32>) {
    let (first, members) = group_by(place_count, places.len(), |g| places[g]);
    let mut vertex = vec![0; places.len()];
    let mut place_of_vertex = Vec::new();
    for place in 0..place_count {
        let members = &members[first[place]..first[place + 1]];
        let here: Vec<Vec3> = members.iter().map(|&g| normals[g]).collect();
        let groups = crease::groups(&here);
        let base = place_of_vertex.len() as u32;
        for (&g, group) in members.iter().zip(&groups) {
            vertex[g] = base + group;
        }
        let count = groups.iter().max().map_or(0, |last| last + 1);
        place_of_vertex.extend((0..count).map(|_| place as u32));
    }
    (vertex, place_of_vertex)
}

/// Sorts the items 0..`items` by `key` below `keys` (a counting sort): those of key k are `sorted[first[k]..first[k + 1]]`.
pub(super) fn group_by(keys: usize, items: usize, key: impl Fn(usize) -> u32) -> (Vec<usize>, Vec<usize>) {
    let mut first = vec![0; keys + 1];
    (0..items).for_each(|item| first[key(item) as usize + 1] += 1);
    for k in 0..keys {
        first[k + 1] += first[k];
    }
    let mut next = first.clone();
    let mut sorted = vec![0; items];
    for item in 0..items {
        let slot = &mut next[key(item) as usize];
        sorted[*slot] = item;
        *slot += 1;
    }
    (first, sorted)
}
