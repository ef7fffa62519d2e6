//! Coordinates for surfaces that have none: cut into charts, flattened and packed by the crate `uvunwrap`.
//!
//! Charts are grown along surfaces, flattened by least squares conformal maps (Lévy et al. 2002) and as rigidly as
//! possible (Liu et al. 2008), and packed by their shapes. What is ours: which edges must be cut. A lookup across an
//! edge of a chart mixes the texels of both sides, so charts end where light jumps: at sharp edges, and where something
//! stands on a surface. Texels are equally large everywhere.

use super::atlas::{MOST_SIZE, area};
use super::{Density, Face, Layout};
use crate::math::weld::{self, Weld};
use crate::view::crease::CREASE_ANGLE;
use crate::{Error, Problem};
use glam::{Vec2, Vec3};
use std::collections::HashMap;
use uvunwrap::{MeshInput, Options, Packing};

/// More triangles than this are packed in rows, which is several times faster and less dense.
const MANY: usize = 20_000;
/// Share of the map that surfaces cover, in estimates.
const USED: f64 = 0.3;
/// Barycentric coordinates this close to a border lie on it.
const ON_BORDER: f32 = 1e-5;

/// Coordinates of faces.
pub struct Unwrapped {
    pub width: u32,
    pub height: u32,
    /// Of the corners of every face, from (0, 0) at the upper left corner of the map to (1, 1).
    pub uv: Vec<[Vec2; 3]>,
}

/// Coordinates of `faces`, which come object by object, fronts before backs.
///
/// # Errors
/// [`Error::Lightmap`] if the map would have to be larger than graphics cards take; it says what fits.
pub fn unwrap(problem: &Problem, faces: &[Face], layout: &Layout) -> Result<Unwrapped, Error> {
    let tolerance = (weld::TOLERANCE * problem.geometry.bounding_sphere().1).max(f32::MIN_POSITIVE);
    let key = |face: &Face| (face.object(problem), face.back);
    let patches: Vec<Patch> =
        faces.chunk_by(|a, b| key(a) == key(b)).map(|faces| Patch::new(problem, faces, tolerance)).collect();
    let surface: f64 = faces.iter().map(|face| area(problem, face)).sum();
    let density = match layout.density {
        Density::Size(page_size) => uvunwrap::Density::Auto { page_size },
        Density::TexelsPerMetre(texels_per_unit) => {
            let needed = (surface * f64::from(texels_per_unit).powi(2)).sqrt();
            if needed > f64::from(MOST_SIZE) {
                return Err(too_large(needed, texels_per_unit, surface));
            }
            uvunwrap::Density::Fixed { texels_per_unit, page_size: None }
        }
    };
    let options = Options {
        density,
        padding: layout.padding,
        packing: if faces.len() > MANY { Packing::Fast } else { Packing::Shape },
        block_align: layout.align_blocks,
        ..Options::default()
    };
    let meshes: Vec<MeshInput> = patches.iter().map(Patch::input).collect();
    let atlas = uvunwrap::generate(&meshes, &options).map_err(|error| Error::Lightmap { what: error.to_string() })?;
    if let Density::TexelsPerMetre(asked) = layout.density
        && atlas.width.max(atlas.height) > MOST_SIZE
    {
        return Err(too_large(f64::from(atlas.width.max(atlas.height)), asked, surface));
    }
    if atlas.page_count > 1 {
        let charts = atlas.chart_count;
        let what = format!(
            "{charts} charts with {} texels of padding around each do not fit into one map of this size; ask for a larger \
             size, or less padding",
            layout.padding
        );
        return Err(Error::Lightmap { what });
    }
    let mut uv = Vec::with_capacity(faces.len());
    for mesh in &atlas.meshes {
        let corner = |index: &u32| Vec2::from(mesh.vertices[*index as usize].uv);
        uv.extend(mesh.indices.chunks_exact(3).map(|corners| [0, 1, 2].map(|k| corner(&corners[k]))));
    }
    // Backs were turned over, so that they are unwrapped as they are seen.
    uv.iter_mut().zip(faces).filter(|(_, face)| face.back).for_each(|(uv, _)| uv.swap(1, 2));
    Ok(Unwrapped { width: atlas.width.max(1), height: atlas.height.max(1), uv })
}

fn too_large(needed: f64, asked: f32, surface: f64) -> Error {
    let fits = f64::from(MOST_SIZE) * (USED / surface).sqrt();
    let what = format!(
        "at {asked} texels per metre it would be more than {needed:.0} texels across, and {MOST_SIZE} are the most; about \
         {} fit",
        if fits > 10.0 { format!("{fits:.0}") } else { format!("{fits:.2}") }
    );
    Error::Lightmap { what }
}

/// One side of an object, its corners welded.
struct Patch {
    positions: Vec<[f32; 3]>,
    indices: Vec<u32>,
    /// Edges that must be cut, from each corner to the next.
    seams: Vec<[bool; 3]>,
}

impl Patch {
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
        Patch { positions: positions.iter().map(Vec3::to_array).collect(), indices: corners.concat(), seams }
    }

    fn input(&self) -> MeshInput<'_> {
        MeshInput { seams: Some(&self.seams), ..MeshInput::new(&self.positions, &self.indices) }
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
