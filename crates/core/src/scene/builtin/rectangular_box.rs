//! A box of six faces, one object each, every face with its own reflectivity and emission. With one element a face its
//! solution follows exactly from the rectangle form factors and a system of six equations.

use super::shapes::Builder;
use super::{BuiltIn, Expected, Parameter, Parameters};
use crate::Error;
use crate::math::Rgb;
use crate::scene::{Camera, Material, Scene};
use glam::Vec3;

pub const BOX: BuiltIn = BuiltIn {
    name: "box",
    what: "an empty box of six faces, each with its own reflectivity and emission",
    parameters: &[
        Parameter { name: "width", default: 4.0, range: [0.01, 1000.0], what: WHAT_LENGTH },
        Parameter { name: "height", default: 3.0, range: [0.01, 1000.0], what: WHAT_LENGTH },
        Parameter { name: "depth", default: 5.0, range: [0.01, 1000.0], what: WHAT_LENGTH },
    ],
    build,
    // 2 (4x3 + 3x5 + 5x4) m²; ceiling 20 m² x 1000 lm/m² and back 12 m² x 96.326 lm/m².
    expected: Expected { triangles: 12, area: 94.0, flux: 20_000.0 + 12.0 * 96.326 },
};

const WHAT_LENGTH: &str = "a length in metres, from 0.01 to 1000";

fn build(parameters: &Parameters) -> Result<Scene, Error> {
    let size = Vec3::from(["width", "height", "depth"].map(|name| parameters.get(name)));
    let faces = [
        ("left", Rgb::new(0.6, 0.2, 0.1), Rgb::BLACK),
        ("right", Rgb::new(0.2, 0.5, 0.7), Rgb::BLACK),
        ("floor", Rgb::new(0.3, 0.3, 0.25), Rgb::BLACK),
        ("ceiling", Rgb::grey(0.8), Rgb::grey(1000.0)),
        ("back", Rgb::grey(0.5), Rgb::new(150.0, 80.0, 100.0)),
        ("front", Rgb::grey(0.9), Rgb::BLACK),
    ];
    let mut builder = Builder::new("box");
    builder.look_inwards(true);
    let cuts = size.to_array().map(|edge| [0.0, edge]);
    for (k, (name, reflectivity, emission)) in faces.into_iter().enumerate() {
        let material = builder.material(Material { emission, ..Material::diffuse(name, reflectivity) });
        builder.object(name, material);
        let face = |axis, greater, _, _| (axis, greater) == (k / 2, k % 2 == 1);
        builder.cut_box([&cuts[0], &cuts[1], &cuts[2]], |p| p, face);
    }
    let eye = Vec3::new(0.5, 0.5, 0.98) * size;
    builder.camera(Camera::looking_at("camera", eye, Vec3::new(0.5, 0.45, 0.0) * size, 1.2));
    Ok(builder.finish())
}
