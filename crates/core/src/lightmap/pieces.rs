//! Surfaces cut where charts of a lightmap end, for programs that make charts by themselves: each piece has vertices of
//! its own, so that nothing grows across a seam.
//!
//! An edge that must be cut is cut if its two sides do not hang together elsewhere ([`super::patch`]). Both sides of a
//! surface are one piece: coordinates are those of triangles.

use super::faces::fronts;
use super::patch::Patch;
use crate::scene::Shape;
use crate::{Error, Problem};
use std::collections::HashMap;

/// The triangles of a scene, in pieces.
#[derive(Clone, Debug, Default)]
pub struct Pieces {
    /// World positions [m] of the vertices; those of an object that are the same up to rounding are the same here.
    pub positions: Vec<[f32; 3]>,
    /// The corners of every triangle of the scene, numbers of vertices. Two triangles share some only if they are on one
    /// piece.
    pub corners: Vec<[u32; 3]>,
}

/// The pieces of all surfaces.
///
/// # Errors
/// [`Error::Lightmap`] for a sphere, which is not made of triangles.
pub fn pieces(problem: &Problem) -> Result<Pieces, Error> {
    if problem.scene.shape != Shape::Triangles {
        let what = "a sphere has no lightmap coordinates; saved as .glb and loaded again it is made of triangles";
        return Err(Error::Lightmap { what: what.to_owned() });
    }
    let faces = fronts(problem);
    let mut positions = Vec::new();
    let mut corners = vec![[0; 3]; problem.scene.triangles.len()];
    let mut faces = faces.iter();
    for patch in Patch::all(problem, faces.as_slice()) {
        let mut numbers: HashMap<(u32, u32), u32> = HashMap::new();
        for ((own, piece), face) in patch.corners.iter().zip(patch.pieces()).zip(&mut faces) {
            corners[face.triangle as usize] = own.map(|vertex| {
                *numbers.entry((piece, vertex)).or_insert_with(|| {
                    positions.push(patch.positions[vertex as usize]);
                    positions.len() as u32 - 1
                })
            });
        }
    }
    Ok(Pieces { positions, corners })
}
