//! Where to stand in a scene that brings no camera.
//!
//! A look round from the middle tells what it is: a room has surfaces all round, a box has an open side, and about an
//! object there is nothing. Rooms are seen from a corner at eye height, boxes through the open side, objects from the front right above.

use super::plastic;
use crate::Problem;
use crate::geometry::{Hit, NONE, Ray};
use crate::math::warp::square_to_sphere;
use crate::scene::Camera;
use glam::Vec3;

/// Vertical opening angle [rad]: a wide lens inside, a normal one outside.
const INSIDE: f32 = 62.0 * std::f32::consts::PI / 180.0;
const OUTSIDE: f32 = 38.0 * std::f32::consts::PI / 180.0;
/// Directions of a look round.
const LOOKS: u32 = 512;
/// Share of directions with a lit side in a room, and in a box that is open to one side.
const ROOM: f32 = 0.9;
const OPEN_BOX: f32 = 0.5;
/// Height of the eyes [m].
const EYES: f32 = 1.6;

/// A camera that shows `problem` sensibly; y is upwards.
pub fn camera(problem: &Problem) -> Camera {
    let (low, high) = problem.scene.bounds();
    let (center, size) = (0.5 * (low + high), high - low);
    let round = look_round(problem, center);
    if round.enclosed > ROOM {
        return in_room(problem, low, size);
    }
    let radius = 0.5 * size.length();
    if round.enclosed > OPEN_BOX
        && let Some(side) = round.open_side
    {
        // Far enough for the near opening to fit into the picture.
        let across = (size - size * side.abs()).max_element();
        let distance = 0.5 * (size * side.abs()).max_element() + 0.55 * across / (0.5 * OUTSIDE).tan();
        return Camera::looking_at("default", center + distance * side, center, OUTSIDE);
    }
    let direction = Vec3::new(0.7, 0.55, 1.0).normalize();
    Camera::looking_at("default", center + direction * (radius / (0.5 * OUTSIDE).sin()), center, OUTSIDE)
}

struct Round {
    /// Share of directions in which there is a lit side.
    enclosed: f32,
    /// The axis about which most of the directions into the open lie.
    open_side: Option<Vec3>,
    /// Mean distance [m] seen.
    distance: f32,
}

fn look_round(problem: &Problem, from: Vec3) -> Round {
    let direction = |k| square_to_sphere(plastic::point(0, k));
    let rays: Vec<Ray> = (0..LOOKS).map(|k| Ray { origin: from, direction: direction(k), from: NONE }).collect();
    let mut hits = vec![Hit::MISS; rays.len()];
    problem.geometry.closest(&rays, &mut hits);
    let lit = |hit: &Hit| !hit.is_miss() && problem.mesh.at(hit.triangle, hit.uv, hit.back).is_some();
    let count = hits.iter().filter(|hit| lit(hit)).count() as f32;
    let open = rays.iter().zip(&hits).filter(|(_, hit)| !lit(hit)).map(|(ray, _)| ray.direction).sum::<Vec3>();
    let axes = [Vec3::Z, Vec3::X, Vec3::NEG_X, Vec3::NEG_Z, Vec3::Y, Vec3::NEG_Y];
    // The mean of directions through a square opening is at least half as long as a single one.
    let strength = open / (LOOKS as f32 - count).max(1.0);
    let side = axes.into_iter().max_by(|a, b| a.dot(strength).total_cmp(&b.dot(strength)));
    let radius = problem.geometry.bounding_sphere().1;
    Round {
        enclosed: count / LOOKS as f32,
        open_side: side.filter(|axis| axis.dot(strength) > 0.5),
        distance: hits.iter().filter(|h| lit(h)).map(|h| h.t.min(radius)).sum::<f32>() / LOOKS as f32,
    }
}

/// From the corner of a room with the widest view, at eye height, towards the middle.
fn in_room(problem: &Problem, low: Vec3, size: Vec3) -> Camera {
    let eyes = EYES.min(0.55 * size.y);
    let target = low + size * Vec3::new(0.5, 0.0, 0.5) + Vec3::Y * (0.8 * eyes);
    let corners = [(0.86, 0.86), (0.14, 0.86), (0.86, 0.14), (0.14, 0.14)];
    let views = corners.map(|(x, z)| {
        let position = low + size * Vec3::new(x, 0.0, z) + Vec3::Y * eyes;
        (look_round(problem, position).distance, position)
    });
    let best = views.into_iter().rev().max_by(|a, b| a.0.total_cmp(&b.0));
    let position = best.map_or(target, |(_, position)| position);
    Camera::looking_at("default", position, target, INSIDE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;
    use crate::mesh::Resolution;
    use crate::scene::{Material, Object, Scene, Triangle, Vertex};

    /// The inside or the outside of a cube of 3 m, without the first `open` faces; the first is that at z = 3.
    fn view_of_cube(open: usize, inside: bool) -> Camera {
        let corner = |k: u32| Vertex::at(Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32) * 3.0);
        let faces = [[4, 6, 7, 5], [0, 1, 3, 2], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        let halves = faces[open..].iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        let facing = |[a, b, c]: [u32; 3]| if inside { [a, c, b] } else { [a, b, c] };
        let triangle = |(source, v)| Triangle { vertices: facing(v), object: 0, source };
        let scene = Scene {
            vertices: (0..8).map(corner).collect(),
            triangles: (0..).zip(halves).map(triangle).collect(),
            objects: vec![Object { name: String::new(), material: 0 }],
            materials: vec![Material::diffuse("", Rgb::grey(0.5))],
            ..Scene::default()
        };
        camera(&Problem::new(scene, Resolution::Elements(12)).unwrap())
    }

    fn is_within(p: Vec3) -> bool {
        p.cmpgt(Vec3::ZERO).all() && p.cmplt(Vec3::splat(3.0)).all()
    }

    #[test]
    fn rooms_are_seen_from_within_boxes_through_their_opening_and_objects_from_outside() {
        let (a, b) = (view_of_cube(0, true).position, view_of_cube(0, false).position);
        assert_ne!(is_within(a), is_within(b), "{a} {b}");
        let open = [view_of_cube(1, true), view_of_cube(1, false)];
        assert!(open.iter().any(|c| c.position.z > 3.0 && c.forward.abs_diff_eq(Vec3::NEG_Z, 1e-5)), "{open:?}");
    }
}
