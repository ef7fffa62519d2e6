//! A scene as plain glTF 2.0 (binary): geometry, diffuse materials, textures, lights and cameras, no solution in it.
//!
//! One mesh and one node for each object that has triangles, in their order, so triangles come object by object. Read
//! back it is the same scene, up to the last digit of emissions and directions. Exitances become luminances in cd/m²
//! (`L = Be / pi`, as KHR_materials_emissive_strength counts), intensities stay in candela and lux
//! (KHR_lights_punctual). Surfaces are written as rough non-metals, so that other viewers show them matt. Coordinates in a
//! lightmap are `TEXCOORD_1`, and keep every bit. glTF knows no exact sphere; one is written as triangles whose corners lie
//! on it, without a lightmap.

use super::glb_container::GlbBuilder;
use super::image::encode_png;
use crate::Error;
use glam::{Mat3, Quat, Vec3};
use isolux_core::geometry;
use isolux_core::math::Rgb;
use isolux_core::mesh::cells;
use isolux_core::scene::{
    Camera, Light, LightKind, Material, Projection, Scene, Shape, Texture, Triangle, Vertex, Wrap,
};
use serde_json::{Map, Value, json};
use std::f32::consts::PI;

/// Along each edge of the octahedron whose faces become a sphere: the area comes out 0.08 % too small.
const SPHERE_DIVISIONS: u16 = 32;

/// The bytes of the file.
///
/// # Errors
/// [`Error::Invalid`] if the scene has an index or a number that no file should have, or is too large for the format.
pub fn write(scene: &Scene) -> Result<Vec<u8>, Error> {
    scene.validate().map_err(|fault| Error::Invalid {
        file: scene.name.clone(),
        place: fault.place,
        what: fault.what,
    })?;
    if let Shape::Sphere { .. } = scene.shape {
        return write(&tessellated(scene));
    }
    let mut glb = GlbBuilder::new();
    for image in &scene.images {
        glb.add_image_png(&image.name, &encode_png(image.width, image.height, &image.texels)?);
    }
    for material in &scene.materials {
        let material = material_json(&mut glb, material, emission_set(scene));
        glb.push("materials", material);
    }
    let mut nodes = Vec::new();
    for (object, triangles) in triangles_by_object(scene).iter().enumerate().filter(|(_, t)| !t.is_empty()) {
        nodes.push(object_node(&mut glb, scene, object, triangles));
    }
    nodes.extend(scene.cameras.iter().map(|camera| camera_node(&mut glb, camera)));
    nodes.extend(scene.lights.iter().enumerate().map(|(k, light)| light_node(&mut glb, k, light)));
    if !scene.lights.is_empty() {
        let lights: Vec<Value> = scene.lights.iter().map(light_json).collect();
        glb.use_extension("KHR_lights_punctual");
        glb.set("extensions", json!({ "KHR_lights_punctual": { "lights": lights } }));
    }
    if !nodes.is_empty() {
        glb.push("scenes", json!({ "name": scene.name, "nodes": nodes }));
        glb.set("scene", json!(0));
    }
    glb.finish()
}

/// Coordinates of the texture of emission: behind those of colour and those of the lightmap, if there are some.
fn emission_set(scene: &Scene) -> u32 {
    1 + u32::from(!scene.lightmap_uvs.is_empty())
}

/// Numbers of the triangles of each object.
fn triangles_by_object(scene: &Scene) -> Vec<Vec<u32>> {
    let mut lists = vec![Vec::new(); scene.objects.len()];
    for (t, triangle) in scene.triangles.iter().enumerate() {
        lists[triangle.object as usize].push(t as u32);
    }
    lists
}

/// Writes an object as a mesh; gives the index of its node.
fn object_node(glb: &mut GlbBuilder, scene: &Scene, object: usize, triangles: &[u32]) -> usize {
    let (numbers, indices) = own_vertices(scene, triangles);
    let vertices: Vec<Vertex> = numbers.iter().map(|&v| scene.vertices[v as usize]).collect();
    let object = &scene.objects[object];
    let material = &scene.materials[object.material as usize];
    let has_map = !scene.lightmap_uvs.is_empty();
    let positions: Vec<[f32; 3]> = vertices.iter().map(|v| v.position.to_array()).collect();
    let mut attributes = Map::new();
    attributes.insert("POSITION".into(), json!(glb.add_f32x3(&positions)));
    if vertices.iter().any(|v| v.color != Rgb::WHITE) {
        let colors: Vec<[f32; 3]> = vertices.iter().map(|v| v.color.to_array()).collect();
        attributes.insert("COLOR_0".into(), json!(glb.add_f32x3(&colors)));
    }
    // Sets are numbered without gaps.
    if material.reflectivity_texture.is_some() || material.emission_texture.is_some() || has_map {
        let uvs: Vec<[f32; 2]> = vertices.iter().map(|v| v.uv.to_array()).collect();
        attributes.insert("TEXCOORD_0".into(), json!(glb.add_f32x2(&uvs)));
    }
    if has_map {
        let uvs: Vec<[f32; 2]> = numbers.iter().map(|&v| scene.lightmap_uvs[v as usize].to_array()).collect();
        attributes.insert("TEXCOORD_1".into(), json!(glb.add_f32x2(&uvs)));
    }
    if material.emission_texture.is_some() {
        let uvs: Vec<[f32; 2]> = vertices.iter().map(|v| v.emission_uv.to_array()).collect();
        attributes.insert(format!("TEXCOORD_{}", emission_set(scene)), json!(glb.add_f32x2(&uvs)));
    }
    let indices = glb.add_indices(&indices);
    let primitive = json!({ "attributes": attributes, "indices": indices, "material": object.material });
    let mesh = glb.push("meshes", json!({ "name": object.name, "primitives": [primitive] }));
    glb.push("nodes", json!({ "name": object.name, "mesh": mesh }))
}

/// Numbers of the vertices that `triangles` use, in the order of first use, and the triangles' indices into them.
fn own_vertices(scene: &Scene, triangles: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let used = triangles.iter().flat_map(|&t| scene.triangles[t as usize].vertices);
    let mut numbers = std::collections::HashMap::new();
    let mut vertices = Vec::new();
    let indices = used
        .map(|v| {
            *numbers.entry(v).or_insert_with(|| {
                vertices.push(v);
                vertices.len() as u32 - 1
            })
        })
        .collect();
    (vertices, indices)
}

/// A material as glTF has it, luminances in cd/m²; the texture of its emission takes the set `emission_coordinates` of texture
/// coordinates. Images of the scene are expected to be those of the file.
pub(super) fn material_json(glb: &mut GlbBuilder, material: &Material, emission_coordinates: u32) -> Value {
    let [r, g, b] = material.reflectivity.to_array();
    let mut surface = json!({ "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0 });
    if let Some(texture) = &material.reflectivity_texture {
        surface["baseColorTexture"] = json!({ "index": texture_index(glb, texture), "texCoord": 0 });
    }
    let mut json = json!({ "name": material.name, "pbrMetallicRoughness": surface, "doubleSided": material.two_sided });
    let brightest = material.emission.max_channel();
    if brightest > 0.0 {
        glb.use_extension("KHR_materials_emissive_strength");
        json["emissiveFactor"] = json!((material.emission / brightest).to_array());
        json["extensions"] = json!({ "KHR_materials_emissive_strength": { "emissiveStrength": brightest / PI } });
    }
    if let Some(texture) = &material.emission_texture {
        json["emissiveTexture"] = json!({ "index": texture_index(glb, texture), "texCoord": emission_coordinates });
    }
    json
}

fn texture_index(glb: &mut GlbBuilder, texture: &Texture) -> usize {
    let code = |wrap| match wrap {
        Wrap::Repeat => 10_497,
        Wrap::MirroredRepeat => 33_648,
        Wrap::ClampToEdge => 33_071,
    };
    let sampler = glb.push("samplers", json!({ "wrapS": code(texture.wrap_u), "wrapT": code(texture.wrap_v) }));
    glb.push("textures", json!({ "source": texture.image, "sampler": sampler }))
}

fn light_json(light: &Light) -> Value {
    let intensity = light.intensity.max_channel();
    let color = if intensity > 0.0 { light.intensity / intensity } else { Rgb::WHITE };
    let mut json = json!({ "name": light.name, "color": color.to_array(), "intensity": intensity });
    match light.kind {
        LightKind::Point { .. } => json["type"] = json!("point"),
        LightKind::Directional { .. } => json["type"] = json!("directional"),
        LightKind::Spot { inner_angle, outer_angle, .. } => {
            json["type"] = json!("spot");
            json["spot"] = json!({ "innerConeAngle": inner_angle, "outerConeAngle": outer_angle });
        }
    }
    json
}

/// Lights shine along the -z axis of their node.
fn light_node(glb: &mut GlbBuilder, index: usize, light: &Light) -> usize {
    let (position, direction) = match light.kind {
        LightKind::Point { position } => (position, Vec3::NEG_Z),
        LightKind::Spot { position, direction, .. } => (position, direction),
        LightKind::Directional { direction } => (Vec3::ZERO, direction),
    };
    let rotation = Quat::from_rotation_arc(Vec3::NEG_Z, direction.normalize_or(Vec3::NEG_Z));
    let mut node = placed_node(&light.name, position, rotation);
    node["extensions"] = json!({ "KHR_lights_punctual": { "light": index } });
    glb.push("nodes", node)
}

/// Cameras look along the -z axis of their node, y upwards.
pub(super) fn camera_node(glb: &mut GlbBuilder, camera: &Camera) -> usize {
    let mut json = json!({ "name": camera.name });
    match camera.projection {
        Projection::Perspective { vertical_angle } => {
            json["type"] = json!("perspective");
            json["perspective"] = json!({ "yfov": vertical_angle, "znear": 0.01 });
            if let Some(aspect) = camera.aspect {
                json["perspective"]["aspectRatio"] = json!(aspect);
            }
        }
        Projection::Orthographic { height } => {
            let (ymag, xmag) = (0.5 * height, 0.5 * height * camera.aspect.unwrap_or(1.0));
            json["type"] = json!("orthographic");
            json["orthographic"] = json!({ "xmag": xmag, "ymag": ymag, "znear": 0.0, "zfar": 1000.0 });
        }
    }
    let index = glb.push("cameras", json);
    let axes = Mat3::from_cols(camera.forward.cross(camera.up), camera.up, -camera.forward);
    let mut node = placed_node(&camera.name, camera.position, Quat::from_mat3(&axes).normalize());
    node["camera"] = json!(index);
    glb.push("nodes", node)
}

fn placed_node(name: &str, position: Vec3, rotation: Quat) -> Value {
    json!({ "name": name, "translation": position.to_array(), "rotation": rotation.to_array() })
}

/// The same scene with a sphere made of triangles.
fn tessellated(scene: &Scene) -> Scene {
    let sphere = geometry::for_scene(scene);
    let mut flat = Scene {
        vertices: Vec::new(),
        triangles: Vec::new(),
        lightmap_uvs: Vec::new(),
        shape: Shape::Triangles,
        ..scene.clone()
    };
    for (t, triangle) in scene.triangles.iter().enumerate() {
        for cell in 0..cells::count(SPHERE_DIVISIONS) {
            let first = flat.vertices.len() as u32;
            let corners = cells::corners(cell, SPHERE_DIVISIONS);
            flat.vertices.extend(corners.map(|uv| Vertex::at(sphere.surface(t as u32, uv).0)));
            flat.triangles.push(Triangle { vertices: [first, first + 1, first + 2], ..*triangle });
        }
    }
    flat
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use crate::import::{self, ImportOptions};
    use glam::Vec2;
    use std::path::Path;

    /// Read with the gltf crate, not with our importer: two mistakes must not cancel.
    #[test]
    fn the_file_says_what_the_scene_says() {
        let scene = fixture::scene();
        let gltf = gltf::Gltf::from_slice(&write(&scene).unwrap()).unwrap();
        let meshes: Vec<gltf::Node> = gltf.nodes().filter(|node| node.mesh().is_some()).collect();
        assert!(meshes.iter().map(|node| node.name().unwrap()).eq(scene.objects.iter().map(|o| o.name.as_str())));
        let corners = meshes.iter().flat_map(|node| {
            let primitive = node.mesh().unwrap().primitives().next().unwrap();
            let reader = primitive.reader(|_| gltf.blob.as_deref());
            let positions: Vec<Vec3> = reader.read_positions().unwrap().map(Vec3::from).collect();
            reader.read_indices().unwrap().into_u32().map(move |k| positions[k as usize]).collect::<Vec<_>>()
        });
        assert!(corners.eq((0..scene.triangles.len() as u32).flat_map(|t| scene.corners(t))));

        for (read, material) in gltf.materials().zip(&scene.materials) {
            assert_eq!(read.pbr_metallic_roughness().base_color_factor()[..3], material.reflectivity.to_array());
            assert_eq!(
                (read.double_sided(), read.pbr_metallic_roughness().metallic_factor()),
                (material.two_sided, 0.0)
            );
            let exitance = read.emissive_factor().map(|c| c * read.emissive_strength().unwrap_or(1.0) * PI);
            assert!(Vec3::from(exitance).distance(Vec3::from(material.emission.to_array())) < 1e-3);
        }
        let texture = gltf.materials().nth(2).unwrap().pbr_metallic_roughness().base_color_texture().unwrap();
        assert_eq!(texture.texture().sampler().wrap_t(), gltf::texture::WrappingMode::MirroredRepeat);

        let lights: Vec<gltf::Node> = gltf.nodes().filter(|node| node.light().is_some()).collect();
        assert_eq!(lights.len(), 3);
        for (node, light) in lights.iter().zip(&scene.lights) {
            let read = node.light().unwrap();
            let intensity = read.color().map(|c| c * read.intensity());
            assert!(Vec3::from(intensity).distance(Vec3::from(light.intensity.to_array())) < 1e-5);
            let (LightKind::Spot { direction, .. } | LightKind::Directional { direction }) = light.kind else {
                continue;
            };
            let rotation = Quat::from_array(node.transform().decomposed().1);
            assert!((rotation * Vec3::NEG_Z).distance(direction) < 1e-6);
        }
        for (node, camera) in gltf.nodes().filter(|node| node.camera().is_some()).zip(&scene.cameras) {
            let (position, rotation, _) = node.transform().decomposed();
            assert_eq!(Vec3::from(position), camera.position);
            let rotation = Quat::from_array(rotation);
            assert!((rotation * Vec3::NEG_Z).distance(camera.forward) < 1e-6);
            assert!((rotation * Vec3::Y).distance(camera.up) < 1e-6);
        }
    }

    #[test]
    fn textures_and_colours_are_in_the_file() {
        let scene = fixture::scene();
        let gltf = gltf::Gltf::from_slice(&write(&scene).unwrap()).unwrap();
        let blob = gltf.blob.as_deref().unwrap();
        let gltf::image::Source::View { view, .. } = gltf.images().next().unwrap().source() else { panic!("embedded") };
        let png = &blob[view.offset()..view.offset() + view.length()];
        let image = ::image::load_from_memory(png).unwrap().into_rgb8();
        assert_eq!(image.as_raw().as_slice(), scene.images[0].texels.as_flattened());

        let wall = gltf.meshes().last().unwrap().primitives().next().unwrap();
        let reader = wall.reader(|_| Some(blob));
        let colors: Vec<[f32; 3]> = reader.read_colors(0).unwrap().into_rgb_f32().collect();
        let uvs: Vec<[f32; 2]> = reader.read_tex_coords(1).unwrap().into_f32().collect();
        let expected = &scene.vertices[20..];
        assert!(colors.iter().copied().eq(expected.iter().map(|v| v.color.to_array())));
        assert!(uvs.iter().copied().eq(expected.iter().map(|v| v.emission_uv.to_array())));
    }

    /// Also where materials have textures of their own, and where vertices were split for it.
    #[test]
    fn coordinates_in_a_lightmap_come_back_to_the_last_bit() {
        let mut scene = fixture::scene();
        let count = scene.triangles.len() as f32;
        let corners: Vec<[Vec2; 3]> = (0..scene.triangles.len())
            .map(|t| [Vec2::ZERO, Vec2::X, Vec2::Y].map(|uv| (uv + Vec2::X * t as f32) / count))
            .collect();
        scene.set_lightmap_corners(&corners).unwrap();
        let importer = import::FORMATS.iter().find(|format| format.extensions.contains(&"glb")).unwrap();
        let read = (importer.read)(Path::new("a.glb"), &write(&scene).unwrap(), &ImportOptions::default()).unwrap();
        assert_eq!(read.lightmap_corners().unwrap(), corners);
        let of_textures = |scene: &Scene, t: usize| {
            scene.triangles[t].vertices.map(|v| scene.vertices[v as usize]).map(|v| (v.color, v.uv, v.emission_uv))
        };
        assert!((10..12).all(|t| of_textures(&read, t) == of_textures(&scene, t)));
        assert_eq!(read.materials[2].emission_texture.map(|t| t.wrap_u), Some(Wrap::Repeat));

        let mut sphere = isolux_core::scene::builtin::builtin("sphere").unwrap();
        sphere.lightmap_uvs = vec![Vec2::ZERO; sphere.vertices.len()];
        assert!(write(&sphere).is_ok());
    }

    #[test]
    fn a_bad_index_is_an_error_and_an_empty_scene_a_file() {
        let mut scene = fixture::scene();
        scene.triangles[3].vertices[1] = 999;
        assert!(write(&scene).unwrap_err().to_string().contains("triangles/3"));
        assert!(gltf::Gltf::from_slice(&write(&Scene::default()).unwrap()).is_ok());
    }
}
