//! How the triangles of a scene are cut: across into slices, and each patch regularly; and which are put together.

use super::cells;
use super::slices::Slices;
use crate::Error;
use crate::scene::{Scene, Shape};

/// Element numbers are `u32`, one of which means "none".
pub const MOST_ELEMENTS: u64 = u32::MAX as u64 - 1;

/// All that is needed to make the same elements again.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Cut {
    /// For every triangle.
    pub slices: Vec<Slices>,
    /// For every patch, triangle by triangle: the number m of divisions, which make m² elements a side.
    pub divisions: Vec<u16>,
    /// For every triangle the least one of its cluster, or its own number; nothing if no triangles are put together.
    pub leaders: Vec<u32>,
}

impl Cut {
    /// No needles and no clusters: triangle `t` is cut into `divisions[t]²` elements a side.
    pub fn regular(divisions: &[u16]) -> Cut {
        Cut { slices: vec![Slices::WHOLE; divisions.len()], divisions: divisions.to_vec(), leaders: Vec::new() }
    }

    /// Number of elements that `scene` is cut into.
    ///
    /// # Errors
    /// [`Error::Parameter`] if this is not a cut of `scene`, [`Error::TooManyElements`].
    pub fn element_count(&self, scene: &Scene) -> Result<usize, Error> {
        let parameter =
            |value: usize, allowed| Err(Error::Parameter { name: "cut", value: value.to_string(), allowed });
        if self.slices.len() != scene.triangles.len() || !self.slices.iter().all(|s| s.is_valid()) {
            return parameter(self.slices.len(), "slices are needed for each triangle");
        }
        let patches: u64 = self.slices.iter().map(|s| u64::from(s.patch_count())).sum();
        if self.divisions.len() as u64 != patches || self.divisions.contains(&0) {
            return parameter(self.divisions.len(), "one number of divisions from 1 is needed for each patch");
        }
        if !self.leaders.is_empty() && self.leaders.len() != scene.triangles.len() {
            return parameter(self.leaders.len(), "a leader is needed for each triangle, or for none");
        }
        let of_side = self.elements_of_sides();
        let mut asked = 0u64;
        for (t, &count) in of_side.iter().enumerate() {
            match self.leaders.get(t).filter(|&&leader| leader as usize != t) {
                None => asked += sides(scene, t as u32) * count,
                Some(&leader) if self.can_follow(scene, &of_side, t, leader as usize) => {}
                Some(_) => return parameter(t, "a cluster is of whole triangles of one object that do not emit"),
            }
        }
        if asked > MOST_ELEMENTS {
            Err(Error::TooManyElements { asked, limit: MOST_ELEMENTS })
        } else {
            Ok(asked as usize)
        }
    }

    /// Number of elements into which a side of each triangle is cut, were there no clusters.
    fn elements_of_sides(&self) -> Vec<u64> {
        let mut divisions = self.divisions.iter();
        let mut of_side = |slices: &Slices| {
            divisions.by_ref().take(slices.patch_count() as usize).map(|&m| u64::from(cells::count(m))).sum()
        };
        self.slices.iter().map(&mut of_side).collect()
    }

    /// Whether triangle `t` may be in the cluster whose least triangle is `leader`.
    fn can_follow(&self, scene: &Scene, of_side: &[u64], t: usize, leader: usize) -> bool {
        let leads = leader < t && self.leaders[leader] as usize == leader;
        leads
            && of_side[t] == 1
            && of_side[leader] == 1
            && scene.triangles[t].object == scene.triangles[leader].object
            && !scene.material_of(t as u32).is_emitter()
            && scene.shape == Shape::Triangles
    }
}

/// Number of sides of triangle `t` that have elements.
pub fn sides(scene: &Scene, t: u32) -> u64 {
    1 + u64::from(scene.material_of(t).two_sided)
}
