//! Where solvers go wrong: nothing to do, hardly anything to do, and far too much.

#![allow(clippy::unwrap_used)]

use glam::{DVec3, Vec3};
use isolux_core::math::Rgb;
use isolux_core::mesh::Resolution;
use isolux_core::scene::builtin::shapes::Builder;
use isolux_core::scene::{Light, LightKind, Material, Scene};
use isolux_core::{Problem, Solution};
use isolux_testing::contour::{convex_room_answer, element_corners};
use isolux_testing::ensemble::{assert_exact, ensemble, irradiances, solve, with_rays};
use isolux_testing::scenes::{brighten, cut, furnace, problem, scene, sphere_irradiance};

const WHITE: Rgb = Rgb::grey(0.7);
const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// Every number of a solution is finite, and the balance closes.
fn sound(problem: &Problem, rays: u64) -> Solution {
    let solution = solve(problem, with_rays(rays));
    let finite = solution.irradiance.iter().chain(&solution.std_error).all(|c| c.is_finite());
    assert!(finite, "{problem:?}");
    assert!(solution.balance.residual().abs() < 1e-6, "{problem:?}: {:?}", solution.balance);
    solution
}

fn is_dark(solution: &Solution) -> bool {
    solution.irradiance.iter().chain(&solution.std_error).all(|c| c.is_black())
}

/// A scene of polygons, each with its material.
fn polygons(parts: &[(Material, &[[f32; 3]])]) -> Scene {
    let mut builder = Builder::new("polygons");
    for (material, corners) in parts {
        let number = builder.material(material.clone());
        builder.object(&material.name, number);
        builder.polygon(&corners.iter().map(|&c| Vec3::from(c)).collect::<Vec<_>>());
    }
    builder.finish()
}

fn emitter() -> Material {
    Material { emission: Rgb::grey(10.0), ..Material::diffuse("emitter", WHITE) }
}

#[test]
fn without_emitter_there_is_no_light_and_no_error() {
    let mut scene = scene("cubes");
    brighten(&mut scene, 0.0);
    let solution = sound(&cut(scene, 1000), 100_000);
    assert!(is_dark(&solution));
    assert_eq!((solution.work.rays, solution.balance.emitted), (0, 0.0));
}

#[test]
fn one_element_alone_sends_all_its_light_into_the_void() {
    let problem = cut(polygons(&[(emitter(), &SQUARE[..3])]), 1);
    assert_eq!(problem.mesh.len(), 1);
    let solution = sound(&problem, 1000);
    assert!(is_dark(&solution));
    assert!((solution.balance.escaped / 5.0 - 1.0).abs() < 1e-6, "{:?}", solution.balance);
}

#[test]
fn an_emitter_that_faces_the_void_lights_nothing() {
    let behind = SQUARE.map(|[x, y, _]| [x, y, -1.0]);
    let problem = cut(polygons(&[(emitter(), &SQUARE), (Material::diffuse("wall", WHITE), &behind)]), 100);
    let solution = sound(&problem, 10_000);
    assert!(is_dark(&solution));
    assert!((solution.balance.escaped / 10.0 - 1.0).abs() < 1e-6);
}

#[test]
fn a_black_room_has_direct_light_only() {
    let mut room = scene("box");
    room.materials.iter_mut().for_each(|m| m.reflectivity = Rgb::BLACK);
    let problem = cut(room, 12);
    let runs = ensemble(&problem, with_rays(20_000), 32);
    assert_exact("black room", &problem, &irradiances(&runs), &convex_room_answer::<12>(&problem));
    assert_eq!(runs[0].balance.unshot, 0.0);
}

#[test]
fn a_lamp_alone_lights_a_room() {
    let mut room = scene("cubes");
    brighten(&mut room, 0.0);
    let kind = LightKind::Point { position: Vec3::new(2.0, 2.0, 2.0) };
    room.lights.push(Light { name: "lamp".into(), intensity: Rgb::grey(100.0), kind });
    let solution = sound(&cut(room, 1000), 200_000);
    assert!((solution.balance.emitted / (400.0 * std::f64::consts::PI) - 1.0).abs() < 1e-6);
    assert!(solution.balance.absorbed / solution.balance.emitted > 1.0 - 2e-6);
}

#[test]
fn hardly_any_light_is_absorbed() {
    let mut bright = scene("sphere");
    bright.materials.iter_mut().for_each(|m| m.reflectivity = Rgb::grey(0.995));
    let problem = cut(bright, 8 * 4);
    let runs = ensemble(&problem, with_rays(20_000), 32);
    assert_exact("bright sphere", &problem, &irradiances(&runs), &sphere_irradiance(&problem));
}

/// Such a room has no solution; the run ends all the same and says how much light is left.
#[test]
fn no_light_is_absorbed() {
    for reflectivity in [1.0, 1.5] {
        let mut endless = scene("sphere");
        endless.materials.iter_mut().for_each(|m| m.reflectivity = Rgb::grey(reflectivity));
        let balance = solve(&cut(endless, 8), with_rays(1000)).balance;
        assert!(balance.unshot > 0.9 * balance.emitted, "{balance:?}");
    }
}

#[test]
fn sixteen_rays_are_enough_for_an_answer() {
    let rough = sound(&problem("cornell-box", 500), 16);
    assert_eq!(rough.work.replicates, 16);
}

/// Two rooms with a two-sided wall between them, light in one only.
#[test]
fn no_light_leaks_through_a_wall() {
    let mut builder = Builder::new("rooms");
    let walls = builder.material(Material::diffuse("walls", WHITE));
    let partition = builder.material(Material { two_sided: true, ..Material::diffuse("partition", WHITE) });
    let lamp = builder.material(emitter());
    builder.look_inwards(true);
    builder.object("walls", walls);
    let cuts: [&[f32]; 3] = [&[0.0, 1.0, 2.0], &[0.0, 1.0], &[0.0, 1.0]];
    builder.cut_box(cuts, |p| p, |axis, greater, _, _| (axis, greater) != (0, false));
    builder.object("lamp", lamp);
    builder.cut_box(cuts, |p| p, |axis, greater, _, _| (axis, greater) == (0, false));
    builder.object("partition", partition);
    builder.polygon(&[[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0]].map(Vec3::from));
    let problem = cut(builder.finish(), 2000);
    let solution = sound(&problem, 1_000_000);
    let x = |e| element_corners(&problem, e).iter().sum::<DVec3>().x / 3.0;
    let dark = |e: u32| x(e) > 1.0 + 1e-6 || (x(e) > 1.0 - 1e-6 && problem.mesh.normal(e).x > 0.0);
    let is_black = |e: u32| solution.irradiance[e as usize].is_black();
    assert!(problem.mesh.elements().all(|e| dark(e) || !is_black(e)));
    // A ray that ends within rounding of the seam, one in a million, may be said to end on either side of it.
    let flux = |e: u32| (solution.irradiance[e as usize] * problem.mesh.area(e)).luminance_f64();
    let leaked: f64 = problem.mesh.elements().filter(|&e| dark(e)).map(flux).sum();
    assert!(leaked < 1e-5 * solution.balance.emitted, "{leaked} lm");
    assert!(problem.mesh.elements().filter(|&e| dark(e) && !is_black(e)).count() < 3);
    assert_eq!((solution.balance.escaped, solution.balance.back_face), (0.0, 0.0));
}

/// By a power of two, so that no coordinate is rounded.
#[test]
fn the_size_of_a_scene_does_not_matter() {
    let scaled = |factor: f32| {
        let mut scene = furnace(scene("cubes"));
        scene.vertices.iter_mut().for_each(|v| v.position *= factor);
        sound(&cut(scene, 1000), 50_000).irradiance
    };
    let (small, large) = (scaled(0.125), scaled(64.0));
    let apart = |(a, b): (&Rgb, &Rgb)| (*a - *b).to_array().into_iter().fold(0.0f32, |m, v| m.max(v.abs()));
    let most = small.iter().zip(&large).map(apart).fold(0.0, f32::max);
    assert!(most < 1e-5, "{most}");
}

#[test]
fn doubling_all_emission_doubles_all_light_bit_for_bit() {
    let solution = |factor| {
        let mut scene = scene("cornell-box");
        let kind = LightKind::Point { position: Vec3::splat(0.2) };
        scene.lights.push(Light { name: "lamp".into(), intensity: Rgb::new(1.0, 0.5, 0.2), kind });
        brighten(&mut scene, factor);
        sound(&Problem::new(scene, Resolution::Elements(1000)).unwrap(), 100_000)
    };
    let (single, double) = (solution(1.0), solution(2.0));
    let doubled = |values: &[Rgb]| values.iter().map(|&v| v * 2.0).collect::<Vec<_>>();
    assert_eq!(double.irradiance, doubled(&single.irradiance));
    assert_eq!(double.std_error, doubled(&single.std_error));
    assert_eq!(double.balance.absorbed, 2.0 * single.balance.absorbed);
}
