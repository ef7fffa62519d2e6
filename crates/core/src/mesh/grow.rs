//! Which triangles make an element together: region growing over shared edges.
//!
//! Where triangles are smaller than half a normal element, a cluster grows from a seed: the neighbour nearest to the seed joins, as
//! long as the area is at most that of a normal element (half a square with the diagonal h), nothing is farther from the seed than
//! h / 2, and the normal is within [`BEND`] of the mean one. Clusters never reach into another object, and so neither into
//! another material, nor across an edge of a thing; triangles that emit stay alone, for lights are sampled exactly. Seeds
//! follow each other along a space-filling curve. What is left between clusters, less than a quarter of one, joins the smallest
//! neighbour that bears it. Greedy, as in the partitioning of finite elements (Farhat 1988). O(n log n), deterministic.

use super::bisection::Division;
use super::cut::Cut;
use super::slices::Slices;
use super::{morton, triangle};
use crate::math::weld::{self, Weld};
use crate::scene::{Scene, Shape};
use glam::{DVec3, Vec3};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Cosine of the greatest angle between a triangle and the mean of its cluster: 20 degrees.
pub const BEND: f64 = 0.939_692_620_785_908_4;
/// Area of a normal element, in squares of the edge length.
const AREA: f64 = 0.25;
/// Greatest distance from the seed, in edge lengths.
const REACH: f64 = 0.5;
/// What remains between clusters, below so much of a normal element, joins one that may become so much larger.
const REST: f64 = 0.25;
const LARGER: f64 = 1.5;

/// "In no cluster yet".
const FREE: u32 = u32::MAX;

/// The triangles of a scene, and which of them share an edge.
pub struct Neighbourhood {
    facets: Vec<Facet>,
    /// Along the space-filling curve.
    order: Vec<u32>,
    /// Neighbours of triangle t: `list[first[t]..first[t + 1]]`.
    first: Vec<usize>,
    list: Vec<u32>,
}

struct Facet {
    center: Vec3,
    /// Distance [m] of the farthest corner from the centre.
    radius: f32,
    /// Normal times area [m²].
    area: DVec3,
    /// Whether it may belong to a cluster at all.
    may_join: bool,
}

/// A cluster that grows.
#[derive(Clone, Default)]
struct Region {
    triangles: Vec<u32>,
    seed: Vec3,
    area: f64,
    /// Sum of normals times areas [m²].
    vector: DVec3,
}

impl Neighbourhood {
    pub fn new(scene: &Scene) -> Neighbourhood {
        let facet = |t: u32| {
            let corners = scene.corners(t);
            let center = (corners[0] + corners[1] + corners[2]) / 3.0;
            Facet {
                center,
                radius: corners.iter().map(|c| c.distance(center)).fold(0.0, f32::max),
                area: triangle::normal(corners).as_dvec3() * triangle::surface_area(scene, t),
                may_join: scene.shape == Shape::Triangles && !scene.material_of(t).is_emitter(),
            }
        };
        let mut pairs = triangle_neighbours(scene);
        pairs.extend(pairs.clone().into_iter().map(|(a, b)| (b, a)));
        pairs.sort_unstable();
        pairs.dedup();
        let count = scene.triangles.len() as u32;
        let first = (0..=count).map(|t| pairs.partition_point(|&(a, _)| a < t)).collect();
        let list = pairs.into_iter().map(|(_, b)| b).collect();
        Neighbourhood { facets: (0..count).map(facet).collect(), order: morton::order(scene), first, list }
    }

    /// For each triangle the least one of its cluster, where elements have edges of about `edge` [m] and `cut` says how triangles
    /// would be cut; nothing if there are no clusters.
    pub fn leaders(&self, cut: &Cut, edge: f64) -> Vec<u32> {
        let normal = AREA * edge * edge;
        let mut region_of = vec![FREE; self.facets.len()];
        let mut regions = Vec::new();
        let is_small = self.small(cut, normal);
        for &seed in self.order.iter().filter(|&&t| is_small[t as usize]) {
            if region_of[seed as usize] == FREE {
                regions.push(self.grow(seed, regions.len() as u32, &is_small, normal, edge, &mut region_of));
            }
        }
        self.join_rests(&mut regions, &mut region_of, normal, edge);
        if regions.iter().all(|region| region.triangles.len() < 2) {
            return Vec::new();
        }
        let mut leaders: Vec<u32> = (0..self.facets.len() as u32).collect();
        for Region { triangles, .. } in &regions {
            let leader = triangles.iter().copied().min().unwrap_or(0);
            triangles.iter().for_each(|&t| leaders[t as usize] = leader);
        }
        leaders
    }

    /// Which triangles are put together: those that are no more than half a normal element, and one piece.
    fn small(&self, cut: &Cut, normal: f64) -> Vec<bool> {
        let mut divisions = cut.divisions.iter();
        let mut is_whole = |slices: &Slices| {
            let patches = slices.patch_count() as usize;
            divisions.by_ref().take(patches).all(|&division| division == Division::Cells(1)) && patches == 1
        };
        let whole = cut.slices.iter().map(&mut is_whole);
        let small = |facet: &Facet| facet.may_join && facet.area.length() <= 0.5 * normal;
        whole.zip(&self.facets).map(|(whole, facet)| whole && small(facet)).collect()
    }

    /// Region `number`, grown from `seed`.
    fn grow(&self, seed: u32, number: u32, is_small: &[bool], normal: f64, edge: f64, of: &mut [u32]) -> Region {
        let center = self.facets[seed as usize].center;
        // Distances are not negative, so their bits are in the order of their values.
        let distance = |t: u32| self.facets[t as usize].center.distance_squared(center).to_bits();
        let mut region = Region { seed: center, ..Region::default() };
        let mut border = BinaryHeap::from([Reverse((0, seed))]);
        while let Some(Reverse((_, t))) = border.pop() {
            let joins = region.area + self.facets[t as usize].area.length() <= normal && self.fits(&region, t, edge);
            if of[t as usize] != FREE || !(t == seed || joins) {
                continue;
            }
            of[t as usize] = number;
            region.add(t, &self.facets[t as usize]);
            let free = self.of(t).iter().filter(|&&n| of[n as usize] == FREE && is_small[n as usize]);
            border.extend(free.map(|&n| Reverse((distance(n), n))));
        }
        region
    }

    /// Whether triangle `t` is near enough to the seed of a region, and looks its way.
    fn fits(&self, region: &Region, t: u32, edge: f64) -> bool {
        let facet = &self.facets[t as usize];
        f64::from(facet.center.distance(region.seed) + facet.radius) <= REACH * edge
            && facet.area.dot(region.vector) >= BEND * facet.area.length() * region.vector.length()
    }

    /// Regions that stayed small join the smallest neighbour that bears them.
    fn join_rests(&self, regions: &mut [Region], region_of: &mut [u32], normal: f64, edge: f64) {
        for number in 0..regions.len() {
            if regions[number].area >= REST * normal {
                continue;
            }
            let rest = std::mem::take(&mut regions[number]);
            let bears = |region: &Region| {
                region.area + rest.area <= LARGER * normal
                    && rest.triangles.iter().all(|&t| self.fits(region, t, LARGER * edge))
            };
            let around = rest.triangles.iter().flat_map(|&t| self.of(t)).map(|&n| region_of[n as usize]);
            let others = around.filter(|&r| r != FREE && r as usize != number && bears(&regions[r as usize]));
            let smaller =
                |a: &u32, b: &u32| regions[*a as usize].area.total_cmp(&regions[*b as usize].area).then(a.cmp(b));
            match others.min_by(smaller) {
                None => regions[number] = rest,
                Some(other) => {
                    for &t in &rest.triangles {
                        region_of[t as usize] = other;
                        regions[other as usize].add(t, &self.facets[t as usize]);
                    }
                }
            }
        }
    }

    fn of(&self, t: u32) -> &[u32] {
        &self.list[self.first[t as usize]..self.first[t as usize + 1]]
    }
}

impl Region {
    fn add(&mut self, t: u32, facet: &Facet) {
        self.triangles.push(t);
        self.area += facet.area.length();
        self.vector += facet.area;
    }
}

/// Pairs of triangles of one object that share an edge; corners at the same place are one.
pub fn triangle_neighbours(scene: &Scene) -> Vec<(u32, u32)> {
    let (low, high) = scene.bounds();
    let mut weld = Weld::new((weld::TOLERANCE * 0.5 * low.distance(high)).max(f32::MIN_POSITIVE));
    let mut edges = Vec::with_capacity(3 * scene.triangles.len());
    for t in 0..scene.triangles.len() as u32 {
        let [a, b, c] = scene.corners(t).map(|corner| weld.number(corner));
        let object = scene.triangles[t as usize].object;
        edges.extend([(a, b), (b, c), (c, a)].map(|(from, to)| (object, from.min(to), from.max(to), t)));
    }
    edges.sort_unstable();
    let pairs = edges.windows(2).filter(|pair| {
        let [a, b] = [pair[0], pair[1]];
        (a.0, a.1, a.2) == (b.0, b.1, b.2) && a.3 != b.3
    });
    pairs.map(|pair| (pair[0].3, pair[1].3)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{ElementMesh, Resolution};
    use crate::scene::builtin::builtin;

    #[test]
    fn clusters_stay_on_one_object_and_off_edges_and_lamps() {
        let scene = builtin("office").unwrap();
        let whole = ElementMesh::new(&scene, Resolution::Elements(1)).unwrap().len();
        for target in [whole as u64 / 2, whole as u64 * 2] {
            let mesh = ElementMesh::new(&scene, Resolution::Clustered(target)).unwrap();
            assert!(mesh.len() as u64 <= target && mesh.len() as u64 * 100 > target * 97, "{} of {target}", mesh.len());
            let mut clusters = 0;
            for cluster in mesh.elements().filter_map(|e| mesh.cluster(e)) {
                clusters += 1;
                let first = cluster.largest();
                for t in cluster.triangles() {
                    assert_eq!(scene.triangles[t as usize].object, scene.triangles[first as usize].object);
                    assert!(!scene.material_of(t).is_emitter());
                    let [a, b] = [first, t].map(|t| triangle::normal(scene.corners(t)));
                    assert!(a.dot(b) > 45f32.to_radians().cos(), "{a} {b}");
                }
            }
            assert!(clusters > 1000, "{clusters}");
        }
    }

    #[test]
    fn elements_are_as_many_as_were_asked_for_however_fine_a_flat_surface_is_modelled() {
        use crate::math::Rgb;
        use crate::scene::Material;
        use crate::scene::builtin::shapes::Builder;
        let plate = |cuts: u32| {
            let mut builder = Builder::new("plate");
            let material = builder.material(Material::diffuse("", Rgb::grey(0.5)));
            builder.object("plate", material);
            let steps: Vec<f32> = (0..=cuts).map(|k| k as f32 / cuts as f32).collect();
            builder.grid(&steps, &steps, |u, v| Vec3::new(u, v, 0.0), |_, _| true);
            builder.finish()
        };
        for cuts in [1, 30, 100] {
            let mesh = ElementMesh::new(&plate(cuts), Resolution::Clustered(300)).unwrap();
            assert!((260..=300).contains(&mesh.len()), "{} elements of {cuts} cuts", mesh.len());
            let sizes = mesh.elements().map(|e| mesh.area(e));
            let (least, most) = sizes.fold((f32::INFINITY, 0f32), |(a, b), size| (a.min(size), b.max(size)));
            assert!(most * mesh.len() as f32 <= 3.0, "{cuts} cuts: {least} to {most}");
        }
    }
}
