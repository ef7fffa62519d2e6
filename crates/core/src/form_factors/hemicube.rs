//! The hemicube (Cohen & Greenberg 1985): half a cube over an element, its faces divided into pixels.
//!
//! `F_ij ≈ Σ ΔF_q` over the pixels q through which j is seen. The delta form factor of a pixel is that of its square from the
//! middle of the cube, by Lambert's formula; all together sum to one. What a pixel sees is found by one ray through its
//! middle, not by drawing the scene into it: the same answer, and the one geometry of all of isolux.
//!
//! Biased: the element is taken for its middle (or a few points), and what is smaller than a pixel may be missed. Cost: 3 R²
//! rays a hemicube.

use super::contour::point_to_polygon;
use super::{Row, Settings, Way};
use crate::geometry::Ray;
use crate::math::Frame;
use crate::mesh::cells;
use crate::transport::{Arrival, arrivals};
use crate::{Error, Problem};
use glam::{DVec3, Vec2, Vec3};
use std::ops::Range;

/// Pixels along an edge.
const RESOLUTIONS: Range<u16> = 2..1025;
/// Divisions of an element along its edge.
const DIVISIONS: Range<u16> = 1..65;
/// Rays traced at once.
const BATCH: usize = 512;

/// Directions and delta form factors of the pixels, in the frame of a surface.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Hemicube {
    pixels: Vec<(Vec3, f64)>,
    /// A hemicube stands on each of the `divisions²` cells of an element.
    divisions: u16,
}

impl Hemicube {
    /// # Errors
    /// [`Error::Parameter`] for an odd or too large resolution, or a number of hemicubes that makes no sense.
    pub fn new(settings: &Settings) -> Result<Hemicube, Error> {
        let Settings { resolution, hemicubes, .. } = *settings;
        if !RESOLUTIONS.contains(&resolution) || resolution % 2 != 0 {
            let allowed = "the edge of a hemicube has an even number of pixels from 2 to 1024";
            return Err(Error::Parameter { name: "resolution", value: resolution.to_string(), allowed });
        }
        if !DIVISIONS.contains(&hemicubes) {
            let allowed = "an element is divided from 1 to 64 times along its edge";
            return Err(Error::Parameter { name: "hemicubes", value: hemicubes.to_string(), allowed });
        }
        Ok(Hemicube { pixels: pixels(resolution), divisions: hemicubes })
    }

    /// Rays for one element: all pixels of all its hemicubes.
    pub fn rays(&self) -> u64 {
        u64::from(cells::count(self.divisions)) * self.pixels.len() as u64
    }

    /// Delta form factors of the pixels of one hemicube; they sum to one.
    pub fn delta_form_factors(&self) -> impl Iterator<Item = f64> + '_ {
        self.pixels.iter().map(|&(_, delta)| delta)
    }

    /// Traces the rays of `element` with numbers in `range`, and hands what each sees, with its share of the light, to `each`.
    pub fn look(&self, problem: &Problem, element: u32, range: Range<u64>, mut each: impl FnMut(Arrival, f64)) {
        let triangle = problem.mesh.triangle(element);
        let back = problem.mesh.place(element).back;
        let corners = problem.mesh.corners(element);
        let count = self.pixels.len() as u64;
        let share = 1.0 / f64::from(cells::count(self.divisions));
        let (mut rays, mut hits) = (Vec::with_capacity(BATCH), Vec::new());
        let mut start = range.start;
        while start < range.end {
            // The rays of one batch leave from one hemicube.
            let cell = start / count;
            let end = range.end.min(start + BATCH as u64).min((cell + 1) * count);
            let uv = middle(corners, cells::corners(cell as u32, self.divisions));
            let (point, front) = problem.geometry.surface(triangle, uv);
            let normal = if back { -front } else { front };
            let (frame, origin) = (Frame::about(normal), point + normal * problem.geometry.lift());
            let pixels = &self.pixels[(start - cell * count) as usize..(end - cell * count) as usize];
            rays.clear();
            rays.extend(pixels.iter().map(|&(local, _)| Ray {
                origin,
                direction: frame.to_world(local),
                from: triangle,
            }));
            arrivals(problem, &rays, &mut hits, |k, arrival| each(arrival, pixels[k].1 * share));
            start = end;
        }
    }
}

impl Way for Hemicube {
    fn row(&self, problem: &Problem, element: u32) -> Row {
        let mut seen = Vec::new();
        let mut back_face = 0.0;
        self.look(problem, element, 0..self.rays(), |arrival, share| match arrival {
            Arrival::Element { element, .. } => seen.push((element, share)),
            Arrival::BackFace => back_face += share,
            Arrival::Escaped => {}
        });
        Row { back_face, ..Row::collect(element, seen) }
    }

    fn most_entries(&self, elements: u64) -> u64 {
        elements.min(self.rays())
    }
}

/// Middle of a cell of the triangle with `corners`.
fn middle([a, b, c]: [Vec2; 3], cell: [Vec2; 3]) -> Vec2 {
    let uv = (cell[0] + cell[1] + cell[2]) / 3.0;
    a + uv.x * (b - a) + uv.y * (c - a)
}

/// Unit vectors through the middles of the pixels, and delta form factors: the top, then the four sides.
fn pixels(resolution: u16) -> Vec<(Vec3, f64)> {
    let n = i32::from(resolution);
    let at = |k: i32| 2.0 * f64::from(k) / f64::from(n) - 1.0;
    let mut pixels = Vec::new();
    let mut add = |face: &dyn Fn(f64, f64) -> DVec3, rows: Range<i32>| {
        for (v, u) in rows.flat_map(|v| (0..n).map(move |u| (v, u))) {
            let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(du, dv)| face(at(u + du), at(v + dv)));
            let direction = corners.iter().sum::<DVec3>().normalize().as_vec3().normalize();
            pixels.push((direction, point_to_polygon(DVec3::ZERO, DVec3::Z, &corners).abs()));
        }
    };
    add(&|u, v| DVec3::new(u, v, 1.0), 0..n);
    // Of the sides only the upper half is above the surface.
    for (cos, sin) in [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)] {
        add(&|u, v| DVec3::new(cos - sin * u, sin + cos * u, v), n / 2..n);
    }
    pixels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delta_form_factors_sum_to_one() {
        for resolution in [2, 16, 64] {
            let cube = Hemicube::new(&Settings { resolution, ..Settings::default() }).unwrap();
            assert_eq!(cube.rays(), 3 * u64::from(resolution).pow(2));
            assert!((cube.delta_form_factors().sum::<f64>() - 1.0).abs() < 1e-12);
            assert!(cube.delta_form_factors().all(|delta| delta > 0.0));
        }
    }

    #[test]
    fn a_pixel_in_the_middle_has_the_published_delta_form_factor() {
        // ΔA / (pi (x² + y² + 1)²), in the limit of small pixels.
        let cube = Hemicube::new(&Settings { resolution: 256, ..Settings::default() }).unwrap();
        let (direction, delta) = cube.pixels[128 * 256 + 128];
        let area = (2.0f64 / 256.0).powi(2);
        let published = area / std::f64::consts::PI * f64::from(direction.z).powi(4);
        assert!((delta / published - 1.0).abs() < 1e-4, "{delta} {published}");
    }

    #[test]
    fn odd_resolutions_are_refused() {
        let error = Hemicube::new(&Settings { resolution: 63, ..Settings::default() }).unwrap_err();
        assert!(error.to_string().contains("even number"));
    }
}
