//! Direct light of its own estimator: against exact form factors, against shooting, and where it should be nothing.

#![allow(clippy::unwrap_used)]

use glam::Vec3;
use isolux_core::Problem;
use isolux_core::form_factors::contour::point_to_polygon;
use isolux_core::math::Rgb;
use isolux_core::math::moments::Moments;
use isolux_core::sampling::OwenSobol;
use isolux_core::scene::builtin::shapes::Builder;
use isolux_core::scene::{Light, LightKind, Material, Scene};
use isolux_core::solvers::direct_light::DirectLight;
use isolux_core::transport::direct_light::{DirectEstimator, Rays, Sight};
use isolux_core::transport::light_sampling::{LightSampler, Receiver};
use isolux_testing::budget::{assert_t, refutes};
use isolux_testing::contour::{element_corners, form_factors};
use isolux_testing::ensemble::{Exact, assert_exact, constant_elements, ensemble, irradiances, refutes_exact};
use isolux_testing::exact::{BLOCKED_SQUARES, parallel_rectangles, perpendicular_rectangles};
use isolux_testing::projections::projections;
use isolux_testing::scenes::{brighten, cut, problem, scene};
use isolux_testing::statistics::p_of_t;
use rayon::prelude::*;

const RUNS: u64 = 32;
/// Light rays alone, cosine rays alone, and both.
const KINDS: [Rays; 3] = [Rays { light: 64, cosine: 0 }, Rays { light: 0, cosine: 64 }, Rays { light: 48, cosine: 16 }];

/// Independent estimates of all elements; `fault` changes what a ray tells.
fn runs_with(problem: &Problem, rays: Rays, fault: impl Fn(Sight) -> Sight + Sync) -> Vec<Vec<Rgb>> {
    let sampler = LightSampler::new(problem);
    let run = |seed| {
        let sequence = OwenSobol::new(seed);
        let mut light = DirectEstimator::new(problem, &sampler, &sequence);
        let of_element = |e| {
            let mut sum = Rgb::BLACK;
            light.look(e, rays, |sight| sum += fault(sight).irradiance(rays));
            sum
        };
        problem.mesh.elements().map(of_element).collect()
    };
    (0..RUNS).into_par_iter().map(run).collect()
}

fn runs(problem: &Problem, rays: Rays) -> Vec<Vec<Rgb>> {
    runs_with(problem, rays, |sight| sight)
}

/// `Σ_j F_ij Be_j` in a convex room.
fn exact_in_convex_room<const N: usize>(problem: &Problem) -> Exact {
    let factors = form_factors::<N>(problem);
    let emission = |j: usize, c: usize| f64::from(problem.mesh.emission(j as u32).to_array()[c]);
    let channel = |i: usize, c: usize| (0..N).map(|j| factors[i][j] * emission(j, c)).sum();
    (0..N).map(|i| std::array::from_fn(|c| channel(i, c))).collect()
}

/// Emitting ceiling and wall touch all other faces: every corner is a singularity of the kernel.
#[test]
fn each_kind_of_ray_lights_a_box() {
    let problem = problem("box", 48);
    let exact = exact_in_convex_room::<48>(&problem);
    for rays in KINDS {
        assert_exact("direct light: box", &problem, &runs(&problem, rays), &exact);
    }
}

#[test]
fn the_box_sees_planted_faults() {
    let problem = problem("box", 48);
    let exact = exact_in_convex_room::<48>(&problem);
    let sees = |rays, fault: fn(Sight) -> Sight| refutes_exact(&problem, &runs_with(&problem, rays, fault), &exact);
    for rays in [KINDS[0], KINDS[2]] {
        assert!(sees(rays, |sight| Sight { light: 1.02 * sight.light, ..sight }), "a density 2 % off");
        assert!(sees(rays, |sight| Sight { cosine: 0.2, ..sight }), "a missing cosine");
    }
    assert!(sees(KINDS[1], |sight| Sight {
        cosine: 1.02 * sight.cosine,
        light: 0.0,
        emission: sight.emission * 1.02,
        ..sight
    }));
}

/// Every point of a sphere gets the mean of what the sphere emits.
#[test]
fn a_sphere_lights_itself_evenly() {
    let problem = problem("sphere", 8 * 16);
    let mesh = &problem.mesh;
    let flux = mesh.total_emitted_flux().map(|flux| flux / mesh.total_area());
    for rays in KINDS {
        assert_exact("direct light: sphere", &problem, &runs(&problem, rays), &vec![flux; mesh.len()]);
    }
}

fn material(name: &str, emission: f32, two_sided: bool) -> Material {
    Material { emission: Rgb::grey(emission), two_sided, ..Material::diffuse(name, Rgb::grey(0.5)) }
}

/// A scene of rectangles, each with its material.
fn rectangles(parts: &[(Material, [[f32; 3]; 4])]) -> Scene {
    let mut builder = Builder::new("rectangles");
    for (material, corners) in parts {
        let number = builder.material(material.clone());
        builder.object(&material.name, number);
        builder.polygon(&corners.map(Vec3::from));
    }
    builder.finish()
}

/// A square with edges parallel to x and y, looking up, or down.
fn level(z: f32, [low, high]: [f32; 2], up: bool) -> [[f32; 3]; 4] {
    let [a, b, c, d] = [[low, low, z], [high, low, z], [high, high, z], [low, high, z]];
    if up { [a, b, c, d] } else { [a, d, c, b] }
}

/// Mean irradiance of the first object in each run.
fn of_first_object(problem: &Problem, runs: &[Vec<Rgb>]) -> Moments {
    let is_first = |e: u32| problem.object(e) == 0;
    let first: Vec<u32> = problem.mesh.elements().filter(|&e| is_first(e)).collect();
    let area: f64 = first.iter().map(|&e| f64::from(problem.mesh.area(e))).sum();
    let mean =
        |run: &Vec<Rgb>| first.iter().map(|&e| f64::from(problem.mesh.area(e) * run[e as usize].g)).sum::<f64>() / area;
    runs.iter().map(mean).collect()
}

fn t_of(moments: Moments, exact: f64) -> f64 {
    (moments.mean - exact) / moments.std_error().hypot(1e-6 * exact)
}

#[test]
fn lamps_light_a_floor_by_their_form_factors() {
    const BE: f32 = 10.0;
    let unit = [0.0, 1.0];
    let floor = (material("floor", 0.0, false), level(0.0, unit, true));
    let above = |two_sided| (material("lamp", BE, two_sided), level(1.0, unit, false));
    let wall = (material("wall", BE, false), [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]]);
    let blocker = (material("blocker", 0.0, true), level(0.5, [0.0, 0.5], true));
    let upside_down = (material("lamp", BE, true), level(1.0, unit, true));
    let facing = parallel_rectangles(1.0, 1.0, 1.0);
    let beside = perpendicular_rectangles(1.0, 1.0, 1.0);
    let cases = [
        ("above", vec![floor.clone(), above(false)], facing),
        ("above, two-sided", vec![floor.clone(), above(true)], facing),
        ("above, the back of two sides", vec![floor.clone(), upside_down], facing),
        ("beside, with a common edge", vec![floor.clone(), wall.clone()], beside),
        ("above and beside", vec![floor.clone(), above(false), wall], facing + beside),
        ("above, half blocked", vec![floor, above(false), blocker], BLOCKED_SQUARES),
    ];
    for (what, parts, factor) in cases {
        let problem = cut(rectangles(&parts), 60);
        for rays in KINDS {
            let (moments, exact) = (of_first_object(&problem, &runs(&problem, rays)), f64::from(BE) * factor);
            assert_t("direct light: rectangles", t_of(moments, exact), RUNS as f64 - 1.0);
        }
        let off = of_first_object(&problem, &runs_with(&problem, KINDS[0], |s| Sight { light: s.light / 1.02, ..s }));
        assert!(refutes(p_of_t(t_of(off, f64::from(BE) * factor), RUNS as f64 - 1.0)), "{what}: a density 2 % off");
    }
}

#[test]
fn where_nothing_shines_there_is_no_light_and_no_ray() {
    let unit = [0.0, 1.0];
    let mut dark = scene("cubes");
    brighten(&mut dark, 0.0);
    let lone = rectangles(&[(material("lamp", 10.0, true), level(0.0, unit, true))]);
    let away = rectangles(&[
        (material("lamp", 10.0, false), level(1.0, unit, true)),
        (material("floor", 0.0, false), level(0.0, unit, true)),
    ]);
    for scene in [dark, lone, away] {
        let problem = cut(scene, 100);
        let sampler = LightSampler::new(&problem);
        let sequence = OwenSobol::new(1);
        let mut light = DirectEstimator::new(&problem, &sampler, &sequence);
        for e in problem.mesh.elements() {
            assert_eq!(light.irradiance(e, KINDS[2]), (Rgb::BLACK, 0), "{problem:?}, element {e}");
        }
    }
}

/// In a convex room what guides the rays is near Lambert's formula, and zero where that is zero.
#[test]
fn what_guides_light_rays_is_near_the_exact_irradiance() {
    let problem = problem("box", 3000);
    let sampler = LightSampler::new(&problem);
    assert_eq!(sampler.emitters().len(), 4);
    for e in problem.mesh.elements() {
        let receiver = Receiver::new(&problem, e);
        for emitter in sampler.emitters() {
            let corners = emitter.corners.map(|corner| corner.as_dvec3());
            let exact = match receiver.normal == emitter.normal {
                true => 0.0,
                false => point_to_polygon(receiver.center.as_dvec3(), receiver.normal.as_dvec3(), &corners),
            };
            let found = receiver.irradiance(emitter) / emitter.emission.luminance();
            assert_eq!(found == 0.0, exact == 0.0, "element {e}: {found} {exact}");
            assert!((f64::from(found) - exact).abs() < 0.05, "element {e}: {found} {exact}");
        }
    }
}

/// Differences of direct light and shooting in a black room, where all light is direct.
#[test]
fn shooting_gives_the_same_direct_light() {
    for (name, elements, rays) in
        [("cubes", 300, 100_000), ("cornell-box", 300, 100_000), ("office:size=1", 1, 400_000)]
    {
        let mut black = scene(name);
        black.materials.iter_mut().for_each(|m| m.reflectivity = Rgb::BLACK);
        let problem = cut(black, elements);
        let shot = irradiances(&ensemble(&problem, constant_elements(rays), RUNS));
        let difference = |(a, b): (&Vec<Rgb>, &Vec<Rgb>)| -> Vec<f64> {
            a.iter().zip(b).map(|(&a, &b)| (a - b).luminance_f64()).collect()
        };
        let differences = |direct: &[Vec<Rgb>]| direct.iter().zip(&shot).map(difference).collect::<Vec<_>>();
        let nothing = vec![0.0; problem.mesh.len()];
        let broad: Vec<_> = projections(&problem, 5, 3).into_iter().filter(|p| !p.name.starts_with("object")).collect();
        assert_eq!(broad.len(), 6);
        let sampled = differences(&runs(&problem, KINDS[2]));
        for projection in &broad {
            let deviation = projection.deviation(&sampled, &nothing);
            assert_t("direct light: shooting", deviation.t, deviation.dof);
        }
        let bright = differences(&runs_with(&problem, KINDS[2], |s| Sight { emission: s.emission * 1.05, ..s }));
        let total = broad[0].deviation(&bright, &nothing);
        assert!(refutes(p_of_t(total.t, total.dof)), "{name}: 5 % more light is seen: {total:?}");
    }
}

const INTENSITY: Rgb = Rgb::new(100.0, 50.0, 20.0);

/// What a light without extent gives the elements of an otherwise dark box.
fn lamp_runs(kind: LightKind) -> (Problem, Vec<Vec<Rgb>>) {
    let mut room = scene("box");
    brighten(&mut room, 0.0);
    room.lights.push(Light { name: "lamp".into(), intensity: INTENSITY, kind });
    let problem = cut(room, 300);
    let sampler = LightSampler::new(&problem);
    let run = |seed| {
        let sequence = OwenSobol::new(seed);
        let mut light = DirectEstimator::new(&problem, &sampler, &sequence);
        problem.mesh.elements().map(|e| light.irradiance(e, Rays { light: 16, cosine: 16 }).0).collect()
    };
    let runs = (0..RUNS).map(run).collect();
    (problem, runs)
}

#[test]
fn a_point_light_lights_by_solid_angle() {
    let position = Vec3::new(1.3, 1.9, 2.2);
    let (problem, runs) = lamp_runs(LightKind::Point { position });
    let irradiance = |e: u32| {
        let [a, b, c] = element_corners(&problem, e).map(|p| p - position.as_dvec3());
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let below = la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la;
        let solid_angle = 2.0 * a.dot(b.cross(c)).abs().atan2(below);
        INTENSITY.to_array().map(|i| f64::from(i) * solid_angle / f64::from(problem.mesh.area(e)))
    };
    let exact: Exact = problem.mesh.elements().map(irradiance).collect();
    assert_exact("direct light: point light", &problem, &runs, &exact);
    let (moved, runs) = lamp_runs(LightKind::Point { position: position + Vec3::X * 0.01 });
    assert!(refutes_exact(&moved, &runs, &exact), "a light a centimetre from where it should be");
}

/// The sun shines from anywhere: nothing is in its way on a floor alone, and all is behind a wall.
#[test]
fn the_sun_lights_a_floor_exactly() {
    let direction = Vec3::new(0.3, 0.2, -1.0).normalize();
    let floor = (material("floor", 0.0, false), level(0.0, [0.0, 1.0], true));
    let roof = (material("roof", 0.0, false), level(1.0, [-9.0, 9.0], true));
    for (parts, share) in [(vec![floor.clone()], 1.0), (vec![floor, roof], 0.0)] {
        let mut scene = rectangles(&parts);
        scene.lights.push(Light {
            name: "sun".into(),
            intensity: INTENSITY,
            kind: LightKind::Directional { direction },
        });
        let problem = cut(scene, 10);
        let sampler = LightSampler::new(&problem);
        let sequence = OwenSobol::new(1);
        let on_floor = |&e: &u32| problem.mesh.triangle(e) < 2;
        let first = problem.mesh.elements().find(on_floor).unwrap();
        let (irradiance, rays) = DirectEstimator::new(&problem, &sampler, &sequence).irradiance(first, KINDS[0]);
        let exact = INTENSITY * -direction.z * share;
        assert!((irradiance - exact).to_array().iter().all(|v| v.abs() < 1e-4), "{irradiance:?} {exact:?}");
        assert_eq!(rays, 64);
    }
}

/// Runs the trial and `rounds` rounds of 16 rays for each element, and hands what each of them received to `each`.
fn rounds(problem: &Problem, seed: u64, rounds: u32, mut each: impl FnMut(u32, Rgb)) -> DirectLight {
    let mut light = DirectLight::new(problem, seed, "owen-sobol".parse().unwrap());
    light.begin_trial();
    for _ in 0..=rounds {
        for piece in 0..light.pieces() {
            let received = light.piece(problem, piece);
            light.merge(problem, piece, &received, |e, irradiance, weight| {
                assert_eq!(weight, 1.0, "nothing else was shot");
                each(e, irradiance);
            });
            light.learn(piece, &received);
        }
        light.begin_round(problem, 16.0 * problem.mesh.len() as f64, f64::INFINITY);
    }
    light
}

/// Shares and numbers of rays are chosen by the light itself, and yet the mean is right, and so is its spread over the rounds.
#[test]
fn rounds_are_unbiased_and_uncorrelated() {
    const ROUNDS: u32 = 8;
    let problem = problem("box", 48);
    let exact = exact_in_convex_room::<48>(&problem);
    let run = |seed| {
        let mut of_elements = vec![Moments::default(); problem.mesh.len()];
        let mut sums = vec![Rgb::BLACK; problem.mesh.len()];
        let light = rounds(&problem, seed, ROUNDS, |e, irradiance| {
            of_elements[e as usize].push(irradiance.luminance_f64());
            sums[e as usize] += irradiance;
        });
        let means: Vec<Rgb> = sums.into_iter().map(|sum| sum / ROUNDS as f32).collect();
        (light, means, of_elements)
    };
    let all: Vec<_> = (0..RUNS).into_par_iter().map(run).collect();
    let means: Vec<Vec<Rgb>> = all.iter().map(|(_, means, _)| means.clone()).collect();
    assert_exact("direct light: rounds", &problem, &means, &exact);
    let surplus = |(_, _, of_elements): &(DirectLight, Vec<Rgb>, Vec<Moments>)| {
        let of_element = |e: u32| {
            let moments = &of_elements[e as usize];
            let [r, g, b] = exact[e as usize];
            let error = moments.mean - (0.2126 * r + 0.7152 * g + 0.0722 * b);
            f64::from(problem.mesh.area(e)) * (error * error - moments.std_error().powi(2))
        };
        problem.mesh.elements().map(of_element).sum::<f64>()
    };
    let moments: Moments = all.iter().map(surplus).collect();
    assert_t("direct light: spread of rounds", moments.mean / moments.std_error(), RUNS as f64 - 1.0);
}

#[test]
fn pieces_are_pure_and_resumed_rounds_go_on() {
    let problem = problem("cornell-box", 3000);
    let mut light = rounds(&problem, 1, 1, |_, _| {});
    assert!(light.pieces() > 2);
    let in_order: Vec<_> = (0..light.pieces()).map(|piece| light.piece(&problem, piece)).collect();
    let pieces: Vec<u64> = (0..light.pieces()).rev().collect();
    let mut others: Vec<_> = pieces.into_par_iter().map(|piece| light.piece(&problem, piece)).collect();
    others.reverse();
    assert_eq!(in_order, others);
    let mut resumed: DirectLight = postcard::from_bytes(&postcard::to_stdvec(&light).unwrap()).unwrap();
    let next = |run: &mut DirectLight| {
        (0..run.pieces()).for_each(|piece| run.learn(piece, &in_order[piece as usize]));
        run.begin_round(&problem, 1e5, 0.01);
        run.piece(&problem, 0)
    };
    assert_eq!(next(&mut light), next(&mut resumed));
}
