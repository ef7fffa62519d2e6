//! A lightmap as files: the map itself, the scene that shows it, and what to know about both.

mod glb;
mod manifest;
mod maps;

use super::{ExportOptions, LitScene, picture};
use crate::Error;
use isolux_core::lightmap::{Layout, Lightmap, ObjectTexels, bake, per_object};
use isolux_core::view::{self, Exposure, VertexField};
use isolux_core::{Problem, Solution};
use std::f32::consts::PI;
use std::path::Path;

/// How a `.glb` brings its light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Carrier {
    /// As what it looks like: one texture of the lit surfaces, tone-mapped, on unlit materials. Every viewer shows it as it is.
    #[default]
    Unlit,
    /// As a light map that is attached to each material by the extension `MOZ_lightmap`, which Hubs and three.js know.
    MozLightmap,
    /// Not at all: materials as they were and coordinates for the map beside it, an `.exr`, to be attached by whoever
    /// loads both.
    Sidecar,
}

impl Carrier {
    pub const ALL: [Carrier; 3] = [Carrier::Unlit, Carrier::MozLightmap, Carrier::Sidecar];

    pub fn name(self) -> &'static str {
        match self {
            Carrier::Unlit => "unlit",
            Carrier::MozLightmap => "MOZ_lightmap",
            Carrier::Sidecar => "sidecar",
        }
    }
}

/// A format that a lightmap can be written in.
#[derive(Clone, Copy, Debug)]
pub struct LightmapFormat {
    /// By which the format is chosen; lower case, without the dot.
    pub extension: &'static str,
    /// What is in the file, in a few words.
    pub what: &'static str,
    pub write: fn(&BakedScene) -> Result<Vec<u8>, Error>,
}

/// All formats.
pub const FORMATS: &[LightmapFormat] = &[
    LightmapFormat { extension: "glb", what: "the scene with its lightmap, see --carrier", write: glb::write },
    LightmapFormat {
        extension: "exr",
        what: "the map, irradiance in lux, linear 32-bit floats",
        write: maps::write_exr,
    },
    LightmapFormat {
        extension: "png",
        what: "the map, sRGB of irradiance over lux_at_white, 8 bits",
        write: maps::write_png,
    },
    LightmapFormat {
        extension: "json",
        what: "sizes, units, what to set in engines, texels of each object",
        write: manifest::write,
    },
];

/// A scene that every viewer shows as it is, with its light in a texture laid out by default.
///
/// # Errors
/// [`Error::Core`] with those of [`bake`], and for a camera that is not there.
pub fn write_unlit(lit: &LitScene, options: &ExportOptions) -> Result<Vec<u8>, Error> {
    let exposure = view::exposure(lit.problem, lit.field(), &picture::view_options(options))?;
    let (layout, carrier) = (Layout::default(), Carrier::Unlit);
    let baked = BakedScene::new(lit.problem, lit.computed, lit.field(), &layout, carrier, exposure, Vec::new())?;
    glb::write(&baked)
}

/// The format for `path`, by its extension in upper or lower case.
///
/// # Errors
/// [`Error::UnknownFormat`], which lists the known ones.
pub fn for_path(path: &Path) -> Result<&'static LightmapFormat, Error> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    FORMATS.iter().find(|format| format.extension == extension).ok_or_else(|| {
        let known: Vec<String> = FORMATS.iter().map(|format| format!(".{}", format.extension)).collect();
        Error::UnknownFormat {
            path: path.to_owned(),
            known: format!("a lightmap can be written as {}", known.join(", ")),
        }
    })
}

/// A lightmap with all that its files say.
#[derive(Debug)]
pub struct BakedScene<'a> {
    pub problem: &'a Problem,
    pub solution: &'a Solution,
    pub lightmap: Lightmap,
    pub objects: Vec<ObjectTexels>,
    pub carrier: Carrier,
    /// Of everything that is shown as it is.
    pub exposure: Exposure,
    /// Irradiance [lux] that is white in 8-bit maps: few texels are brighter.
    pub lux_at_white: f32,
    /// Names of the files that are written, without folders.
    pub files: Vec<String>,
}

/// Share of texels that may be brighter than white in 8-bit maps, where so few levels must do for all others.
const CLIPPED: f64 = 0.001;

impl<'a> BakedScene<'a> {
    /// Bakes the light of `field`, which belongs to `problem` and `solution`.
    ///
    /// # Errors
    /// [`Error::Core`] with those of [`bake`].
    pub fn new(
        problem: &'a Problem,
        solution: &'a Solution,
        field: &VertexField,
        layout: &Layout,
        carrier: Carrier,
        exposure: Exposure,
        files: Vec<String>,
    ) -> Result<BakedScene<'a>, Error> {
        let lightmap = bake(problem, field, layout)?;
        let objects = per_object(problem, solution, &lightmap);
        let lux_at_white = white(&lightmap, exposure);
        Ok(BakedScene { problem, solution, lightmap, objects, carrier, exposure, lux_at_white, files })
    }

    /// Share of the texels on surfaces that are brighter than white in 8-bit maps.
    pub fn clipped(&self) -> f64 {
        let levels = on_surfaces(&self.lightmap);
        levels.iter().filter(|&&level| level > self.lux_at_white).count() as f64 / levels.len().max(1) as f64
    }

    /// The first of the files with this extension.
    pub fn file(&self, extension: &str) -> Option<&str> {
        self.files
            .iter()
            .map(String::as_str)
            .find(|name| Path::new(name).extension().is_some_and(|own| own.eq_ignore_ascii_case(extension)))
    }
}

/// The brightest channel [lux] of each texel on a surface.
fn on_surfaces(lightmap: &Lightmap) -> Vec<f32> {
    let shown = lightmap.texels.list.iter().zip(&lightmap.irradiance).filter(|(texel, _)| texel.is_some());
    shown.map(|(_, light)| light.max_channel()).collect()
}

/// Irradiance [lux] that only few texels exceed; no more than what makes a surface of reflectivity 1/2 white when it is
/// exposed.
fn white(lightmap: &Lightmap, exposure: Exposure) -> f32 {
    let mut levels = on_surfaces(lightmap);
    levels.sort_by(f32::total_cmp);
    let clipped = (CLIPPED * levels.len() as f64) as usize;
    let white = levels.iter().rev().nth(clipped).copied().filter(|white| *white > 0.0).unwrap_or(1.0);
    white.min(2.0 * PI / exposure.scale())
}

#[cfg(test)]
mod tests;
