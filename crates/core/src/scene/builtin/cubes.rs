//! Cubes: a closed box room of 4 m x 3 m x 4 m with a square emitter in its ceiling and two cubes standing 1 mm above the
//! floor. Smooth light with hard contacts: the second scene of the empirical comparison of Bekaert et al., WSCG 1999.

use super::shapes::Builder;
use super::{BuiltIn, Expected, Parameters};
use crate::Error;
use crate::math::Rgb;
use crate::scene::{Camera, Material, Scene};
use glam::{Affine3A, Quat, Vec3};
use std::f32::consts::PI;

pub const CUBES: BuiltIn = BuiltIn {
    name: "cubes",
    what: "a closed room of 4 x 3 x 4 m, an emitter in its ceiling, two cubes on its floor",
    parameters: &[],
    build,
    // Room 2 (16 + 12 + 12) m² in 30 quads, cubes 6 (1.2² + 0.8²) m²; one square metre of pi 1000 lm/m².
    expected: Expected { triangles: 60 + 24, area: 80.0 + 12.48, flux: 1000.0 * PI as f64 },
};

/// Luminance of the emitter [cd/m²].
const LUMINANCE: f32 = 1000.0;

fn build(_: &Parameters) -> Result<Scene, Error> {
    let mut builder = Builder::new("cubes");
    builder.look_inwards(true);
    let mut diffuse = |name: &str, r, g, b| builder.material(Material::diffuse(name, Rgb::new(r, g, b)));
    let white = diffuse("white", 0.7, 0.7, 0.7);
    let [left, right] = [diffuse("terracotta", 0.6, 0.3, 0.2), diffuse("blue", 0.25, 0.35, 0.6)];
    let [large, small] = [diffuse("grey", 0.5, 0.5, 0.5), diffuse("yellow", 0.7, 0.55, 0.2)];
    let emission = Rgb::grey(PI * LUMINANCE);
    let light = builder.material(Material { emission, ..Material::diffuse("light", Rgb::grey(0.5)) });

    // All faces are cut at the emitter's edges, so that the room has no T-junctions.
    let (across, up) = ([0.0, 1.5, 2.5, 4.0], [0.0, 3.0]);
    let mut face = |name: &str, material, keep: &dyn Fn(usize, bool, bool) -> bool| {
        builder.object(name, material);
        let keep = |axis, greater, i, j| keep(axis, greater, (i, j) == (1, 1));
        builder.cut_box([&across, &up, &across], |p| p, keep);
    };
    face("left-wall", left, &|axis, greater, _| (axis, greater) == (0, false));
    face("right-wall", right, &|axis, greater, _| (axis, greater) == (0, true));
    face("floor", white, &|axis, greater, _| (axis, greater) == (1, false));
    face("ceiling", white, &|axis, greater, middle| (axis, greater, middle) == (1, true, false));
    face("light", light, &|axis, greater, middle| (axis, greater, middle) == (1, true, true));
    face("back-wall", white, &|axis, greater, _| (axis, greater) == (2, false));
    face("front-wall", white, &|axis, greater, _| (axis, greater) == (2, true));

    builder.look_inwards(false);
    for (name, material, edge, x, z, turn) in
        [("large-cube", large, 1.2, 1.3, 1.3, 0.3), ("small-cube", small, 0.8, 2.8, 2.4, -0.4)]
    {
        builder.object(name, material);
        let position = Vec3::new(x, 0.001, z);
        builder.place(Affine3A::from_rotation_translation(Quat::from_rotation_y(turn), position));
        let half = 0.5 * edge;
        builder.cuboid(Vec3::new(-half, 0.0, -half), Vec3::new(half, edge, half));
    }
    builder.camera(Camera::looking_at("camera", Vec3::new(2.0, 1.7, 3.95), Vec3::new(2.0, 1.1, 0.5), 1.3));
    Ok(builder.finish())
}
