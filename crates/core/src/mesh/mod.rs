//! Elements: the small pieces of surface that carry one radiosity each.
//!
//! Surfaces are traced, elements are scored. A triangle is one *patch*, or if it is a needle several (see [`slices`]); a patch
//! with `m` divisions is cut into `m²` congruent elements (see [`cells`]), or into patches, and these again (see [`bisection`]). So a hit's
//! barycentric coordinates lead to its element in O(1), or O(depth) where the mesh follows the light or contacts, and area and normal need no storage
//! of their own. Where triangles are smaller than elements should be, an element is a *cluster* of whole triangles instead (see
//! [`clusters`]), each of which is a patch of one cell. A two-sided triangle has two sets of elements back to back. Elements
//! are numbered triangle by triangle along a space-filling curve, so neighbouring numbers are neighbours in space: rays shot
//! in the order of elements have sorted origins.

mod average;
mod bisection;
mod build;
pub mod cells;
mod clip;
mod clusters;
mod contacts;
mod cut;
mod descent;
mod grow;
mod locate;
mod lookup;
mod mip;
mod morton;
mod resolution;
mod slices;
mod sparse;
mod triangle;

pub use bisection::{Division, MOST_BISECTIONS, halved, halves};
pub use clusters::{Cluster, Piece};
pub(crate) use cut::sides;
pub use cut::{Cut, MOST_ELEMENTS};
pub(crate) use grow::{BEND, triangle_neighbours};
pub use locate::{Point, TOGETHER};
pub use lookup::{LANES, Lookup};
pub use resolution::Resolution;
pub use slices::Slices;
pub(crate) use triangle::surface_area;

use crate::math::Rgb;
use crate::math::warp::square_to_triangle;
use bisection::{Content, Part};
use clusters::Clusters;
use descent::Step;
use glam::{Vec2, Vec3};
use sparse::SparseColors;

/// Elements of all triangles, struct of arrays, 16 bytes an element and 12 more if it emits light.
#[derive(Clone, Debug)]
pub struct ElementMesh {
    surfaces: Vec<Surface>,
    /// Those of each triangle in turn, then the parts of each that is divided.
    patches: Vec<Patch>,
    /// Where the patches lie that are parts of others, the last ones.
    parts: Vec<Part>,
    /// Where it goes on from each patch, if any is divided.
    steps: Vec<Step>,
    clusters: Clusters,
    /// Patch of every element; of a cluster that of its largest triangle.
    patch: Vec<u32>,
    reflectivity: Vec<Rgb>,
    emission: SparseColors,
}

/// One triangle.
#[derive(Clone, Copy, Debug)]
struct Surface {
    first_patch: u32,
    slices: Slices,
    two_sided: bool,
    normal: Vec3,
}

/// A part of a triangle that is cut regularly: first the elements of its front, then those of its back; or divided into patches.
#[derive(Clone, Copy, Debug)]
struct Patch {
    triangle: u32,
    /// The first of its elements, or of its parts.
    first: u32,
    /// Along each edge; none if it is bisected.
    divisions: u16,
    content: Content,
    /// Area of each element [m²]; of a cluster that of all its triangles. Of a patch that is bisected the share at which it is.
    measure: f32,
}

/// Where an element lies on its triangle, or on one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    pub triangle: u32,
    pub patch: u32,
    /// Whether it is on the back, seeing the half space the normal points away from.
    pub back: bool,
    /// Number of the cell on the patch, see [`cells`].
    pub cell: u32,
}

impl ElementMesh {
    /// Number of elements, both sides of two-sided surfaces counted.
    pub fn len(&self) -> usize {
        self.patch.len()
    }

    pub fn is_empty(&self) -> bool {
        self.patch.is_empty()
    }

    /// Numbers of the elements.
    pub fn elements(&self) -> std::ops::Range<u32> {
        0..self.len() as u32
    }

    /// Triangle on which element `e` lies; the largest of a cluster, whose triangles all belong to one object.
    pub fn triangle(&self, e: u32) -> u32 {
        self.patch_of(e).triangle
    }

    /// Reflectivity (albedo), averaged over the element.
    pub fn reflectivity(&self, e: u32) -> Rgb {
        self.reflectivity[e as usize]
    }

    /// Self-emitted exitance `Be` [lm/m²], averaged over the element.
    pub fn emission(&self, e: u32) -> Rgb {
        self.emission.get(e)
    }

    /// Area [m²].
    pub fn area(&self, e: u32) -> f32 {
        self.patch_of(e).measure
    }

    /// Emitted flux `Pe = A Be` [lm].
    pub fn emitted_flux(&self, e: u32) -> Rgb {
        self.emission(e) * self.area(e)
    }

    /// Unit normal of the side on which the element lies (of the flat triangle, see [`crate::geometry::Geometry`] for curved surfaces;
    /// of the largest of a cluster).
    pub fn normal(&self, e: u32) -> Vec3 {
        let place = self.place(e);
        let front = self.surfaces[place.triangle as usize].normal;
        if place.back { -front } else { front }
    }

    /// Where element `e` lies; of a cluster its largest triangle, see [`ElementMesh::pieces`] for all.
    pub fn place(&self, e: u32) -> Place {
        let (patch, Patch { triangle, first, divisions, .. }) = (self.patch[e as usize], *self.patch_of(e));
        let (offset, per_side) = (e - first, cells::count(divisions));
        let back = offset >= per_side;
        Place { triangle, patch, back, cell: if back { offset - per_side } else { offset } }
    }

    /// The element at barycentric coordinates `uv` of `triangle`, seen from the front or the back; `None` for the back
    /// of a one-sided surface.
    pub fn at(&self, triangle: u32, uv: Vec2, back: bool) -> Option<u32> {
        self.locate(triangle, uv, back).map(|(element, _)| element)
    }

    /// As [`ElementMesh::at`], with the barycentric coordinates within the element, in the order of its corners.
    #[inline]
    pub fn locate(&self, triangle: u32, uv: Vec2, back: bool) -> Option<(u32, Vec2)> {
        let surface = &self.surfaces[triangle as usize];
        if back && !surface.two_sided {
            return None;
        }
        let (patch, uv) = surface.slices.locate(uv);
        let (patch, uv) = self.leaf_at(surface.first_patch + patch, uv);
        let patch = &self.patches[patch as usize];
        let (cell, within) = cells::locate(uv, patch.divisions);
        let within = self.clusters.piece(triangle).map_or(within, |piece| piece.within(within));
        let offset = if back { cells::count(patch.divisions) } else { 0 };
        Some((patch.first + offset + cell, within))
    }

    /// The patch with elements at barycentric coordinates `uv` of `triangle`, and the barycentric coordinates on it.
    pub fn patch_at(&self, triangle: u32, uv: Vec2) -> (u32, Vec2) {
        let surface = &self.surfaces[triangle as usize];
        let (patch, within) = surface.slices.locate(uv);
        self.leaf_at(surface.first_patch + patch, within)
    }

    /// Numbers of the patches that have elements, in ascending order: all but those that are divided.
    pub fn patches(&self) -> impl Iterator<Item = u32> + '_ {
        (0..).zip(&self.patches).filter(|(_, patch)| !patch.is_divided()).map(|(number, _)| number)
    }

    /// Triangle on which `patch` lies.
    pub fn triangle_of_patch(&self, patch: u32) -> u32 {
        self.patches[patch as usize].triangle
    }

    /// Number of elements along each edge of `patch`; 0 if it is divided into patches.
    pub fn divisions(&self, patch: u32) -> u16 {
        let patch = &self.patches[patch as usize];
        if patch.is_divided() { 0 } else { patch.divisions }
    }

    /// Whether something stands on each edge of `patch`, from corner k to the next.
    pub fn beside(&self, patch: u32) -> [bool; 3] {
        match self.patches[patch as usize].content {
            Content::Elements { beside } => [0, 1, 2].map(|k| beside >> k & 1 == 1),
            _ => [false; 3],
        }
    }

    /// Barycentric coordinates on the triangle of the point `uv` of `patch`.
    pub fn on_triangle(&self, patch: u32, uv: Vec2) -> Vec2 {
        let [corner, along, across] = self.frame(patch);
        corner + uv.x * along + uv.y * across
    }

    /// Barycentric coordinates on its triangle of the three corners of element `e`; of a cluster those of its largest triangle.
    pub fn corners(&self, e: u32) -> [Vec2; 3] {
        self.corners_at(self.place(e))
    }

    /// Barycentric coordinates on its triangle of the three corners of a place.
    pub fn corners_at(&self, Place { patch, cell, .. }: Place) -> [Vec2; 3] {
        cells::corners(cell, self.divisions(patch)).map(|uv| self.on_triangle(patch, uv))
    }

    /// Where element `e` lies, and in barycentric coordinates on its triangle: a corner, and the edges from it. For an element that is
    /// no cluster.
    pub fn place_and_edges(&self, e: u32) -> (Place, [Vec2; 3]) {
        let place = self.place(e);
        let (corner, length) = cells::frame(place.cell, self.divisions(place.patch));
        let [a, along, across] = self.frame(place.patch);
        (place, [a + corner.x * along + corner.y * across, length * along, length * across])
    }

    /// Triangle, and barycentric coordinates on it, of the point of element `e` that belongs to `s` in the unit square;
    /// area preserving.
    pub fn point(&self, e: u32, s: Vec2) -> (u32, Vec2) {
        self.on_element(e, square_to_triangle(s))
    }

    /// How the triangles were cut: with it the same elements can be made again.
    pub fn cut(&self) -> Cut {
        let mut slices = Vec::with_capacity(self.surfaces.len());
        let mut divisions = Vec::with_capacity(self.patches.len());
        for surface in &self.surfaces {
            slices.push(surface.slices);
            surface.patches().for_each(|patch| self.divisions_below(patch, &mut divisions));
        }
        Cut { slices, divisions, leaders: self.clusters.leaders() }
    }

    pub fn is_two_sided(&self, triangle: u32) -> bool {
        self.surfaces[triangle as usize].two_sided
    }

    /// Total area of all elements `A_T` [m²]; a two-sided surface counts twice.
    pub fn total_area(&self) -> f64 {
        self.areas().map(|(area, count)| f64::from(area) * f64::from(count)).sum()
    }

    /// Areas [m²] of all elements, and how many in turn have each.
    pub fn areas(&self) -> impl Iterator<Item = (f32, u32)> + Clone + '_ {
        let sides = |patch: &Patch| if self.is_two_sided(patch.triangle) { 2 } else { 1 };
        // Of the patches of a cluster only the one that stands for it.
        let counts =
            |(number, patch): &(u32, &Patch)| !patch.is_divided() && self.patch[patch.first as usize] == *number;
        let patches = (0..).zip(&self.patches).filter(counts);
        patches.map(move |(_, patch)| (patch.measure, sides(patch) * cells::count(patch.divisions)))
    }

    /// Total emitted flux of the surfaces [lm] per channel.
    pub fn total_emitted_flux(&self) -> [f64; 3] {
        self.elements().fold([0.0; 3], |mut sum, e| {
            self.emitted_flux(e).to_array().iter().zip(&mut sum).for_each(|(v, s)| *s += f64::from(*v));
            sum
        })
    }

    /// Takes the emission of `other`, which has the same elements, on those triangles that `keep` names; all else is black.
    pub fn take_emission(&mut self, other: &ElementMesh, keep: impl Fn(u32) -> bool) {
        let kept = |e: u32| Some(other.emission(e)).filter(|emission| !emission.is_black() && keep(other.triangle(e)));
        self.emission = other.elements().map(|e| kept(e).unwrap_or(Rgb::BLACK)).collect();
    }

    fn patch_of(&self, e: u32) -> &Patch {
        &self.patches[self.patch[e as usize] as usize]
    }
}

impl Surface {
    /// Numbers of the patches that are no part of another.
    fn patches(&self) -> std::ops::Range<u32> {
        self.first_patch..self.first_patch + self.slices.patch_count()
    }
}
