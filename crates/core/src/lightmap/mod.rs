//! Lightmaps: irradiance as a texture, for programs that show a scene and compute no light.
//!
//! ```text
//! Problem + VertexField --faces, atlas--> where every triangle lies in the map    (unwrap: made; existing: the file's own)
//!                       --texels-------> which point of the surface each texel shows
//!                       --bake---------> irradiance [lux] of every texel       (covered, borders, fill: where that is not enough)
//! ```
//!
//! Every texel that a bilinear lookup on a surface reads has a point of that surface: the one at its centre, or the
//! nearest. Texels that lie under other geometry take the light of those beside them ([`covered`]), those beyond the
//! border of a chart are set so that a lookup on the border gives the field's value ([`borders`]), and everything
//! between charts continues them ([`fill`]). Biased by what a texel cannot show: light is linear between texel centres.

mod atlas;
mod borders;
mod covered;
mod existing;
mod faces;
mod fill;
mod lit;
mod patch;
mod pieces;
mod summary;
mod texels;
mod unwrap;

pub use atlas::{Atlas, Border, Density, Layout, Origin};
pub use faces::Face;
pub use lit::radiosity;
pub use pieces::{Pieces, pieces};
pub use summary::{ObjectTexels, per_object};
pub use texels::{Texel, Texels};

use crate::math::Rgb;
use crate::view::VertexField;
use crate::{Error, Problem};
use glam::Vec2;
use rayon::prelude::*;

/// Irradiance [lux] of the surfaces of a scene, in a texture.
#[derive(Clone, Debug)]
pub struct Lightmap {
    pub atlas: Atlas,
    pub texels: Texels,
    /// Irradiance [lux] of every texel, rows from the top; those that no lookup on a surface reads continue the charts
    /// beside them.
    pub irradiance: Vec<Rgb>,
    /// Texels that lie under other geometry, and took the light of those beside them.
    pub covered: u32,
}

/// The light of `field` in a map that is laid out as `layout` says.
///
/// # Errors
/// [`Error::Lightmap`] if the map would be too large, or there is nothing to show; [`Error::Parameter`] for a
/// layout without meaning.
pub fn bake(problem: &Problem, field: &VertexField, layout: &Layout) -> Result<Lightmap, Error> {
    let atlas = Atlas::new(problem, field, layout)?;
    let texels = Texels::of(&atlas);
    let light = |texel: &Option<Texel>| {
        texel.map_or(Rgb::BLACK, |texel| atlas.faces[texel.face as usize].irradiance(problem, field, texel.at))
    };
    let mut irradiance: Vec<Rgb> = texels.list.par_iter().map(light).collect();
    let covered = covered::covered(problem, field, &atlas, &texels, &irradiance);
    fill::continue_under(&atlas, &texels, &covered, &mut irradiance);
    borders::fit(problem, field, &atlas, &texels, &covered, &mut irradiance);
    fill::continue_between(&atlas, &texels, &mut irradiance);
    let covered = covered.iter().filter(|is_covered| **is_covered).count() as u32;
    Ok(Lightmap { atlas, texels, irradiance, covered })
}

impl Lightmap {
    /// Irradiance [lux] at `uv`, as a program that shows the map finds it: by bilinear interpolation, without mipmaps.
    /// (0, 0) is the upper left corner of the map.
    pub fn lookup(&self, uv: Vec2) -> Rgb {
        let stencil = texels::stencil(uv, self.atlas.width, self.atlas.height);
        stencil.into_iter().map(|(texel, weight)| self.irradiance[texel] * weight).sum()
    }
}

#[cfg(test)]
mod tests;
