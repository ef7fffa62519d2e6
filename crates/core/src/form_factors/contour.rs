//! Form factors by contour integrals: exact between polygons that see all of each other.
//!
//! ```text
//! F_12 = 1 / (2 pi A_1)  ∮ ∮  ln |x - y|  dx · dy                (Sparrow 1963)
//! F(x, 2) = 1 / (2 pi)  Σ_k gamma_k (n · g_k)                    (Lambert 1760; Baum, Rushmeier & Winget 1989)
//! ```
//!
//! The first is the second, integrated over element 1 by Stokes' theorem: over the borders of both, counter-clockwise seen
//! from their fronts. The integral along an edge of 2 is closed. That along an edge of 1 is by Gauss and Legendre's rule if
//! the elements are apart, and else by the double exponential rule (Takahasi & Mori 1974), which bears the singularities of
//! shared corners and edges. Parts behind the other's plane are clipped off. Where something blocks, the exact value is
//! multiplied by the share of it that gets through (see [`super::visibility`]): that part is a deterministic estimate with a
//! bias.
//!
//! Only flat elements. Light that meets the back of a one-sided surface is lost, and not told apart from light that escapes.
//! Cost: n² / 2 pairs, 5 µs each, and 16 rays for each; many more rays where the view is partly blocked.

use super::polygon::{Plane, centroid, clip, element_corners};
use super::visibility::Visibility;
use super::{Row, Settings, Way};
use crate::scene::Shape;
use crate::{Error, Problem};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

/// All elements as polygons.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Contour {
    elements: Vec<Flat>,
    /// Heights [m] above a plane that are nothing but rounding.
    tolerance: f64,
    visibility: Visibility,
}

#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
struct Flat {
    corners: [DVec3; 3],
    plane: Plane,
    area: f64,
    centroid: DVec3,
    radius: f64,
}

impl Contour {
    /// # Errors
    /// [`Error::Parameter`] for curved surfaces, or without divisions for the visibility.
    pub fn new(problem: &Problem, settings: &Settings) -> Result<Contour, Error> {
        if problem.scene.shape != Shape::Triangles {
            let allowed = "contour integrals need flat elements; use hemicube or local-lines for a sphere";
            return Err(Error::Parameter { name: "form factors", value: "contour".to_owned(), allowed });
        }
        let visibility = Visibility::new(settings.visibility)?;
        let flat = |e: u32| {
            let corners = element_corners(problem, e);
            let centroid = centroid(corners);
            Flat {
                corners,
                plane: Plane::through(centroid, problem.mesh.normal(e).as_dvec3()),
                area: f64::from(problem.mesh.area(e)),
                centroid,
                radius: corners.iter().map(|c| c.distance(centroid)).fold(0.0, f64::max),
            }
        };
        let tolerance = f64::from(problem.geometry.lift());
        Ok(Contour { elements: problem.mesh.elements().map(flat).collect(), tolerance, visibility })
    }

    /// `A_i F_ij` [m²] between two elements.
    pub fn exchange(&self, problem: &Problem, i: u32, j: u32) -> f64 {
        let (a, b) = (&self.elements[i as usize], &self.elements[j as usize]);
        let first = clip(&a.corners, b.plane, self.tolerance);
        let second = clip(&b.corners, a.plane, self.tolerance);
        if first.is_empty() || second.is_empty() {
            return 0.0;
        }
        let triangles = [problem.mesh.triangle(i), problem.mesh.triangle(j)];
        let share = self.visibility.share(problem, triangles, [a.corners, b.corners], [a.plane, b.plane]);
        if share <= 0.0 {
            return 0.0;
        }
        let apart = a.centroid.distance(b.centroid) > 2.0 * (a.radius + b.radius);
        let unblocked = if apart { exchange_area_apart(&first, &second) } else { exchange_area(&first, &second) };
        share * unblocked.max(0.0)
    }
}

impl Way for Contour {
    fn row(&self, problem: &Problem, element: u32) -> Row {
        let area = self.elements[element as usize].area;
        let factor = |j: u32| (j, self.exchange(problem, element, j) / area);
        let others = element + 1..self.elements.len() as u32;
        Row { element, entries: others.map(factor).filter(|(_, f)| *f > 0.0).collect(), ..Row::default() }
    }

    fn most_entries(&self, elements: u64) -> u64 {
        elements
    }

    fn is_upper_half(&self) -> bool {
        true
    }
}

/// `A_1 F_12` [m²] of two plane polygons, nothing between them, to about eleven digits; they may touch.
pub fn exchange_area(first: &[DVec3], second: &[DVec3]) -> f64 {
    double_contour(&cut_at_feet(first, second), second, double_exponential)
}

/// As [`exchange_area`], faster, for polygons that are further apart than they are large.
pub fn exchange_area_apart(first: &[DVec3], second: &[DVec3]) -> f64 {
    double_contour(first, second, gauss_legendre)
}

/// Form factor from a small patch at `point` with unit `normal` to a polygon that lies in front of it (Lambert). Positive if
/// the patch sees the polygon counter-clockwise.
pub fn point_to_polygon(point: DVec3, normal: DVec3, corners: &[DVec3]) -> f64 {
    let edge = |k: usize| {
        let (a, b) = (corners[k] - point, corners[(k + 1) % corners.len()] - point);
        let cross = a.cross(b);
        cross.length().atan2(a.dot(b)) * normal.dot(cross.normalize_or_zero())
    };
    (0..corners.len()).map(edge).sum::<f64>() / -TAU
}

fn double_contour(first: &[DVec3], second: &[DVec3], integrate: fn(&dyn Fn(f64) -> f64) -> f64) -> f64 {
    let along = |(a, b): (DVec3, DVec3)| {
        let over_second = |x: DVec3| edges(second).map(|edge| (b - a).dot(log_distance(x, edge))).sum::<f64>();
        integrate(&|s| over_second(a + (b - a) * s))
    };
    edges(first).map(along).sum::<f64>() / TAU
}

/// `polygon` with more corners: at the feet, on its edges, of corners of `other` that are near. There the inner integral has
/// a kink where edges overlap in part, and the rule bears it at the ends only.
fn cut_at_feet(polygon: &[DVec3], other: &[DVec3]) -> Vec<DVec3> {
    const NEAR: f64 = 0.1;
    let mut cut = Vec::new();
    for (a, b) in edges(polygon) {
        let (edge, squared) = (b - a, (b - a).length_squared());
        let foot = |c: &DVec3| {
            let along = (*c - a).dot(edge) / squared;
            let near = (a + edge * along).distance_squared(*c) < NEAR * NEAR * squared;
            (near && (1e-6..1.0 - 1e-6).contains(&along)).then_some(along)
        };
        let mut feet: Vec<f64> = other.iter().filter_map(foot).collect();
        feet.sort_by(f64::total_cmp);
        cut.push(a);
        cut.extend(feet.into_iter().map(|along| a + edge * along));
    }
    cut
}

/// Edges of a polygon that have a length.
fn edges(polygon: &[DVec3]) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
    let edge = |k: usize| (polygon[k], polygon[(k + 1) % polygon.len()]);
    (0..polygon.len()).map(edge).filter(|(a, b)| a != b)
}

/// `∫ ln |x - y| dy` along the edge from a to b.
fn log_distance(x: DVec3, (a, b): (DVec3, DVec3)) -> DVec3 {
    let length = (b - a).length();
    let direction = (b - a) / length;
    let along = (x - a).dot(direction);
    let height = (x - a - direction * along).length();
    let antiderivative = |t: f64| {
        let squared = t * t + height * height;
        let angle = if height > 0.0 { height * (t / height).atan() } else { 0.0 };
        if squared > 0.0 { 0.5 * t * squared.ln() - t + angle } else { 0.0 }
    };
    direction * (antiderivative(length - along) - antiderivative(-along))
}

/// The integral of `f` over [0, 1]; singularities at the ends are allowed.
fn double_exponential(f: &dyn Fn(f64) -> f64) -> f64 {
    const STEP: f64 = 1.0 / 16.0;
    let node = |k: i32| {
        let t = STEP * f64::from(k);
        let (inner, slope) = (FRAC_PI_2 * t.sinh(), FRAC_PI_2 * t.cosh());
        0.5 * slope / inner.cosh().powi(2) * f(1.0 / (1.0 + (-2.0 * inner).exp()))
    };
    STEP * (-56..=56).map(node).sum::<f64>()
}

/// The integral of a smooth `f` over [0, 1] by eight points.
fn gauss_legendre(f: &dyn Fn(f64) -> f64) -> f64 {
    const NODES: [(f64, f64); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
        (0.960_289_856_497_536_2, 0.101_228_536_290_376_3),
    ];
    NODES.iter().map(|(x, w)| 0.5 * w * (f(0.5 - 0.5 * x) + f(0.5 + 0.5 * x))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_rules_agree_on_polygons_that_are_apart() {
        let first = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(DVec3::from);
        let second = [[0.3, 0.2, 3.0], [0.1, 1.0, 3.5], [1.2, 0.4, 3.2]].map(DVec3::from);
        let (exact, fast) = (exchange_area(&first, &second), exchange_area_apart(&first, &second));
        assert!(exact > 0.001 && (fast / exact - 1.0).abs() < 1e-9, "{fast} {exact}");
        // Reciprocity: the same integral the other way round.
        assert!((exchange_area(&second, &first) / exact - 1.0).abs() < 1e-10);
    }

    #[test]
    fn edges_that_overlap_in_part_are_no_trouble() {
        // Two strips of a floor and three of a wall, with one edge in common: the parts make up the whole.
        let floor =
            |x: f64, w: f64| [[x, 0.0, 0.0], [x + w, 0.0, 0.0], [x + w, 1.0, 0.0], [x, 1.0, 0.0]].map(DVec3::from);
        let wall =
            |x: f64, w: f64| [[x, 0.0, 0.0], [x, 0.0, 1.0], [x + w, 0.0, 1.0], [x + w, 0.0, 0.0]].map(DVec3::from);
        let whole = exchange_area(&floor(0.0, 1.0), &wall(0.0, 1.0));
        let third = |k: u32| wall(f64::from(k) / 3.0, 1.0 / 3.0);
        let parts = (0..2).flat_map(|i| (0..3).map(move |j| exchange_area(&floor(0.5 * f64::from(i), 0.5), &third(j))));
        assert!((parts.sum::<f64>() / whole - 1.0).abs() < 1e-9);
        assert!((whole - 0.200_043_776).abs() < 1e-9);
    }

    #[test]
    fn lambert_sees_the_square_above_its_corner() {
        let square = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]].map(|[x, y]| DVec3::new(x, y, 1.0));
        assert!((point_to_polygon(DVec3::ZERO, DVec3::Z, &square) - 0.138_531_606).abs() < 1e-9);
    }
}
