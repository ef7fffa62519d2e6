//! Light that was reflected at least once, apart from the rest: exact answers, and the books of all light.

#![allow(clippy::unwrap_used)]

use glam::Vec3;
use isolux_core::math::Rgb;
use isolux_core::scene::{Light, LightKind, Material, Scene};
use isolux_core::solvers::monte_carlo::axes::Lines;
use isolux_core::solvers::monte_carlo::{LightPart, Method, Settings};
use isolux_testing::battery::{Trial, methods, with_method};
use isolux_testing::budget::assert_t_of;
use isolux_testing::contour::{convex_room_answer, convex_room_direct};
use isolux_testing::ensemble::{
    Exact, assert_exact, deviations, ensemble, irradiances, refutes_exact, solve, with_rays,
};
use isolux_testing::projections::Deviation;
use isolux_testing::scenes::{cut, problem, scene};

fn indirect(settings: Settings) -> Settings {
    Settings { light: LightPart::Indirect, ..settings }
}

/// The methods that tell direct from reflected light.
fn telling() -> impl Iterator<Item = Trial> {
    methods().into_iter().filter(|trial| trial.method.check_light(LightPart::Indirect).is_ok())
}

/// `a + factor * b`, element by element.
fn plus(a: &Exact, factor: f64, b: &Exact) -> Exact {
    a.iter().zip(b).map(|(a, b)| std::array::from_fn(|c| a[c] + factor * b[c])).collect()
}

/// `scene` with the same grey everywhere.
fn painted(mut scene: Scene, reflectivity: f32, emission: f32) -> Scene {
    let grey =
        |name: &str| Material { emission: Rgb::grey(emission), ..Material::diffuse(name, Rgb::grey(reflectivity)) };
    scene.materials.iter_mut().for_each(|material| *material = grey(&material.name));
    scene
}

/// All light less `F Be`. The fault: a twentieth of the direct light is taken for reflected light, or all
/// of it where lines are global, for few bundles are noisy.
#[test]
fn whoever_tells_them_apart_has_the_reflected_light_of_a_box() {
    let problem = problem("box", 12);
    let direct = convex_room_direct::<12>(&problem);
    let exact = plus(&convex_room_answer::<12>(&problem), -1.0, &direct);
    for Trial { name, method } in telling() {
        let settings = indirect(with_method(method, Settings { replicates: 8, ..with_rays(40_000) }));
        let runs = irradiances(&ensemble(&problem, settings, 24));
        for Deviation { name: quantity, t, dof } in deviations(&problem, &runs, &exact) {
            assert_t_of("indirect light: box", &format!("{name}: {quantity}"), t, dof);
        }
        let fault = if method.lines == Lines::Local { 0.05 } else { 1.0 };
        assert!(refutes_exact(&problem, &runs, &plus(&exact, -fault, &direct)), "{name}");
    }
}

/// Where everything emits 0.4 and reflects 0.6 of the radiosity 1, 0.4 of the irradiance is direct.
#[test]
fn a_furnace_reflects_its_reflectivity() {
    let problem = cut(painted(scene("cubes"), 0.6, 0.4), 1500);
    let runs = irradiances(&ensemble(&problem, indirect(with_rays(100_000)), 32));
    assert_exact("indirect light: furnace", &problem, &runs, &vec![[f64::from(0.6f32); 3]; problem.mesh.len()]);
}

/// Inside a sphere of radius 1 that reflects half, what is reflected is as much as the light without extent sends, I / R².
#[test]
fn the_light_of_lamps_is_direct() {
    let mut sphere = painted(scene("sphere"), 0.5, 0.0);
    let intensity = Rgb::new(100.0, 50.0, 20.0);
    sphere.lights.push(Light { name: "light".into(), intensity, kind: LightKind::Point { position: Vec3::ZERO } });
    let problem = cut(sphere, 8 * 16);
    let runs = irradiances(&ensemble(&problem, indirect(with_rays(30_000)), 32));
    assert_exact("indirect light: point light", &problem, &runs, &vec![[100.0, 50.0, 20.0]; problem.mesh.len()]);
}

#[test]
fn the_books_are_those_of_all_light() {
    let problem = problem("cornell-box", 2000);
    for Trial { name, method } in telling() {
        let settings = Settings { method, replicates: 8, ..with_rays(50_000) };
        let [all, part] = [settings, indirect(settings)].map(|settings| solve(&problem, settings));
        assert_eq!(all.balance, part.balance, "{name}");
        assert_eq!(all.work, part.work, "{name}");
        assert!(part.provenance.parameter("light") == Some("indirect"), "{name}");
    }
}

/// Nothing is reflected in a black room, and nothing is left of it.
#[test]
fn a_black_room_has_no_indirect_light() {
    let mut black = scene("box");
    black.materials.iter_mut().for_each(|material| material.reflectivity = Rgb::BLACK);
    let problem = cut(black, 200);
    let solution = solve(&problem, indirect(with_rays(20_000)));
    assert!(solution.irradiance.iter().all(|lux| lux.is_black()) && solution.balance.absorbed > 0.0);
}

#[test]
fn methods_that_cannot_tell_are_refused_before_they_start() {
    let problem = problem("box", 12);
    for name in ["wdrs", "random-walk", "particle-tracing", "keller"] {
        let settings = indirect(Settings { method: Method::named(name).unwrap(), ..with_rays(8_000) });
        let error = isolux_core::solvers::MonteCarlo::new(&problem, settings).unwrap_err();
        assert!(error.to_string().contains("cannot be told apart"), "{error}");
    }
}
