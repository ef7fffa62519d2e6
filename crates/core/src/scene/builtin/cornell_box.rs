//! The Cornell box: geometry measured at Cornell University (graphics.cornell.edu/online/box/data.html), in metres, with
//! the RGB reflectances and the RGB radiance that renderers agree on for it. The front is open; the two boxes have no
//! bottoms; everything is one-sided.

use super::shapes::Builder;
use super::{BuiltIn, Expected, Parameters};
use crate::Error;
use crate::math::Rgb;
use crate::scene::{Camera, Material, Scene};
use glam::Vec3;
use std::f32::consts::PI;

pub const CORNELL_BOX: BuiltIn = BuiltIn {
    name: "cornell-box",
    what: "the Cornell box: measured geometry, RGB reflectances, open in front",
    parameters: &[],
    build,
    expected: Expected { triangles: 38, area: 1.920_70, flux: 0.13 * 0.105 * PI as f64 * 14.400_6 },
};

/// Radiance of the light; isolux takes it as cd/m².
const LIGHT: Rgb = Rgb::new(18.387, 18.387 * 0.760_716_8, 18.387 * 0.367_301_4);
const WHITE: Rgb = Rgb::new(0.885_809, 0.698_859, 0.666_422);
const RED: Rgb = Rgb::new(0.570_068, 0.043_013_5, 0.044_370_6);
const GREEN: Rgb = Rgb::new(0.105_421, 0.377_98, 0.076_425);

/// Corners of quads as published [mm], counter-clockwise seen from inside the room, or from outside a box.
type Quads = &'static [[[f32; 3]; 4]];

const FLOOR: Quads = &[[[552.8, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 559.2], [549.6, 0.0, 559.2]]];
const PANEL: Quads = &[[[343.0, 548.8, 227.0], [343.0, 548.8, 332.0], [213.0, 548.8, 332.0], [213.0, 548.8, 227.0]]];
const CEILING: Quads = &[
    [[556.0, 548.8, 0.0], [556.0, 548.8, 559.2], [343.0, 548.8, 332.0], [343.0, 548.8, 227.0]],
    [[556.0, 548.8, 559.2], [0.0, 548.8, 559.2], [213.0, 548.8, 332.0], [343.0, 548.8, 332.0]],
    [[0.0, 548.8, 559.2], [0.0, 548.8, 0.0], [213.0, 548.8, 227.0], [213.0, 548.8, 332.0]],
    [[0.0, 548.8, 0.0], [556.0, 548.8, 0.0], [343.0, 548.8, 227.0], [213.0, 548.8, 227.0]],
];
const BACK: Quads = &[[[549.6, 0.0, 559.2], [0.0, 0.0, 559.2], [0.0, 548.8, 559.2], [556.0, 548.8, 559.2]]];
const RIGHT: Quads = &[[[0.0, 0.0, 559.2], [0.0, 0.0, 0.0], [0.0, 548.8, 0.0], [0.0, 548.8, 559.2]]];
const LEFT: Quads = &[[[552.8, 0.0, 0.0], [549.6, 0.0, 559.2], [556.0, 548.8, 559.2], [556.0, 548.8, 0.0]]];
const SMALL_BOX: Quads = &[
    [[130.0, 165.0, 65.0], [82.0, 165.0, 225.0], [240.0, 165.0, 272.0], [290.0, 165.0, 114.0]],
    [[290.0, 0.0, 114.0], [290.0, 165.0, 114.0], [240.0, 165.0, 272.0], [240.0, 0.0, 272.0]],
    [[130.0, 0.0, 65.0], [130.0, 165.0, 65.0], [290.0, 165.0, 114.0], [290.0, 0.0, 114.0]],
    [[82.0, 0.0, 225.0], [82.0, 165.0, 225.0], [130.0, 165.0, 65.0], [130.0, 0.0, 65.0]],
    [[240.0, 0.0, 272.0], [240.0, 165.0, 272.0], [82.0, 165.0, 225.0], [82.0, 0.0, 225.0]],
];
const LARGE_BOX: Quads = &[
    [[423.0, 330.0, 247.0], [265.0, 330.0, 296.0], [314.0, 330.0, 456.0], [472.0, 330.0, 406.0]],
    [[423.0, 0.0, 247.0], [423.0, 330.0, 247.0], [472.0, 330.0, 406.0], [472.0, 0.0, 406.0]],
    [[472.0, 0.0, 406.0], [472.0, 330.0, 406.0], [314.0, 330.0, 456.0], [314.0, 0.0, 456.0]],
    [[314.0, 0.0, 456.0], [314.0, 330.0, 456.0], [265.0, 330.0, 296.0], [265.0, 0.0, 296.0]],
    [[265.0, 0.0, 296.0], [265.0, 330.0, 296.0], [423.0, 330.0, 247.0], [423.0, 0.0, 247.0]],
];

fn build(_: &Parameters) -> Result<Scene, Error> {
    let mut builder = Builder::new("cornell-box");
    let white = builder.material(Material::diffuse("white", WHITE));
    let red = builder.material(Material::diffuse("red", RED));
    let green = builder.material(Material::diffuse("green", GREEN));
    let light = builder.material(Material { emission: LIGHT * PI, ..Material::diffuse("light", WHITE) });
    let surfaces: [(&str, u32, Quads); 8] = [
        ("floor", white, FLOOR),
        ("light", light, PANEL),
        ("ceiling", white, CEILING),
        ("back", white, BACK),
        ("green-wall", green, RIGHT),
        ("red-wall", red, LEFT),
        ("small-box", white, SMALL_BOX),
        ("large-box", white, LARGE_BOX),
    ];
    for (name, material, quads) in surfaces {
        builder.object(name, material);
        quads.iter().for_each(|quad| builder.polygon(&quad.map(|p| Vec3::from_array(p) / 1000.0)));
    }
    let position = Vec3::new(0.278, 0.273, -0.8);
    let camera = Camera::looking_at("camera", position, position + Vec3::Z, 0.686_047_9);
    builder.camera(Camera { aspect: Some(1.0), ..camera });
    Ok(builder.finish())
}
