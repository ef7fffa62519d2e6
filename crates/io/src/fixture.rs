//! Small problems with made-up solutions, for the tests of the writers.

use glam::{Vec2, Vec3};
use isolux_core::math::Rgb;
use isolux_core::mesh::Resolution;
use isolux_core::scene::builtin::shapes::Builder;
use isolux_core::scene::*;
use isolux_core::solution::{Balance, Provenance, Work};
use isolux_core::{Problem, Solution};

/// A cube of 2 m with a bright ceiling and one textured, two-sided, tinted wall, seen from inside; every kind of light
/// and camera; names that need quoting.
pub fn scene() -> Scene {
    let corner = |k: usize| Vec3::from([k & 1, k >> 1 & 1, k >> 2 & 1].map(|bit| 2.0 * bit as f32));
    // Floor, ceiling (y = 2), then the walls; counter-clockwise from inside.
    let faces = [[0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5], [0, 2, 6, 4], [1, 5, 7, 3]];
    let names = ["floor", "ceiling", "back, \"wall\"", "front", "left <wall> & co", "größe"];
    let mut lamp = Material::diffuse("lamp", Rgb::grey(0.1));
    lamp.emission = Rgb::new(300.0, 200.0, 50.0);
    let mut papered = Material::diffuse("papered", Rgb::new(0.9, 0.8, 0.7));
    papered.reflectivity_texture = Some(Texture { image: 0, wrap_u: Wrap::ClampToEdge, wrap_v: Wrap::MirroredRepeat });
    papered.emission_texture = Some(Texture { image: 0, wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat });
    papered.emission = Rgb::new(0.0, 2.0, 1.0);
    papered.two_sided = true;
    let materials = vec![Material::diffuse("grey", Rgb::grey(0.5)), lamp, papered];

    let mut scene = Scene {
        name: "box".into(),
        materials,
        images: vec![Image {
            name: "paper".into(),
            width: 2,
            height: 3,
            texels: (0..6).map(|k| [40 * k, 255 - 40 * k, 7]).collect(),
        }],
        lights: lights(),
        cameras: cameras(),
        remarks: vec!["made up".into()],
        ..Scene::default()
    };
    for (k, (face, name)) in faces.iter().zip(names).enumerate() {
        let first = scene.vertices.len() as u32;
        let uvs = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        scene.vertices.extend(face.iter().zip(uvs).map(|(&c, uv)| match k {
            5 => Vertex { position: corner(c), color: Rgb::new(uv.x, 0.5, 1.0), uv, emission_uv: 2.0 * uv },
            _ => Vertex::at(corner(c)),
        }));
        scene.objects.push(Object { name: name.into(), material: [0, 1, 0, 0, 0, 2][k] });
        for vertices in [[first, first + 1, first + 2], [first, first + 2, first + 3]] {
            let source = scene.triangles.len() as u32;
            scene.triangles.push(Triangle { vertices, object: k as u32, source });
        }
    }
    scene
}

fn lights() -> Vec<Light> {
    let position = Vec3::new(0.5, 1.5, 0.7);
    let direction = Vec3::new(1.0, -2.0, 0.5).normalize();
    let light = |name: &str, kind| Light { name: name.into(), intensity: Rgb::new(20.0, 10.0, 5.0), kind };
    vec![
        light("bulb", LightKind::Point { position }),
        light("spot", LightKind::Spot { position, direction, inner_angle: 0.2, outer_angle: 0.5 }),
        light("sun", LightKind::Directional { direction }),
    ]
}

fn cameras() -> Vec<Camera> {
    let mut door = Camera::looking_at("door", Vec3::ONE, Vec3::new(0.1, 0.2, 0.3), 0.8);
    door.aspect = Some(1.5);
    let plan = Camera {
        projection: Projection::Orthographic { height: 2.5 },
        aspect: Some(1.0),
        ..Camera::looking_at("plan", Vec3::ONE, Vec3::X + Vec3::Z, 0.8)
    };
    vec![door, plan]
}

/// [`scene`] in some hundred elements, every number different.
pub fn lit_box() -> (Problem, Solution) {
    let problem = Problem::new(scene(), Resolution::MaxEdge(0.75)).unwrap();
    let solution = made_up(&problem);
    (problem, solution)
}

/// A ball with two sides whose elements are made of many triangles each.
pub fn lit_ball() -> (Problem, Solution) {
    let mut builder = Builder::new("ball");
    let material = builder.material(Material { two_sided: true, ..Material::diffuse("grey", Rgb::grey(0.5)) });
    builder.object("ball", material);
    builder.ball(Vec3::ONE, 1.0, 32);
    let problem = Problem::new(builder.finish(), Resolution::Clustered(200)).unwrap();
    assert!(problem.mesh.has_clusters());
    let solution = made_up(&problem);
    (problem, solution)
}

/// A solution of the right size that no solver would give; one element has no standard error.
pub fn made_up(problem: &Problem) -> Solution {
    let value = |e: u32, k: f32| k * (1.0 + e as f32 / 7.0);
    let mut std_error: Vec<Rgb> =
        problem.mesh.elements().map(|e| Rgb::new(value(e, 0.1), value(e, 0.2), value(e, 0.3))).collect();
    std_error[3] = Rgb::grey(f32::NAN);
    Solution {
        irradiance: problem.mesh.elements().map(|e| Rgb::new(value(e, 1.0), value(e, 2.0), value(e, 3.0))).collect(),
        std_error,
        certainty: None,
        work: Work { rays: 12_345, replicates: 8 },
        balance: Balance { emitted: 100.0, absorbed: 90.0, escaped: 6.0, back_face: 3.0, unshot: 1.0 },
        provenance: Provenance {
            scene: problem.scene.name.clone(),
            scene_hash: problem.scene.hash(),
            method: "made-up".into(),
            parameters: vec![("colour".into(), "any".into())],
            seed: u64::MAX,
            version: isolux_core::VERSION.into(),
        },
        groups: Vec::new(),
    }
}

/// A small xorshift generator: mutations must be the same each time.
pub fn random(state: &mut u64) -> usize {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 16) as usize
}
