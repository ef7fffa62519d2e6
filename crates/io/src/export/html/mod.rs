//! The lit scene as one page for any browser, which needs nothing else and no network.
//!
//! The page is that of `viewer/`, built by `make viewer` and put into this program by `build.rs`; what it shows is inserted as text:
//! packed [`part`]s in base64. [`Surfaces`] are one part and their light another, so that new light can be sent to
//! a page that is open (`isolux solve --live`), and two solutions of the same surfaces have them once.

mod batch;
mod light;
mod part;
mod surfaces;

pub use surfaces::Surfaces;

use super::{ExportOptions, LitScene};
use crate::Error;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use isolux_core::solution::GroupLight;
use isolux_core::{Problem, Solution};
use serde_json::{Value, json};

/// The built page; empty if there was none when this program was built.
const PAGE: &str = include_str!(concat!(env!("OUT_DIR"), "/viewer.html"));
/// Where in the page the parts belong.
const PLACE: &str = "<!-- isolux: what this page shows -->";
/// No browser holds a longer text [bytes].
const LONGEST: usize = 500_000_000;

/// The page of `lit`.
///
/// # Errors
/// [`Error::NoViewer`]; [`Error::Core`] for a camera that is not there; [`Error::Invalid`] for more than browsers can read.
pub fn write(lit: &LitScene, options: &ExportOptions) -> Result<Vec<u8>, Error> {
    let surfaces = surfaces(lit);
    let light = light_part(lit, &surfaces, options)?;
    page(&json!({}), &[("surfaces", &surfaces.part(lit.problem)?), ("light", &light)])
}

/// A page that shows two solutions side by side. Each has a name.
///
/// # Errors
/// Those of [`write`].
pub fn write_compared(
    (after, name): (&LitScene, &str),
    (before, name_before): (&LitScene, &str),
    options: &ExportOptions,
) -> Result<Vec<u8>, Error> {
    let (surfaces, surfaces_before) = (surfaces(after), surfaces(before));
    let (part, part_before) = (surfaces.part(after.problem)?, surfaces_before.part(before.problem)?);
    let light = light_part(after, &surfaces, options)?;
    let is_mixture = part == part_before && is_mixture_of_same(&after.solution, &before.solution);
    let light_before = light::part(before, &surfaces_before, options, is_mixture, Compression::default())?;
    let about = json!({ "compared": {
        "names": [name, name_before],
        "same_elements": has_same_elements(after.problem, before.problem),
    } });
    let mut parts: Vec<(&str, &[u8])> = vec![("surfaces", &part), ("light", &light), ("light-before", &light_before)];
    if part != part_before {
        parts.push(("surfaces-before", &part_before));
    }
    page(&about, &parts)
}

/// The page that asks its server for what it shows: `surfaces`, `light`, and how far the solve is (`revision`).
///
/// # Errors
/// [`Error::NoViewer`].
pub fn live_page() -> Result<Vec<u8>, Error> {
    page(&json!({ "live": true }), &[])
}

/// The surfaces that show `lit`.
pub fn surfaces(lit: &LitScene) -> Surfaces {
    Surfaces::new(lit.problem, lit.field(), &lit.solution.groups, lit.draft.is_some())
}

/// The light of `lit` on `surfaces`, which were made for the same problem. Drafts are packed in a hurry.
///
/// # Errors
/// [`Error::Core`] for a camera that is not there.
pub fn light_part(lit: &LitScene, surfaces: &Surfaces, options: &ExportOptions) -> Result<Vec<u8>, Error> {
    let packing = if lit.draft.is_some() { Compression::fast() } else { Compression::default() };
    light::part(lit, surfaces, options, false, packing)
}

/// The built page, with nothing to show.
///
/// # Errors
/// [`Error::NoViewer`] if this program was built without it.
pub fn template() -> Result<(&'static str, &'static str), Error> {
    PAGE.split_once(PLACE).ok_or(Error::NoViewer)
}

fn page(about: &Value, parts: &[(&str, &[u8])]) -> Result<Vec<u8>, Error> {
    let (head, tail) = template()?;
    // Names must not end the script early.
    let about = about.to_string().replace('<', "\\u003c");
    let mut page = format!("{head}<script type=\"application/json\" id=\"about\">{about}</script>\n");
    for (id, bytes) in parts {
        page += &format!("<script type=\"application/octet-stream;base64\" id=\"{id}\">");
        STANDARD.encode_string(bytes, &mut page);
        page += "</script>\n";
    }
    page += tail;
    if page.len() > LONGEST {
        let what = format!(
            "the page would have {} MB, more than browsers read; solve with fewer --elements",
            page.len() / 1_000_000
        );
        return Err(super::cannot_encode("html")(what));
    }
    Ok(page.into_bytes())
}

/// Whether both are made of the light of the same groups of lamps, each with factors of its own.
fn is_mixture_of_same(one: &Solution, other: &Solution) -> bool {
    let same = |(a, b): (&GroupLight, &GroupLight)| a.group == b.group && a.solution == b.solution;
    !one.groups.is_empty() && one.groups.len() == other.groups.len() && one.groups.iter().zip(&other.groups).all(same)
}

/// Whether values of the elements of one can be compared with those of the other: same triangles, cut alike.
fn has_same_elements(one: &Problem, other: &Problem) -> bool {
    let (a, b) = (&one.scene, &other.scene);
    let corners = |problem: &Problem| problem.scene.vertices.iter().map(|v| v.position).collect::<Vec<_>>();
    a.triangles == b.triangles && corners(one) == corners(other) && one.mesh.cut() == other.mesh.cut()
}

#[cfg(test)]
mod tests;
