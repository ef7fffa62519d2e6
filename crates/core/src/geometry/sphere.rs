//! The inside of an exact sphere: the geometry whose form factors `F_ij = A_j / A` are known for every mesh.
//!
//! Its eight "triangles" are the faces of an octahedron (see [`octahedron`]), each carried to its octant of the sphere by the
//! equal-area map of Clarberg (Fast equal-area mapping of the (hemi)sphere using SIMD, 2008). With the face's first corner as
//! pole and barycentric coordinates (u, v),
//!
//! ```text
//! r = u + v,   phi = (pi/2) v / r,   height over the equator  1 - r²,   distance from the axis  r sqrt(2 - r²)
//! ```
//!
//! so equal areas of the face become equal areas of the sphere: its regular cells are elements of one size, and a uniform
//! point of a cell is uniform on its patch. Shared edges map to the same great circles, so the patches join without gaps.

use super::{Geometry, Hit, HitLists, NONE, Ray};
use crate::scene::octahedron;
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::FRAC_PI_2;

/// A sphere seen from inside. Positions are computed in double precision.
#[derive(Clone, Debug)]
pub struct Sphere {
    center: DVec3,
    radius: f64,
    faces: [[DVec3; 3]; 8],
}

impl Sphere {
    /// A sphere of `radius` [m] about `center`.
    pub fn new(center: Vec3, radius: f32) -> Sphere {
        let faces = octahedron().map(|face| face.map(|corner| corner.as_dvec3()));
        Sphere { center: center.as_dvec3(), radius: f64::from(radius), faces }
    }

    /// Unit vector from the centre to the point `uv` of a face.
    fn outward(&self, face: u32, uv: Vec2) -> DVec3 {
        let [pole, east, north] = self.faces[face as usize];
        let (u, v) = (f64::from(uv.x).max(0.0), f64::from(uv.y).max(0.0));
        let r = (u + v).min(1.0);
        let (sin, cos) = (FRAC_PI_2 * v / (u + v).max(f64::MIN_POSITIVE)).sin_cos();
        let from_axis = r * (2.0 - r * r).sqrt();
        pole * (1.0 - r * r) + (east * cos + north * sin) * from_axis
    }

    /// Face and barycentric coordinates of the point in direction `outward` from the centre: the inverse of the map.
    fn inverse(&self, outward: DVec3) -> (u32, Vec2) {
        let face = u32::from(outward.x < 0.0) | u32::from(outward.y < 0.0) << 1 | u32::from(outward.z < 0.0) << 2;
        let [height, x, y] = self.faces[face as usize].map(|axis| axis.dot(outward));
        // 1 - height, written so that nothing cancels at the pole.
        let r = ((x * x + y * y) / (1.0 + height)).sqrt().min(1.0);
        let v = r * y.atan2(x) / FRAC_PI_2;
        (face, Vec2::new((r - v) as f32, v as f32))
    }

    /// Where the ray enters the sphere, if it comes from outside, and where it leaves it. A ray that starts inside, or leaves
    /// the surface, ends at the far root of `|o + t d|² = R²`, which is never its own origin; one that comes from outside
    /// hits the back first.
    fn hits(&self, ray: &Ray) -> [Option<Hit>; 2] {
        let origin = ray.origin.as_dvec3() - self.center;
        let direction = ray.direction.as_dvec3().normalize_or_zero();
        let b = origin.dot(direction);
        let nearest = origin - direction * b;
        let half_chord_squared = self.radius * self.radius - nearest.length_squared();
        let outside = ray.from == NONE && origin.length() > self.radius + f64::from(self.lift());
        let half_chord = half_chord_squared.max(0.0).sqrt();
        if outside && (half_chord_squared < 0.0 || -b - half_chord < 0.0) {
            return [None; 2];
        }
        let at = |t: f64, back| {
            let (triangle, uv) = self.inverse((origin + direction * t).normalize_or(DVec3::X));
            Hit { t: t.max(0.0) as f32, triangle, uv, back }
        };
        [outside.then(|| at(-b - half_chord, true)), Some(at(-b + half_chord, false))]
    }

    fn first(&self, ray: &Ray) -> Hit {
        self.hits(ray).into_iter().flatten().next().unwrap_or(Hit::MISS)
    }
}

impl Geometry for Sphere {
    fn closest(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.first(ray);
        }
    }

    fn all(&self, rays: &[Ray], lists: &mut HitLists) {
        lists.clear();
        for ray in rays {
            self.hits(ray).into_iter().flatten().for_each(|hit| lists.push(hit));
            lists.finish();
        }
    }

    fn any(&self, rays: &[Ray], reach: &[f32], blocked: &mut [bool]) {
        for ((ray, reach), blocked) in rays.iter().zip(reach).zip(blocked) {
            *blocked = self.first(ray).t < *reach;
        }
    }

    fn surface(&self, triangle: u32, uv: Vec2) -> (Vec3, Vec3) {
        let outward = self.outward(triangle, uv);
        ((self.center + outward * self.radius).as_vec3(), -outward.as_vec3())
    }

    fn lift(&self) -> f32 {
        8.0 * f32::EPSILON * (self.center.abs().max_element() + self.radius) as f32
    }

    fn bounding_sphere(&self) -> (Vec3, f32) {
        (self.center.as_vec3(), (self.radius * (1.0 + 1e-6)) as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::warp::square_to_triangle;
    use crate::mesh::cells;

    const CENTER: Vec3 = Vec3::new(1.0, -2.0, 3.0);

    /// Barycentric midpoints of an n x n grid on a face.
    fn points(n: u32) -> impl Iterator<Item = Vec2> {
        let middle = move |k: u32| (k as f32 + 0.5) / n as f32;
        (0..n * n).map(move |k| square_to_triangle(Vec2::new(middle(k % n), middle(k / n))))
    }

    #[test]
    fn map_and_inverse_agree() {
        let sphere = Sphere::new(CENTER, 2.0);
        let corners = [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::new(1e-6, 1e-7)];
        for face in 0..8 {
            for uv in points(30) {
                let (back_face, back_uv) = sphere.inverse(sphere.outward(face, uv));
                assert_eq!(back_face, face);
                assert!((back_uv - uv).length() < 1e-6, "{uv} {back_uv}");
            }
            for uv in corners {
                let outward = sphere.outward(face, uv);
                let (back_face, back_uv) = sphere.inverse(outward);
                assert!((sphere.outward(back_face, back_uv) - outward).length() < 1e-7);
            }
        }
    }

    /// The map's Jacobian, by differences, is that of equal areas everywhere: (4 pi / 8) over the face's area 1/2.
    #[test]
    fn equal_areas_stay_equal() {
        let sphere = Sphere::new(Vec3::ZERO, 1.0);
        let h = 1.0 / 1024.0;
        for uv in points(40).filter(|uv| uv.x > 2.0 * h && uv.y > 2.0 * h && uv.x + uv.y < 1.0 - 2.0 * h) {
            let along = |d: Vec2| (sphere.outward(3, uv + d) - sphere.outward(3, uv - d)) / f64::from(2.0 * h);
            let jacobian = along(Vec2::X * h).cross(along(Vec2::Y * h)).length();
            assert!((jacobian / std::f64::consts::PI - 1.0).abs() < 2e-3, "{uv}: {jacobian}");
        }
    }

    #[test]
    fn surface_points_lie_on_the_sphere_and_normals_look_inwards() {
        let sphere = Sphere::new(CENTER, 2.0);
        for (face, uv) in (0..8).flat_map(|face| points(10).map(move |uv| (face, uv))) {
            let (position, normal) = sphere.surface(face, uv);
            assert!((position + 2.0 * normal - CENTER).length() < 1e-6);
        }
    }

    #[test]
    fn rays_from_the_surface_end_at_the_other_end_of_their_chord() {
        let sphere = Sphere::new(CENTER, 2.0);
        for (from, uv) in (0..8).flat_map(|face| points(8).map(move |uv| (face, uv))) {
            let (origin, normal) = sphere.surface(from, uv);
            for (to, target) in (0..8).flat_map(|face| points(5).map(move |uv| (face, uv))) {
                let (end, _) = sphere.surface(to, target);
                let (direction, chord) = ((end - origin).normalize_or_zero(), end.distance(origin));
                if chord > 0.3 {
                    let ray = Ray { origin: origin + normal * sphere.lift(), direction, from };
                    let hit = sphere.first(&ray);
                    assert!((hit.t - chord).abs() < 1e-3 * chord && !hit.back, "{hit:?} {chord}");
                    assert_eq!(cells::at(hit.uv, 1), 0);
                    assert!(sphere.surface(hit.triangle, hit.uv).0.distance(end) < 1e-3);
                }
            }
        }
    }

    #[test]
    fn rays_from_outside_hit_the_back_or_nothing() {
        let sphere = Sphere::new(CENTER, 2.0);
        let ray = |direction| Ray { origin: CENTER + Vec3::Z * 10.0, direction, from: NONE };
        let hit = sphere.first(&ray(Vec3::NEG_Z));
        assert!(hit.back && (hit.t - 8.0).abs() < 1e-5);
        assert!(sphere.first(&ray(Vec3::Z)).is_miss() && sphere.first(&ray(Vec3::X)).is_miss());
        let through = sphere.hits(&ray(Vec3::NEG_Z)).map(|hit| hit.map(|hit| (hit.t.round(), hit.back)));
        assert_eq!(through, [Some((8.0, true)), Some((12.0, false))]);
        let mut blocked = [false; 2];
        sphere.any(&[ray(Vec3::NEG_Z); 2], &[7.9, 8.1], &mut blocked);
        assert_eq!(blocked, [false, true]);
    }
}
