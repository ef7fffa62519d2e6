//! A triangle as an eye sees it: its solid angle, and directions distributed uniformly over it.
//!
//! With unit vectors a, b, c to the corners, `tan(omega / 2) = |a · (b × c)| / (1 + a·b + b·c + c·a)` (Van Oosterom & Strackee,
//! The Solid Angle of a Plane Triangle, 1983). Directions come from two numbers by an area-preserving map (Arvo, Stratified
//! Sampling of Spherical Triangles, SIGGRAPH 1995): the first cuts off a triangle of the same corner a and side through b with
//! that share of the area, the second chooses a point on the cut. Double precision: lamps far away are small.

use glam::{DVec3, Vec2, Vec3};

/// The front of a triangle, seen from a point.
#[derive(Clone, Copy, Debug)]
pub struct SphericalTriangle {
    /// Unit vectors to the corners.
    a: DVec3,
    b: DVec3,
    c: DVec3,
    /// Unit vector at right angles to a, in the plane of a and c.
    towards_c: DVec3,
    /// Sine and cosine of the angle at a.
    sin_angle: f64,
    cos_angle: f64,
    solid_angle: f64,
}

impl SphericalTriangle {
    /// What `eye` sees of a triangle with these `corners` [m]; `None` if it sees its back, or its edge.
    pub fn new(corners: [Vec3; 3], eye: Vec3) -> Option<SphericalTriangle> {
        let eye = eye.as_dvec3();
        let [p, q, r] = corners.map(|corner| corner.as_dvec3() - eye);
        // Edges, not corners: the products of three nearly equal vectors would lose all digits of a small triangle.
        let volume = -p.dot((q - p).cross(r - p));
        let lengths = p.length() * q.length() * r.length();
        if volume <= 0.0 || lengths <= 0.0 {
            return None;
        }
        let [a, b, c] = [p, q, r].map(|v| v.normalize_or_zero());
        let determinant = volume / lengths;
        let solid_angle = 2.0 * determinant.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        let (on_b, on_c) = (a.cross(b), a.cross(c));
        let product = on_b.length() * on_c.length();
        let towards_c = (c - a * a.dot(c)).normalize_or_zero();
        let (sin_angle, cos_angle) = (determinant / product, on_b.dot(on_c) / product);
        (sin_angle > 0.0 && solid_angle > 0.0).then_some(SphericalTriangle {
            a,
            b,
            c,
            towards_c,
            sin_angle,
            cos_angle,
            solid_angle,
        })
    }

    /// Solid angle [sr].
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// Solid angle weighted by the cosine to the unit vector `normal`, below its plane with negative sign [sr]: `pi` times the form
    /// factor to a triangle above the plane (Lambert 1760).
    pub fn projected(&self, normal: Vec3) -> f64 {
        let normal = normal.as_dvec3();
        let edge = |from: DVec3, to: DVec3| {
            let across = to.cross(from);
            across.length().atan2(from.dot(to)) * normal.dot(across.normalize_or_zero())
        };
        0.5 * (edge(self.a, self.b) + edge(self.b, self.c) + edge(self.c, self.a))
    }

    /// The unit vector to the point that belongs to `s` in the unit square.
    pub fn direction(&self, s: Vec2) -> Vec3 {
        let (sin_area, cos_area) = (f64::from(s.x) * self.solid_angle).sin_cos();
        let (sin, cos) = (self.sin_angle, self.cos_angle);
        // Sine and cosine of the area less the angle at a, as in the paper.
        let (sin_rest, cos_rest) = (sin_area * cos - cos_area * sin, cos_area * cos + sin_area * sin);
        let u = cos_rest - cos;
        let v = sin_rest + sin * self.a.dot(self.b);
        let q = ((v * cos_rest - u * sin_rest) * cos - v) / ((v * sin_rest + u * cos_rest) * sin);
        let q = if q.is_finite() { q.clamp(-1.0, 1.0) } else { 1.0 };
        let cut = self.a * q + self.towards_c * (1.0 - q * q).sqrt();
        let z = 1.0 - f64::from(s.y) * (1.0 - cut.dot(self.b));
        let away = (cut - self.b * cut.dot(self.b)).normalize_or_zero();
        (self.b * z + away * (1.0 - z * z).max(0.0).sqrt()).as_vec3().normalize_or(self.a.as_vec3())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    const OCTANT: [Vec3; 3] = [Vec3::X, Vec3::Z, Vec3::Y];
    const EYE: Vec3 = Vec3::new(0.3, -0.2, 0.5);

    fn grid(n: u32) -> impl Iterator<Item = Vec2> {
        (0..n * n).map(move |k| Vec2::new((k % n) as f32 + 0.5, (k / n) as f32 + 0.5) / n as f32)
    }

    fn mean(triangle: &SphericalTriangle, f: impl Fn(Vec3) -> f64) -> f64 {
        grid(200).map(|s| f(triangle.direction(s))).sum::<f64>() / 40_000.0
    }

    #[test]
    fn an_octant_is_an_eighth_of_the_sphere_and_its_back_is_nothing() {
        let seen = SphericalTriangle::new(OCTANT, Vec3::ZERO).unwrap();
        assert!((seen.solid_angle() - FRAC_PI_2).abs() < 1e-12);
        // The octant projects to a quarter of the unit disc.
        assert!((seen.projected(Vec3::Z) - 0.5 * FRAC_PI_2).abs() < 1e-12);
        assert!((seen.projected(Vec3::NEG_X) + 0.5 * FRAC_PI_2).abs() < 1e-12);
        let [a, b, c] = OCTANT;
        assert!(SphericalTriangle::new([a, c, b], Vec3::ZERO).is_none());
        assert!(SphericalTriangle::new(OCTANT, Vec3::splat(1.0 / 3.0)).is_none());
    }

    /// Over an octant the mean of x y is 2 / (3 pi), that of z² a third, that of z a half.
    #[test]
    fn directions_have_the_moments_of_the_uniform_octant() {
        let octant = SphericalTriangle::new(OCTANT, Vec3::ZERO).unwrap();
        assert!((mean(&octant, |d| f64::from(d.z)) - 0.5).abs() < 1e-4);
        assert!((mean(&octant, |d| f64::from(d.z).powi(2)) - 1.0 / 3.0).abs() < 1e-4);
        assert!((mean(&octant, |d| f64::from(d.x * d.y)) - 2.0 / (3.0 * PI)).abs() < 1e-4);
    }

    /// However far or flat: the mean of uniform directions along an axis is the projected solid angle over the solid angle.
    #[test]
    fn directions_are_uniform_in_solid_angle() {
        for (size, distance) in [(1.0, 0.01), (1.0, 1.0), (0.01, 3.0), (0.001, 30.0)] {
            let tilted = [[0.0, 0.0, 0.0], [1.0, 0.1, -0.2], [0.2, 1.0, 0.0]].map(Vec3::from);
            let corners = tilted.map(|p| EYE - Vec3::Z * distance + p * size);
            let seen = SphericalTriangle::new(corners, EYE).unwrap();
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                let exact = seen.projected(axis) / seen.solid_angle();
                let found = mean(&seen, |d| f64::from(d.dot(axis)));
                assert!((found - exact).abs() < 1e-4 * f64::from(size) + 3e-7, "{size} {distance}: {found} {exact}");
            }
            let [p, q, r] = corners.map(|corner| (corner - EYE).as_dvec3());
            for s in grid(20) {
                let d = seen.direction(s).as_dvec3();
                let inside = [(p, q), (q, r), (r, p)].iter().all(|(a, b)| a.cross(*b).normalize().dot(d) < 1e-6);
                assert!(inside, "{size} {distance}: {d}");
            }
        }
    }
}
