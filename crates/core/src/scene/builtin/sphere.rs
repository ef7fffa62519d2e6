//! The inside of an exact sphere of radius 1 m: the one scene where every element's radiosity is known for any
//! reflectivities and emissions, `B_i = Be_i + rho_i mean(Be) / (1 - mean(rho))`, since `F_ij = A_j / A`.
//! Each octant reflects and emits differently in every channel.

use super::{BuiltIn, Expected, Parameter, Parameters};
use crate::Error;
use crate::math::Rgb;
use crate::scene::{Camera, Material, Object, Scene, Shape, Triangle, Vertex, octahedron};
use glam::Vec3;
use std::f32::consts::PI;

pub const SPHERE: BuiltIn = BuiltIn {
    name: "sphere",
    what: "the inside of an exact sphere, every octant different; its solution is known exactly",
    parameters: &[Parameter {
        name: "rho",
        default: 0.5,
        range: [0.001, 0.999],
        what: "the mean reflectivity, from 0.001 to 0.999",
    }],
    build,
    // The luminance of EMISSION summed over the octants, pi/2 m² each.
    expected: Expected { triangles: 8, area: 4.0 * PI as f64, flux: 0.5 * PI as f64 * 1_203.41 },
};

/// Where octant k deviates from the mean reflectivity, as a share of the room there is; each channel sums to zero.
const DEVIATION: [[f32; 3]; 8] = [
    [0.9, -0.5, 0.1],
    [-0.9, 0.5, 0.3],
    [0.4, 0.9, -0.8],
    [-0.4, -0.9, 0.4],
    [0.0, 0.2, 0.9],
    [0.6, -0.2, -0.9],
    [-0.6, 0.7, 0.6],
    [0.0, -0.7, -0.6],
];

/// Emitted exitance [lm/m²] of octant k.
const EMISSION: [[f32; 3]; 8] = [
    [1000.0, 800.0, 500.0],
    [0.0; 3],
    [0.0, 100.0, 0.0],
    [0.0; 3],
    [50.0, 0.0, 200.0],
    [0.0; 3],
    [0.0; 3],
    [200.0, 300.0, 400.0],
];

fn build(parameters: &Parameters) -> Result<Scene, Error> {
    let rho = parameters.get("rho");
    let room = rho.min(1.0 - rho);
    let octants = (0..8).map(|k| format!("octant {k}"));
    let material = |(name, k): (String, usize)| Material {
        emission: Rgb::from(EMISSION[k]),
        ..Material::diffuse(&name, Rgb::from(DEVIATION[k].map(|d| rho + room * d)))
    };
    let triangle = |k: u32| Triangle { vertices: [3 * k, 3 * k + 1, 3 * k + 2], object: k, source: k };
    let view = Camera::looking_at("camera", Vec3::new(0.0, 0.0, 0.9), Vec3::ZERO, 1.6);
    Ok(Scene {
        name: "sphere".to_owned(),
        vertices: octahedron().as_flattened().iter().map(|&p| Vertex::at(p)).collect(),
        triangles: (0..8).map(triangle).collect(),
        objects: octants.clone().zip(0..).map(|(name, material)| Object { name, material }).collect(),
        materials: octants.zip(0..).map(material).collect(),
        cameras: vec![view],
        shape: Shape::Sphere { center: Vec3::ZERO, radius: 1.0 },
        ..Scene::default()
    })
}
