//! Which point of the surface each texel shows.
//!
//! A bilinear lookup anywhere on a triangle reads the four texels around it. All of these have a point: that at the
//! texel's centre if a triangle is there, else the nearest point of any triangle. So coverage is conservative in the
//! strict sense, that no lookup on a surface reads a texel without light, and a triangle smaller than a texel has
//! texels, too.

use super::Atlas;
use glam::{DVec2, Vec2};

/// How far beyond a triangle [texels] lookups on it read: the centres of the four texels around a point are not further.
const REACH: f64 = std::f64::consts::SQRT_2;

/// What a texel shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texel {
    pub face: u32,
    /// Barycentric coordinates on the face.
    pub at: Vec2,
    /// Whether that is the texel's centre, not only the nearest point.
    pub inside: bool,
}

/// What every texel shows.
#[derive(Clone, Debug)]
pub struct Texels {
    /// Rows from the top; `None` for texels that no lookup on a surface reads.
    pub list: Vec<Option<Texel>>,
    width: u32,
    height: u32,
}

impl Texels {
    /// Of the faces of `atlas`. Where faces are as near, the one of the lowest number has the texel.
    pub fn of(atlas: &Atlas) -> Texels {
        let (width, height) = (atlas.width, atlas.height);
        let count = width as usize * height as usize;
        let mut list: Vec<Option<Texel>> = vec![None; count];
        let mut nearest = vec![f64::INFINITY; count];
        for face in 0..atlas.faces.len() as u32 {
            let corners = atlas.in_texels(face);
            let [a, b, c] = corners;
            let (low, high) = (a.min(b).min(c) - REACH, a.max(b).max(c) + REACH);
            // Centres lie at halves.
            let range = |low: f64, high: f64, size: u32| {
                (low - 0.5).ceil().max(0.0) as u32..((high + 0.5).max(0.0) as u32).min(size)
            };
            for y in range(low.y, high.y, height) {
                for x in range(low.x, high.x, width) {
                    let center = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
                    let (at, distance) = nearest_point(corners, center);
                    let texel = y as usize * width as usize + x as usize;
                    if distance < REACH && distance < nearest[texel] {
                        nearest[texel] = distance;
                        list[texel] = Some(Texel { face, at: at.as_vec2(), inside: distance == 0.0 });
                    }
                }
            }
        }
        Texels { list, width, height }
    }

    /// Numbers of the up to eight texels around `texel`.
    pub fn around(&self, texel: usize) -> impl Iterator<Item = usize> + use<> {
        let (width, height) = (self.width as usize, self.height as usize);
        let (x, y) = (texel % width, texel / width);
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        rows.flat_map(move |row| (x.saturating_sub(1)..(x + 2).min(width)).map(move |column| row * width + column))
            .filter(move |&other| other != texel)
    }

    /// Whether neighbouring texels touch at a corner only.
    pub fn is_across_corner(&self, texel: usize, other: usize) -> bool {
        let width = self.width as usize;
        texel % width != other % width && texel / width != other / width
    }
}

/// The point of a triangle that is nearest to `p`, in barycentric coordinates (those of the second and the third
/// corner), and its distance.
fn nearest_point([a, b, c]: [DVec2; 3], p: DVec2) -> (DVec2, f64) {
    let area = (b - a).perp_dot(c - a);
    let (u, v) = ((p - a).perp_dot(c - a) / area, (b - a).perp_dot(p - a) / area);
    if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
        return (DVec2::new(u, v), 0.0);
    }
    let corners = [(a, DVec2::ZERO), (b, DVec2::X), (c, DVec2::Y)];
    let on_edge = |k: usize| {
        let ((from, at_from), (to, at_to)) = (corners[k], corners[(k + 1) % 3]);
        let way = to - from;
        let t = ((p - from).dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (at_from + t * (at_to - at_from), (from + t * way).distance(p))
    };
    let [first, second, third] = [0, 1, 2].map(on_edge);
    let nearer = |x: (DVec2, f64), y: (DVec2, f64)| if y.1 < x.1 { y } else { x };
    nearer(nearer(first, second), third)
}

/// The four texels that a bilinear lookup at `uv` reads, with their weights; the map ends at its borders (clamp to edge).
pub fn stencil(uv: Vec2, width: u32, height: u32) -> [(usize, f32); 4] {
    let along = |u: f32, size: u32| {
        let x = f64::from(u) * f64::from(size) - 0.5;
        let (low, part) = (x.floor(), (x - x.floor()) as f32);
        let clamped = |x: f64| x.clamp(0.0, f64::from(size - 1)) as usize;
        ([clamped(low), clamped(low + 1.0)], [1.0 - part, part])
    };
    let ((x, wx), (y, wy)) = (along(uv.x, width), along(uv.y, height));
    [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| (y[j] * width as usize + x[i], wx[i] * wy[j]))
}
