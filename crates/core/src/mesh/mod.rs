//! Elements: the small pieces of surface that carry one radiosity each.
//!
//! Surfaces are traced, elements are scored. A triangle with `m` divisions is cut into `m²` congruent elements (see
//! [`cells`]), so a hit's barycentric coordinates lead to its element in O(1), and area and normal need no storage of
//! their own. A two-sided triangle has two sets of elements back to back. Elements are numbered triangle by triangle along a
//! space-filling curve, so neighbouring numbers are neighbours in space: rays shot in the order of elements have sorted origins.

mod average;
pub mod cells;
mod clip;
mod mip;
mod morton;
mod subdivide;

pub use subdivide::{Resolution, count as element_count};

use crate::Error;
use crate::math::Rgb;
use crate::math::warp::square_to_triangle;
use crate::scene::Scene;
use average::Averages;
use glam::{Vec2, Vec3};

/// Elements of all triangles, struct of arrays, 28 bytes an element.
#[derive(Clone, Debug)]
pub struct ElementMesh {
    sides: Vec<TriangleElements>,
    triangle: Vec<u32>,
    reflectivity: Vec<Rgb>,
    emission: Vec<Rgb>,
}

/// Which elements belong to one triangle.
#[derive(Clone, Copy, Debug)]
struct TriangleElements {
    first: u32,
    divisions: u16,
    two_sided: bool,
    /// Area of each element [m²].
    element_area: f32,
    normal: Vec3,
}

/// Where an element lies on its triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    pub triangle: u32,
    /// Whether it is on the back, seeing the half space the normal points away from.
    pub back: bool,
    /// Number of the cell on the triangle, see [`cells`].
    pub cell: u32,
}

impl ElementMesh {
    /// Cuts `scene` into elements as `resolution` asks.
    ///
    /// # Errors
    /// [`Error::NoSurface`] without triangles, [`Error::TooManyElements`], [`Error::NotFinite`] for a material or texture that is not.
    pub fn new(scene: &Scene, resolution: Resolution) -> Result<ElementMesh, Error> {
        let divisions = resolution.divisions(scene)?;
        ElementMesh::with_divisions(scene, &divisions)
    }

    /// Cuts triangle `t` of `scene` into `divisions[t]²` elements a side: what a saved solution remembers of its mesh.
    ///
    /// # Errors
    /// As [`ElementMesh::new`]; [`Error::Parameter`] if `divisions` is not one number from 1 for each triangle.
    pub fn with_divisions(scene: &Scene, divisions: &[u16]) -> Result<ElementMesh, Error> {
        if scene.triangles.is_empty() {
            return Err(Error::NoSurface);
        }
        if divisions.len() != scene.triangles.len() || divisions.contains(&0) {
            let allowed = "one number of divisions from 1 is needed for each triangle";
            return Err(Error::Parameter { name: "divisions", value: divisions.len().to_string(), allowed });
        }
        let total = subdivide::count(scene, divisions)?;
        let mut mesh = ElementMesh {
            sides: vec![TriangleElements::UNSET; divisions.len()],
            triangle: Vec::with_capacity(total),
            reflectivity: Vec::with_capacity(total),
            emission: Vec::with_capacity(total),
        };
        let averages = Averages::new(scene);
        for t in morton::order(scene) {
            mesh.push_triangle(scene, &averages, t, divisions[t as usize]);
        }
        mesh.check_finite()?;
        Ok(mesh)
    }

    fn push_triangle(&mut self, scene: &Scene, averages: &Averages, t: u32, divisions: u16) {
        let material = scene.material_of(t);
        let cell_count = cells::count(divisions);
        self.sides[t as usize] = TriangleElements {
            first: self.triangle.len() as u32,
            divisions,
            two_sided: material.two_sided,
            element_area: (subdivide::surface_area(scene, t) / f64::from(cell_count)) as f32,
            normal: subdivide::normal(scene.corners(t)),
        };
        let first = self.triangle.len();
        for cell in 0..cell_count {
            let (reflectivity, emission) = averages.over_cell(t, cells::corners(cell, divisions));
            self.triangle.push(t);
            self.reflectivity.push(reflectivity);
            self.emission.push(emission);
        }
        if material.two_sided {
            self.triangle.extend_from_within(first..);
            self.reflectivity.extend_from_within(first..);
            self.emission.extend_from_within(first..);
        }
    }

    fn check_finite(&self) -> Result<(), Error> {
        for (what, values) in [("reflectivity", &self.reflectivity), ("emission", &self.emission)] {
            if let Some(e) = values.iter().position(|c| !c.is_finite()) {
                let value = values[e].to_array().into_iter().find(|v| !v.is_finite()).unwrap_or(f32::NAN);
                return Err(Error::NotFinite { element: e as u32, what, value });
            }
        }
        Ok(())
    }

    /// Number of elements, both sides of two-sided surfaces counted.
    pub fn len(&self) -> usize {
        self.triangle.len()
    }

    pub fn is_empty(&self) -> bool {
        self.triangle.is_empty()
    }

    /// Numbers of the elements.
    pub fn elements(&self) -> std::ops::Range<u32> {
        0..self.len() as u32
    }

    /// Triangle on which element `e` lies.
    pub fn triangle(&self, e: u32) -> u32 {
        self.triangle[e as usize]
    }

    /// Reflectivity (albedo), averaged over the element.
    pub fn reflectivity(&self, e: u32) -> Rgb {
        self.reflectivity[e as usize]
    }

    /// Self-emitted exitance `Be` [lm/m²], averaged over the element.
    pub fn emission(&self, e: u32) -> Rgb {
        self.emission[e as usize]
    }

    /// Area [m²].
    pub fn area(&self, e: u32) -> f32 {
        self.sides[self.triangle(e) as usize].element_area
    }

    /// Emitted flux `Pe = A Be` [lm].
    pub fn emitted_flux(&self, e: u32) -> Rgb {
        self.emission(e) * self.area(e)
    }

    /// Unit normal of the side on which the element lies (of the flat triangle; see [`crate::geometry::Geometry`] for curved surfaces).
    pub fn normal(&self, e: u32) -> Vec3 {
        let side = &self.sides[self.triangle(e) as usize];
        if self.place(e).back { -side.normal } else { side.normal }
    }

    pub fn place(&self, e: u32) -> Place {
        let triangle = self.triangle(e);
        let side = &self.sides[triangle as usize];
        let (offset, per_side) = (e - side.first, cells::count(side.divisions));
        let back = offset >= per_side;
        Place { triangle, back, cell: if back { offset - per_side } else { offset } }
    }

    /// The element at barycentric coordinates `uv` of `triangle`, seen from the front or the back; `None` for the back
    /// of a one-sided surface.
    pub fn at(&self, triangle: u32, uv: Vec2, back: bool) -> Option<u32> {
        let side = &self.sides[triangle as usize];
        if back && !side.two_sided {
            return None;
        }
        let offset = if back { cells::count(side.divisions) } else { 0 };
        Some(side.first + offset + cells::at(uv, side.divisions))
    }

    /// Barycentric coordinates within its element of the point `uv` of `triangle`.
    pub fn within(&self, triangle: u32, uv: Vec2) -> Vec2 {
        cells::within(uv, self.sides[triangle as usize].divisions)
    }

    /// Barycentric coordinates on its triangle of the three corners of element `e`.
    pub fn corners(&self, e: u32) -> [Vec2; 3] {
        let place = self.place(e);
        cells::corners(place.cell, self.sides[place.triangle as usize].divisions)
    }

    /// Barycentric coordinates on its triangle of the point of element `e` that belongs to `s` in the unit square;
    /// area preserving.
    pub fn point(&self, e: u32, s: Vec2) -> Vec2 {
        let [a, b, c] = self.corners(e);
        let uv = square_to_triangle(s);
        a + uv.x * (b - a) + uv.y * (c - a)
    }

    /// Number of divisions along each edge of `triangle`.
    pub fn divisions(&self, triangle: u32) -> u16 {
        self.sides[triangle as usize].divisions
    }

    pub fn is_two_sided(&self, triangle: u32) -> bool {
        self.sides[triangle as usize].two_sided
    }

    /// Total area of all elements `A_T` [m²]; a two-sided surface counts twice.
    pub fn total_area(&self) -> f64 {
        self.elements().map(|e| f64::from(self.area(e))).sum()
    }

    /// Total emitted flux of the surfaces [lm] per channel.
    pub fn total_emitted_flux(&self) -> [f64; 3] {
        self.elements().fold([0.0; 3], |mut sum, e| {
            self.emitted_flux(e).to_array().iter().zip(&mut sum).for_each(|(v, s)| *s += f64::from(*v));
            sum
        })
    }
}

impl TriangleElements {
    const UNSET: TriangleElements =
        TriangleElements { first: 0, divisions: 1, two_sided: false, element_area: 0.0, normal: Vec3::Z };
}
