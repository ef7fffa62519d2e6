//! Exact answers: form factors in closed form and global illumination that follows from them.
//!
//! Form factors are in row convention, `F12` is the share of what leaves 1 that reaches 2. Formulas as catalogued by
//! Howell, A Catalog of Radiation Heat Transfer Configuration Factors (C-11, C-14, C-41).

use std::f64::consts::PI;

/// `F12` of unit squares one unit apart with a square blocker over the quarter [0, 0.5]² at half height.
pub const BLOCKED_SQUARES: f64 = 0.149_868_67;

/// `F12` of two equal, directly opposed rectangles of `a` x `b`, a distance `c` apart.
pub fn parallel_rectangles(a: f64, b: f64, c: f64) -> f64 {
    let (x, y) = (a / c, b / c);
    let (xr, yr) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    let logarithm = (xr * yr / (1.0 + x * x + y * y).sqrt()).ln();
    let angles = x * yr * (x / yr).atan() + y * xr * (y / xr).atan() - x * x.atan() - y * y.atan();
    2.0 / (PI * x * y) * (logarithm + angles)
}

/// `F12` of rectangles at right angles with a common edge of length `l`; the first is `w` wide, the second `h`.
pub fn perpendicular_rectangles(l: f64, w: f64, h: f64) -> f64 {
    let (w, h) = (w / l, h / l);
    let (w2, h2) = (w * w, h * h);
    let diagonal = (w2 + h2).sqrt();
    let all = 1.0 + w2 + h2;
    let angles = w * (1.0 / w).atan() + h * (1.0 / h).atan() - diagonal * (1.0 / diagonal).atan();
    let logarithm = ((1.0 + w2) * (1.0 + h2) / all).ln()
        + w2 * (w2 * all / ((1.0 + w2) * (w2 + h2))).ln()
        + h2 * (h2 * all / ((1.0 + h2) * (w2 + h2))).ln();
    (angles + 0.25 * logarithm) / (PI * w)
}

/// `F12` of parallel discs of radii `r1` and `r2` about a common axis, a distance `h` apart.
pub fn coaxial_discs(r1: f64, r2: f64, h: f64) -> f64 {
    let s = 1.0 + (h * h + r2 * r2) / (r1 * r1);
    0.5 * (s - (s * s - 4.0 * (r2 / r1).powi(2)).sqrt())
}

/// `F12` of two infinitely long plates of equal width that meet at `angle` [rad].
pub fn wedge(angle: f64) -> f64 {
    1.0 - (0.5 * angle).sin()
}

/// Form factors `F[i][j]` between the faces of a box, in the order left, right, floor, ceiling, back, front.
pub fn box_form_factors([width, height, depth]: [f64; 3]) -> [[f64; 6]; 6] {
    let size = [width, height, depth];
    let between = |i: usize, j: usize| {
        let (a, b) = (i / 2, j / 2);
        let other = |x: usize, y: usize| size[3 - x - y];
        match (i == j, a == b) {
            (true, _) => 0.0,
            (_, true) => parallel_rectangles(size[(a + 1) % 3], size[(a + 2) % 3], size[a]),
            // Faces perpendicular to a and b share an edge along the third axis; the first extends along b.
            _ => perpendicular_rectangles(other(a, b), size[b], size[a]),
        }
    };
    std::array::from_fn(|i| std::array::from_fn(|j| between(i, j)))
}

/// Radiosities `B = Be + rho F B` of a few patches.
pub fn radiosities<const N: usize>(emission: [f64; N], reflectivity: [f64; N], factors: &[[f64; N]; N]) -> [f64; N] {
    let entry = |i: usize, j: usize| f64::from(u8::from(i == j)) - reflectivity[i] * factors[i][j];
    solve(std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))), emission)
}

/// Radiosities of patches inside a sphere, where `F_ij = A_j / A`: `B_i = Be_i + rho_i mean(Be) / (1 - mean(rho))`, means
/// weighted by area. Patches are given as (area, reflectivity, emission).
pub fn sphere_radiosities(patches: &[(f64, f64, f64)]) -> Vec<f64> {
    let area: f64 = patches.iter().map(|(a, _, _)| a).sum();
    let mean_reflectivity = patches.iter().map(|(a, rho, _)| a * rho).sum::<f64>() / area;
    let mean_emission = patches.iter().map(|(a, _, emission)| a * emission).sum::<f64>() / area;
    let irradiance = mean_emission / (1.0 - mean_reflectivity);
    patches.iter().map(|(_, rho, emission)| emission + rho * irradiance).collect()
}

/// Solves the dense system `matrix x = right` by Gaussian elimination with partial pivoting.
///
/// # Panics
/// If the matrix is singular.
pub fn solve<const N: usize>(mut matrix: [[f64; N]; N], mut right: [f64; N]) -> [f64; N] {
    for k in 0..N {
        let pivot = (k..N).fold(k, |best, i| if matrix[i][k].abs() > matrix[best][k].abs() { i } else { best });
        assert!(matrix[pivot][k] != 0.0, "the matrix is singular");
        matrix.swap(k, pivot);
        right.swap(k, pivot);
        let (row, value) = (matrix[k], right[k]);
        for i in k + 1..N {
            let factor = matrix[i][k] / row[k];
            matrix[i].iter_mut().zip(row).for_each(|(entry, pivot)| *entry -= factor * pivot);
            right[i] -= factor * value;
        }
    }
    for k in (0..N).rev() {
        let known: f64 = (k + 1..N).map(|j| matrix[k][j] * right[j]).sum();
        right[k] = (right[k] - known) / matrix[k][k];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use isolux_core::form_factors::contour::point_to_polygon;
    use std::f64::consts::TAU;

    #[track_caller]
    fn assert_near(found: f64, exact: f64) {
        assert!((found - exact).abs() < 1e-9, "{found} instead of {exact}");
    }

    #[test]
    fn rectangles_have_their_published_form_factors() {
        assert_near(parallel_rectangles(1.0, 1.0, 1.0), 0.199_824_896);
        for (gap, exact) in [(0.1, 0.826_994_522), (0.5, 0.415_253_284), (2.0, 0.068_589_589), (10.0, 0.003_162_057)] {
            assert_near(parallel_rectangles(1.0, 1.0, gap), exact);
        }
        assert_near(parallel_rectangles(2.0, 1.0, 1.0), 0.285_875_385);
        assert_near(perpendicular_rectangles(1.0, 1.0, 1.0), 0.200_043_776);
        assert_near(perpendicular_rectangles(1.0, 1.0, 2.0), 0.232_852_603);
        assert_near(perpendicular_rectangles(1.0, 2.0, 1.0), 0.116_426_301);
    }

    #[test]
    fn round_and_endless_bodies_have_their_published_form_factors() {
        assert_near(coaxial_discs(1.0, 1.0, 1.0), 0.381_966_011);
        assert_near(coaxial_discs(1.0, 1.0, 2.0), 0.171_572_875);
        assert_near(wedge(PI / 6.0), 0.741_180_955);
        assert_near(wedge(PI / 2.0), 0.292_893_219);
        // A closed cylinder of radius 1 and height 2 by closure and reciprocity.
        let base_side = 1.0 - coaxial_discs(1.0, 1.0, 2.0);
        assert_near(base_side, 0.828_427_125);
        let side_base = base_side * PI / (2.0 * TAU);
        assert_near(side_base, 0.207_106_781);
        assert_near(1.0 - 2.0 * side_base, 0.585_786_438);
    }

    #[test]
    fn lambert_sees_the_square_above_its_corner() {
        let square = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]].map(|[x, y]| DVec3::new(x, y, 1.0));
        assert_near(point_to_polygon(DVec3::ZERO, DVec3::Z, &square), 0.138_531_606);
        // Integrated over the square below it, the form factor of the two squares.
        let n = 200;
        let middle = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
        let points = (0..n * n).map(|k| DVec3::new(middle(k % n), middle(k / n), 0.0));
        let mean = points.map(|p| point_to_polygon(p, DVec3::Z, &square)).sum::<f64>() / f64::from(n * n);
        assert!((mean - parallel_rectangles(1.0, 1.0, 1.0)).abs() < 1e-5, "{mean}");
    }

    #[test]
    fn rows_of_a_box_sum_to_one_and_are_reciprocal() {
        let size = [4.0, 3.0, 5.0];
        let factors = box_form_factors(size);
        let area = [15.0, 15.0, 20.0, 20.0, 12.0, 12.0];
        for i in 0..6 {
            assert_near(factors[i].iter().sum(), 1.0);
            (0..6).for_each(|j| assert_near(area[i] * factors[i][j], area[j] * factors[j][i]));
        }
    }

    #[test]
    fn a_furnace_is_solved_exactly_in_box_and_sphere() {
        let rho = [0.1, 0.9, 0.5, 0.3, 0.7, 0.2];
        let emission = rho.map(|r| 1.0 - r);
        radiosities(emission, rho, &box_form_factors([4.0, 3.0, 5.0])).into_iter().for_each(|b| assert_near(b, 1.0));
        let patches: Vec<_> = rho.iter().enumerate().map(|(k, r)| (k as f64 + 1.0, *r, 1.0 - r)).collect();
        sphere_radiosities(&patches).into_iter().for_each(|b| assert_near(b, 1.0));
    }
}
