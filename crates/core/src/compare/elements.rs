//! The light of one mesh on the elements of another of the same scene.

use crate::math::Rgb;
use crate::mesh::cells;
use crate::{Problem, Solution};
use glam::Vec2;
use rayon::prelude::*;

/// An element is looked at in the middles of so many rows of congruent cells, 64 of them.
const ROWS: u16 = 8;

/// Irradiance [lux] of the solution `b` of `other` on the elements of `problem`: means over points of each. Exact where an element of `problem` lies in
/// one of `other`; else off by the share of a 64th or two of the element that lie across a border.
pub fn irradiance_on(problem: &Problem, other: &Problem, b: &Solution) -> Vec<Rgb> {
    let middles: Vec<Vec2> =
        (0..cells::count(ROWS)).map(|c| cells::corners(c, ROWS).iter().sum::<Vec2>() / 3.0).collect();
    let on = |e: u32| {
        let back = problem.mesh.place(e).back;
        let at = |within: &Vec2| {
            let (triangle, uv) = problem.mesh.on_element(e, *within);
            other.mesh.at(triangle, uv, back).map_or(Rgb::BLACK, |e| b.irradiance[e as usize])
        };
        middles.iter().map(at).sum::<Rgb>() / middles.len() as f32
    };
    problem.mesh.elements().into_par_iter().map(on).collect()
}
