//! Scenes whose solution is known exactly, and changes of scenes whose effect is.

use crate::ensemble::Exact;
use crate::exact::sphere_radiosities;
use glam::Vec3;
use isolux_core::Problem;
use isolux_core::math::Rgb;
use isolux_core::mesh::Resolution;
use isolux_core::scene::builtin::builtin;
use isolux_core::scene::builtin::shapes::Builder;
use isolux_core::scene::{Material, Scene, Triangle};

/// A built-in scene cut into about `elements` elements.
///
/// # Panics
/// If there is no such scene.
pub fn problem(name: &str, elements: u64) -> Problem {
    cut(scene(name), elements)
}

/// The built-in scene called `name`.
///
/// # Panics
/// If there is no such scene.
pub fn scene(name: &str) -> Scene {
    builtin(name).expect("a built-in scene")
}

/// `scene` cut into about `elements` elements.
///
/// # Panics
/// If it cannot be cut.
pub fn cut(scene: Scene, elements: u64) -> Problem {
    Problem::new(scene, Resolution::Elements(elements)).expect("a scene that can be cut")
}

/// Rectangles given by their corners, counter-clockwise from the front, one object each.
pub fn rectangles(corners: &[[[f32; 3]; 4]]) -> Scene {
    let mut builder = Builder::new("rectangles");
    let white = builder.material(Material::diffuse("white", Rgb::grey(0.5)));
    for quad in corners {
        builder.object("rectangle", white);
        builder.polygon(&quad.map(Vec3::from));
    }
    builder.finish()
}

/// Makes a closed scene a white furnace: everything emits what it does not reflect, so radiosity is 1 everywhere.
pub fn furnace(mut scene: Scene) -> Scene {
    scene.materials.iter_mut().for_each(|m| m.emission = Rgb::WHITE - m.reflectivity);
    scene
}

/// The exact radiosities, and irradiances, of a white furnace.
pub fn furnace_answer(problem: &Problem) -> Exact {
    vec![[1.0; 3]; problem.mesh.len()]
}

/// The exact radiosities inside a sphere.
pub fn sphere_answer(problem: &Problem) -> Exact {
    let mesh = &problem.mesh;
    let of_channel = |c: usize| {
        let value = |color: Rgb| f64::from(color.to_array()[c]);
        let patch = |e| (f64::from(mesh.area(e)), value(mesh.reflectivity(e)), value(mesh.emission(e)));
        sphere_radiosities(&mesh.elements().map(patch).collect::<Vec<_>>())
    };
    let channels = [0, 1, 2].map(of_channel);
    (0..mesh.len()).map(|e| std::array::from_fn(|c| channels[c][e])).collect()
}

/// The exact irradiances inside a sphere: the same everywhere.
pub fn sphere_irradiance(problem: &Problem) -> Exact {
    let mesh = &problem.mesh;
    let mean = |color: &dyn Fn(u32) -> Rgb| {
        let weighted = |e| color(e).to_array().map(|v| f64::from(v) * f64::from(mesh.area(e)) / mesh.total_area());
        mesh.elements().map(weighted).fold([0.0; 3], |sum, v| std::array::from_fn(|c| sum[c] + v[c]))
    };
    let (emission, reflectivity) = (mean(&|e| mesh.emission(e)), mean(&|e| mesh.reflectivity(e)));
    vec![std::array::from_fn(|c| emission[c] / (1.0 - reflectivity[c])); mesh.len()]
}

/// Turns an object inside out.
///
/// # Panics
/// If there is no such object.
pub fn flip(scene: &mut Scene, object: &str) {
    let object = scene.objects.iter().position(|o| o.name == object).expect("an object of the scene") as u32;
    let turn = |t: &mut Triangle| t.vertices.swap(1, 2);
    scene.triangles.iter_mut().filter(|t| t.object == object).for_each(turn);
}

/// Multiplies everything that the scene emits.
pub fn brighten(scene: &mut Scene, factor: f32) {
    scene.materials.iter_mut().for_each(|m| m.emission = m.emission * factor);
    scene.lights.iter_mut().for_each(|l| l.intensity = l.intensity * factor);
}
