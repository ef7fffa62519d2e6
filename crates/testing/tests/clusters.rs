//! Elements made of many triangles: cut finely and put together again, a room is the room it was.

#![allow(clippy::unwrap_used)]

use glam::{Vec2, Vec3};
use isolux_core::Problem;
use isolux_core::math::Rgb;
use isolux_core::mesh::{Cut, Resolution, cells};
use isolux_core::scene::builtin::shapes::Builder;
use isolux_core::scene::{Material, Scene, Triangle, Vertex};
use isolux_core::solvers::monte_carlo::axes::Walk;
use isolux_core::solvers::monte_carlo::{METHODS, Method, Settings};
use isolux_testing::battery::{is_unbiased, with_method};
use isolux_testing::contour::convex_room_answer;
use isolux_testing::ensemble::{
    Exact, assert_exact, constant_elements, ensemble, irradiances, radiosities, refutes_exact, solve, with_rays,
};
use isolux_testing::mutants::{Fault, with_fault};
use isolux_testing::scenes::{furnace_answer, problem};
use rayon::ThreadPoolBuilder;

/// Divisions of the triangles of a room that is cut finely.
const FINE: u16 = 4;

/// A room cut finely where nothing emits, and for each triangle its place in the room: triangle and cell.
fn refined(room: &Scene) -> (Scene, Vec<(u32, u32)>) {
    let mut fine = Scene { vertices: Vec::new(), triangles: Vec::new(), ..room.clone() };
    let mut places = Vec::new();
    for (t, &triangle) in (0..).zip(&room.triangles) {
        let [a, b, c] = room.corners(t);
        let divisions = if room.material_of(t).is_emitter() { 1 } else { FINE };
        for cell in 0..cells::count(divisions) {
            let corners = cells::corners(cell, divisions).map(|uv| a + uv.x * (b - a) + uv.y * (c - a));
            let first = fine.vertices.len() as u32;
            fine.vertices.extend(corners.map(Vertex::at));
            fine.triangles.push(Triangle { vertices: [first, first + 1, first + 2], ..triangle });
            places.push((t, cell));
        }
    }
    (fine, places)
}

/// The box cut finely, one element for each of its twelve triangles as `parent` tells where small ones belong, and the exact answer of
/// the twelve.
fn put_together(parent: impl Fn((u32, u32)) -> u32) -> (Problem, Exact) {
    let whole = problem("box", 12);
    let (scene, places) = refined(&whole.scene);
    let parents: Vec<u32> = places.into_iter().map(parent).collect();
    let leader = |t: &u32| parents.iter().position(|p| p == t).unwrap() as u32;
    let leaders = parents.iter().map(leader).collect();
    let fine = Problem::with_cut(scene, &Cut { leaders, ..Cut::regular(&vec![1; parents.len()]) }).unwrap();
    assert_eq!(fine.mesh.len(), 12);
    let answer = convex_room_answer::<12>(&whole);
    let element = |parent: u32| whole.mesh.at(parent, Vec2::splat(0.25), false).unwrap();
    let exact = fine.mesh.elements().map(|e| answer[element(parents[fine.mesh.triangle(e) as usize]) as usize]);
    let exact = exact.collect();
    (fine, exact)
}

#[test]
fn a_box_cut_and_put_together_again_has_the_light_it_had() {
    let (fine, exact) = put_together(|(t, _)| t);
    for named in METHODS.iter().filter(|named| is_unbiased(&named.method) && named.method.walk == Walk::Discrete) {
        let runs = irradiances(&ensemble(&fine, with_method(named.method, with_rays(30_000)), 48));
        assert_exact("clusters: box", &fine, &runs, &exact);
    }
}

/// Four of the sixteen small triangles of each half of a wall are put to the other half.
#[test]
fn triangles_in_the_wrong_cluster_are_seen() {
    let emits: Vec<bool> = (0..12).map(|t| problem("box", 12).scene.material_of(t).is_emitter()).collect();
    let wrong = |(t, cell): (u32, u32)| if cell < 4 && !emits[t as usize] { t ^ 1 } else { t };
    let (fine, exact) = put_together(wrong);
    let runs = irradiances(&ensemble(&fine, with_method(Settings::default().method, with_rays(30_000)), 48));
    assert!(refutes_exact(&fine, &runs, &exact));
}

/// A room with `walls`, and things of `material` in it that are round, or rounded, and finely cut.
fn furnished(walls: Material, material: Material) -> Builder {
    let mut builder = Builder::new("furnished");
    let (walls, material) = (builder.material(walls), builder.material(material));
    builder.object("walls", walls);
    builder.look_inwards(true);
    builder.cuboid(Vec3::ZERO, Vec3::new(3.0, 2.0, 2.0));
    builder.look_inwards(false);
    builder.object("ball", material);
    builder.ball(Vec3::new(0.8, 0.9, 1.0), 0.5, 32);
    builder.object("cushion", material);
    builder.rounded_cuboid(Vec3::new(1.5, 0.01, 0.5), Vec3::new(2.5, 0.7, 1.5), 0.2, 8);
    builder
}

/// Things that reflect all light in a furnace: radiosity is 1 on them as on the walls.
fn furnace() -> Scene {
    let walls = Material { emission: Rgb::grey(0.6), ..Material::diffuse("wall", Rgb::grey(0.4)) };
    furnished(walls, Material::diffuse("white", Rgb::WHITE)).finish()
}

/// Two-sided things under a lamp.
fn room() -> Scene {
    let thing = Material { two_sided: true, ..Material::diffuse("thing", Rgb::new(0.5, 0.6, 0.7)) };
    let mut builder = furnished(Material::diffuse("wall", Rgb::grey(0.4)), thing);
    let lamp = Material { emission: Rgb::grey(100.0), ..Material::diffuse("lamp", Rgb::grey(0.5)) };
    let lamp = builder.material(lamp);
    builder.object("lamp", lamp);
    builder.cuboid(Vec3::new(1.0, 1.7, 1.0), Vec3::new(1.2, 1.8, 1.2));
    builder.finish()
}

fn clustered(scene: Scene, elements: u64) -> Problem {
    let triangles = scene.triangles.len();
    let problem = Problem::new(scene, Resolution::Clustered(elements)).unwrap();
    assert!(problem.mesh.has_clusters() && problem.mesh.len() * 4 < triangles, "{problem:?} of {triangles} triangles");
    problem
}

#[test]
fn a_furnace_has_radiosity_one_on_round_elements() {
    let problem = clustered(furnace(), 500);
    let exact = furnace_answer(&problem);
    for name in ["stochastic-jacobi", "auto"] {
        let settings = Settings { method: Method::named(name).unwrap(), ..constant_elements(100_000) };
        let runs = ensemble(&problem, settings, 32);
        assert_exact("clusters: furnace", &problem, &irradiances(&runs), &exact);
        assert_exact("clusters: furnace", &problem, &radiosities(&problem, &runs), &exact);
    }
    let leaky = with_fault(clustered(furnace(), 500), Fault::Leaks(0.01));
    assert!(refutes_exact(&leaky, &irradiances(&ensemble(&leaky, constant_elements(100_000), 32)), &exact));
}

#[test]
fn rooms_with_clusters_are_balanced() {
    let balance = solve(&clustered(room(), 600), with_rays(200_000)).balance;
    assert!(balance.residual().abs() < 1e-6, "{balance:?}");
    assert!((balance.absorbed / balance.emitted - 1.0).abs() < 1e-5, "{balance:?}");
}

#[test]
fn any_number_of_threads_gives_the_same_bits_with_clusters() {
    let solve_on = |threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let problem = clustered(room(), 600);
            let solution = solve(&problem, Settings { replicates: 8, ..with_rays(400_000) });
            (problem.mesh.cut(), postcard::to_stdvec(&solution).unwrap())
        })
    };
    let one = solve_on(1);
    assert!(solve_on(2) == one && solve_on(7) == one);
}
