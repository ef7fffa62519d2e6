//! The scene with its lightmap as a GLB.
//!
//! One mesh and node for each object, and the cameras. `TEXCOORD_1` are the coordinates in the map. Faces are those
//! that have texels: both sides of a two-sided surface are faces of their own, without the dark insides of things,
//! unless the coordinates are the file's; then materials are two-sided as they were. What materials are depends on the
//! [`Carrier`]:
//!
//! - unlit: one texture for all, of what the surfaces look like, and its coordinates are `TEXCOORD_0`, too, for viewers
//!   that know no others.
//! - MOZ_lightmap: matt materials with colours, textures and emission as they were, and the light map, in 8 bits, attached to
//!   each. Light is exposed, so that a viewer without exposure shows the room as bright as the picture: `intensity` and
//!   emission contain the factor 2^exposure_stops.
//! - sidecar: the same without the map, emission in cd/m².

use super::{BakedScene, Carrier, maps};
use crate::Error;
use crate::export::glb_container::GlbBuilder;
use crate::export::image::encode_png;
use crate::export::scene_glb::{camera_node, material_json};
use glam::Vec2;
use isolux_core::lightmap::{self, Origin};
use isolux_core::math::Rgb;
use isolux_core::scene::{Material, Scene};
use serde_json::{Value, json};
use std::collections::HashMap;

/// Coordinates of the texture of emission: 0 are those of colour, 1 those of the map.
const EMISSION_SET: u32 = 2;

/// The bytes of the file.
///
/// # Errors
/// [`Error::Invalid`] for a scene too large for the format (4 GiB).
pub fn write(baked: &BakedScene) -> Result<Vec<u8>, Error> {
    let scene = &baked.problem.scene;
    let mut glb = GlbBuilder::new();
    glb.set("asset", asset(baked));
    add_materials(baked, &mut glb)?;
    let faces = &baked.lightmap.atlas.faces;
    let mut nodes = Vec::new();
    let mut first = 0;
    for faces in faces.chunk_by(|a, b| a.object(baked.problem) == b.object(baked.problem)) {
        let numbers = first..first + faces.len();
        first = numbers.end;
        let object = &scene.objects[faces[0].object(baked.problem) as usize];
        let primitive = add_faces(baked, &mut glb, numbers, object.material);
        let mesh = glb.push("meshes", json!({ "name": object.name, "primitives": [primitive] }));
        nodes.push(glb.push("nodes", json!({ "name": object.name, "mesh": mesh })));
    }
    nodes.extend(scene.cameras.iter().map(|camera| camera_node(&mut glb, camera)));
    let number = glb.push("scenes", json!({ "name": scene.name, "nodes": nodes }));
    glb.set("scene", json!(number));
    glb.finish()
}

fn asset(baked: &BakedScene) -> Value {
    let meaning = match baked.carrier {
        Carrier::Unlit => {
            "baseColorTexture: radiosity / pi [cd/m^2] times 2^exposure_stops, filmic tone curve (Hable 2010), sRGB"
        }
        Carrier::MozLightmap => {
            "MOZ_lightmap: linear; irradiance [lux] = texel / 255 * lux_at_white; \
             intensity and emission are exposed by 2^exposure_stops"
        }
        Carrier::Sidecar => "TEXCOORD_1: coordinates in the map beside this file; the map holds irradiance [lux]",
    };
    json!({
        "version": "2.0",
        "generator": format!("isolux {}", isolux_core::VERSION),
        "extras": { "isolux": {
            "carrier": baked.carrier.name(),
            "light": meaning,
            "lightmap": baked.file("exr").or(baked.file("png")),
            "exposure_stops": baked.exposure.stops,
            "lux_at_white": baked.lux_at_white,
        } },
    })
}

/// Adds images and materials, numbered as in the scene.
fn add_materials(baked: &BakedScene, glb: &mut GlbBuilder) -> Result<(), Error> {
    let scene = &baked.problem.scene;
    if baked.carrier == Carrier::Unlit {
        let map = add_map(glb, &maps::lit_png(baked, &lightmap::radiosity(baked.problem, &baked.lightmap))?);
        glb.use_extension("KHR_materials_unlit");
        for material in &scene.materials {
            let surface = json!({
                "baseColorTexture": { "index": map, "texCoord": 0 },
                "metallicFactor": 0.0,
                "roughnessFactor": 1.0,
            });
            glb.push(
                "materials",
                json!({
                    "name": material.name,
                    "pbrMetallicRoughness": surface,
                    "doubleSided": is_double_sided(baked, material),
                    "extensions": { "KHR_materials_unlit": {} },
                }),
            );
        }
        return Ok(());
    }
    for image in &scene.images {
        glb.add_image_png(&image.name, &encode_png(image.width, image.height, &image.texels)?);
    }
    let map = match baked.carrier {
        Carrier::MozLightmap => Some(add_map(glb, &maps::linear_png(baked)?)),
        _ => None,
    };
    for material in &scene.materials {
        let two_sided = is_double_sided(baked, material);
        let exposed = if map.is_some() { baked.exposure.scale() } else { 1.0 };
        let shown = Material { two_sided, emission: material.emission * exposed, ..material.clone() };
        let mut json = material_json(glb, &shown, EMISSION_SET);
        // Without it, engines take a share of the light for gloss.
        glb.use_extension("KHR_materials_specular");
        json["extensions"]["KHR_materials_specular"] = json!({ "specularFactor": 0.0 });
        if let Some(map) = map {
            glb.use_extension("MOZ_lightmap");
            let intensity = baked.lux_at_white * baked.exposure.scale();
            json["extensions"]["MOZ_lightmap"] = json!({ "index": map, "texCoord": 1, "intensity": intensity });
        }
        glb.push("materials", json);
    }
    Ok(())
}

/// Adds a map as a texture; gives its index.
fn add_map(glb: &mut GlbBuilder, png: &[u8]) -> usize {
    let source = glb.add_image_png("lightmap", png);
    // Linear between texels, no repetition, and no mipmap: a coarse level mixes charts, and draws dark lines along
    // their borders.
    let sampler = json!({ "magFilter": 9_729, "minFilter": 9_729, "wrapS": 33_071, "wrapT": 33_071 });
    let sampler = glb.push("samplers", sampler);
    glb.push("textures", json!({ "sampler": sampler, "source": source }))
}

fn is_double_sided(baked: &BakedScene, material: &Material) -> bool {
    material.two_sided && baked.lightmap.atlas.origin == Origin::File
}

/// A corner of faces, all that the file has of it.
#[derive(Clone, Copy)]
struct Corner {
    position: [f32; 3],
    map: [f32; 2],
    color: [f32; 3],
    uv: [f32; 2],
    emission_uv: [f32; 2],
}

impl Corner {
    /// Equal if all bits are.
    fn key(&self) -> [u32; 12] {
        let mut bits = [0; 12];
        let all = self.position.iter().chain(&self.map).chain(&self.color).chain(&self.uv).chain(&self.emission_uv);
        bits.iter_mut().zip(all).for_each(|(bits, value)| *bits = value.to_bits());
        bits
    }
}

/// Adds faces as a primitive.
fn add_faces(baked: &BakedScene, glb: &mut GlbBuilder, faces: std::ops::Range<usize>, material: u32) -> Value {
    let mut corners: Vec<Corner> = Vec::new();
    let mut known: HashMap<[u32; 12], u32> = HashMap::new();
    let mut indices = Vec::with_capacity(3 * faces.len());
    for f in faces {
        let mut of_face = [0, 1, 2].map(|k| {
            let corner = corner(baked, f, k);
            *known.entry(corner.key()).or_insert_with(|| {
                corners.push(corner);
                corners.len() as u32 - 1
            })
        });
        if baked.lightmap.atlas.faces[f].back && baked.lightmap.atlas.origin != Origin::File {
            of_face.swap(1, 2);
        }
        indices.extend(of_face);
    }
    let scene = &baked.problem.scene;
    let material_of = &scene.materials[material as usize];
    let map = glb.add_f32x2(&corners.iter().map(|c| c.map).collect::<Vec<_>>());
    let mut attributes = json!({
        "POSITION": glb.add_f32x3(&corners.iter().map(|c| c.position).collect::<Vec<_>>()),
        "TEXCOORD_0": map,
        "TEXCOORD_1": map,
    });
    if baked.carrier != Carrier::Unlit {
        if material_of.reflectivity_texture.is_some() {
            attributes["TEXCOORD_0"] = json!(glb.add_f32x2(&corners.iter().map(|c| c.uv).collect::<Vec<_>>()));
        }
        if material_of.emission_texture.is_some() {
            let uvs: Vec<[f32; 2]> = corners.iter().map(|c| c.emission_uv).collect();
            attributes[format!("TEXCOORD_{EMISSION_SET}")] = json!(glb.add_f32x2(&uvs));
        }
        if corners.iter().any(|c| c.color != [1.0; 3]) {
            attributes["COLOR_0"] = json!(glb.add_f32x3(&corners.iter().map(|c| c.color).collect::<Vec<_>>()));
        }
    }
    let indices = glb.add_indices(&indices);
    json!({ "attributes": attributes, "indices": indices, "material": material })
}

/// Corner `k` of face `f`; what the carrier does not show is left at zero.
fn corner(baked: &BakedScene, f: usize, k: usize) -> Corner {
    let atlas = &baked.lightmap.atlas;
    let face = &atlas.faces[f];
    let position = baked.problem.geometry.surface(face.triangle, face.corners[k]).0.to_array();
    let map = atlas.uv[f][k].to_array();
    if baked.carrier == Carrier::Unlit {
        return Corner { position, map, color: [1.0; 3], uv: [0.0; 2], emission_uv: [0.0; 2] };
    }
    let (color, uv, emission_uv) = of_material(&baked.problem.scene, face.triangle, face.corners[k]);
    Corner { position, map, color: color.to_array(), uv: uv.to_array(), emission_uv: emission_uv.to_array() }
}

/// Vertex colour and texture coordinates at barycentric coordinates of a triangle.
fn of_material(scene: &Scene, triangle: u32, at: Vec2) -> (Rgb, Vec2, Vec2) {
    let [a, b, c] = scene.triangles[triangle as usize].vertices.map(|v| &scene.vertices[v as usize]);
    let (wa, wb, wc) = (1.0 - at.x - at.y, at.x, at.y);
    (
        a.color * wa + b.color * wb + c.color * wc,
        a.uv * wa + b.uv * wb + c.uv * wc,
        a.emission_uv * wa + b.emission_uv * wb + c.emission_uv * wc,
    )
}
