//! The coordinates that a file has: whether they are those of a lightmap.
//!
//! Whoever made them knows what they are for, so they are taken as they are, unless a map on them would be wrong:
//! outside of the map, or with two surfaces in the same place.

use super::atlas::{MOST_SIZE, area, area_in_texels};
use super::{Density, Face, Layout};
use crate::scene::Shape;
use crate::{Error, Problem};
use glam::{DVec2, Vec2};

/// How far outside of the map a corner may lie: rounding.
const OUTSIDE: f32 = 1e-4;
/// Centres of texels this close to an edge of a triangle, as a share of its height, may be in its neighbour, too.
const EDGE: f64 = 1e-3;

/// Coordinates of the corners of `face`, from those of the scene's vertices.
pub fn coordinates(problem: &Problem, face: &Face) -> [Vec2; 3] {
    let uvs = problem.scene.triangles[face.triangle as usize].vertices.map(|v| problem.scene.lightmap_uvs[v as usize]);
    face.corners.map(|at| {
        if at == Vec2::ZERO {
            uvs[0]
        } else if at == Vec2::X {
            uvs[1]
        } else if at == Vec2::Y {
            uvs[2]
        } else {
            uvs[0] + at.x * (uvs[1] - uvs[0]) + at.y * (uvs[2] - uvs[0])
        }
    })
}

/// Texels across and down: what was asked for, or what the density asked for takes.
///
/// # Errors
/// [`Error::Lightmap`] if that is too large; it says what fits.
pub fn size(problem: &Problem, faces: &[Face], uv: &[[Vec2; 3]], layout: &Layout) -> Result<u32, Error> {
    let asked = match layout.density {
        Density::Size(size) => return Ok(size),
        Density::TexelsPerMetre(asked) => asked,
    };
    let surface: f64 = faces.iter().map(|face| area(problem, face)).sum();
    let of_unit_map: f64 = uv.iter().map(|uv| area_in_texels(uv, DVec2::ONE)).sum();
    let size = f64::from(asked) * (surface / of_unit_map.max(f64::MIN_POSITIVE)).sqrt();
    if size > f64::from(MOST_SIZE) {
        let fits = f64::from(asked) * f64::from(MOST_SIZE) / size;
        let what = format!(
            "at {asked} texels per metre it would be {size:.0} texels across, and {MOST_SIZE} are the most; {fits:.2} fit"
        );
        return Err(Error::Lightmap { what });
    }
    Ok((size.ceil() as u32).max(16).next_multiple_of(4))
}

/// Why the coordinates are none of a lightmap of `size` texels across; `None` if they are.
pub fn fault(problem: &Problem, faces: &[Face], uv: &[[Vec2; 3]], size: u32) -> Option<String> {
    if problem.scene.shape != Shape::Triangles {
        return Some("a sphere has none".to_owned());
    }
    let name = |f: usize| &problem.scene.objects[faces[f].object(problem) as usize].name;
    let is_outside = |uv: &[Vec2; 3]| uv.iter().any(|p| p.min_element() < -OUTSIDE || p.max_element() > 1.0 + OUTSIDE);
    if let Some(f) = uv.iter().position(is_outside) {
        return Some(format!("those of '{}' leave the range from 0 to 1", name(f)));
    }
    let is_flat = |uv: &[Vec2; 3]| area_in_texels(uv, DVec2::ONE) <= 0.0;
    let flat = uv.iter().filter(|uv| is_flat(uv)).count();
    if 2 * flat > uv.len() {
        return Some(format!("{flat} of {} triangles have no area in them", uv.len()));
    }
    let (one, other) = overlap(uv, size)?;
    Some(match name(one) == name(other) {
        true => format!("triangles of '{}' overlap", name(one)),
        false => format!("'{}' and '{}' overlap", name(one), name(other)),
    })
}

/// Two triangles that have the centre of the same texel inside.
fn overlap(uv: &[[Vec2; 3]], size: u32) -> Option<(usize, usize)> {
    let mut owner = vec![u32::MAX; size as usize * size as usize];
    for (f, uv) in uv.iter().enumerate() {
        let [a, b, c] = uv.map(|uv| uv.as_dvec2() * f64::from(size));
        let area = (b - a).perp_dot(c - a);
        if area == 0.0 {
            continue;
        }
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let range = |low: f64, high: f64| (low - 0.5).ceil().max(0.0) as u32..((high + 0.5).max(0.0) as u32).min(size);
        for y in range(low.y, high.y) {
            for x in range(low.x, high.x) {
                let p = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
                let weights = [(b - p).perp_dot(c - p), (c - p).perp_dot(a - p), (a - p).perp_dot(b - p)];
                if weights.iter().all(|w| w / area > EDGE) {
                    let cell = &mut owner[y as usize * size as usize + x as usize];
                    if *cell != u32::MAX {
                        return Some((*cell as usize, f));
                    }
                    *cell = f as u32;
                }
            }
        }
    }
    None
}
