//! Writers, one format a file. Each turns a solution into the bytes of a file; [`crate::files`] puts them on the disk.

mod csv;
pub mod elements;
mod faces;
pub mod factors;
mod glb;
pub mod glb_container;
pub mod html;
pub mod image;
pub mod json;
pub mod lightmap;
mod npz;
mod picture;
mod ply;
pub mod scene_glb;
mod vtu;

use crate::{Error, solution_file};
use isolux_core::view::{self, VertexField};
use isolux_core::{Problem, Solution};
use std::borrow::Cow;
use std::cell::{OnceCell, RefCell};
use std::path::Path;

/// One format a solution can be written in.
#[derive(Clone, Copy, Debug)]
pub struct Exporter {
    /// By which the format is chosen: how names of its files end, lower case. The first that fits counts.
    pub ending: &'static str,
    /// What is in the file, in a few words.
    pub what: &'static str,
    pub write: fn(&LitScene, &ExportOptions) -> Result<Vec<u8>, Error>,
}

/// A problem and its solution, to be written; what several writers need is made once, when the first asks for it.
#[derive(Debug)]
pub struct LitScene<'a> {
    pub problem: &'a Problem,
    /// As the tables have it: smoothed, if that was asked for.
    pub solution: Cow<'a, Solution>,
    /// As it was computed.
    pub computed: &'a Solution,
    smoothing: Smoothing,
    field: OnceCell<VertexField>,
    /// Of a draft; with the field of an earlier one, until the own is there.
    draft: Option<RefCell<Option<VertexField>>>,
}

impl<'a> LitScene<'a> {
    pub fn new(problem: &'a Problem, solution: &'a Solution) -> LitScene<'a> {
        LitScene::smoothed(problem, solution, Smoothing::default())
    }

    /// With the noise taken out of what `smoothing` says.
    pub fn smoothed(problem: &'a Problem, computed: &'a Solution, smoothing: Smoothing) -> LitScene<'a> {
        let solution = match smoothing {
            Smoothing::All => Cow::Owned(view::smooth(problem, computed)),
            Smoothing::Pictures | Smoothing::None => Cow::Borrowed(computed),
        };
        LitScene { problem, solution, computed, smoothing, field: OnceCell::new(), draft: None }
    }

    /// A solution that is still being computed, as [`VertexField::draft`] shows it, on the vertices of an `earlier` field.
    pub fn draft(problem: &'a Problem, solution: &'a Solution, earlier: Option<VertexField>) -> LitScene<'a> {
        LitScene { draft: Some(RefCell::new(earlier)), ..LitScene::new(problem, solution) }
    }

    /// The light as it is looked at.
    pub fn field(&self) -> &VertexField {
        self.field.get_or_init(|| {
            let earlier = self.draft.as_ref().and_then(RefCell::take);
            self.field_of(self.computed, earlier)
        })
    }

    /// The light of `solution`, one of this problem, made as [`LitScene::field`] is; on the vertices of an `earlier` field, if that
    /// is enough.
    fn field_of(&self, solution: &Solution, earlier: Option<VertexField>) -> VertexField {
        match &self.draft {
            Some(_) => VertexField::draft(self.problem, &solution.irradiance, earlier),
            None if self.smoothing == Smoothing::None => VertexField::as_computed(self.problem, solution),
            None => VertexField::new(self.problem, solution),
        }
    }

    /// The field, if anybody has asked for it; that of the earlier draft, if nobody has.
    pub fn into_field(self) -> Option<VertexField> {
        self.field.into_inner().or_else(|| self.draft.and_then(RefCell::into_inner))
    }
}

/// Where noise is taken out, see [`mod@view::smooth`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Smoothing {
    /// In what is looked at: `.png`, `.exr`, `.glb`.
    #[default]
    Pictures,
    /// In tables, too; but not in `.isolux`, which holds what was computed.
    All,
    None,
}

impl Smoothing {
    pub const ALL: [Smoothing; 3] = [Smoothing::Pictures, Smoothing::All, Smoothing::None];

    pub fn name(self) -> &'static str {
        match self {
            Smoothing::Pictures => "pictures",
            Smoothing::All => "all",
            Smoothing::None => "none",
        }
    }
}

/// All formats. A new one is a file in this folder and a line here.
pub const FORMATS: &[Exporter] = &[
    Exporter {
        ending: ".isolux",
        what: "the whole solution with its scene, to be read again",
        write: |lit, _| solution_file::write(lit.problem, lit.computed),
    },
    Exporter {
        ending: "-lightmap.glb",
        what: "the lit scene with its light in a texture",
        write: lightmap::write_unlit,
    },
    Exporter { ending: ".glb", what: "the lit scene, for any viewer of glTF", write: glb::write },
    Exporter { ending: PAGE, what: "the lit scene, as a page for any browser", write: html::write },
    Exporter { ending: ".png", what: "a picture for a screen", write: picture::write_png },
    Exporter { ending: ".exr", what: "a picture in cd/m², linear, for further work", write: picture::write_exr },
    Exporter { ending: ".ply", what: "elements as coloured triangles with their light", write: ply::write },
    Exporter { ending: ".vtu", what: "elements as cells with their light, for ParaView", write: vtu::write },
    Exporter { ending: ".csv", what: "a table with a row for each element", write: csv::write },
    Exporter { ending: ".npz", what: "arrays with a row for each element, for NumPy", write: npz::write },
    Exporter { ending: ".json", what: "a summary: totals, balance, light on each object", write: json::write },
];

/// How names of pages end.
pub const PAGE: &str = ".html";

/// The formats that this program can write: all, but for pages if it was built without the viewer.
pub fn writable() -> impl Iterator<Item = &'static Exporter> {
    FORMATS.iter().filter(|format| format.ending != PAGE || html::template().is_ok())
}

/// What a writer may be told. Each uses what concerns it.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportOptions {
    /// Name or number, from 0, of the camera of a picture; the scene's first, or a default view, if `None`.
    pub camera: Option<String>,
    /// Size of a picture in pixels. Without a height it follows from the camera's aspect, or is 16:9.
    pub width: u32,
    pub height: Option<u32>,
    /// Samples per pixel.
    pub samples: u32,
    /// Exposure of a picture in stops, a stop more is twice as bright (see [`isolux_core::view::tone`]); automatic if
    /// `None`.
    pub exposure: Option<f32>,
    pub smoothing: Smoothing,
    /// More entries for the summary: what only the caller knows, like the seconds it took.
    pub extras: serde_json::Map<String, serde_json::Value>,
}

impl Default for ExportOptions {
    fn default() -> ExportOptions {
        let extras = serde_json::Map::new();
        let smoothing = Smoothing::default();
        ExportOptions { camera: None, width: 1280, height: None, samples: 16, exposure: None, smoothing, extras }
    }
}

/// The writer for `path`, by how its name ends, in upper or lower case.
///
/// # Errors
/// [`Error::UnknownFormat`], which lists the known ones; [`Error::NoViewer`] for a page that this program cannot make.
pub fn for_path(path: &Path) -> Result<&'static Exporter, Error> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let fits = |format: &&Exporter| name.len() > format.ending.len() && name.ends_with(format.ending);
    let found = FORMATS.iter().find(fits).ok_or_else(|| {
        let known: Vec<&str> = writable().map(|format| format.ending).collect();
        Error::UnknownFormat {
            path: path.to_owned(),
            known: format!("a solution can be written as {}", known.join(", ")),
        }
    })?;
    if found.ending == PAGE {
        html::template()?;
    }
    Ok(found)
}

/// The error of an encoder that could not write `format`.
fn cannot_encode<E: std::fmt::Display>(format: &'static str) -> impl Fn(E) -> Error {
    move |e| Error::Invalid { file: format!(".{format} output"), place: "encoding".into(), what: e.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn formats_are_found_by_how_names_end() {
        let ending = |name: &str| for_path(Path::new(name)).unwrap().ending;
        assert_eq!(["a/b.x.VTU", "a/room.glb"].map(ending), [".vtu", ".glb"]);
        assert_eq!(["a/Room-Lightmap.GLB", "lightmap.glb"].map(ending), ["-lightmap.glb", ".glb"]);
        for path in ["a.doc", "csv", ".csv", "", "a."] {
            let message = for_path(Path::new(path)).unwrap_err().to_string();
            assert!(message.contains(".npz") && message.contains("unknown file type"), "{message}");
        }
    }

    #[test]
    fn every_format_writes_the_same_bytes_each_time() {
        let (problem, solution) = fixture::lit_box();
        for format in writable() {
            let write = || (format.write)(&LitScene::new(&problem, &solution), &ExportOptions::default()).unwrap();
            let bytes = write();
            assert!(!bytes.is_empty() && bytes == write(), "{}", format.ending);
        }
    }
}
