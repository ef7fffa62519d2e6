//! The light of a page: irradiance at the vertices and on the elements, with its errors, one set for each light group.

use super::part::Part;
use super::surfaces::Surfaces;
use crate::Error;
use crate::export::{ExportOptions, LitScene, Smoothing, json, picture};
use flate2::Compression;
use isolux_core::math::Rgb;
use isolux_core::math::estimate::student;
use isolux_core::view::camera_rays;
use isolux_core::view::{self, VertexField};
use isolux_core::{Problem, Solution};
use serde_json::{Value, json};

/// Of the error bars.
const CONFIDENCE: f64 = 0.95;
/// Degrees of freedom for which the page is told Student's t.
const FREEDOMS: u32 = 60;

/// The part of a page with the light on `surfaces`, packed; with the factors of the groups alone, if their light `is_known`.
///
/// # Errors
/// [`Error::Core`] for a camera that is not there.
pub fn part(
    lit: &LitScene,
    surfaces: &Surfaces,
    options: &ExportOptions,
    is_known: bool,
    packing: Compression,
) -> Result<Vec<u8>, Error> {
    let LitScene { problem, solution, .. } = lit;
    let mut part = Part::default();
    let exposure = view::exposure(problem, lit.field(), &picture::view_options(options))?;
    part.set("exposure_stops", json!(exposure.stops));
    part.set("camera", json!(first_camera(problem, options)?));
    part.set("smoothing", json!(if lit.draft.is_some() { Smoothing::None } else { lit.smoothing }.name()));
    part.set("students_t", (1..=FREEDOMS).map(|freedom| json!(student(CONFIDENCE, f64::from(freedom)))).collect());
    part.set("has_groups", json!(!solution.groups.is_empty()));
    part.set("summary", json::summary(problem, solution, &options.extras));
    if solution.groups.is_empty() {
        part.set("groups", json!([group("all light", Rgb::WHITE, solution)]));
        add_light(&mut part, 0, surfaces, lit.field(), solution);
        return part.finish(packing);
    }
    let one = |part: &isolux_core::solution::GroupLight| group(&part.group.name, part.factor, &part.solution);
    part.set("groups", solution.groups.iter().map(one).collect());
    if is_known {
        return part.finish(packing);
    }
    let mut field = None;
    for (k, group) in solution.groups.iter().enumerate() {
        let alone = &group.solution;
        let of_group = lit.field_of(alone, field.take());
        match lit.smoothing {
            Smoothing::All => add_light(&mut part, k, surfaces, &of_group, &view::smooth(problem, alone)),
            Smoothing::Pictures | Smoothing::None => add_light(&mut part, k, surfaces, &of_group, alone),
        }
        field = Some(of_group);
    }
    part.finish(packing)
}

/// A group of lamps: what it is called, how many times it emits what it did when it was solved, and the degrees of freedom of its error bars.
fn group(name: &str, factor: Rgb, solution: &Solution) -> Value {
    let freedom = solution.certainty.as_ref().map(|certainty| certainty.scene.freedom);
    json!({ "name": name, "factor": factor.to_array(), "freedom": freedom })
}

fn add_light(part: &mut Part, k: usize, surfaces: &Surfaces, field: &VertexField, solution: &Solution) {
    part.add_f16(&format!("vertex irradiance {k}"), &surfaces.irradiance(field));
    part.add_f32(&format!("irradiance {k}"), solution.irradiance.iter().map(|light| light.to_array()));
    let errors: Vec<[f32; 3]> = solution.std_error.iter().map(|error| error.to_array()).collect();
    part.add_f16(&format!("std_error {k}"), &errors);
}

/// Number of the camera to begin with, among those of [`Surfaces::part`]: after the scene's own comes the overview.
fn first_camera(problem: &Problem, options: &ExportOptions) -> Result<usize, Error> {
    let cameras = &problem.scene.cameras;
    let found = camera_rays::find(&problem.scene, options.camera.as_deref())?;
    let number = found.and_then(|found| cameras.iter().position(|camera| std::ptr::eq(camera, found)));
    Ok(number.unwrap_or(cameras.len()))
}
