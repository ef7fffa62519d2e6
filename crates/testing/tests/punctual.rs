//! Lights without extent, against the solid angles under which they see elements.

use glam::{DVec3, Vec3};
use isolux_core::Problem;
use isolux_core::math::Rgb;
use isolux_core::scene::builtin::shapes::Builder;
use isolux_core::scene::{Light, LightKind, Material, Scene};
use isolux_testing::contour::element_corners;
use isolux_testing::ensemble::{Exact, assert_exact, ensemble, irradiances, refutes_exact, with_rays};
use isolux_testing::scenes::{cut, scene};

const INTENSITY: Rgb = Rgb::new(100.0, 50.0, 20.0);
const POSITION: Vec3 = Vec3::new(1.3, 1.9, 2.2);

/// A built-in scene in which nothing emits but a light, everything with the same reflectivity.
fn lit(name: &str, reflectivity: f32, kind: LightKind) -> Scene {
    let mut scene = scene(name);
    scene.materials.iter_mut().for_each(|m| *m = Material::diffuse(&m.name, Rgb::grey(reflectivity)));
    scene.lights.push(Light { name: "light".into(), intensity: INTENSITY, kind });
    scene
}

fn runs(problem: &Problem) -> Vec<Vec<Rgb>> {
    irradiances(&ensemble(problem, with_rays(30_000), 32))
}

/// `INTENSITY` times a number for each element.
fn colored(values: impl Iterator<Item = f64>) -> Exact {
    values.map(|value| INTENSITY.to_array().map(|i| f64::from(i) * value)).collect()
}

fn area([a, b, c]: [DVec3; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}

/// Solid angle of a triangle seen from the origin (Van Oosterom & Strackee 1983).
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let below = la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la;
    2.0 * a.dot(b.cross(c)).abs().atan2(below)
}

#[test]
fn a_point_light_in_a_black_box_lights_by_solid_angle() {
    let problem = cut(lit("box", 0.0, LightKind::Point { position: POSITION }), 300);
    let irradiance = |e: u32| {
        let corners = element_corners(&problem, e);
        solid_angle(corners.map(|p| p - POSITION.as_dvec3())) / area(corners)
    };
    let exact = colored(problem.mesh.elements().map(irradiance));
    let runs = runs(&problem);
    assert_exact("point light in a black box", &problem, &runs, &exact);
    // The fault: the light a centimetre from where it should be.
    let position = POSITION + Vec3::X * 0.01;
    let moved = cut(lit("box", 0.0, LightKind::Point { position }), 300);
    assert!(refutes_exact(&moved, &irradiances(&ensemble(&moved, with_rays(30_000), 32)), &exact));
}

/// I / R² directly, and as much again for every reflection.
#[test]
fn a_point_light_in_the_middle_of_a_sphere_lights_it_evenly() {
    for reflectivity in [0.0f32, 0.5] {
        let problem = cut(lit("sphere", reflectivity, LightKind::Point { position: Vec3::ZERO }), 8 * 16);
        let irradiance = 1.0 / (1.0 - f64::from(reflectivity));
        let exact = colored(problem.mesh.elements().map(|_| irradiance));
        assert_exact("point light in a sphere", &problem, &runs(&problem), &exact);
    }
}

/// The intensity of the spot over the solid angle of each element, by the midpoint rule on a fine grid.
#[test]
fn a_spot_in_a_black_box_lights_what_lies_in_its_cone() {
    let (inner_angle, outer_angle) = (0.4, 0.9);
    let direction = Vec3::new(0.3, -1.0, -0.2).normalize();
    let problem =
        cut(lit("box", 0.0, LightKind::Spot { position: POSITION, direction, inner_angle, outer_angle }), 300);
    let irradiance = |e: u32| {
        let seen = element_corners(&problem, e).map(|p| p - POSITION.as_dvec3());
        let falloff = |[a, b, c]: [DVec3; 3]| {
            let cos = (a + b + c).normalize().dot(direction.as_dvec3());
            f64::from(Light::spot_falloff(cos as f32, inner_angle, outer_angle))
        };
        quarters(seen, 6).into_iter().map(|piece| falloff(piece) * solid_angle(piece)).sum::<f64>() / area(seen)
    };
    let exact = colored(problem.mesh.elements().map(irradiance));
    assert_exact("spot in a black box", &problem, &runs(&problem), &exact);
}

/// A triangle cut into four, again and again.
fn quarters(triangle: [DVec3; 3], times: u32) -> Vec<[DVec3; 3]> {
    (0..times).fold(vec![triangle], |pieces, _| {
        let cut = |[a, b, c]: [DVec3; 3]| {
            let (ab, bc, ca) = (a.midpoint(b), b.midpoint(c), c.midpoint(a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        pieces.into_iter().flat_map(cut).collect()
    })
}

#[test]
fn the_sun_lights_a_floor_by_the_cosine() {
    let direction = Vec3::new(0.5, -1.0, 0.3).normalize();
    let mut builder = Builder::new("floor");
    let grey = builder.material(Material::diffuse("grey", Rgb::grey(0.5)));
    builder.object("floor", grey);
    builder.polygon(&[[0.0, 0.0, 0.0], [0.0, 0.0, 2.0], [3.0, 0.0, 2.0], [3.0, 0.0, 0.0]].map(Vec3::from));
    let mut floor = builder.finish();
    floor.lights.push(Light { name: "sun".into(), intensity: INTENSITY, kind: LightKind::Directional { direction } });
    let problem = cut(floor, 50);
    let exact = colored(problem.mesh.elements().map(|_| -f64::from(direction.y)));
    assert_exact("sun on a floor", &problem, &runs(&problem), &exact);
}
