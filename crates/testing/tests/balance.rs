//! All light is accounted for: emitted = absorbed + escaped + lost at back faces + unshot, in every scene.

use glam::Vec3;
use isolux_core::math::Rgb;
use isolux_core::math::moments::Moments;
use isolux_core::scene::builtin::BUILT_IN;
use isolux_core::scene::{Light, LightKind, Material, Scene};
use isolux_core::{Problem, Solution};
use isolux_testing::budget::assert_t;
use isolux_testing::contour::convex_room_answer;
use isolux_testing::ensemble::{ensemble, solve, with_rays};
use isolux_testing::scenes::{cut, flip, problem, scene};

/// Solves, and refuses a balance that does not close to 10^-6 of the emitted power.
fn balanced(problem: &Problem) -> Solution {
    let solution = solve(problem, with_rays(100_000));
    let balance = solution.balance;
    assert!(balance.residual().abs() < 1e-6, "{problem:?}: {} of {balance:?}", balance.residual());
    assert!((0.0..1e-6).contains(&(balance.unshot / balance.emitted)), "{problem:?}: {balance:?}");
    assert!(balance.absorbed >= 0.0 && balance.escaped >= 0.0 && balance.back_face >= 0.0);
    solution
}

fn luminous_flux(problem: &Problem) -> f64 {
    problem.mesh.elements().map(|e| problem.mesh.emitted_flux(e).luminance_f64()).sum()
}

#[test]
fn every_built_in_scene_is_balanced() {
    for entry in &BUILT_IN {
        let problem = problem(entry.name, 2000);
        let balance = balanced(&problem).balance;
        assert!((balance.emitted / luminous_flux(&problem) - 1.0).abs() < 1e-6, "{}", entry.name);
        assert_eq!(balance.escaped > 0.0, entry.name == "cornell-box", "{} is open: {balance:?}", entry.name);
    }
}

#[test]
fn bright_rooms_are_balanced() {
    for name in ["labyrinth:rho=0.99", "labyrinth:rho=0.999", "sphere:rho=0.99", "sphere:rho=0.999"] {
        balanced(&problem(name, 1000));
    }
}

/// The Cornell box with a light of each kind: those of the sun and the spot partly miss it.
#[test]
fn a_scene_with_lights_without_extent_is_balanced() {
    let mut scene = scene("cornell-box");
    let position = Vec3::new(0.2, 0.4, 0.2);
    let direction = Vec3::new(0.3, -1.0, 0.5).normalize();
    let kinds = [
        LightKind::Point { position },
        LightKind::Spot { position, direction, inner_angle: 0.2, outer_angle: 0.7 },
        LightKind::Directional { direction },
    ];
    let light = |kind| Light { name: String::new(), intensity: Rgb::new(3.0, 2.0, 0.5), kind };
    scene.lights = kinds.map(light).to_vec();
    let problem = cut(scene, 2000);
    let balance = balanced(&problem).balance;
    let radius = problem.geometry.bounding_sphere().1;
    let lights: f64 = problem.scene.lights.iter().map(|l| l.flux(radius).luminance_f64()).sum();
    assert!((balance.emitted / (lights + luminous_flux(&problem)) - 1.0).abs() < 1e-6);
}

/// The back of a wall that looks the wrong way takes what a black wall would: all that falls on it.
#[test]
fn a_flipped_wall_swallows_what_falls_on_it() {
    const WALL: &str = "left";
    let mut black = scene("box");
    black.materials[0] = Material::diffuse("black", Rgb::BLACK);
    let mut flipped = black.clone();
    flip(&mut flipped, WALL);
    let black = cut(black, 12);
    let flux = on_object(&black, &convex_room_answer::<12>(&black), WALL);
    let flipped = cut(flipped, 12);
    balanced(&flipped);
    let runs = ensemble(&flipped, with_rays(20_000), 32);
    let moments: Moments = runs.iter().map(|run| run.balance.back_face).collect();
    assert_t("back face of a flipped wall", (moments.mean - flux) / moments.std_error(), 31.0);
}

/// Luminous flux [lm] that falls on an object.
fn on_object(problem: &Problem, irradiance: &[[f64; 3]], name: &str) -> f64 {
    let Scene { triangles, objects, .. } = &problem.scene;
    let on = |e: &u32| objects[triangles[problem.mesh.triangle(*e) as usize].object as usize].name == name;
    let flux = |e: u32| {
        let [r, g, b] = irradiance[e as usize];
        f64::from(problem.mesh.area(e)) * (0.2126 * r + 0.7152 * g + 0.0722 * b)
    };
    problem.mesh.elements().filter(on).map(flux).sum()
}
