//! Surfaces that are cut where others stand on them: no light passes below, and nothing shows that elements are finite there.

use glam::Vec3;
use isolux_core::math::Rgb;
use isolux_core::mesh::Resolution;
use isolux_core::scene::builtin::shapes::Builder;
use isolux_core::scene::{Material, Scene};
use isolux_core::solvers::monte_carlo::{METHODS, Settings};
use isolux_core::transport::Leaving;
use isolux_core::view::VertexField;
use isolux_core::{Problem, Solution};
use isolux_testing::ensemble::{solve, with_rays};

const DETAIL: f32 = 0.03;

/// A room 1 m high and deep with a lamp for its first wall, and what `furnish` puts into it, of a two-sided material.
fn room(length: f32, furnish: impl Fn(&mut Builder)) -> Scene {
    let mut builder = Builder::new("room");
    let white = Material::diffuse("white", Rgb::grey(0.7));
    let walls = builder.material(white.clone());
    let inner = builder.material(Material { two_sided: true, ..white.clone() });
    let lamp = builder.material(Material { emission: Rgb::grey(10.0), ..white });
    let cuts: [&[f32]; 3] = [&[0.0, length], &[0.0, 1.0], &[0.0, 1.0]];
    builder.look_inwards(true);
    builder.object("walls", walls);
    builder.cut_box(cuts, |p| p, |axis, greater, _, _| (axis, greater) != (0, false));
    builder.object("lamp", lamp);
    builder.cut_box(cuts, |p| p, |axis, greater, _, _| (axis, greater) == (0, false));
    builder.look_inwards(false);
    builder.object("inner", inner);
    furnish(&mut builder);
    builder.finish()
}

/// A box in the middle of the room, with its lower face at z = `low` if it has one.
fn boxed(low: f32, has_bottom: bool) -> Scene {
    room(1.0, |builder| {
        let cuts: [&[f32]; 3] = [&[0.31, 0.72], &[0.33, 0.69], &[low, low + 0.4]];
        builder.cut_box(cuts, |p| p, |axis, greater, _, _| has_bottom || (axis, greater) != (2, false));
    })
}

/// `scene` in about `elements` elements, cut along contacts if that `is_asked`.
fn cut(scene: &Scene, elements: u64, is_asked: bool) -> Problem {
    let resolution = Resolution::Elements(elements);
    let made = if is_asked {
        Problem::cut_along_contacts(scene.clone(), resolution, DETAIL)
    } else {
        Problem::new(scene.clone(), resolution)
    };
    made.expect("a room that can be cut")
}

/// Mean irradiance of the elements of `object` that all lie where `keep` says, by their corners and whether they are on the back.
fn mean(problem: &Problem, solution: &Solution, object: u32, keep: impl Fn(&[Vec3; 3], bool) -> bool) -> f64 {
    let corners = |e: u32| problem.mesh.corners(e).map(|uv| problem.geometry.surface(problem.mesh.triangle(e), uv).0);
    let on = |&e: &u32| problem.object(e) == object && keep(&corners(e), problem.mesh.place(e).back);
    let (flux, area) = problem.mesh.elements().filter(on).fold((0.0, 0.0), |(flux, area), e| {
        let own = f64::from(problem.mesh.area(e));
        (flux + own * solution.irradiance[e as usize].luminance_f64(), area + own)
    });
    flux / area
}

/// The default method, and one that sends light out from whole elements: the leakiest there is.
///
/// Lines that meet the edge between two faces are as near to one as to the other, to the last bit of their distance; of light that
/// leaves a room they let 1e-7 to 4e-7 pass (30 million rays, either method). So many rays as here make one of them worth 1e-7.
fn settings() -> [Settings; 2] {
    let rays = with_rays(3_000_000);
    [Settings { method: METHODS[0].method, ..rays }, Settings { leaving: Leaving::WholeElement, ..rays }]
}

#[test]
fn a_closed_box_in_a_bright_room_is_black_inside() {
    for (low, has_bottom) in [(0.3, true), (0.0, true), (0.0, false), (-0.1, true), (-0.1, false)] {
        for settings in settings() {
            let inside = |is_cut: bool| {
                let problem = cut(&boxed(low, has_bottom), 2000, is_cut);
                let solution = solve(&problem, settings);
                let of_side = |asked: bool| mean(&problem, &solution, 2, |_, back| back == asked);
                of_side(true) / of_side(false)
            };
            let (whole, cut) = (inside(false), inside(true));
            assert!(cut < 1e-6, "z = {low}, bottom {has_bottom}: {cut} of the light outside");
            assert!(whole > 1e-3 || low > 0.0, "z = {low}, bottom {has_bottom}: it must leak to begin with: {whole}");
        }
    }
}

#[test]
fn rooms_on_both_sides_of_a_wall_without_thickness_do_not_mix() {
    for x in [0.86, 0.94, 1.02] {
        let rooms = room(2.0, |builder| {
            builder.polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[y, z]| Vec3::new(x, y, z)));
        });
        for settings in settings() {
            let dark = |is_cut: bool| {
                let problem = cut(&rooms, 2000, is_cut);
                let solution = solve(&problem, settings);
                let bright = mean(&problem, &solution, 0, |corners, _| corners.iter().all(|p| p.x < x + 1e-4));
                mean(&problem, &solution, 0, |corners, _| corners.iter().all(|p| p.x > x - 1e-4)) / bright
            };
            let (whole, cut) = (dark(false), dark(true));
            assert!(cut < 1e-6, "x = {x}: {cut} of the light in the other room");
            assert!(whole > 1e-4, "x = {x}: it must leak to begin with: {whole}");
        }
    }
}

/// In a room in which light is the same everywhere, a box stands on or is sunk into a floor, which gets none under it: elements of the floor
/// that are neither, and vertices of the open floor that are off.
fn fringe(problem: &Problem) -> (usize, usize) {
    let solution = solve(problem, with_rays(1_000_000));
    let is_floor = |&e: &u32| problem.object(e) == 0;
    let is_between = |e: &u32| (0.15..0.85).contains(&solution.irradiance[*e as usize].luminance());
    let between = problem.mesh.elements().filter(is_floor).filter(is_between).count();
    let field = VertexField::as_computed(problem, &solution);
    let lit = problem.mesh.elements().filter(is_floor).filter(|&e| solution.irradiance[e as usize].luminance() > 0.5);
    let is_off = |v: &u32| (field.irradiance(*v).luminance() - 1.0).abs() > 0.15;
    (between, lit.flat_map(|e| field.vertices_at(problem, problem.mesh.place(e))).filter(is_off).count())
}

#[test]
fn boxes_on_and_in_a_floor_have_no_fringe() {
    for low in [0.0, -0.1] {
        let mut scene = boxed(low, true);
        for material in &mut scene.materials {
            (material.reflectivity, material.emission) = (Rgb::grey(0.5), Rgb::grey(0.5));
            // Behind it nothing is seen, and there is no light.
            material.two_sided = false;
        }
        let (cut, whole) = (fringe(&cut(&scene, 3000, true)), fringe(&cut(&scene, 3000, false)));
        assert_eq!(cut, (0, 0), "z = {low}");
        assert!(whole.0 > 10, "z = {low}: elements lie on both sides to begin with: {whole:?}");
    }
}
