//! Which elements even each other out when noise is taken out, and how strongly.
//!
//! Neighbours touch at a vertex, so they lie on the same smooth surface ([`super::crease`]), and belong to the same object. An even
//! exchange gives every vertex v the mean of the elements around it, weighted with w, and every element the mean of its three
//! vertices:
//!
//! ```text
//! x_i += Σ_j s_ij (x_j - x_i),    s_ij = Σ_v w_j / (3 W_v),    W_v = Σ w of the elements around v
//! ```
//!
//! `w_i s_ij = w_j s_ji`: what one gains the other loses, so `Σ w x` stays as it is, whatever part of each exchange takes place. A
//! cluster meets its neighbours at more than three vertices: with k of them it gives each `w / k` in place of `w / 3`.

use super::vertices::Vertices;
use crate::Problem;
use rayon::prelude::*;

/// A vertex where more elements meet is the hub of a fan: its elements are not neighbours in any useful sense.
const HUB: usize = 64;

/// The neighbours of every element, about 12, with their shares s. 8 bytes each.
pub struct Neighbours {
    /// Those of element e are `list[first[e]..first[e + 1]]`.
    first: Vec<usize>,
    list: Vec<(u32, f32)>,
}

impl Neighbours {
    /// `weight[e]` is w of element e, not negative; elements without weight have no neighbours.
    pub fn new(problem: &Problem, vertices: &Vertices, weight: &[f32]) -> Neighbours {
        let part = |e: usize| weight[e] * (3.0 / meetings(problem, vertices, e as u32).len().max(1) as f32);
        let parts: Vec<f32> = (0..weight.len()).into_par_iter().map(part).collect();
        let sum = |v: u32| vertices.touching(v).iter().map(|&e| parts[e as usize]).sum();
        let sums: Vec<f32> = (0..vertices.len() as u32).into_par_iter().map(sum).collect();
        let of_element = |e: u32| around(problem, vertices, e, &parts, &sums);
        let lists: Vec<Vec<(u32, f32)>> = (0..weight.len() as u32).into_par_iter().map(of_element).collect();
        let mut first = Vec::with_capacity(lists.len() + 1);
        first.push(0);
        for list in &lists {
            first.push(first[first.len() - 1] + list.len());
        }
        Neighbours { first, list: lists.concat() }
    }

    /// Neighbours of element `e` with their shares, which add up to less than 1.
    pub fn of(&self, e: usize) -> impl Iterator<Item = (usize, f32)> {
        self.list[self.first[e]..self.first[e + 1]].iter().map(|&(n, share)| (n as usize, share))
    }
}

/// The vertices at which element `e` meets others: its corners, or those on the border of a cluster.
fn meetings(problem: &Problem, vertices: &Vertices, e: u32) -> Vec<u32> {
    let mut touched = vertices.of_element(problem, e);
    if problem.mesh.cluster(e).is_some() {
        touched.retain(|&v| vertices.touching(v).len() > 1);
    }
    touched
}

/// Neighbours of element `e` with their shares, in ascending order; `parts` are three times what elements give each of their
/// vertices, `sums` the `W_v`.
fn around(problem: &Problem, vertices: &Vertices, e: u32, parts: &[f32], sums: &[f32]) -> Vec<(u32, f32)> {
    if parts[e as usize] <= 0.0 {
        return Vec::new();
    }
    let mut list = Vec::with_capacity(16);
    let meetings = meetings(problem, vertices, e);
    for &v in &meetings {
        let touching = vertices.touching(v);
        if touching.len() <= HUB {
            let near = touching
                .iter()
                .filter(|&&n| n != e && parts[n as usize] > 0.0 && problem.object(n) == problem.object(e));
            list.extend(near.map(|&n| (n, parts[n as usize] / (meetings.len() as f32 * sums[v as usize]))));
        }
    }
    list.sort_unstable_by_key(|&(n, _)| n);
    list.dedup_by(|again, kept| {
        let same = again.0 == kept.0;
        kept.1 += if same { again.1 } else { 0.0 };
        same
    });
    list
}
