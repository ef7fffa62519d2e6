//! Where elements are, what is known of each, and in what colour to show it: what all element-wise formats share.

use glam::Vec3;
use isolux_core::math::Rgb;
use isolux_core::mesh::Place;
use isolux_core::view::smooth::SMOOTHED;
use isolux_core::{Problem, Solution};

/// Something known of every element, in three channels.
pub struct Quantity {
    pub name: &'static str,
    /// As it is called in a viewer.
    pub title: &'static str,
    /// Empty if it has none.
    pub unit: &'static str,
    pub of: fn(&Problem, &Solution, u32) -> Rgb,
}

impl Quantity {
    /// The values of all elements.
    pub fn values(&self, problem: &Problem, solution: &Solution) -> impl Iterator<Item = Rgb> {
        problem.mesh.elements().map(|e| (self.of)(problem, solution, e))
    }
}

pub const REFLECTIVITY: Quantity = Quantity {
    name: "reflectivity",
    title: "Reflectivity",
    unit: "",
    of: |problem, _, e| problem.mesh.reflectivity(e),
};
pub const EMISSION: Quantity =
    Quantity { name: "emission", title: "Emission", unit: "lm/m²", of: |problem, _, e| problem.mesh.emission(e) };
pub const IRRADIANCE: Quantity = Quantity {
    name: "irradiance",
    title: "Irradiance",
    unit: "lux",
    of: |_, solution, e| solution.irradiance[e as usize],
};
/// NaN where it is not known.
pub const STD_ERROR: Quantity = Quantity {
    name: "std_error",
    title: "StandardError",
    unit: "lux",
    of: |_, solution, e| solution.std_error[e as usize],
};
pub const RADIOSITY: Quantity = Quantity {
    name: "radiosity",
    title: "Radiosity",
    unit: "lm/m²",
    of: |problem, solution, e| solution.radiosity(problem, e),
};

/// The triangles that show all elements, each with the number of its element: one an element, and several for a cluster.
pub fn pieces(problem: &Problem) -> impl Iterator<Item = (u32, Place)> + Clone {
    problem.mesh.elements().flat_map(|e| problem.mesh.pieces(e).map(move |place| (e, place)))
}

/// World positions [m] of the corners of a piece on the true surface, counter-clockwise seen from the side it is on.
pub fn corners(problem: &Problem, place: Place) -> [Vec3; 3] {
    let [a, b, c] = problem.mesh.corners_at(place).map(|uv| problem.geometry.surface(place.triangle, uv).0);
    if place.back { [a, c, b] } else { [a, b, c] }
}

/// For comments: `, smoothed within the error bars`, if the noise was taken out of the numbers.
pub fn smoothed_in_words(solution: &Solution) -> String {
    let how = solution.provenance.parameter(SMOOTHED);
    how.map_or_else(String::new, |how| format!(", {SMOOTHED} {how}"))
}

/// sRGB colours of all elements for showing: the radiosity over a white point, clamped. The white point is the 99th
/// percentile, by area, of the luminance of the *reflected* radiosity, so lamps do not darken the rest.
pub fn display_colors(problem: &Problem, solution: &Solution) -> Vec<[u8; 3]> {
    let mesh = &problem.mesh;
    let reflected = |e: u32| (mesh.reflectivity(e) * solution.irradiance[e as usize]).luminance();
    let mut by_luminance: Vec<(f32, f32)> = mesh.elements().map(|e| (reflected(e), mesh.area(e))).collect();
    by_luminance.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut below = 0.99 * mesh.total_area();
    let white_point = by_luminance.iter().find(|(_, area)| {
        below -= f64::from(*area);
        below <= 0.0
    });
    let white = white_point.or(by_luminance.last()).map_or(1.0, |(luminance, _)| *luminance);
    let white = if white > 0.0 { white } else { 1.0 };
    mesh.elements().map(|e| (solution.radiosity(problem, e) / white).to_srgb8()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use glam::Vec2;

    #[test]
    fn corners_run_counter_clockwise_round_the_normal_of_each_side() {
        let (problem, _) = fixture::lit_box();
        for e in problem.mesh.elements() {
            let [a, b, c] = corners(&problem, problem.mesh.place(e));
            let cross = (b - a).cross(c - a);
            let (position, normal) = problem.centre(e);
            assert!(cross.normalize().distance(normal) < 1e-5, "element {e}");
            assert!((0.5 * cross.length() - problem.mesh.area(e)).abs() < 1e-5, "element {e}");
            assert!(((a + b + c) / 3.0).distance(position) < 1e-5, "element {e}");
        }
    }

    #[test]
    fn the_middle_of_a_cluster_is_that_of_its_points() {
        let (problem, _) = fixture::lit_ball();
        for e in problem.mesh.elements() {
            let square = |k: u32| Vec2::new((k % 50) as f32 + 0.5, (k / 50) as f32 + 0.5) / 50.0;
            let points = (0..2500).map(|k| problem.mesh.point(e, square(k)));
            let mean = points.map(|(t, uv)| problem.geometry.surface(t, uv).0).sum::<Vec3>() / 2500.0;
            let (position, normal) = problem.centre(e);
            let side = if problem.mesh.place(e).back { -1.0 } else { 1.0 };
            assert!(mean.distance(position) < 0.01, "{mean} {position}");
            assert!(normal.distance(side * (position - Vec3::ONE).normalize()) < 0.05, "{normal}");
        }
    }

    #[test]
    fn colours_go_from_black_to_white() {
        let (problem, mut solution) = fixture::lit_box();
        solution.irradiance.fill(Rgb::WHITE);
        let colors = display_colors(&problem, &solution);
        assert!(colors.contains(&[255; 3]) && colors.iter().any(|c| c != &[255; 3]));
        solution.irradiance.fill(Rgb::BLACK);
        let reflects_only = |e: usize| problem.mesh.emission(e as u32).is_black();
        assert!(display_colors(&problem, &solution).iter().enumerate().all(|(e, c)| !reflects_only(e) || c == &[0; 3]));
    }
}
