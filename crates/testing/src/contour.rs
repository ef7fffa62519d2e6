//! Exact answers of convex rooms: form factors between elements that see all of each other, by the contour integrals of
//! [`isolux_core::form_factors::contour`], without its rays, and the dense system that follows.

use crate::ensemble::Exact;
use crate::exact::solve;
use isolux_core::Problem;
use isolux_core::form_factors::contour::exchange_area;
pub use isolux_core::form_factors::polygon::element_corners;
use isolux_core::math::Rgb;

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

/// The exact irradiances that the `N` elements of a convex room have straight from the lights, `F Be`.
///
/// # Panics
/// If the problem has another number of elements.
pub fn convex_room_direct<const N: usize>(problem: &Problem) -> Exact {
    assert_eq!(problem.mesh.len(), N, "the number of elements");
    let seen = |row: &[f64; N]| {
        let emission = |j: usize| problem.mesh.emission(j as u32).to_array();
        (0..N).fold([0.0; 3], |sum, j| std::array::from_fn(|c| sum[c] + row[j] * f64::from(emission(j)[c])))
    };
    form_factors::<N>(problem).iter().map(seen).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{parallel_rectangles, perpendicular_rectangles};
    use crate::scenes::problem;
    use glam::DVec3;

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
        let face = |e: u32| problem.object(e) as usize;
        let mut sums = [[0.0; 6]; 6];
        for (i, row) in halves.iter().enumerate() {
            row.iter().zip(0..).for_each(|(f, j)| sums[face(i as u32)][face(j)] += 0.5 * f);
        }
        for (found, exact) in sums.as_flattened().iter().zip(faces.as_flattened()) {
            assert!((found - exact).abs() < 1e-9, "{found} {exact}");
        }
    }
}
