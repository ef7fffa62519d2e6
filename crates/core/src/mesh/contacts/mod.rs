//! Elements are cut where others stand on them or pass through them, along their foot: then every element lies on one side, and no light passes.
//!
//! Elements that no contact meets stay as they are. Cells are split where one does, in the factors of their number, so those around it stay
//! together, and those that it meets are bisected along it ([`knife`]). An element is left whole only if what a contact takes off it is as thin as
//! the rounding of coordinates. Cost: O(depth) for each piece of a contact.

mod knife;

use super::bisection::Division;
use super::cells;
use super::cut::{Cut, sides};
use super::resolution::Resolution;
use crate::Error;
use crate::scene::{Contacts, Flat, Scene, Touched};
use glam::Vec2;
use knife::Knife;
use rayon::prelude::*;

/// A number of elements is close enough to that which was asked for from this share of it on.
const CLOSE: f64 = 0.97;
/// Trials to meet it.
const TRIALS: usize = 4;

impl Resolution {
    /// How to cut `scene`, along its `contacts` as well. There are not more elements than were asked for: the others are a little larger.
    ///
    /// # Errors
    /// Those of [`Resolution::cut`].
    pub fn cut_along(self, scene: &Scene, contacts: &Contacts) -> Result<Cut, Error> {
        if scene.triangles.is_empty() {
            return Err(Error::NoSurface);
        }
        let whole = self.cut(scene)?;
        let Some(most) = self.most(scene).map(|most| most.max(Resolution::least(scene))) else {
            return Ok(whole.along(scene, contacts, u64::MAX));
        };
        if contacts.triangles.is_empty() {
            return Ok(whole);
        }
        let (mut best, mut cut, mut aim) = (whole.along(scene, contacts, most), whole, most as f64);
        for _ in 0..TRIALS {
            let along = cut.along(scene, contacts, u64::MAX);
            let count = along.element_count(scene)? as u64;
            if count <= most {
                best = along;
                if count as f64 >= CLOSE * most as f64 {
                    break;
                }
            }
            aim *= 0.5 * (1.0 + CLOSE) * most as f64 / count as f64;
            cut = self.with_most(aim as u64, scene).cut(scene)?;
        }
        Ok(best)
    }
}

/// A triangle cut anew.
struct Anew {
    triangle: u32,
    divisions: Vec<Division>,
    /// Elements that it has more than before.
    more: u64,
    /// Length of contacts [m] for each of these.
    gain: f64,
}

impl Cut {
    /// This cut of `scene`, cut along its `contacts` as well. If that makes more than `most` elements, not on all triangles: on those first that have
    /// the longest contacts for each element more. Triangles that are put together stay whole.
    pub fn along(&self, scene: &Scene, contacts: &Contacts, most: u64) -> Cut {
        let first = self.first_divisions();
        let is_clustered = self.is_clustered();
        let cut_anew = |touched: &Touched| {
            let t = touched.triangle as usize;
            if is_clustered.get(t) == Some(&true) {
                return None;
            }
            let before = &self.divisions[first[t]..first[t + 1]];
            let mut knife =
                Knife { touched, near: 4.0 * contacts.tolerance, from: before.iter().copied(), cut: Vec::new() };
            let [a, b, c] = touched.plane.whole.0;
            let on_plane = |uv: Vec2| a + f64::from(uv.x) * (b - a) + f64::from(uv.y) * (c - a);
            for patch in 0..self.slices[t].patch_count() {
                knife.walk(Flat(self.slices[t].corners(patch).map(on_plane)), &touched.inner, 0);
            }
            let more = sides(scene, touched.triangle) * (elements(&knife.cut) - elements(before));
            let length: f64 = touched.inner.iter().map(|[p, q]| p.distance(*q)).sum();
            let gain = if more == 0 { f64::INFINITY } else { length / more as f64 };
            Some(Anew { triangle: touched.triangle, divisions: knife.cut, more, gain })
        };
        let mut anew: Vec<Anew> = contacts.triangles.par_iter().filter_map(cut_anew).collect();
        anew.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        let mut left = most.saturating_sub(self.element_count(scene).map_or(u64::MAX, |count| count as u64));
        anew.retain(|anew| {
            let fits = anew.more <= left;
            left -= if fits { anew.more } else { 0 };
            fits
        });
        anew.sort_by_key(|anew| anew.triangle);
        let mut divisions = Vec::with_capacity(self.divisions.len());
        let mut copied = 0;
        for Anew { triangle, divisions: own, .. } in anew {
            let t = triangle as usize;
            divisions.extend_from_slice(&self.divisions[copied..first[t]]);
            divisions.extend(own);
            copied = first[t + 1];
        }
        divisions.extend_from_slice(&self.divisions[copied..]);
        Cut { divisions, slices: self.slices.clone(), leaders: self.leaders.clone() }
    }

    /// Which triangles are put together with others; nothing if none is.
    fn is_clustered(&self) -> Vec<bool> {
        let mut is_clustered = vec![false; self.leaders.len()];
        for (t, &leader) in self.leaders.iter().enumerate().filter(|&(t, &leader)| leader as usize != t) {
            (is_clustered[t], is_clustered[leader as usize]) = (true, true);
        }
        is_clustered
    }
}

fn elements(divisions: &[Division]) -> u64 {
    let of_leaf = |division: &Division| match division {
        Division::Cells(m) => u64::from(cells::count(*m)),
        _ => 0,
    };
    divisions.iter().map(of_leaf).sum()
}

#[cfg(test)]
mod tests;
