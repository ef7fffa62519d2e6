//! Readers, one format a file.
//!
//! A reader turns bytes into a [`Scene`]: world space, metres, linear colours, exitance in lm/m². What it had to assume,
//! and what it left out, it says in [`Scene::remarks`]; what it cannot make sense of is an error that names the place.
//! No content of a file makes a reader panic, hang or take memory out of proportion to the file.

mod builder;
mod gltf;
mod images;
mod obj;
mod ply;
mod polygon;
mod stl;

use crate::{Error, files};
use isolux_core::scene::Scene;
use std::path::Path;

/// A file format that scenes are read from: one line of [`FORMATS`].
pub struct Importer {
    /// What people call the format.
    pub name: &'static str,
    /// Extensions by which it is known, lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// What is taken from such a file, for `isolux list`.
    pub what: &'static str,
    /// Reads the content of the file at the path, and files that it refers to from beside it.
    pub read: fn(&Path, &[u8], &ImportOptions) -> Result<Scene, Error>,
}

/// Every format that scenes are read from.
pub const FORMATS: &[Importer] = &[
    Importer {
        name: "glTF 2.0",
        extensions: &["glb", "gltf"],
        what: "nodes, instances, textures, emission, punctual lights, cameras",
        read: gltf::read,
    },
    Importer {
        name: "Wavefront OBJ",
        extensions: &["obj"],
        what: "polygons, groups, MTL materials (Kd, Ke, map_Kd)",
        read: obj::read,
    },
    Importer { name: "PLY", extensions: &["ply"], what: "polygons, vertex colours as reflectivity", read: ply::read },
    Importer { name: "STL", extensions: &["stl"], what: "triangles, in a default grey", read: stl::read },
];

/// What a reader is told besides the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ImportOptions {
    /// How the intensities of KHR_lights_punctual are meant.
    pub light_units: LightUnits,
    pub insides: Insides,
}

/// What happens to those sides of closed two-sided surfaces that nobody can see: see [`Scene::hide_insides`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Insides {
    /// They are no surfaces.
    #[default]
    Hide,
    /// They are surfaces like any other, as the file says.
    Keep,
}

impl Insides {
    pub const ALL: [Insides; 2] = [Insides::Hide, Insides::Keep];

    pub fn name(self) -> &'static str {
        match self {
            Insides::Hide => "hide",
            Insides::Keep => "keep",
        }
    }
}

/// How the intensities of punctual lights in a glTF file are meant. The names are those of the lighting modes of
/// Blender's exporter, which writes all three without saying which; the results here are always candela and lux.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightUnits {
    /// As KHR_lights_punctual says: candela for point and spot lights, lux for directional ones.
    #[default]
    Spec,
    /// W/sr for point and spot lights, W/m² for directional ones; times 683 lm/W.
    Compat,
    /// W for point and spot lights, spread over 4 pi sr, and W/m² for directional ones; times 683 lm/W.
    Raw,
}

/// Reads the scene file at `path`; its extension tells the format.
///
/// # Errors
/// [`Error::UnknownFormat`] for an extension that is not in [`FORMATS`], [`Error::File`] for a file (or one that it
/// refers to) that cannot be read, [`Error::Invalid`] for content that makes no sense.
pub fn read_scene(path: &Path, options: &ImportOptions) -> Result<Scene, Error> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let Some(format) = FORMATS.iter().find(|f| f.extensions.contains(&extension.as_str())) else {
        let known: Vec<String> =
            FORMATS.iter().map(|f| format!("{} (.{})", f.name, f.extensions.join(", ."))).collect();
        let known = format!("isolux reads {}; export the scene as one of these, best as .glb", known.join(", "));
        return Err(Error::UnknownFormat { path: path.to_owned(), known });
    };
    let mut scene = (format.read)(path, &files::read(path)?, options)?;
    scene.name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    if options.insides == Insides::Hide {
        let objects = scene.hide_insides();
        scene.remarks.extend(remark(&objects));
    }
    Ok(scene)
}

/// What there is to say about `objects` whose insides are hidden.
fn remark(objects: &[String]) -> Option<String> {
    let named: Vec<String> = objects.iter().take(NAMED).map(|name| format!("'{name}'")).collect();
    let more = if objects.len() > NAMED { format!(" and {} more", objects.len() - NAMED) } else { String::new() };
    let named = named.join(", ");
    let what = format!("closed surfaces of {named}{more}: only the side that can be seen counts");
    (!objects.is_empty()).then_some(what)
}

/// How many objects a remark names.
const NAMED: usize = 3;

/// Reads the file that `reference` names from beside `path`.
fn read_beside(path: &Path, reference: &str) -> Result<Vec<u8>, Error> {
    files::read(&path.parent().unwrap_or(Path::new("")).join(reference.replace('\\', "/")))
}
