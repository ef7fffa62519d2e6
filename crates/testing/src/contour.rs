//! Form factors between polygons that see all of each other, exactly, by the double contour integral
//!
//! ```text
//! F_12 = 1 / (2 pi A_1)  ∮ ∮  ln |x - y|  dx · dy        (Sparrow 1963)
//! ```
//!
//! over the borders of both, counter-clockwise seen from their fronts. The integral along an edge of the second is closed
//! (an elementary antiderivative), that along an edge of the first is by the double exponential rule (Takahasi & Mori 1974), which
//! bears the singularities where polygons share a corner or an edge.

use crate::ensemble::Exact;
use crate::exact::solve;
use glam::DVec3;
use isolux_core::Problem;
use isolux_core::math::Rgb;
use std::f64::consts::{FRAC_PI_2, TAU};

/// `A_1 F_12` [m²] of two plane polygons, nothing between them.
pub fn exchange_area(first: &[DVec3], second: &[DVec3]) -> f64 {
    let along = |(a, b): (DVec3, DVec3)| {
        let over_second = |x: DVec3| edges(second).map(|edge| (b - a).dot(log_distance(x, edge))).sum::<f64>();
        integrate(|s| over_second(a + (b - a) * s))
    };
    edges(first).map(along).sum::<f64>() / TAU
}

/// Corners [m] of an element of flat triangles.
pub fn element_corners(problem: &Problem, e: u32) -> [DVec3; 3] {
    let [a, b, c] = problem.scene.corners(problem.mesh.triangle(e)).map(|p| p.as_dvec3());
    problem.mesh.corners(e).map(|uv| a + (b - a) * f64::from(uv.x) + (c - a) * f64::from(uv.y))
}

/// The exact irradiances of the `N` elements of a convex room.
///
/// # Panics
/// If the problem has another number of elements.
pub fn convex_room_answer<const N: usize>(problem: &Problem) -> Exact {
    assert_eq!(problem.mesh.len(), N, "the number of elements");
    let factors = form_factors::<N>(problem);
    let channel = |c: usize| {
        let value = |color: Rgb| f64::from(color.to_array()[c]);
        let direct: [f64; N] =
            std::array::from_fn(|i| (0..N).map(|j| factors[i][j] * value(problem.mesh.emission(j as u32))).sum());
        // E = F (Be + rho E)
        let identity = |i, j| f64::from(u8::from(i == j));
        let entry = |i: usize, j: usize| identity(i, j) - factors[i][j] * value(problem.mesh.reflectivity(j as u32));
        solve(std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))), direct)
    };
    let channels = [0, 1, 2].map(channel);
    (0..N).map(|e| std::array::from_fn(|c| channels[c][e])).collect()
}

/// `F[i][j]` between the elements of a convex room.
pub fn form_factors<const N: usize>(problem: &Problem) -> Vec<[f64; N]> {
    let corners: Vec<_> = problem.mesh.elements().map(|e| element_corners(problem, e)).collect();
    let row = |i: usize| {
        let [a, b, c] = corners[i];
        let area = 0.5 * (b - a).cross(c - a).length();
        let factor = |j: usize| {
            let coplanar = problem.mesh.normal(i as u32) == problem.mesh.normal(j as u32);
            if coplanar { 0.0 } else { exchange_area(&corners[i], &corners[j]) / area }
        };
        std::array::from_fn(factor)
    };
    (0..N).map(row).collect()
}

fn edges(polygon: &[DVec3]) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
    (0..polygon.len()).map(|k| (polygon[k], polygon[(k + 1) % polygon.len()]))
}

/// `∫ ln |x - y| dy` along the edge from a to b.
fn log_distance(x: DVec3, (a, b): (DVec3, DVec3)) -> DVec3 {
    let (direction, length) = ((b - a).normalize(), (b - a).length());
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
fn integrate(f: impl Fn(f64) -> f64) -> f64 {
    const STEP: f64 = 1.0 / 16.0;
    let node = |k: i32| {
        let t = STEP * f64::from(k);
        let (inner, slope) = (FRAC_PI_2 * t.sinh(), FRAC_PI_2 * t.cosh());
        0.5 * slope / inner.cosh().powi(2) * f(1.0 / (1.0 + (-2.0 * inner).exp()))
    };
    STEP * (-56..=56).map(node).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{parallel_rectangles, perpendicular_rectangles};
    use crate::scenes::problem;

    fn polygon<const N: usize>(corners: [[f64; 3]; N]) -> [DVec3; N] {
        corners.map(DVec3::from)
    }

    #[test]
    fn rectangles_have_their_closed_form_factors() {
        let floor = polygon([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
        let above = polygon([[0.0, 0.0, 0.5], [0.0, 1.0, 0.5], [1.0, 1.0, 0.5], [1.0, 0.0, 0.5]]);
        let beside = polygon([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 2.0], [0.0, 0.0, 2.0]]);
        assert!((exchange_area(&floor, &above) - parallel_rectangles(1.0, 1.0, 0.5)).abs() < 1e-11);
        assert!((exchange_area(&floor, &beside) - perpendicular_rectangles(1.0, 1.0, 2.0)).abs() < 1e-11);
    }

    #[test]
    fn rows_of_a_box_cut_into_triangles_sum_to_one() {
        let problem = problem("box", 48);
        for (row, e) in form_factors::<48>(&problem).iter().zip(0..) {
            assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{}", row.iter().sum::<f64>());
            assert!(row.iter().all(|f| (0.0..1.0).contains(f)), "element {e}");
        }
    }

    #[test]
    fn halves_of_faces_add_up_to_faces() {
        let problem = problem("box", 12);
        let halves = form_factors::<12>(&problem);
        let faces = crate::exact::box_form_factors([4.0, 3.0, 5.0]);
        let face = |e: u32| problem.scene.triangles[problem.mesh.triangle(e) as usize].object as usize;
        let mut sums = [[0.0; 6]; 6];
        for (i, row) in halves.iter().enumerate() {
            row.iter().zip(0..).for_each(|(f, j)| sums[face(i as u32)][face(j)] += 0.5 * f);
        }
        for (found, exact) in sums.as_flattened().iter().zip(faces.as_flattened()) {
            assert!((found - exact).abs() < 1e-9, "{found} {exact}");
        }
    }
}
