//! Polygons to triangles: a fan for convex ones, ears cut off (Meisters 1975) for the others.

use glam::{DVec2, DVec3, Vec3};

/// Polygons with more corners become fans whatever their shape: cutting ears takes time with the square of their number.
const MOST_CORNERS: usize = 512;

/// Cuts the polygon with these corners into `corners.len() - 2` triangles, given by positions in `corners`, all of the
/// polygon's orientation. A polygon that crosses itself gets as many, if not good ones.
pub fn triangulate(corners: &[Vec3]) -> Vec<[usize; 3]> {
    let points = flatten(corners);
    let mut left: Vec<usize> = (0..corners.len()).collect();
    let mut triangles = Vec::with_capacity(corners.len().saturating_sub(2));
    if corners.len() <= MOST_CORNERS && !is_convex(&points) {
        let mut i = 0;
        let mut refused = 0;
        while left.len() > 3 && refused < left.len() {
            i %= left.len();
            if is_ear(&points, &left, i) {
                triangles.push(around(&left, i));
                left.remove(i);
                refused = 0;
            } else {
                i += 1;
                refused += 1;
            }
        }
    }
    triangles.extend((2..left.len()).map(|k| [left[0], left[k - 1], left[k]]));
    triangles
}

/// The corners in the plane that shows the polygon best, counter-clockwise; the normal is Newell's.
fn flatten(corners: &[Vec3]) -> Vec<DVec2> {
    let corners: Vec<DVec3> = corners.iter().map(|p| p.as_dvec3()).collect();
    let next = corners.iter().cycle().skip(1);
    let normal: DVec3 = corners.iter().zip(next).map(|(&a, &b)| (a - corners[0]).cross(b - corners[0])).sum();
    let size = normal.abs();
    if size.z >= size.x && size.z >= size.y {
        corners.iter().map(|p| DVec2::new(p.x * normal.z.signum(), p.y)).collect()
    } else if size.x >= size.y {
        corners.iter().map(|p| DVec2::new(p.y * normal.x.signum(), p.z)).collect()
    } else {
        corners.iter().map(|p| DVec2::new(p.z * normal.y.signum(), p.x)).collect()
    }
}

fn is_convex(points: &[DVec2]) -> bool {
    let n = points.len();
    (0..n).all(|i| turn([points[i], points[(i + 1) % n], points[(i + 2) % n]]) >= 0.0)
}

/// Whether the corner at position `i` of the corners that are left can be cut off.
fn is_ear(points: &[DVec2], left: &[usize], i: usize) -> bool {
    let ear = around(left, i);
    let [a, b, c] = ear.map(|k| points[k]);
    let is_inside = |p: DVec2| turn([a, b, p]) >= 0.0 && turn([b, c, p]) >= 0.0 && turn([c, a, p]) >= 0.0;
    turn([a, b, c]) > 0.0 && !left.iter().any(|k| !ear.contains(k) && is_inside(points[*k]))
}

fn around(left: &[usize], i: usize) -> [usize; 3] {
    let n = left.len();
    [left[(i + n - 1) % n], left[i], left[(i + 1) % n]]
}

/// Twice the signed area of a triangle: positive for a turn to the left.
fn turn([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[Vec3], [a, b, c]: [usize; 3]) -> f32 {
        (corners[b] - corners[a]).cross(corners[c] - corners[a]).z / 2.0
    }

    #[test]
    fn a_concave_polygon_is_covered_once() {
        // An L of area 3, as drawn and from behind.
        let outline = [(0., 0.), (2., 0.), (2., 1.), (1., 1.), (1., 2.), (0., 2.)];
        let mut corners: Vec<Vec3> = outline.iter().map(|&(x, y)| Vec3::new(x, y, 0.5)).collect();
        for sign in [1.0, -1.0] {
            for _ in 0..corners.len() {
                corners.rotate_left(1);
                let areas: Vec<f32> = triangulate(&corners).into_iter().map(|t| sign * area(&corners, t)).collect();
                assert_eq!((areas.len(), areas.iter().sum::<f32>()), (4, 3.0));
                assert!(areas.iter().all(|a| *a > 0.0));
            }
            corners.reverse();
        }
    }

    #[test]
    fn what_is_no_polygon_still_has_its_number_of_triangles() {
        assert!(triangulate(&[]).is_empty() && triangulate(&[Vec3::X; 2]).is_empty());
        assert_eq!(triangulate(&[Vec3::NAN; 7]).len(), 5);
        assert_eq!(triangulate(&[Vec3::X, Vec3::Y, -Vec3::X, -Vec3::Y, Vec3::ZERO, Vec3::splat(2.0)]).len(), 4);
    }
}
