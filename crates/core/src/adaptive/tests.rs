use super::borders::Borders;
use super::forest::Leaf;
use super::*;
use crate::mesh::{cells, surface_area};
use crate::sampling::SequenceName;
use crate::scene::Material;
use crate::scene::builtin::builtin;
use crate::scene::builtin::shapes::Builder;
use crate::solution::Work;
use crate::transport::{DirectEstimator, LightSampler};
use crate::view::tests::solution;
use glam::{Vec2, Vec3};

/// A hundred rays an element of 20,000.
const EFFORT: Effort = Effort { rays: 2_000_000, seed: 1, light: LightPart::All };

/// A built-in scene under made-up light [lux] at every place [m].
fn lit(name: &str, elements: u64, light: impl Fn(Vec3) -> f32) -> (Problem, Vec<Rgb>) {
    lit_scene(builtin(name).unwrap(), elements, light)
}

fn lit_scene(scene: Scene, elements: u64, light: impl Fn(Vec3) -> f32) -> (Problem, Vec<Rgb>) {
    let problem = Problem::new(scene, Resolution::Elements(elements)).unwrap();
    let irradiance = problem.mesh.elements().map(|e| Rgb::grey(light(problem.centre(e).0))).collect();
    (problem, irradiance)
}

/// The scene of `problem` with at most so many elements that follow the `irradiance` [lux].
fn adapted(problem: &Problem, irradiance: &[Rgb], elements: u64) -> Problem {
    let cut = adapt(problem, irradiance, elements, &Contacts::NONE).unwrap();
    Problem::with_cut(problem.scene.clone(), &cut).unwrap()
}

/// Brighter and brighter towards the middle of the floor.
fn pool(p: Vec3) -> f32 {
    100.0 * (-p.distance_squared(Vec3::new(0.3, 0.0, -0.2))).exp()
}

/// What each element is wrong by [lux² m²] under `light`.
fn errors(problem: &Problem, light: impl Fn(Vec3) -> f32) -> Vec<f32> {
    let error = |e: u32| {
        let [a, b, c] = problem.mesh.corners(e);
        let samples: Vec<f32> = (0..cells::count(8))
            .map(|cell| {
                let uv = cells::corners(cell, 8).iter().sum::<Vec2>() / 3.0;
                light(problem.geometry.surface(problem.mesh.triangle(e), a + uv.x * (b - a) + uv.y * (c - a)).0)
            })
            .collect();
        let mean = samples.iter().sum::<f32>() / samples.len() as f32;
        problem.mesh.area(e) * samples.iter().map(|x| (x - mean).powi(2)).sum::<f32>() / samples.len() as f32
    };
    problem.mesh.elements().map(error).collect()
}

#[test]
fn the_budget_is_used_and_never_exceeded() {
    for name in ["cornell-box", "cubes"] {
        let (problem, light) = lit(name, 5000, pool);
        for elements in [6000, 20_000] {
            let count = adapted(&problem, &light, elements).mesh.len() as u64;
            assert!(count <= elements && count as f64 > 0.9 * elements as f64, "{name}: {count} of {elements}");
        }
    }
}

#[test]
fn elements_are_cut_along_all_contacts_and_are_not_more_for_that() {
    let mut builder = Builder::new("a wall that crosses a floor");
    let material = builder.material(Material::diffuse("", Rgb::grey(0.5)));
    builder.object("all", material);
    for corners in [
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, -1.0], [0.0, 0.0, -1.0]],
        [[0.1, -0.1, -0.2], [0.9, -0.1, -0.7], [0.9, 0.4, -0.7], [0.1, 0.4, -0.2]],
    ] {
        builder.polygon(&corners.map(Vec3::from));
    }
    let (problem, light) = lit_scene(builder.finish(), 2000, pool);
    let elements = 1000;
    let contacts = Contacts::of(&problem.scene, Resolution::Elements(elements).typical_edge(&problem.scene));
    let count = |cut: &Cut| cut.element_count(&problem.scene).unwrap() as u64;
    let cut = adapt(&problem, &light, elements, &contacts).unwrap();
    let whole = adapt(&problem, &light, elements, &Contacts::NONE).unwrap();
    let [before, after] = [&whole, &whole.along(&problem.scene, &contacts, u64::MAX)].map(count);
    assert!(after as f64 > 1.05 * before as f64, "there are too few contacts to tell: {before} elements, {after} cut");
    assert!(count(&cut) <= elements && count(&cut) as f64 > 0.9 * elements as f64, "{}", count(&cut));
    assert_eq!(count(&cut.along(&problem.scene, &contacts, u64::MAX)), count(&cut));
}

#[test]
fn the_error_of_equal_numbers_of_elements_is_halved() {
    // Soft, a slanted edge, and a change in one direction only.
    let edge = |p: Vec3| if p.x + 0.3 * p.z > 0.4 { 100.0 } else { 1.0 };
    let slope = |p: Vec3| 100.0 * (-20.0 * (p.x - 0.2).powi(2)).exp();
    let lights: [(&str, &dyn Fn(Vec3) -> f32); 3] = [("pool", &pool), ("edge", &edge), ("slope", &slope)];
    for (name, light) in lights {
        let (problem, irradiance) = lit("cubes", 40_000, light);
        let adaptive: f32 = errors(&adapted(&problem, &irradiance, 10_000), light).iter().sum();
        let uniform: f32 = errors(&lit("cubes", 10_000, light).0, light).iter().sum();
        assert!(adaptive.sqrt() < 0.5 * uniform.sqrt(), "{name}: {} {}", adaptive.sqrt(), uniform.sqrt());
    }
}

#[test]
fn elements_have_equal_errors_where_the_light_is_smooth() {
    let (problem, irradiance) = lit("cubes", 40_000, pool);
    let brightness = Brightness::among(&problem, &irradiance);
    let mut errors = errors(&adapted(&problem, &irradiance, 10_000), |p| brightness.of(pool(p)));
    errors.sort_by(f32::total_cmp);
    let quantile = |q: f64| errors[(q * (errors.len() - 1) as f64) as usize];
    assert!(quantile(0.9) < 8.0 * quantile(0.4), "{} {}", quantile(0.4), quantile(0.9));
}

#[test]
fn bright_light_counts_by_its_logarithm_and_dim_light_in_full() {
    let (problem, irradiance) = lit("cubes", 400, |_| 50.0);
    let brightness = Brightness::among(&problem, &irradiance);
    assert!((brightness.of(0.01) - 0.01).abs() < 1e-4 && brightness.of(0.0) == 0.0);
    let octaves = [1e4, 2e4, 4e4].map(|lux| brightness.of(lux));
    let steps = [octaves[1] - octaves[0], octaves[2] - octaves[1]];
    assert!(steps.iter().all(|step| (step / (3.0 * 2f32.ln()) - 1.0).abs() < 0.01), "{steps:?}");
}

#[test]
fn elements_are_long_where_light_changes_in_one_direction_only() {
    let (problem, irradiance) = lit("cubes", 40_000, |p| 100.0 * (-20.0 * (p.x - 0.2).powi(2)).exp());
    let adaptive = adapted(&problem, &irradiance, 10_000);
    let (mut along, mut across) = (0.0, 0.0);
    for e in adaptive.mesh.elements().filter(|&e| adaptive.mesh.normal(e).x.abs() < 0.1) {
        let corners = adaptive.mesh.corners(e).map(|uv| adaptive.geometry.surface(adaptive.mesh.triangle(e), uv).0);
        let extent = corners[0].max(corners[1]).max(corners[2]) - corners[0].min(corners[1]).min(corners[2]);
        (along, across) = (along + extent.y.max(extent.z), across + extent.x);
    }
    assert!(along > 1.5 * across, "{along} {across}");
}

#[test]
fn neighbours_differ_by_one_level() {
    // A jump along a slanted line: the smallest elements beside the largest.
    let (problem, irradiance) = lit("cubes", 4000, |p| if p.x + 0.3 * p.z > 0.4 { 100.0 } else { 1.0 });
    let problem = adapted(&problem, &irradiance, 16_000);
    let borders = Borders::of(&problem.scene, problem.geometry.as_ref());
    let (mut met, mut longest) = (0, 0f32);
    for e in problem.mesh.elements() {
        let leaf = Leaf::new(problem.mesh.triangle(e), 0, problem.mesh.corners(e));
        for balance::Probe { triangle, uv, length } in balance::probes(&problem, &borders, &leaf) {
            let (neighbour, within) = problem.mesh.locate(triangle, uv, false).unwrap();
            let other = Leaf::new(triangle, 0, problem.mesh.corners(neighbour));
            met += usize::from(triangle != leaf.triangle);
            longest = longest.max(balance::edge_at(&problem, &other, within).1 / length);
        }
    }
    assert!(met > 100 && longest > 1.9 && longest < 2.2, "{met} across edges, {longest}");
}

#[test]
fn triangles_are_put_together_where_the_mesh_is_finer_than_the_light() {
    let (problem, irradiance) = lit("office", 1, |p| if p.x > 0.0 { 100.0 } else { 50.0 });
    let sides = Resolution::least(&problem.scene);
    for elements in [sides / 2, sides + 2000] {
        let adaptive = adapted(&problem, &irradiance, elements);
        let count = adaptive.mesh.len() as u64;
        // Where light does not change at all some are left over.
        assert!((elements / 2..=elements).contains(&count), "{count} of {elements}");
        let clusters = adaptive.mesh.elements().filter_map(|e| adaptive.mesh.cluster(e));
        let one_sided = clusters.map(|cluster| {
            let at = |t: u32| scene_middle(&adaptive, t).x > 0.0;
            let first = at(cluster.largest());
            cluster.triangles().all(|t| at(t) == first)
        });
        let of_one_light: Vec<bool> = one_sided.collect();
        let share = of_one_light.iter().filter(|same| **same).count() as f64 / of_one_light.len() as f64;
        assert!(of_one_light.len() > 500 && share > 0.97, "{} clusters, {share} in one light", of_one_light.len());
    }
}

/// On a mesh of clusters, too, all triangles have light: it is put together again as before.
#[test]
fn what_was_put_together_can_be_again() {
    let light = |p: Vec3| if p.x > 0.0 { 100.0 } else { 50.0 };
    let (problem, irradiance) = lit("office", 1, light);
    let elements = Resolution::least(&problem.scene) / 2;
    let once = adapted(&problem, &irradiance, elements);
    let irradiance: Vec<Rgb> = once.mesh.elements().map(|e| Rgb::grey(light(once.centre(e).0))).collect();
    let twice = adapted(&once, &irradiance, elements);
    assert!(twice.mesh.len() as u64 <= elements, "{} of {elements}, {} before", twice.mesh.len(), once.mesh.len());
}

fn scene_middle(problem: &Problem, t: u32) -> Vec3 {
    problem.scene.corners(t).into_iter().sum::<Vec3>() / 3.0
}

#[test]
fn the_same_light_makes_the_same_mesh() {
    let (problem, irradiance) = lit("cubes", 4000, pool);
    let cut = || adapt(&problem, &irradiance, 16_000, &Contacts::NONE).unwrap();
    assert!(cut() == cut());
}

#[test]
fn in_the_dark_elements_are_as_large_as_they_may_be() {
    let (problem, dark) = lit("box", 1000, |_| 0.0);
    let dark = adapted(&problem, &dark, 4000);
    let largest = dark.mesh.elements().map(|e| dark.mesh.area(e)).fold(0.0, f32::max);
    assert!(dark.mesh.len() <= 4000 && f64::from(largest) <= 1.001 * LARGEST * dark.mesh.total_area() / 4000.0);
}

/// The same random numbers for all: below a lamp light changes less from element to element than with numbers of their own.
#[test]
fn direct_light_of_neighbours_has_the_same_noise() {
    let problem = Problem::new(builtin("cornell-box").unwrap(), Resolution::Elements(20_000)).unwrap();
    let rays = EFFORT.of_direct_light(20_000);
    let (same, traced) = light::direct(&problem, rays, 1);
    assert!(traced > 0 && same.len() == problem.mesh.len());
    let (sampler, sequence) = (LightSampler::new(&problem), SequenceName::default().make(1));
    let mut estimator = DirectEstimator::new(&problem, &sampler, &*sequence);
    let own: Vec<Rgb> = problem.mesh.elements().map(|e| estimator.irradiance(e, rays).0).collect();
    let is_floor = |e: u32| problem.mesh.normal(e).y > 0.99 && problem.centre(e).0.y < 0.01;
    let step = |light: &[Rgb]| {
        let on_floor = problem.mesh.elements().filter(|&e| is_floor(e));
        let values: Vec<f32> = on_floor.map(|e| light[e as usize].luminance()).collect();
        let mut steps: Vec<f32> = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
        steps.sort_by(f32::total_cmp);
        steps[steps.len() / 2]
    };
    assert!(step(&same) < 0.8 * step(&own), "{} {}", step(&same), step(&own));
    let sum = |light: &[Rgb]| light.iter().map(|light| light.luminance_f64()).sum::<f64>();
    assert!((sum(&same) / sum(&own) - 1.0).abs() < 0.05, "{} {}", sum(&same), sum(&own));
}

#[test]
fn without_a_pilot_the_mesh_is_uniform() {
    let scene = builtin("cubes").unwrap();
    let followed = follow_light(scene.clone(), 16_000, &Contacts::NONE, EFFORT, |_, _| Ok::<_, Error>(None)).unwrap();
    let uniform = Problem::new(scene.clone(), Resolution::Clustered(16_000)).unwrap();
    assert!(followed.rays == 0 && followed.problem.mesh.cut() == uniform.mesh.cut());
    assert!(follow_light(scene, 16_000, &Contacts::NONE, EFFORT, |_, _| Err(Error::NoSurface)).is_err());
}

#[test]
fn indirect_light_alone_takes_no_direct_light() {
    let scene = builtin("cubes").unwrap();
    let pilot = |problem: &Problem, settings: Settings| {
        assert!(settings.light == LightPart::Indirect);
        let irradiance = problem.mesh.elements().map(|e| Rgb::grey(pool(problem.centre(e).0))).collect();
        let solution = solution(irradiance);
        let work = Work { rays: 7, replicates: 2 };
        Ok::<_, Error>(Some(Solution { work, ..solution }))
    };
    let indirect = Effort { light: LightPart::Indirect, ..EFFORT };
    assert_eq!(follow_light(scene.clone(), 4000, &Contacts::NONE, indirect, pilot).unwrap().rays, 7);
    assert!(follow_light(scene, 4000, &Contacts::NONE, EFFORT, pilot).unwrap().rays > 4000);
}

#[test]
fn a_triangle_with_one_element_has_the_moments_of_linear_light() {
    let problem = Problem::new(builtin("cubes").unwrap(), Resolution::Elements(1)).unwrap();
    let irradiance: Vec<Rgb> = problem.mesh.elements().map(|e| Rgb::grey(pool(problem.centre(e).0))).collect();
    let light = Light::new(&problem, &irradiance);
    let mut uneven = 0;
    for t in 0..light.triangles() {
        // The integral of (E - mean)² of what is linear between three corners is A/12 times the sum over these.
        let corners = [Vec2::ZERO, Vec2::X, Vec2::Y].map(|corner| light.at(t, corner)[0]);
        let mean = corners.iter().sum::<f32>() / 3.0;
        let square: f32 = corners.iter().map(|light| (light - mean).powi(2)).sum();
        let error = surface_area(&problem.scene, t) as f32 * square / 12.0;
        let on = light.on(t);
        assert!((on.mean[0] - mean).abs() < 1e-4 * mean.max(1.0), "{t}: {} {mean}", on.mean[0]);
        assert!((on.error - error).abs() < 1e-3 * error.max(1e-3), "{t}: {} {error}", on.error);
        uneven += usize::from(error > 1.0);
    }
    assert!(uneven > 4, "{uneven}");
}
