//! Binary trees of clusters over the elements of each side of each triangle: halved across the longer extent, down to one
//! element.

use crate::Problem;
use crate::form_factors::polygon::{centroid, element_corners, grid};
use glam::DVec3;

/// Points by which a cluster stands for its elements.
pub const SAMPLES: usize = 4;

/// Elements of one plane that exchange light as one.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Cluster {
    /// Numbers of its halves; `None` for a single element.
    pub halves: Option<[u32; 2]>,
    /// Area [m²].
    pub area: f64,
    pub normal: DVec3,
    pub triangle: u32,
    /// The element, or the first of them.
    pub element: u32,
    /// Points [m] spread over it.
    pub samples: [DVec3; SAMPLES],
}

/// All clusters; halves come after their whole.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Clusters {
    pub all: Vec<Cluster>,
    /// Those that are no half of another: one for each side of a triangle.
    pub roots: Vec<u32>,
}

/// An element and its centroid [m].
type Placed = (u32, DVec3);

impl Clusters {
    pub fn of(problem: &Problem) -> Clusters {
        let mut clusters = Clusters { all: Vec::with_capacity(2 * problem.mesh.len()), roots: Vec::new() };
        let side = |e: u32| (problem.mesh.triangle(e), problem.mesh.place(e).back);
        let mut elements: Vec<u32> = problem.mesh.elements().collect();
        elements.sort_by_key(|&e| side(e));
        for group in elements.chunk_by(|&a, &b| side(a) == side(b)) {
            let mut placed: Vec<Placed> = group.iter().map(|&e| (e, centroid(element_corners(problem, e)))).collect();
            let root = clusters.grow(problem, &mut placed);
            clusters.roots.push(root);
        }
        clusters
    }

    /// Adds the cluster of `placed` and all below it; gives its number.
    fn grow(&mut self, problem: &Problem, placed: &mut [Placed]) -> u32 {
        let number = self.all.len() as u32;
        let (element, _) = placed[0];
        self.all.push(Cluster {
            halves: None,
            area: placed.iter().map(|&(e, _)| f64::from(problem.mesh.area(e))).sum(),
            normal: problem.mesh.normal(element).as_dvec3(),
            triangle: problem.mesh.triangle(element),
            element,
            samples: [DVec3::ZERO; SAMPLES],
        });
        let samples = if placed.len() == 1 {
            let mut middles = grid(element_corners(problem, element), 2).map(centroid);
            std::array::from_fn(|_| middles.next().unwrap_or(placed[0].1))
        } else {
            let corner = |k: fn(DVec3, DVec3) -> DVec3| placed.iter().map(|p| p.1).reduce(k).unwrap_or_default();
            let extent = corner(DVec3::max) - corner(DVec3::min);
            let axis = (0..3).fold(0, |longest, k| if extent[k] > extent[longest] { k } else { longest });
            placed.sort_by(|a, b| a.1[axis].total_cmp(&b.1[axis]).then(a.0.cmp(&b.0)));
            let (low, high) = placed.split_at_mut(placed.len() / 2);
            let halves = [self.grow(problem, low), self.grow(problem, high)];
            self.all[number as usize].halves = Some(halves);
            // After the recursion the elements lie in the order of the leaves: neighbours in space.
            std::array::from_fn(|k| placed[(2 * k + 1) * placed.len() / (2 * SAMPLES)].1)
        };
        self.all[number as usize].samples = samples;
        number
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Resolution;
    use crate::scene::builtin::builtin;

    #[test]
    fn every_element_is_a_leaf_once_and_areas_add_up() {
        let problem = Problem::new(builtin("cubes").unwrap(), Resolution::Elements(300)).unwrap();
        let Clusters { all, roots } = Clusters::of(&problem);
        let mut leaves: Vec<u32> = all.iter().filter(|c| c.halves.is_none()).map(|c| c.element).collect();
        leaves.sort_unstable();
        assert_eq!(leaves, problem.mesh.elements().collect::<Vec<_>>());
        assert_eq!(roots.len(), problem.scene.triangles.len());
        for (k, cluster) in all.iter().enumerate() {
            let Some(halves) = cluster.halves else { continue };
            let parts: f64 = halves.iter().map(|&h| all[h as usize].area).sum();
            assert!(halves.iter().all(|&h| h as usize > k) && (parts / cluster.area - 1.0).abs() < 1e-9);
        }
    }
}
