use super::*;
use isolux_core::Solution;
use isolux_core::mesh::{Cut, Division, Slices};
use isolux_core::scene::{Material, Scene, Triangle, Vertex};

/// Two halves of a two-sided unit square with a texture of one dark texel; `light` [lux] in front and behind.
fn square(divisions: &[u16], light: [f32; 2]) -> Vec<u8> {
    square_cut(&Cut::regular(divisions), light)
}

fn square_cut(cut: &Cut, light: [f32; 2]) -> Vec<u8> {
    let mut scene = Scene::default();
    let texture = Texture { image: 0, wrap_u: Wrap::Repeat, wrap_v: Wrap::ClampToEdge };
    scene.images.push(Image { name: "dark".into(), width: 1, height: 1, texels: vec![[100; 3]] });
    let material = Material::diffuse("cloth", Rgb::grey(0.5));
    scene.materials.push(Material { reflectivity_texture: Some(texture), two_sided: true, ..material });
    scene.objects.push(Object { name: "flag".into(), material: 0 });
    scene.vertices = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y].map(Vertex::at).to_vec();
    let halves = [[0, 1, 2], [0, 2, 3]];
    scene.triangles = (0..).zip(halves).map(|(source, vertices)| Triangle { vertices, object: 0, source }).collect();
    scene.cameras.push(Camera::looking_at("eye", Vec3::Z, Vec3::ZERO, 1.0));
    let problem = Problem::with_cut(scene, cut).unwrap();
    let light = |e| Rgb::grey(light[usize::from(problem.mesh.place(e).back)]);
    let irradiance: Vec<Rgb> = problem.mesh.elements().map(light).collect();
    let solution = Solution { std_error: irradiance.clone(), irradiance, ..Solution::default() };
    let options = ExportOptions { exposure: Some(-4.0), ..ExportOptions::default() };
    write(&LitScene::new(&problem, &solution), &options).unwrap()
}

/// Corner positions of all faces, and colours of all vertices.
fn faces(file: &[u8]) -> (Vec<[Vec3; 3]>, Vec<[u16; 4]>) {
    let gltf = gltf::Gltf::from_slice(file).unwrap();
    let primitive = gltf.meshes().next().unwrap().primitives().next().unwrap();
    let reader = primitive.reader(|_| gltf.blob.as_deref());
    let positions: Vec<Vec3> = reader.read_positions().unwrap().map(Vec3::from).collect();
    let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
    let faces = indices.chunks(3).map(|f| [f[0], f[1], f[2]].map(|v| positions[v as usize])).collect();
    (faces, reader.read_colors(0).unwrap().into_rgba_u16().collect())
}

#[test]
fn both_sides_face_their_own_way_and_the_unlit_one_is_left_out() {
    let normal = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a);
    let (both, _) = faces(&square(&[2, 2], [20.0, 10.0]));
    assert_eq!(both.iter().filter(|f| normal(**f).z > 0.0).count(), 8);
    assert_eq!(both.iter().filter(|f| normal(**f).z < 0.0).count(), 8);
    let (front, _) = faces(&square(&[2, 2], [20.0, 0.0]));
    assert!(front.len() == 8 && front.iter().all(|f| normal(*f).z > 0.0));
}

#[test]
fn vertices_know_how_sure_their_light_is() {
    let file = square(&[2, 3], [20.0, 10.0]);
    let gltf = gltf::Gltf::from_slice(&file).unwrap();
    let primitive = gltf.meshes().next().unwrap().primitives().next().unwrap();
    let numbers = |name: &str| {
        let (_, accessor) = primitive.attributes().find(|(s, _)| s.to_string() == name).unwrap();
        let start = accessor.view().unwrap().offset() + accessor.offset();
        let bytes = &gltf.blob.as_deref().unwrap()[start..start + accessor.count() * 12];
        bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect::<Vec<f32>>()
    };
    // The errors of this solution are as large as its light.
    let (light, errors) = (numbers("_IRRADIANCE"), numbers("_STD_ERROR"));
    assert!(!light.is_empty() && light.len() == errors.len());
    assert!(light.iter().zip(&errors).all(|(light, error)| (light - error).abs() < 1e-3), "{errors:?}");
}

#[test]
fn texture_times_colour_is_the_picture() {
    let (_, colors) = faces(&square(&[1, 1], [20.0, 0.0]));
    let seen = 0.5 * Rgb::from_srgb8([100; 3]).g * 20.0 * FRAC_1_PI;
    let shown = Exposure { stops: -4.0 }.display(Rgb::grey(seen)).g;
    // The embedded texture is as bright as it goes, so its one texel is white.
    assert!((f32::from(colors[0][1]) / 65535.0 - shown).abs() < 1e-4);
}

#[test]
fn edges_between_different_divisions_share_all_vertices() {
    let (all, _) = faces(&square(&[3, 4], [20.0, 0.0]));
    let on_diagonal = |p: &Vec3| (p.x - p.y).abs() < 1e-5;
    let mut edges = std::collections::BTreeMap::new();
    for face in &all {
        for k in 0..3 {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            if on_diagonal(&a) && on_diagonal(&b) {
                let key = |p: Vec3| (p.x * 1e4).round() as i32;
                *edges.entry((key(a).min(key(b)), key(a).max(key(b)))).or_insert(0) += 1;
            }
        }
    }
    // Thirds and quarters cut the diagonal into six pieces, each with a face on either side.
    assert_eq!(edges.values().copied().collect::<Vec<_>>(), [2; 6]);
}

#[test]
fn edges_of_bisected_patches_share_all_vertices() {
    let (bisected, cells) = (|from| Division::Bisected { from, share: 0.5 }, Division::Cells);
    let first = [bisected(0), bisected(1), cells(1), bisected(2), cells(2), cells(1), bisected(0), cells(4), cells(1)];
    let second = [bisected(1), cells(1), bisected(0), cells(2), bisected(1), bisected(2), cells(1), cells(1), cells(8)];
    let cut = Cut { slices: vec![Slices::WHOLE; 2], divisions: [first, second].concat(), leaders: Vec::new() };
    let (all, _) = faces(&square_cut(&cut, [20.0, 0.0]));
    let key = |p: Vec3| ((p.x * 1e5).round() as i32, (p.y * 1e5).round() as i32);
    let mut edges = std::collections::BTreeMap::new();
    for face in &all {
        for k in 0..3 {
            let (a, b) = (key(face[k]), key(face[(k + 1) % 3]));
            *edges.entry((a.min(b), a.max(b))).or_insert(0) += 1;
        }
    }
    // Closed but for the border of the square: every edge has a face on either side.
    let on_border = |((ax, ay), (bx, by)): ((i32, i32), (i32, i32))| {
        [0, 100_000].iter().any(|side| (ax == *side && bx == *side) || (ay == *side && by == *side))
    };
    assert!(edges.len() > 100 && edges.iter().all(|(edge, faces)| *faces == if on_border(*edge) { 1 } else { 2 }));
}

#[test]
fn the_file_says_what_it_is_and_where_to_look_from() {
    let file = square(&[1, 1], [20.0, 0.0]);
    let gltf = gltf::Gltf::from_slice(&file).unwrap();
    assert_eq!(gltf.nodes().filter_map(|n| n.name().map(str::to_owned)).collect::<Vec<_>>(), ["flag", "eye"]);
    assert_eq!(gltf.cameras().count(), 1);
    let extras = gltf.document.as_json().asset.extras.as_ref().unwrap();
    assert!(extras.get().contains("\"exposure_stops\":-4.0"));
}
