//! How finely each triangle is cut.

use crate::Error;
use crate::scene::{Scene, Shape};
use glam::{DVec3, Vec3};

/// How many elements, or how large.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Resolution {
    /// As close to this number of elements as regular subdivision comes, never fewer than one for each side of a
    /// triangle. Elements of thin triangles get longer than others, so that they do not eat the budget.
    Elements(u64),
    /// No element has an edge longer than this [m].
    MaxEdge(f32),
    /// One element for each side of every triangle, and this many more.
    Extra(u64),
}

impl Default for Resolution {
    /// Room for shadows on large walls without drowning in elements.
    fn default() -> Resolution {
        Resolution::Extra(400_000)
    }
}

/// Element numbers are `u32`, one of which means "none".
const MOST_ELEMENTS: u64 = u32::MAX as u64 - 1;
/// Cell numbers of one triangle must fit as well.
const MOST_DIVISIONS: f64 = 30_000.0;

impl Resolution {
    /// Divisions for every triangle.
    ///
    /// # Errors
    /// [`Error::TooManyElements`]; [`Error::Parameter`] for zero elements or an edge that is not positive.
    pub fn divisions(self, scene: &Scene) -> Result<Vec<u16>, Error> {
        match self {
            Resolution::Elements(0) => {
                Err(Error::Parameter { name: "elements", value: "0".into(), allowed: "ask for at least one element" })
            }
            Resolution::Elements(target) => divisions_for_target(scene, target),
            Resolution::Extra(more) => {
                let least = count(scene, &vec![1; scene.triangles.len()])? as u64;
                divisions_for_target(scene, least.saturating_add(more))
            }
            Resolution::MaxEdge(edge) if edge > 0.0 && edge.is_finite() => {
                let divisions = |t| (longest_edge(scene, t) / f64::from(edge)).ceil();
                let wanted: Vec<f64> = (0..scene.triangles.len() as u32).map(divisions).collect();
                let asked: f64 = wanted.iter().map(|m| m * m).sum();
                if asked > MOST_ELEMENTS as f64 || wanted.iter().any(|&m| m > MOST_DIVISIONS) {
                    return Err(Error::TooManyElements { asked: asked as u64, limit: MOST_ELEMENTS });
                }
                Ok(wanted.into_iter().map(|m| m.max(1.0) as u16).collect())
            }
            Resolution::MaxEdge(edge) => Err(Error::Parameter {
                name: "max-edge",
                value: edge.to_string(),
                allowed: "the longest edge must be a positive length in metres",
            }),
        }
    }
}

/// Bisects the edge length until the number of elements is as close below `target` as it gets.
fn divisions_for_target(scene: &Scene, target: u64) -> Result<Vec<u16>, Error> {
    if target > MOST_ELEMENTS {
        return Err(Error::TooManyElements { asked: target, limit: MOST_ELEMENTS });
    }
    let sizes: Vec<[f64; 2]> = (0..scene.triangles.len() as u32).map(|t| length_and_width(scene, t)).collect();
    let divisions = |edge: f64| -> Vec<u16> { sizes.iter().map(|&size| economical_divisions(size, edge)).collect() };
    let total = |edge: f64| -> u64 {
        let elements = |(t, &size): (usize, &[f64; 2])| {
            let m = u64::from(economical_divisions(size, edge));
            m * m * side_count(scene, t as u32)
        };
        sizes.iter().enumerate().map(elements).sum()
    };
    let longest = sizes.iter().map(|s| s[0]).fold(0.0, f64::max);
    let (mut fine, mut coarse) = (longest / MOST_DIVISIONS, longest.max(f64::MIN_POSITIVE));
    for _ in 0..50 {
        let middle = (fine * coarse).sqrt();
        if total(middle) > target { fine = middle } else { coarse = middle }
    }
    let divisions = divisions(coarse);
    count(scene, &divisions)?;
    Ok(divisions)
}

/// `length / edge` for a well-shaped triangle. A thin one gets about as many elements as squares of `edge` fit along it:
/// cut by its length alone, a strip 100 edges long would become 10,000 splinters.
fn economical_divisions([length, width]: [f64; 2], edge: f64) -> u16 {
    let along = length / edge;
    let across = (width / edge).max(1.0).min(along);
    (along * across).sqrt().ceil().clamp(1.0, MOST_DIVISIONS) as u16
}

/// Number of elements that `divisions` make.
///
/// # Errors
/// [`Error::TooManyElements`].
pub fn count(scene: &Scene, divisions: &[u16]) -> Result<usize, Error> {
    let elements = |(t, &m): (usize, &u16)| u64::from(m) * u64::from(m) * side_count(scene, t as u32);
    let asked = divisions.iter().enumerate().map(elements).sum();
    if asked > MOST_ELEMENTS { Err(Error::TooManyElements { asked, limit: MOST_ELEMENTS }) } else { Ok(asked as usize) }
}

fn side_count(scene: &Scene, t: u32) -> u64 {
    1 + u64::from(scene.material_of(t).two_sided)
}

/// Area [m²] of the surface that triangle `t` stands for.
pub fn surface_area(scene: &Scene, t: u32) -> f64 {
    match scene.shape {
        Shape::Triangles => 0.5 * cross(scene.corners(t)).length(),
        Shape::Sphere { radius, .. } => 4.0 * std::f64::consts::PI * f64::from(radius).powi(2) / 8.0,
    }
}

/// Unit normal of the front of a triangle, computed in double precision.
pub fn normal(corners: [Vec3; 3]) -> Vec3 {
    cross(corners).normalize_or(DVec3::Z).as_vec3()
}

fn cross([a, b, c]: [Vec3; 3]) -> DVec3 {
    let a = a.as_dvec3();
    (b.as_dvec3() - a).cross(c.as_dvec3() - a)
}

fn longest_edge(scene: &Scene, t: u32) -> f64 {
    let [a, b, c] = scene.corners(t);
    f64::from(a.distance(b).max(b.distance(c)).max(c.distance(a)))
}

/// Longest edge, and the height above it doubled: both equal for a half square cut along its diagonal.
fn length_and_width(scene: &Scene, t: u32) -> [f64; 2] {
    let length = longest_edge(scene, t);
    let height = cross(scene.corners(t)).length() / length.max(f64::MIN_POSITIVE);
    [length, 2.0 * height]
}
