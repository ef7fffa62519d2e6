//! Convex polygons in the plane, cut along the axes (Sutherland and Hodgman 1974): how much of a texel a triangle covers.

use glam::DVec2;

/// A triangle has three corners, and each of four cuts adds at most one.
const MOST_CORNERS: usize = 7;

/// A convex polygon.
#[derive(Clone, Copy)]
pub struct Polygon {
    corners: [DVec2; MOST_CORNERS],
    count: usize,
}

impl Polygon {
    const EMPTY: Polygon = Polygon { corners: [DVec2::ZERO; MOST_CORNERS], count: 0 };

    pub fn triangle(corners: [DVec2; 3]) -> Polygon {
        let mut polygon = Polygon::EMPTY;
        corners.into_iter().for_each(|corner| polygon.push(corner));
        polygon
    }

    /// The part with `low <= x <= high`, or y for `axis` 1. Infinite bounds do not cut.
    pub fn between(&self, axis: usize, low: f64, high: f64) -> Polygon {
        self.cut(axis, low, 1.0).cut(axis, high, -1.0)
    }

    /// The part where `side * (p[axis] - bound)` is not negative.
    fn cut(&self, axis: usize, bound: f64, side: f64) -> Polygon {
        let mut part = Polygon::EMPTY;
        for k in 0..self.count {
            let (a, b) = (self.corners[k], self.corners[(k + 1) % self.count]);
            let (height_a, height_b) = (side * (a[axis] - bound), side * (b[axis] - bound));
            if height_a >= 0.0 {
                part.push(a);
            }
            if (height_a < 0.0) != (height_b < 0.0) {
                part.push(a + (b - a) * (height_a / (height_a - height_b)));
            }
        }
        part
    }

    fn push(&mut self, corner: DVec2) {
        if let Some(free) = self.corners.get_mut(self.count) {
            *free = corner;
            self.count += 1;
        }
    }

    /// Area and centroid; zero and the first corner for an empty polygon.
    pub fn area_and_centroid(&self) -> (f64, DVec2) {
        let origin = self.corners[0];
        let (mut double_area, mut moment) = (0.0, DVec2::ZERO);
        for k in 2..self.count {
            let (a, b) = (self.corners[k - 1] - origin, self.corners[k] - origin);
            let part = a.perp_dot(b);
            double_area += part;
            moment += (a + b) * part;
        }
        let centroid = if double_area == 0.0 { origin } else { origin + moment / (3.0 * double_area) };
        (0.5 * double_area.abs(), centroid)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_cut_into_texels_keeps_area_and_moment() {
        let triangle = Polygon::triangle([DVec2::new(0.3, 0.1), DVec2::new(6.7, 2.2), DVec2::new(2.4, 5.9)]);
        let (mut area, mut moment) = (0.0, DVec2::ZERO);
        for (x, y) in (0..7).flat_map(|x| (0..7).map(move |y| (f64::from(x), f64::from(y)))) {
            let (part, centroid) = triangle.between(1, y, y + 1.0).between(0, x, x + 1.0).area_and_centroid();
            area += part;
            moment += centroid * part;
        }
        let (whole, centroid) = triangle.area_and_centroid();
        assert!((area - whole).abs() < 1e-12 && (moment - centroid * whole).length() < 1e-12);
        assert!((centroid - DVec2::new(9.4, 8.2) / 3.0).length() < 1e-12);
    }
}
