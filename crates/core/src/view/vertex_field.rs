//! Irradiance as people look at it: one value for every vertex, linear between them.
//!
//! A solution has one value for every element and noise in it. The field's value at a vertex is the mean of the elements
//! that touch it, weighted with their open areas ([`super::cover`]) and nearness ([`super::vertex_weights`]), after differences that the error bars cannot tell from
//! noise were taken out ([`super::smooth`]). Vertices are shared where surfaces meet smoothly ([`super::crease`]), so
//! furniture looks round and edges between walls stay sharp, light runs on inside elements of many triangles
//! ([`super::pycnophylactic`]), and T-vertices follow the edge they lie on
//! ([`super::seams`]). Not the inverse variances of the elements: a value that is low by chance has a small
//! error bar as well, and would be believed too much.

use super::grid::Side;
use super::seams::EdgePoints;
use super::vertex_weights::VertexWeights;
use super::vertices::Vertices;
use super::{cover, pycnophylactic, seams, smooth};
use crate::math::Rgb;
use crate::mesh::{Place, cells};
use crate::{Problem, Solution};
use glam::{Vec2, Vec3};

/// Irradiance [lux] interpolated over the surface, and how sure it is. Memory grows with the number of element corners, 50 to 70 bytes
/// each.
///
/// The standard error at a vertex is the mean of those of the elements that touch it, with the same weights: what it is if neighbours
/// err together, and at most that. What smoothing takes away is not taken off.
#[derive(Clone, Debug)]
pub struct VertexField {
    vertices: Vertices,
    irradiance: Vec<Rgb>,
    /// Empty if nobody knows how sure the light is.
    std_error: Vec<Rgb>,
}

impl VertexField {
    /// With the noise of `solution` taken out as far as its error bars allow ([`super::smooth`]).
    pub fn new(problem: &Problem, solution: &Solution) -> VertexField {
        let vertices = Vertices::new(problem);
        let open = cover::open_shares(problem, solution, &vertices);
        let values = smooth::of_open_parts(problem, solution, &vertices, &open);
        VertexField::without_seams(problem, vertices, solution, &values, &open)
    }

    /// With all the noise of `solution`.
    pub fn as_computed(problem: &Problem, solution: &Solution) -> VertexField {
        let vertices = Vertices::new(problem);
        let open = cover::open_shares(problem, solution, &vertices);
        VertexField::without_seams(problem, vertices, solution, &smooth::as_computed(solution, &open), &open)
    }

    /// Of `values` [lux], those of the open parts of the elements of `solution`.
    fn without_seams(
        problem: &Problem,
        vertices: Vertices,
        solution: &Solution,
        values: &[Rgb],
        open: &[f32],
    ) -> VertexField {
        let weights = VertexWeights::new(problem, &vertices, open);
        let mut field = VertexField::of_values(problem, vertices, &weights, values);
        if let Some(errors) = smooth::errors_of_open_parts(solution, open) {
            field.std_error = weights.means(&field.vertices, &errors);
        }
        for seam in seams::t_vertices(problem, &field.vertices) {
            let (from, to) = (field.irradiance(seam.from), field.irradiance(seam.to));
            field.irradiance[seam.vertex as usize] = from + (to - from) * seam.t;
        }
        field
    }

    /// A first look at `irradiance` [lux] of the elements that is still being computed: means at the vertices, no noise taken out and no seam
    /// closed. On the vertices of `earlier`, a field of the same problem, if there is one.
    pub fn draft(problem: &Problem, irradiance: &[Rgb], earlier: Option<VertexField>) -> VertexField {
        let vertices = earlier.map_or_else(|| Vertices::new(problem), |field| field.vertices);
        let weights = VertexWeights::new(problem, &vertices, &vec![1.0; problem.mesh.len()]);
        VertexField::of_values(problem, vertices, &weights, irradiance)
    }

    /// Means at the vertices of `values` [lux] of the elements.
    fn of_values(problem: &Problem, vertices: Vertices, weights: &VertexWeights, values: &[Rgb]) -> VertexField {
        let mut irradiance = weights.means(&vertices, values);
        pycnophylactic::interpolate(problem, &vertices, values, &mut irradiance);
        VertexField { vertices, irradiance, std_error: Vec::new() }
    }

    /// Irradiance [lux] at barycentric coordinates `uv` of `triangle`, on its front or its back; black for the back of a
    /// one-sided surface, which has none.
    pub fn irradiance_at(&self, problem: &Problem, triangle: u32, uv: Vec2, back: bool) -> Rgb {
        self.interpolated(&self.irradiance, problem, triangle, uv, back)
    }

    /// Irradiance [lux] there on the front and on the back.
    pub fn irradiance_on_sides(&self, problem: &Problem, triangle: u32, uv: Vec2) -> [Rgb; 2] {
        let spot = Spot::at(problem, triangle, uv);
        let on = |back| self.between(&self.irradiance, problem, spot, back);
        [on(false), if problem.mesh.is_two_sided(triangle) { on(true) } else { Rgb::BLACK }]
    }

    /// Standard error [lux] there; NaN if it is not known.
    pub fn std_error_at(&self, problem: &Problem, triangle: u32, uv: Vec2, back: bool) -> Rgb {
        if !self.is_error_known() {
            return Rgb::grey(f32::NAN);
        }
        self.interpolated(&self.std_error, problem, triangle, uv, back)
    }

    /// Whether somebody knows how sure the light is: not of drafts, and not after deterministic methods.
    pub fn is_error_known(&self) -> bool {
        !self.std_error.is_empty()
    }

    /// `values` of the vertices, linear between them.
    fn interpolated(&self, values: &[Rgb], problem: &Problem, triangle: u32, uv: Vec2, back: bool) -> Rgb {
        if back && !problem.mesh.is_two_sided(triangle) {
            return Rgb::BLACK;
        }
        self.between(values, problem, Spot::at(problem, triangle, uv), back)
    }

    /// `values` of the vertices around `spot`, on the front or on the back.
    fn between(&self, values: &[Rgb], problem: &Problem, spot: Spot, back: bool) -> Rgb {
        let side = Side { patch: spot.patch, back };
        let value = |ij| {
            let number = self.vertices.grid.number(&problem.mesh, side, ij);
            values[self.vertices.of_grid_point(number) as usize]
        };
        let [a, b, c] = spot.corners.map(value);
        a + (b - a) * spot.within.x + (c - a) * spot.within.y
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.vertices.len()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Vertices at the corners of a place where an element lies, in the orientation of the triangle's front.
    pub fn vertices_at(&self, problem: &Problem, place: Place) -> [u32; 3] {
        self.vertices.at(problem, place)
    }

    /// Irradiance [lux] at vertex `v`.
    pub fn irradiance(&self, v: u32) -> Rgb {
        self.irradiance[v as usize]
    }

    /// Standard error [lux] at vertex `v`; NaN if it is not known.
    pub fn std_error(&self, v: u32) -> Rgb {
        self.std_error.get(v as usize).copied().unwrap_or(Rgb::grey(f32::NAN))
    }

    /// Where elements' edges have vertices of their neighbours on them; for programs that draw triangles.
    pub fn edge_points(&self, problem: &Problem) -> EdgePoints {
        EdgePoints::new(problem, &self.vertices)
    }

    /// Number of the place of vertex `v`: vertices on both sides of a sharp edge have the same.
    pub fn place(&self, v: u32) -> u32 {
        self.vertices.place(v)
    }

    /// World position [m] of a place.
    pub fn position_of_place(&self, place: u32) -> Vec3 {
        self.vertices.positions()[place as usize]
    }

    /// World position [m] of vertex `v`.
    pub fn position(&self, v: u32) -> Vec3 {
        self.vertices.position(v)
    }
}

/// A cell of a patch, and where in it.
#[derive(Clone, Copy, Debug)]
struct Spot {
    patch: u32,
    /// Grid points at its corners.
    corners: [[u32; 2]; 3],
    /// Barycentric coordinates.
    within: Vec2,
}

impl Spot {
    /// At barycentric coordinates `uv` of `triangle`.
    fn at(problem: &Problem, triangle: u32, uv: Vec2) -> Spot {
        let (patch, uv) = problem.mesh.patch_at(triangle, uv);
        let m = problem.mesh.divisions(patch);
        let (cell, within) = cells::locate(uv, m);
        let s = within.x.clamp(0.0, 1.0);
        let t = within.y.clamp(0.0, 1.0 - s);
        Spot { patch, corners: cells::grid_corners(cell, m), within: Vec2::new(s, t) }
    }
}

#[cfg(test)]
mod tests;
