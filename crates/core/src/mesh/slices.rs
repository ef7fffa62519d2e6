//! Needles are cut across before they are cut into elements.
//!
//! Regular subdivision keeps a triangle's shape: it would turn a needle into splinters as long as rooms, half of them behind
//! other surfaces. So a triangle much longer than its shortest edge is first cut into k *slices* parallel to that edge, of
//! equal height; the one at the tip is a triangle, every other is halved along a diagonal. These triangles are its *patches*.
//!
//! With the tip at the origin and one unit along each long edge for each slice, slice i lies between x + y = i and i + 1. Its
//! diagonal runs from (i, 0) to (0, i + 1); patch 2i lies beyond it, patch 2i - 1 before it.

use crate::math::whole::{number, smaller, whole};
use glam::{Vec2, Vec3};

/// How a triangle is cut into patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Slices {
    count: u16,
    /// Number of the corner at the tip.
    tip: u8,
}

impl Slices {
    /// The triangle as it is: one patch.
    pub const WHOLE: Slices = Slices { count: 1, tip: 0 };

    /// `count` slices parallel to the shortest edge of a triangle; the triangle as it is for zero or one.
    pub fn across(corners: [Vec3; 3], count: u16) -> Slices {
        if count <= 1 {
            return Slices::WHOLE;
        }
        let opposite = |k: usize| corners[(k + 1) % 3].distance_squared(corners[(k + 2) % 3]);
        let tip = (1..3).fold(0, |tip, k| if opposite(k) < opposite(tip) { k } else { tip });
        Slices { count, tip: tip as u8 }
    }

    /// Whether there is such a cut: what is read from a file may be anything.
    pub fn is_valid(self) -> bool {
        self.tip < 3 && self.count > 0
    }

    pub fn patch_count(self) -> u32 {
        2 * u32::from(self.count) - 1
    }

    /// Share of the triangle's area that `patch` has.
    pub fn area_share(self, patch: u32) -> f64 {
        f64::from(patch / 2 + 1) / f64::from(self.count).powi(2)
    }

    /// Barycentric coordinates on the triangle of the corners of `patch`, in the orientation of the triangle.
    pub fn corners(self, patch: u32) -> [Vec2; 3] {
        if self.count == 1 {
            return [Vec2::ZERO, Vec2::X, Vec2::Y];
        }
        let i = patch.div_ceil(2) as f32;
        let (near, far) = (Vec2::new(i, 0.0), Vec2::new(0.0, i + 1.0));
        let grid =
            if patch.is_multiple_of(2) { [near, Vec2::new(i + 1.0, 0.0), far] } else { [near, far, Vec2::new(0.0, i)] };
        grid.map(|p| self.on_triangle(p / f32::from(self.count)))
    }

    /// The patch at barycentric coordinates `uv` of the triangle, and the barycentric coordinates on it, in the order of
    /// its [`corners`](Slices::corners).
    #[inline]
    pub fn locate(self, uv: Vec2) -> (u32, Vec2) {
        if self.count == 1 {
            return (0, uv);
        }
        let [[x], [y]] = self.along_edges([uv.x], [uv.y]);
        self.patch_at(x, y)
    }

    /// As [`Slices::locate`], for what lies at (x, y) [`along the edges`](Slices::along_edges) of a needle.
    #[inline(always)]
    pub fn patch_at(self, x: f32, y: f32) -> (u32, Vec2) {
        let count = f32::from(self.count);
        let positive = |x: f32| if x > 0.0 { x } else { 0.0 };
        let (x, y) = (positive(x * count), positive(y * count));
        let below = smaller(whole(x + y), count - 1.0);
        let beyond = x * (below + 1.0) + y * below >= below * (below + 1.0);
        // Half the points lie beyond the diagonal, in no order: values are chosen, for a branch would be guessed wrong.
        let across = if beyond { y } else { x } / if beyond { below + 1.0 } else { below };
        let up = x + y - below;
        let within = [Vec2::new(up, 1.0 - across - up), Vec2::new(x - below * (1.0 - across), across)];
        let select = |coordinate: usize| if beyond { within[1][coordinate] } else { within[0][coordinate] };
        (2 * number(below) - u32::from(!beyond), Vec2::new(select(0), select(1)))
    }

    /// Coordinates along the two edges that leave the tip, of points of the triangle.
    #[inline(always)]
    pub fn along_edges<const N: usize>(self, u: [f32; N], v: [f32; N]) -> [[f32; N]; 2] {
        let first = std::array::from_fn(|k| 1.0 - u[k] - v[k]);
        match self.tip {
            0 => [u, v],
            1 => [v, first],
            _ => [first, u],
        }
    }

    /// Coordinates on the triangle of what lies at `p` along the two edges.
    fn on_triangle(self, p: Vec2) -> Vec2 {
        let at_tip = 1.0 - p.x - p.y;
        match self.tip {
            0 => p,
            1 => Vec2::new(at_tip, p.x),
            _ => Vec2::new(p.y, at_tip),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All ways to cut that differ, up to nine slices and one of many.
    fn cuts() -> impl Iterator<Item = Slices> {
        let counts = (2..10).chain([1000]);
        counts.flat_map(|count| (0..3).map(move |tip| Slices { count, tip })).chain([Slices::WHOLE])
    }

    fn double_area([a, b, c]: [Vec2; 3]) -> f32 {
        (b - a).perp_dot(c - a)
    }

    #[test]
    fn points_lead_to_the_patch_they_lie_on() {
        for slices in cuts() {
            for k in 0..2000 {
                let u = (k as f32 * 0.618_034).fract();
                let uv = Vec2::new(u, (k as f32 * 0.414_214).fract() * (1.0 - u));
                let (patch, within) = slices.locate(uv);
                let [a, b, c] = slices.corners(patch);
                assert!(patch < slices.patch_count());
                assert!(within.min_element() > -1e-3 && within.x + within.y < 1.001, "{slices:?} {uv} {within}");
                let back = a + within.x * (b - a) + within.y * (c - a);
                assert!(back.distance(uv) < 1e-5, "{slices:?}: {uv} in patch {patch} is {back}");
            }
        }
    }

    #[test]
    fn patches_have_their_share_of_the_area_in_the_triangles_orientation() {
        for slices in cuts() {
            for patch in 0..slices.patch_count() {
                let share = slices.area_share(patch) as f32;
                let area = double_area(slices.corners(patch));
                assert!((area - share).abs() < 1e-6, "{slices:?} {patch}: {area} is not {share}");
            }
            let all: f64 = (0..slices.patch_count()).map(|patch| slices.area_share(patch)).sum();
            assert!((all - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn points_on_and_beyond_the_border_have_a_patch() {
        for slices in cuts() {
            for uv in [Vec2::X, Vec2::Y, Vec2::ZERO, Vec2::splat(0.5), Vec2::new(-1e-3, 1.001), Vec2::splat(0.501)] {
                assert!(slices.locate(uv).0 < slices.patch_count(), "{slices:?} {uv}");
            }
        }
    }

    #[test]
    fn the_tip_lies_opposite_the_shortest_edge() {
        let [a, b, c] = [Vec3::ZERO, Vec3::new(9.0, 1.0, 0.0), Vec3::new(9.0, 0.0, 0.0)];
        for (tip, corners) in [[a, b, c], [c, a, b], [b, c, a]].into_iter().enumerate() {
            assert_eq!(Slices::across(corners, 5), Slices { count: 5, tip: tip as u8 });
        }
        assert_eq!(Slices::across([a, b, c], 1), Slices::WHOLE);
    }
}
