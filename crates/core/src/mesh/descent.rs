//! From a patch that is divided to that part of it, itself not divided, in which a point lies.
//!
//! Where a wall is two triangles trees are deep, and rays end here and there on them: what such a descent costs is memory that is not in any cache, and branches
//! that are guessed wrong. Nearly all patches are bisected in the middle, which four bytes can say, a quarter of what a patch is; the point in the half is then a few operations
//! without a branch. Other patches are asked themselves. Nothing of this is there for a mesh in which no patch is divided.

use super::bisection::Content;
use super::{ElementMesh, Patch};
use glam::Vec2;

/// Bits of the number of a part; those above tell from which corner a patch is bisected in the middle.
const BITS: u32 = 30;

/// Where it goes on from a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step(u32);

impl Step {
    /// Nowhere: the patch has elements.
    const STAY: Step = Step(0);
    /// Where the patch says.
    const ASK: Step = Step(1);

    fn of(patch: &Patch) -> Step {
        match patch.content {
            Content::Elements { .. } => Step::STAY,
            Content::Bisected { from } if patch.measure == 0.5 && patch.first >> BITS == 0 => {
                Step(u32::from(from + 1) << BITS | patch.first)
            }
            _ => Step::ASK,
        }
    }

    /// The steps from all `patches`; none if no patch is divided.
    pub(super) fn from_all(patches: &[Patch]) -> Vec<Step> {
        let is_any_divided = patches.iter().any(Patch::is_divided);
        if is_any_divided { patches.iter().map(Step::of).collect() } else { Vec::new() }
    }

    /// Of a patch that is bisected in the middle the half at `uv`, and the barycentric coordinates on it: [`super::bisection::halved`] without a branch.
    #[inline(always)]
    fn half_at(self, uv: Vec2) -> (u32, Vec2) {
        let corners = [uv.x, uv.y, 1.0 - uv.x - uv.y, uv.x, uv.y];
        let from = ((self.0 >> BITS).wrapping_sub(1) & 3) as usize;
        let (after, before) = (corners[from], corners[from + 1]);
        // Minimum, maximum and bits: a choice between two would become a branch.
        let near = if after < before { after } else { before };
        let far = if after > before { after } else { before };
        let (at_foot, at_far) = ((2.0 * near).to_bits(), (far - near).to_bits());
        let second = (after - before).to_bits() >> 31;
        let swapped = (at_foot ^ at_far) & second.wrapping_neg();
        let within = Vec2::new(f32::from_bits(at_far ^ swapped), f32::from_bits(at_foot ^ swapped));
        ((self.0 & ((1 << BITS) - 1)) + second, within)
    }
}

impl ElementMesh {
    /// The patch with elements at the point `uv` of `patch`, and the barycentric coordinates on it.
    #[inline(always)]
    pub(super) fn leaf_at(&self, mut patch: u32, mut uv: Vec2) -> (u32, Vec2) {
        while let Some(&step) = self.steps.get(patch as usize).filter(|&&step| step != Step::STAY) {
            (patch, uv) = self.part_at(patch, step, uv);
        }
        (patch, uv)
    }

    /// From the `patch` of each point x, y to the part of it that is not divided, all of them one level at a time: then the processor waits
    /// for many parts at once. `waiting` is room for the numbers of those points that are not there yet. Patches without a meaning stay.
    #[inline(always)]
    pub(super) fn leaves_at(&self, patch: &mut [u32], [x, y]: [&mut [f32]; 2], waiting: &mut [u32]) {
        if self.steps.is_empty() {
            return;
        }
        let step_from = |patch: u32| self.steps.get(patch as usize).map_or(Step::STAY, |&step| step);
        let mut count = 0;
        // All are written down, and those that are there written over: no branch, for it would be guessed wrong.
        for (k, &patch) in (0..).zip(&*patch) {
            waiting[count] = k;
            count += usize::from(step_from(patch) != Step::STAY);
        }
        while count > 0 {
            let mut left = 0;
            for i in 0..count {
                let k = waiting[i] as usize;
                let (part, uv) = self.part_at(patch[k], step_from(patch[k]), Vec2::new(x[k], y[k]));
                (patch[k], x[k], y[k]) = (part, uv.x, uv.y);
                waiting[left] = k as u32;
                left += usize::from(step_from(part) != Step::STAY);
            }
            count = left;
        }
    }

    /// The part of `patch` at `uv`, to which `step` leads, and the barycentric coordinates on it.
    #[inline(always)]
    fn part_at(&self, patch: u32, step: Step, uv: Vec2) -> (u32, Vec2) {
        if step == Step::ASK { self.patches[patch as usize].part_at(uv) } else { step.half_at(uv) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::bisection::halved;
    use super::*;

    #[test]
    fn steps_lead_to_halves() {
        for (from, k) in [0, 1, 2].into_iter().flat_map(|from| (0..1000).map(move |k| (from, k))) {
            let u = (k as f32 * 0.618_034).fract();
            let uv = Vec2::new(u, (k as f32 * 0.414_214).fract() * (1.0 - u));
            let (content, first) = (Content::Bisected { from }, 77);
            let step = Step::of(&Patch { content, first, measure: 0.5, ..Patch::NONE });
            let (half, within) = halved(uv, from);
            assert_eq!(step.half_at(uv), (first + half, within));
        }
    }

    #[test]
    fn what_is_not_bisected_in_the_middle_is_asked() {
        let bisected = Patch { content: Content::Bisected { from: 1 }, measure: 0.25, ..Patch::NONE };
        let split = Patch { content: Content::Split, divisions: 2, ..Patch::NONE };
        assert_eq!([bisected, split, Patch::NONE].map(|patch| Step::of(&patch)), [Step::ASK, Step::ASK, Step::STAY]);
        assert!(Step::from_all(&[Patch::NONE]).is_empty());
    }
}
