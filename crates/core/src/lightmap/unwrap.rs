//! Coordinates for surfaces that have none: cut into charts, flattened and packed by the crate `uvunwrap`.
//!
//! Charts are grown along surfaces, flattened by least squares conformal maps (Lévy et al. 2002) and as rigidly as
//! possible (Liu et al. 2008), and packed by their shapes. What is ours: which edges must be cut ([`super::patch`]).
//! Texels are equally large everywhere.

use super::atlas::{MOST_SIZE, area};
use super::patch::Patch;
use super::{Density, Face, Layout};
use crate::{Error, Problem};
use glam::Vec2;
use uvunwrap::{MeshInput, Options, Packing};

/// More triangles than this are packed in rows, which is several times faster and less dense.
const MANY: usize = 20_000;
/// Share of the map that surfaces cover, in estimates.
const USED: f64 = 0.3;

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
    let patches = Patch::all(problem, faces);
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
    let meshes: Vec<MeshInput> = patches.iter().map(input).collect();
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

fn input(patch: &Patch) -> MeshInput<'_> {
    MeshInput { seams: Some(&patch.seams), ..MeshInput::new(&patch.positions, patch.corners.as_flattened()) }
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
