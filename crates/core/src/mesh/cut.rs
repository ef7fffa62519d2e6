//! How the triangles of a scene are cut: across into slices, and each patch regularly, or into four and these again.

use super::cells;
use super::parts::{MOST_SPLITS, PARTS};
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
    /// For every patch, triangle by triangle: the number m of divisions, which make m² elements a side; or 0, and then the same for
    /// the four parts into which it is split (see [`super::parts`]).
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
        let mut divisions = self.divisions.iter().copied();
        let mut asked = 0u64;
        for (t, slices) in (0..).zip(&self.slices) {
            for _ in 0..slices.patch_count() {
                let Some(elements) = elements_of_patch(&mut divisions) else {
                    return parameter(self.divisions.len(), "divisions are needed for each patch, or for its parts");
                };
                asked = asked.saturating_add(sides(scene, t).saturating_mul(elements));
            }
        }
        if divisions.next().is_some() {
            return parameter(self.divisions.len(), "there are divisions of more patches than there are");
        }
        if asked > MOST_ELEMENTS {
            Err(Error::TooManyElements { asked, limit: MOST_ELEMENTS })
        } else {
            Ok(asked as usize)
        }
    }
}

/// Elements a side of the patch whose divisions come next; `None` if they end before the patch does, or it is split too often.
fn elements_of_patch(divisions: &mut impl Iterator<Item = u16>) -> Option<u64> {
    let mut elements = 0u64;
    // How many patches are still to come at each depth.
    let mut left = vec![1];
    while let Some(here) = left.last_mut() {
        if *here == 0 {
            left.pop();
            continue;
        }
        *here -= 1;
        match divisions.next()? {
            0 if left.len() > MOST_SPLITS => return None,
            0 => left.push(PARTS),
            m => elements = elements.saturating_add(u64::from(cells::count(m))),
        }
    }
    Some(elements)
}

/// Number of sides of triangle `t` that have elements.
pub fn sides(scene: &Scene, t: u32) -> u64 {
    1 + u64::from(scene.material_of(t).two_sided)
}
