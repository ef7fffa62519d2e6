//! Light inside elements of many triangles: smooth, and with each element's own mean.
//!
//! The mean of the elements that touch a vertex would make a cluster flat inside, with a ramp around it. Smooth pycnophylactic
//! interpolation (Tobler, J. American Statistical Association 1979) was made for maps of densities of which only the
//! mean of each district is known: in turn every vertex takes the mean of its neighbours, and every cluster is lifted or lowered
//! to its mean again. Vertices that touch any other element keep their value. Linear in the triangles of clusters, [`ROUNDS`] times
//! a few operations each; same bits always. Nothing changes without clusters.

use super::vertices::Vertices;
use crate::Problem;
use crate::math::Rgb;

/// Each reaches one triangle further.
const ROUNDS: usize = 48;

/// A triangle of a cluster.
struct Facet {
    /// Number of its cluster, from 0.
    cluster: usize,
    vertices: [usize; 3],
    /// Area [m²], or any measure of it.
    area: f32,
}

/// Changes `irradiance` [lux] at the vertices inside clusters, whose means are `values`.
pub fn interpolate(problem: &Problem, vertices: &Vertices, values: &[Rgb], irradiance: &mut [Rgb]) {
    if !problem.mesh.has_clusters() {
        return;
    }
    let clusters: Vec<u32> = problem.mesh.elements().filter(|&e| problem.mesh.cluster(e).is_some()).collect();
    let facets = facets(problem, vertices, &clusters);
    let area = sums(clusters.len(), facets.iter().map(|f| (f.cluster, f.area)));
    let area_around = sums(irradiance.len(), facets.iter().flat_map(|f| f.vertices.map(|v| (v, f.area))));
    let edges = sums(irradiance.len(), facets.iter().flat_map(|f| f.vertices.map(|v| (v, 2.0))));
    let is_free = |v: u32| vertices.touching(v).iter().all(|&e| problem.mesh.cluster(e).is_some());
    let free: Vec<usize> = (0..vertices.len() as u32).filter(|&v| is_free(v)).map(|v| v as usize).collect();
    for _ in 0..ROUNDS {
        // Each edge inside counts twice, once for each of its triangles.
        let others = |f: &Facet, k: usize| irradiance[f.vertices[(k + 1) % 3]] + irradiance[f.vertices[(k + 2) % 3]];
        let around = |f: &Facet| [0, 1, 2].map(|k| (f.vertices[k], others(f, k)));
        let around = sums(irradiance.len(), facets.iter().flat_map(around));
        free.iter().for_each(|&v| irradiance[v] = around[v] / edges[v]);
        let light = |f: &Facet| f.vertices.into_iter().map(|v| irradiance[v]).sum::<Rgb>() * (f.area / 3.0);
        let light = sums(clusters.len(), facets.iter().map(|f| (f.cluster, light(f))));
        let missing = |f: &Facet| values[clusters[f.cluster] as usize] - light[f.cluster] / area[f.cluster];
        let lift = |f: &Facet| f.vertices.map(|v| (v, missing(f) * f.area));
        let lifts = sums(irradiance.len(), facets.iter().flat_map(lift));
        free.iter().for_each(|&v| irradiance[v] = positive(irradiance[v] + lifts[v] / area_around[v]));
    }
}

/// The triangles of all `clusters` that are larger than a point.
fn facets(problem: &Problem, vertices: &Vertices, clusters: &[u32]) -> Vec<Facet> {
    let of_cluster = |(cluster, &e): (usize, &u32)| {
        let facet = move |place| {
            let corners = vertices.at(problem, place);
            let [a, b, c] = corners.map(|v| vertices.position(v));
            let area = (b - a).cross(c - a).length();
            Facet { cluster, vertices: corners.map(|v| v as usize), area: area.max(f32::MIN_POSITIVE) }
        };
        problem.mesh.pieces(e).map(facet)
    };
    clusters.iter().enumerate().flat_map(of_cluster).collect()
}

/// The sums of the values that belong to each of `count` numbers.
fn sums<T: Copy + Default + std::ops::AddAssign>(count: usize, values: impl Iterator<Item = (usize, T)>) -> Vec<T> {
    let mut sums = vec![T::default(); count];
    values.for_each(|(k, value)| sums[k] += value);
    sums
}

fn positive(color: Rgb) -> Rgb {
    Rgb::from(color.to_array().map(|v| v.max(0.0)))
}

#[cfg(test)]
mod tests {
    use super::super::VertexField;
    use super::super::tests::solution;
    use super::*;
    use crate::mesh::Cut;
    use crate::scene::Material;
    use crate::scene::builtin::shapes::Builder;
    use glam::{Vec2, Vec3};

    /// Squares along an edge of a plate, and along an edge of a cluster.
    const PLATE: usize = 32;
    const CLUSTER: usize = 8;

    /// A plate 1 m wide in sixteen clusters.
    fn plate() -> Problem {
        let mut builder = Builder::new("plate");
        let material = builder.material(Material::diffuse("", Rgb::grey(0.5)));
        builder.object("plate", material);
        let steps: Vec<f32> = (0..=PLATE).map(|k| k as f32 / PLATE as f32).collect();
        builder.grid(&steps, &steps, |u, v| Vec3::new(u, v, 0.0), |_, _| true);
        let leader = |t: usize| {
            let first = |k: usize| k / CLUSTER * CLUSTER;
            2 * (first(t / 2 / PLATE) * PLATE + first(t / 2 % PLATE)) as u32
        };
        let triangles = 2 * PLATE * PLATE;
        let cut = Cut { leaders: (0..triangles).map(leader).collect(), ..Cut::regular(&vec![1; triangles]) };
        Problem::with_cut(builder.finish(), &cut).unwrap()
    }

    /// Means over the clusters of `light` [lux] at each place, and what becomes of them.
    fn field(problem: &Problem, light: impl Fn(Vec3) -> f32) -> (Vec<Rgb>, VertexField) {
        let mean = |e| {
            let points = problem.mesh.pieces(e).map(|p| problem.geometry.surface(p.triangle, Vec2::splat(1.0 / 3.0)).0);
            Rgb::grey(points.map(&light).sum::<f32>() / problem.mesh.pieces(e).count() as f32)
        };
        let means: Vec<Rgb> = problem.mesh.elements().map(mean).collect();
        let field = VertexField::as_computed(problem, &solution(means.clone()));
        (means, field)
    }

    #[test]
    fn a_gradient_runs_straight_through_clusters_and_their_means_are_kept() {
        let problem = plate();
        assert_eq!(problem.mesh.len(), 16);
        let light = |p: Vec3| 10.0 + 8.0 * p.x + 4.0 * p.y;
        let (means, field) = field(&problem, light);
        for v in 0..field.len() as u32 {
            let p = field.position(v);
            // Away from the border, beyond which nothing is known. Flat clusters with ramps would be wrong by 1.5.
            if p.min(Vec3::ONE - p).truncate().min_element() > 0.3 {
                assert!((field.irradiance(v).g - light(p)).abs() < 0.25, "{p}: {} {}", field.irradiance(v).g, light(p));
            }
        }
        for e in problem.mesh.elements() {
            let at = |place: crate::mesh::Place| field.vertices_at(&problem, place).map(|v| field.irradiance(v).g);
            let mean = problem.mesh.pieces(e).flat_map(at).sum::<f32>() / (6 * CLUSTER * CLUSTER) as f32;
            assert!((mean / means[e as usize].g - 1.0).abs() < 0.01, "{mean} {}", means[e as usize].g);
        }
    }

    #[test]
    fn even_light_stays_even() {
        let problem = plate();
        let (_, field) = field(&problem, |_| 7.0);
        assert!((0..field.len() as u32).all(|v| (field.irradiance(v).g - 7.0).abs() < 1e-4));
    }
}
