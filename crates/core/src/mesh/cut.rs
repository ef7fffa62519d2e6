//! How the triangles of a scene are cut: across into slices, and each patch regularly, or into patches and these again; and which are put
//! together.

use super::bisection::{Division, MOST_DEPTH};
use super::cells;
use super::slices::Slices;
use crate::Error;
use crate::scene::{Scene, Shape};

/// Element numbers are `u32`, one of which means "none".
pub const MOST_ELEMENTS: u64 = u32::MAX as u64 - 1;

/// All that is needed to make the same elements again.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Cut {
    /// For every triangle.
    pub slices: Vec<Slices>,
    /// For every patch, triangle by triangle; after each that is divided follow those of its parts.
    pub divisions: Vec<Division>,
    /// For every triangle the least one of its cluster, or its own number; nothing if no triangles are put together.
    pub leaders: Vec<u32>,
}

impl Cut {
    /// No needles and no clusters: triangle `t` is cut into `divisions[t]²` elements a side.
    pub fn regular(divisions: &[u16]) -> Cut {
        let cells = divisions.iter().map(|&m| Division::Cells(m));
        Cut { slices: vec![Slices::WHOLE; divisions.len()], divisions: cells.collect(), leaders: Vec::new() }
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
        let Some(of_side) = self.elements_of_sides() else {
            return parameter(
                self.divisions.len(),
                "divisions are needed for each patch, or for its parts, and no more",
            );
        };
        if !self.leaders.is_empty() && self.leaders.len() != scene.triangles.len() {
            return parameter(self.leaders.len(), "a leader is needed for each triangle, or for none");
        }
        let mut asked = 0u64;
        for (t, &count) in of_side.iter().enumerate() {
            match self.leaders.get(t).filter(|&&leader| leader as usize != t) {
                None => asked = asked.saturating_add(sides(scene, t as u32).saturating_mul(count)),
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

    /// Number of elements into which a side of each triangle is cut, were there no clusters; `None` if the divisions are too few or too
    /// many, or wrong, or those of a patch that is divided too often.
    fn elements_of_sides(&self) -> Option<Vec<u64>> {
        let mut divisions = self.divisions.iter().copied();
        let mut of_side = |slices: &Slices| {
            (0..slices.patch_count())
                .try_fold(0u64, |sum, _| Some(sum.saturating_add(elements_of_patch(&mut divisions)?)))
        };
        let all = self.slices.iter().map(&mut of_side).collect();
        if divisions.next().is_some() { None } else { all }
    }

    /// Where in the divisions those of each triangle begin, and the end.
    pub(super) fn first_divisions(&self) -> Vec<usize> {
        let mut divisions = self.divisions.iter().copied();
        let end_of = |slices: &Slices| {
            let _ = (0..slices.patch_count()).try_for_each(|_| elements_of_patch(&mut divisions).map(drop));
            self.divisions.len() - divisions.len()
        };
        std::iter::once(0).chain(self.slices.iter().map(end_of)).collect()
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

/// Elements a side of the patch whose divisions come next; `None` if they end before the patch does, or it is divided too often.
fn elements_of_patch(divisions: &mut impl Iterator<Item = Division>) -> Option<u64> {
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
            Division::Cells(m) if m > 0 => elements = elements.saturating_add(u64::from(cells::count(m))),
            _ if left.len() > MOST_DEPTH => return None,
            Division::Bisected { from: 0..3, share } if share > 0.0 && share < 1.0 => left.push(2),
            Division::Split(m) if m > 0 => left.push(cells::count(m)),
            Division::Beside(0..8) => left.push(1),
            _ => return None,
        }
    }
    Some(elements)
}

/// Number of sides of triangle `t` that have elements.
pub fn sides(scene: &Scene, t: u32) -> u64 {
    1 + u64::from(scene.is_two_sided(t))
}
