//! How the triangles of a scene are cut: across into slices, and each patch regularly.

use super::cells;
use super::slices::Slices;
use crate::Error;
use crate::scene::Scene;

/// Element numbers are `u32`, one of which means "none".
pub const MOST_ELEMENTS: u64 = u32::MAX as u64 - 1;

/// All that is needed to make the same elements again.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Cut {
    /// For every triangle.
    pub slices: Vec<Slices>,
    /// For every patch, triangle by triangle: the number m of divisions, which make m² elements a side.
    pub divisions: Vec<u16>,
}

impl Cut {
    /// No needles: triangle `t` is cut into `divisions[t]²` elements a side.
    pub fn regular(divisions: &[u16]) -> Cut {
        Cut { slices: vec![Slices::WHOLE; divisions.len()], divisions: divisions.to_vec() }
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
        let mut divisions = self.divisions.iter();
        let mut asked = 0u64;
        for (t, slices) in self.slices.iter().enumerate() {
            let patches = divisions.by_ref().take(slices.patch_count() as usize);
            asked += sides(scene, t as u32) * patches.map(|&m| u64::from(cells::count(m))).sum::<u64>();
        }
        if asked > MOST_ELEMENTS {
            Err(Error::TooManyElements { asked, limit: MOST_ELEMENTS })
        } else {
            Ok(asked as usize)
        }
    }
}

/// Number of sides of triangle `t` that have elements.
pub fn sides(scene: &Scene, t: u32) -> u64 {
    1 + u64::from(scene.material_of(t).two_sided)
}
