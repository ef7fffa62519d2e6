//! How finely each triangle is cut.

use super::bisection::Division;
use super::cut::{Cut, MOST_ELEMENTS, sides};
use super::grow::Neighbourhood;
use super::slices::Slices;
use super::triangle::{height, longest_edge, shortest_edge, surface_area};
use crate::Error;
use crate::scene::Scene;
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use std::f64::consts::FRAC_1_SQRT_2;

/// How many elements, or how large.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Resolution {
    /// As close to this number of elements as it comes, never fewer than one for each side of a triangle.
    Elements(u64),
    /// No element has an edge longer than this [m].
    MaxEdge(f32),
    /// One element for each side of every triangle, and this many more.
    Extra(u64),
    /// As close to this number of elements as it comes from below, whatever the number of triangles: those much smaller than
    /// elements are put together ([`super::grow`]), as far as surfaces are smooth and connected.
    Clustered(u64),
}

impl Default for Resolution {
    /// Room for shadows on large walls without drowning in elements, however finely things are modelled.
    fn default() -> Resolution {
        Resolution::Clustered(400_000)
    }
}

/// Cell numbers of one patch must fit into 32 bits, and slices into 16.
const MOST_DIVISIONS: f64 = 30_000.0;

/// Meshes with clusters have at least this share of the elements that were asked for, if they can.
const CLOSE: f64 = 0.998;
/// So many guesses at the length of their edges, before it is bisected so often.
const GUESSES: u32 = 6;
const STEPS: u32 = 14;

impl Resolution {
    /// Number of the sides of all triangles of `scene`, the fewest elements there can be.
    pub fn least(scene: &Scene) -> u64 {
        (0..scene.triangles.len() as u32).map(|t| sides(scene, t)).sum()
    }

    /// Most elements that `scene` is cut into, if that is what is said.
    pub fn most(self, scene: &Scene) -> Option<u64> {
        match self {
            Resolution::Elements(elements) | Resolution::Clustered(elements) => Some(elements),
            Resolution::Extra(more) => Some(Resolution::least(scene).saturating_add(more)),
            Resolution::MaxEdge(_) => None,
        }
    }

    /// The same with another number of elements at most, if that is what is said.
    pub(super) fn with_most(self, elements: u64, scene: &Scene) -> Resolution {
        match self {
            Resolution::Elements(_) => Resolution::Elements(elements.max(1)),
            Resolution::Clustered(_) => Resolution::Clustered(elements.max(1)),
            Resolution::Extra(_) => Resolution::Extra(elements.saturating_sub(Resolution::least(scene))),
            Resolution::MaxEdge(edge) => Resolution::MaxEdge(edge),
        }
    }

    /// About as long [m] are the edges of equal elements that are not smaller because their triangle is.
    pub fn typical_edge(self, scene: &Scene) -> f32 {
        let of_triangle = |t: u32| surface_area(scene, t) * sides(scene, t) as f64;
        let area: f64 = (0..scene.triangles.len() as u32).map(of_triangle).sum();
        match self {
            Resolution::MaxEdge(edge) => edge,
            _ => (2.0 * area / self.most(scene).unwrap_or(1).max(1) as f64).sqrt() as f32,
        }
    }

    /// How to cut `scene`.
    ///
    /// # Errors
    /// [`Error::TooManyElements`]; [`Error::Parameter`] for zero elements or an edge that is not positive.
    pub fn cut(self, scene: &Scene) -> Result<Cut, Error> {
        match self {
            Resolution::Elements(0) | Resolution::Clustered(0) => {
                Err(Error::Parameter { name: "elements", value: "0".into(), allowed: "ask for at least one element" })
            }
            Resolution::Elements(target) => cut_for_target(scene, in_range(target)?),
            Resolution::Clustered(target) => cut_with_clusters(scene, in_range(target)?),
            Resolution::Extra(more) => cut_for_target(scene, in_range(Resolution::least(scene).saturating_add(more))?),
            Resolution::MaxEdge(edge) if edge > 0.0 && edge.is_finite() => {
                let edge = f64::from(edge);
                let limited = |corners: [Vec3; 3]| divisions(longest_edge(corners) / edge);
                let asked = elements(scene, edge, limited);
                let longest = (0..scene.triangles.len() as u32).map(|t| longest_edge(scene.corners(t)));
                if asked > MOST_ELEMENTS || longest.fold(0.0, f64::max) > MOST_DIVISIONS * edge {
                    return Err(Error::TooManyElements { asked, limit: MOST_ELEMENTS });
                }
                Ok(cut(scene, edge, limited))
            }
            Resolution::MaxEdge(edge) => Err(Error::Parameter {
                name: "max-edge",
                value: edge.to_string(),
                allowed: "the edge must be a positive length in metres",
            }),
        }
    }
}

/// `elements`, if there may be so many.
fn in_range(elements: u64) -> Result<u64, Error> {
    if elements > MOST_ELEMENTS {
        return Err(Error::TooManyElements { asked: elements, limit: MOST_ELEMENTS });
    }
    Ok(elements)
}

/// The cut whose number of elements is as close below `target` as it gets.
fn cut_for_target(scene: &Scene, target: u64) -> Result<Cut, Error> {
    let few = |edge: f64| elements(scene, edge, |corners| economical(corners, edge)) <= target;
    let longest = (0..scene.triangles.len() as u32).map(|t| longest_edge(scene.corners(t))).fold(0.0, f64::max);
    let edge = least_edge([longest / MOST_DIVISIONS, longest], 40, few);
    let cut = cut(scene, edge, |corners| economical(corners, edge));
    cut.element_count(scene)?;
    Ok(cut)
}

/// The same with clusters. Their number falls as edges grow, as good as always: at worst there are a few elements fewer.
fn cut_with_clusters(scene: &Scene, target: u64) -> Result<Cut, Error> {
    let neighbourhood = Neighbourhood::new(scene);
    let clustered = |edge: f64| {
        let cut = cut(scene, edge, |corners| economical(corners, edge));
        Cut { leaders: neighbourhood.leaders(&cut, edge), ..cut }
    };
    // Clusters may be as large as the scene.
    let (low, high) = scene.bounds();
    let size = 2.0 * f64::from(low.distance(high)).min(f64::from(f32::MAX));
    let (mut fine, mut coarse) = (size / MOST_DIVISIONS, size.max(f64::MIN_POSITIVE));
    let (mut best, mut last) = (None, None);
    let aim = 0.5 * (1.0 + CLOSE) * target as f64;
    let mut edge = f64::from(Resolution::Clustered(target).typical_edge(scene));
    for step in 0..GUESSES + STEPS {
        let cut = clustered(edge);
        let count = cut.element_count(scene).map_or(MOST_ELEMENTS, |count| count as u64);
        if count > target {
            fine = edge;
        } else {
            (coarse, best) = (edge, Some(cut));
            if count as f64 >= CLOSE * target as f64 {
                break;
            }
        }
        // Half as long edges make four times as many on large triangles, fewer on small ones: the last two lengths tell.
        let (x, y) = (edge.ln(), (count as f64).ln());
        let slope = last.map_or(-2.0, |(other_x, other_y)| (y - other_y) / (x - other_x));
        let guess = edge * ((aim.ln() - y) / slope).exp();
        last = Some((x, y));
        edge = if step < GUESSES && fine < guess && guess < coarse { guess } else { (fine * coarse).sqrt() };
    }
    let cut = best.unwrap_or_else(|| clustered(coarse));
    if cut.leaders.is_empty() { cut_for_target(scene, target) } else { Ok(cut) }
}

/// Bisects the edge length [m] for the least that is long enough for `few` elements, the longest if none is.
fn least_edge([shortest, longest]: [f64; 2], steps: u32, few: impl Fn(f64) -> bool) -> f64 {
    let (mut fine, mut coarse) = (shortest, longest.max(f64::MIN_POSITIVE));
    for _ in 0..steps {
        let middle = (fine * coarse).sqrt();
        if few(middle) {
            coarse = middle;
        } else {
            fine = middle;
        }
    }
    coarse
}

/// Cuts into slices about `edge` high, and every patch into as many divisions as `of_patch` says.
fn cut(scene: &Scene, edge: f64, of_patch: impl Fn([Vec3; 3]) -> u16 + Sync) -> Cut {
    let corners: Vec<[Vec3; 3]> = (0..scene.triangles.len() as u32).map(|t| scene.corners(t)).collect();
    let slices: Vec<Slices> = corners.par_iter().map(|&corners| slices(corners, edge)).collect();
    let divided = |(&corners, &slices)| patches(corners, slices).map(|patch| Division::Cells(of_patch(patch)));
    let divisions = corners.par_iter().zip(&slices).flat_map_iter(divided).collect();
    Cut { slices, divisions, leaders: Vec::new() }
}

/// Number of elements of that cut; a triangle without an edge longer than `edge` is one.
fn elements(scene: &Scene, edge: f64, of_patch: impl Fn([Vec3; 3]) -> u16 + Sync) -> u64 {
    let of_triangle = |t: u32| {
        let corners = scene.corners(t);
        if longest_edge(corners) <= edge {
            return sides(scene, t);
        }
        let of_side: u64 = patches(corners, slices(corners, edge)).map(|patch| u64::from(of_patch(patch)).pow(2)).sum();
        of_side.saturating_mul(sides(scene, t))
    };
    (0..scene.triangles.len() as u32).into_par_iter().map(of_triangle).reduce(|| 0, u64::saturating_add)
}

/// Slices as high as the shortest edge, or if that is much less than `edge`, such that each half of one has no edge longer
/// than `edge`.
pub fn slices(corners: [Vec3; 3], edge: f64) -> Slices {
    let (shortest, length) = (shortest_edge(corners), longest_edge(corners));
    let count = if shortest > FRAC_1_SQRT_2 * edge {
        (length / shortest).floor()
    } else {
        (length / (edge * edge - shortest * shortest).sqrt()).ceil()
    };
    if length <= edge { Slices::WHOLE } else { Slices::across(corners, count.min(MOST_DIVISIONS) as u16) }
}

/// Corners of the patches of a triangle.
fn patches([a, b, c]: [Vec3; 3], slices: Slices) -> impl Iterator<Item = [Vec3; 3]> {
    let position = move |uv: Vec2| a + uv.x * (b - a) + uv.y * (c - a);
    (0..slices.patch_count()).map(move |patch| slices.corners(patch).map(position))
}

/// `length / edge` for a well-shaped patch. A thin one gets about as many elements as squares of `edge` fit along it: cut by
/// its length alone, a strip three edges long would become nine splinters.
fn economical(corners: [Vec3; 3], edge: f64) -> u16 {
    // The width is the length for a half square cut along its diagonal.
    let (length, width) = (longest_edge(corners), 2.0 * height(corners));
    let along = length / edge;
    let across = (width / edge).max(1.0).min(along);
    divisions((along * across).sqrt())
}

fn divisions(wanted: f64) -> u16 {
    wanted.ceil().clamp(1.0, MOST_DIVISIONS) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;
    use crate::mesh::ElementMesh;
    use crate::scene::builtin::shapes::Builder;
    use crate::scene::{Material, Shape};

    /// Needles and well-shaped triangles of many sizes; with `flat` also flat ones, whose edges are all long.
    fn scene(flat: bool) -> Scene {
        let mut builder = Builder::new("needles");
        let material = builder.material(Material::diffuse("", Rgb::grey(0.5)));
        builder.object("needles", material);
        let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0);
        for (length, width) in [(9.0, 0.01), (9.0, 0.3), (9.0, 2.0), (1.0, 1.0), (0.02, 0.01), (3.0, 0.05)] {
            builder.polygon(&[corner(0.0, 0.0), corner(length, 0.0), corner(length, width)]);
            if flat {
                builder.polygon(&[corner(length, 0.0), corner(0.5 * length, width), corner(0.0, 0.0)]);
            }
        }
        builder.finish()
    }

    /// Longest edges [m] of all elements.
    fn edges(scene: &Scene, resolution: Resolution) -> Vec<f64> {
        let mesh = ElementMesh::new(scene, resolution).unwrap();
        let of_element = |e| {
            let [a, b, c] = scene.corners(mesh.triangle(e));
            longest_edge(mesh.corners(e).map(|uv| a + uv.x * (b - a) + uv.y * (c - a)))
        };
        mesh.elements().map(of_element).collect()
    }

    #[test]
    fn no_element_has_a_longer_edge_than_was_asked_for() {
        let scene = scene(true);
        assert_eq!(scene.shape, Shape::Triangles);
        for edge in [20.0, 2.0, 0.5, 0.1, 0.03] {
            let longest = edges(&scene, Resolution::MaxEdge(edge)).into_iter().fold(0.0, f64::max);
            assert!(longest <= f64::from(edge) * 1.00001, "{longest} is more than {edge}");
        }
    }

    #[test]
    fn targets_are_met_from_below_and_needles_do_not_stay_long() {
        let scene = scene(false);
        for target in [200, 2000, 20_000] {
            let edges = edges(&scene, Resolution::Elements(target));
            let count = edges.len() as u64;
            assert!(count <= target && count > target * 8 / 10, "{count} for {target}");
            // Cut regularly, the thinnest needle would have elements of sqrt(9 m times the others' edge).
            let mean = (edges.iter().map(|edge| edge * edge).sum::<f64>() / count as f64).sqrt();
            let longest = edges.iter().copied().fold(0.0, f64::max);
            assert!(longest < 5.0 * mean, "{longest} {mean} for {target}");
        }
    }
}
