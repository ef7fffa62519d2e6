//! Which edges of a surface must be cut before it is flattened.
//!
//! A lookup across an edge of a chart mixes the texels of both sides, so charts end where light jumps: at sharp edges, and
//! where something stands on a surface. They end with their objects, too.

use super::Face;
use crate::Problem;
use crate::math::DisjointSets;
use crate::math::weld::{self, Weld};
use crate::view::crease::CREASE_ANGLE;
use glam::{Vec2, Vec3};
use std::collections::HashMap;

/// Barycentric coordinates this close to a border lie on it.
const ON_BORDER: f32 = 1e-5;

/// One side of an object, its corners welded.
pub struct Patch {
    pub positions: Vec<[f32; 3]>,
    /// Of every face, numbers of positions, as they are seen.
    pub corners: Vec<[u32; 3]>,
    /// Edges that must be cut, from each corner to the next.
    pub seams: Vec<[bool; 3]>,
}

impl Patch {
    /// Those of `faces`, which come object by object, fronts before backs.
    pub fn all(problem: &Problem, faces: &[Face]) -> Vec<Patch> {
        let tolerance = (weld::TOLERANCE * problem.geometry.bounding_sphere().1).max(f32::MIN_POSITIVE);
        let key = |face: &Face| (face.object(problem), face.back);
        faces.chunk_by(|a, b| key(a) == key(b)).map(|faces| Patch::new(problem, faces, tolerance)).collect()
    }

    fn new(problem: &Problem, faces: &[Face], tolerance: f32) -> Patch {
        let mut weld = Weld::new(tolerance);
        let mut corners = Vec::with_capacity(faces.len());
        for face in faces {
            let [a, b, c] = face.positions(problem).map(|p| weld.number(p));
            corners.push(if face.back { [a, c, b] } else { [a, b, c] });
        }
        let positions: Vec<Vec3> = weld.into_positions();
        let normal = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|v| positions[v as usize]);
            (b - a).cross(c - a).normalize_or_zero()
        };
        let normals: Vec<Vec3> = corners.iter().map(|&corners| normal(corners)).collect();
        let mut around: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
        for (f, corners) in corners.iter().enumerate() {
            (0..3).for_each(|k| around.entry(edge(corners, k)).or_default().push(f));
        }
        let is_sharp = |f: usize, edge: [u32; 2]| {
            around[&edge].iter().any(|&other| normals[other].dot(normals[f]) < CREASE_ANGLE.cos())
        };
        let seams = (0..corners.len()).map(|f| {
            let stands_on = foot(problem, &faces[f]);
            [0, 1, 2].map(|k| stands_on[k] || is_sharp(f, edge(&corners[f], k)))
        });
        let seams = seams.collect();
        Patch { positions: positions.iter().map(Vec3::to_array).collect(), corners, seams }
    }

    /// Number of the piece that each face is on. Faces hang together across an edge that has one of them on either side
    /// and must not be cut.
    pub fn pieces(&self) -> Vec<u32> {
        let mut beside: HashMap<[u32; 2], Vec<(usize, usize)>> = HashMap::new();
        for (f, corners) in self.corners.iter().enumerate() {
            (0..3).for_each(|k| beside.entry(edge(corners, k)).or_default().push((f, k)));
        }
        let mut pieces = DisjointSets::new(self.corners.len());
        for corners in &self.corners {
            for k in 0..3 {
                if let [one, other] = beside[&edge(corners, k)][..]
                    && [one, other].iter().all(|&(f, k)| !self.seams[f][k])
                    && self.corners[one.0][one.1] != self.corners[other.0][other.1]
                {
                    pieces.join(one.0 as u32, other.0 as u32);
                }
            }
        }
        pieces.numbered().0
    }
}

/// Edge `k` of a face with these corners.
fn edge(corners: &[u32; 3], k: usize) -> [u32; 2] {
    let (a, b) = (corners[k], corners[(k + 1) % 3]);
    [a.min(b), a.max(b)]
}

/// On which edges of a face something stands, in the order of its corners as they are seen.
fn foot(problem: &Problem, face: &Face) -> [bool; 3] {
    let mesh = &problem.mesh;
    let middles = [Vec2::new(0.5, 0.0), Vec2::splat(0.5), Vec2::new(0.0, 0.5)];
    let [ab, bc, ca] = middles.map(|middle| {
        let (patch, on_patch) = mesh.patch_at(face.triangle, middle);
        let off = [on_patch.y, 1.0 - on_patch.x - on_patch.y, on_patch.x];
        mesh.beside(patch).iter().zip(off).any(|(stands_on, off)| *stands_on && off.abs() < ON_BORDER)
    });
    if face.back { [ca, bc, ab] } else { [ab, bc, ca] }
}
