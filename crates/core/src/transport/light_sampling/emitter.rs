//! Emitters: one side of a triangle if it emits alike everywhere, else each of its elements that emits.
//!
//! Large emitters are few, so they are easy to choose among, and a direction uniform in the solid angle of a whole window is as good as
//! one of a part of it. Curved surfaces are sampled uniformly by area instead.

use crate::Problem;
use crate::geometry::NONE;
use crate::math::warp::square_to_triangle;
use crate::math::{Rgb, SphericalTriangle};
use crate::mesh::ElementMesh;
use crate::scene::Shape;
use glam::{Vec2, Vec3};

/// A triangular surface that emits the same everywhere, on one side.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Emitter {
    /// The triangle it lies on, and on which side.
    pub triangle: u32,
    pub back: bool,
    /// Emitted exitance [lm/m²].
    pub emission: Rgb,
    /// Area [m²].
    pub area: f32,
    /// World positions [m] of the corners, counter-clockwise seen from where it emits, and the normal on that side; zero if
    /// it is curved.
    pub corners: [Vec3; 3],
    pub normal: Vec3,
    /// Barycentric coordinates of the corners on the triangle.
    uv: [Vec2; 3],
    curved: bool,
}

/// A direction towards an emitter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aim {
    pub direction: Vec3,
    /// Density of such directions [1/sr].
    pub density: f32,
}

impl Emitter {
    /// Emitted luminous flux [lm].
    pub fn flux(&self) -> f64 {
        f64::from(self.area) * self.emission.luminance_f64()
    }

    /// The direction from `eye` that belongs to `s` in the unit square; `None` if it does not see the emitting side there.
    pub fn aim(&self, problem: &Problem, eye: Vec3, s: Vec2) -> Option<Aim> {
        if self.curved {
            let [a, b, c] = self.uv;
            let uv = square_to_triangle(s);
            let (point, front) = problem.geometry.surface(self.triangle, a + uv.x * (b - a) + uv.y * (c - a));
            let direction = (point - eye).normalize_or_zero();
            return self.by_area(point.distance(eye), direction, front).map(|density| Aim { direction, density });
        }
        let seen = SphericalTriangle::new(self.corners, eye)?;
        Some(Aim { direction: seen.direction(s), density: (1.0 / seen.solid_angle()) as f32 })
    }

    /// Density [1/sr] of [`Emitter::aim`] in a `direction` from `eye` that meets the emitter at barycentric coordinates `uv` of its
    /// triangle, at `distance` [m].
    pub fn density(&self, problem: &Problem, eye: Vec3, direction: Vec3, distance: f32, uv: Vec2) -> f32 {
        if self.curved {
            let (_, front) = problem.geometry.surface(self.triangle, uv);
            return self.by_area(distance, direction, front).unwrap_or(0.0);
        }
        SphericalTriangle::new(self.corners, eye).map_or(0.0, |seen| (1.0 / seen.solid_angle()) as f32)
    }

    /// `r² / (A cos)`, where uniform points of the area become directions.
    fn by_area(&self, distance: f32, direction: Vec3, front: Vec3) -> Option<f32> {
        let cos = if self.back { direction.dot(front) } else { -direction.dot(front) };
        (cos > 0.0).then(|| distance * distance / (self.area * cos))
    }
}

/// The emitters of a problem in the order of its elements, and for each element the number of the emitter it belongs to, or [`NONE`].
pub fn emitters(problem: &Problem) -> (Vec<Emitter>, Vec<u32>) {
    let mesh = &problem.mesh;
    let (mut all, mut of_element) = (Vec::new(), vec![NONE; mesh.len()]);
    let mut first = 0;
    while first < mesh.len() as u32 {
        let triangle = mesh.triangle(first);
        let end = (first..mesh.len() as u32).find(|&e| mesh.triangle(e) != triangle).unwrap_or(mesh.len() as u32);
        for back in [false, true] {
            let side: Vec<u32> = (first..end).filter(|&e| mesh.place(e).back == back).collect();
            add_side(problem, &side, back, &mut all, &mut of_element);
        }
        first = end;
    }
    (all, of_element)
}

/// Adds the emitters among the elements of one side of a triangle.
fn add_side(problem: &Problem, side: &[u32], back: bool, all: &mut Vec<Emitter>, of_element: &mut [u32]) {
    const WHOLE: [Vec2; 3] = [Vec2::ZERO, Vec2::X, Vec2::Y];
    let mesh: &ElementMesh = &problem.mesh;
    let Some(&first) = side.first() else { return };
    let mut add = |elements: &[u32], uv: [Vec2; 3]| {
        let emission = mesh.emission(elements[0]);
        if emission.luminance() > 0.0 {
            elements.iter().for_each(|&e| of_element[e as usize] = all.len() as u32);
            let area = elements.iter().map(|&e| f64::from(mesh.area(e))).sum::<f64>() as f32;
            all.push(emitter(problem, mesh.triangle(first), back, uv, emission, area));
        }
    };
    if side.iter().all(|&e| mesh.emission(e) == mesh.emission(first)) {
        add(side, WHOLE);
    } else {
        side.iter().for_each(|&e| add(&[e], mesh.corners(e)));
    }
}

fn emitter(problem: &Problem, triangle: u32, back: bool, uv: [Vec2; 3], emission: Rgb, area: f32) -> Emitter {
    let [a, b, c] = uv.map(|uv| problem.geometry.surface(triangle, uv).0);
    let curved = problem.scene.shape != Shape::Triangles;
    let front = if curved { Vec3::ZERO } else { problem.geometry.surface(triangle, uv[0]).1 };
    let (corners, normal) = if back { ([a, c, b], -front) } else { ([a, b, c], front) };
    Emitter { triangle, back, emission, area, corners, normal, uv, curved }
}
