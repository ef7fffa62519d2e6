//! The lit scene as a GLB that any viewer shows as it is: unlit materials, the light in the vertices' colours.
//!
//! One mesh and node for each object, by its name, and the scene's cameras. `COLOR_0` is the tone-mapped radiosity; where
//! the material has a texture it stays at full resolution and `COLOR_0` is what the texture must be multiplied by to look
//! like the picture. Both sides of a two-sided surface are there as faces of their own, each with its own light, but for the dark insides
//! of things. The
//! numbers themselves are in the attributes `_IRRADIANCE` and `_STD_ERROR` [lux], linear Rec. 709; `asset.extras` says so in the file.

use super::faces::{Faces, elements_by_object, mean};
use super::glb_container::GlbBuilder;
use super::image::encode_png;
use super::picture::view_options;
use super::{ExportOptions, LitScene, Smoothing};
use crate::Error;
use glam::{Mat3, Quat, Vec2, Vec3};
use isolux_core::Problem;
use isolux_core::math::Rgb;
use isolux_core::math::color::linear_to_srgb;
use isolux_core::mesh::Place;
use isolux_core::scene::{Camera, Image, Object, Projection, Texture, Wrap};
use isolux_core::view::{self, Exposure, VertexField};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::f32::consts::FRAC_1_PI;

/// The file's bytes, exposed as the picture that `options` ask for.
///
/// # Errors
/// [`Error::Invalid`] for a scene too large for the format (4 GiB); [`Error::Core`] for a camera that is not there.
pub fn write(lit: &LitScene, options: &ExportOptions) -> Result<Vec<u8>, Error> {
    let exposure = view::exposure(lit.problem, lit.field(), &view_options(options))?;
    write_field(lit.problem, lit.field(), exposure, options.smoothing)
}

fn write_field(
    problem: &Problem,
    field: &VertexField,
    exposure: Exposure,
    smoothing: Smoothing,
) -> Result<Vec<u8>, Error> {
    let faces = Faces::new(problem, field);
    let mut writer = Writer { problem, field, exposure, faces, glb: GlbBuilder::new(), images: HashMap::new() };
    writer.glb.set("asset", asset(exposure, smoothing));
    writer.glb.use_extension("KHR_materials_unlit");
    let mut nodes = Vec::new();
    for (object, elements) in problem.scene.objects.iter().zip(elements_by_object(problem)) {
        if !elements.is_empty() {
            let mesh = writer.add_object(object, &elements)?;
            nodes.push(writer.glb.push("nodes", json!({ "name": object.name, "mesh": mesh })));
        }
    }
    let far = 4.0 * problem.geometry.bounding_sphere().1;
    for camera in &problem.scene.cameras {
        let number = writer.glb.push("cameras", camera_json(camera, far));
        nodes.push(writer.glb.push("nodes", camera_node(camera, number)));
    }
    let scene = writer.glb.push("scenes", json!({ "name": problem.scene.name, "nodes": nodes }));
    writer.glb.set("scene", json!(scene));
    writer.glb.finish()
}

fn asset(exposure: Exposure, smoothing: Smoothing) -> Value {
    json!({
        "version": "2.0",
        "generator": format!("isolux {}", isolux_core::VERSION),
        "extras": { "isolux": {
            "exposure_stops": exposure.stops,
            "ev100": exposure.ev100(),
            "smoothing": smoothing.name(),
            "COLOR_0": "radiosity / pi [cd/m^2] times 2^exposure_stops, filmic tone curve (Hable 2010), linear; \
                        divided by the texture's mean where there is a texture",
            "_IRRADIANCE": "irradiance [lux], linear Rec. 709; illuminance = 0.2126 r + 0.7152 g + 0.0722 b",
            "_STD_ERROR": "standard error of the irradiance [lux]: mean of those of the elements around, before smoothing",
        } },
    })
}

struct Writer<'a> {
    problem: &'a Problem,
    field: &'a VertexField,
    exposure: Exposure,
    faces: Faces<'a>,
    glb: GlbBuilder,
    /// Embedded images by their number in the scene.
    images: HashMap<u32, EmbeddedImage>,
}

#[derive(Clone, Copy)]
struct EmbeddedImage {
    index: usize,
    /// Linear mean colour of the image, as it is in the scene.
    mean: Rgb,
    /// The brightest channel of any texel, by which the embedded image is divided. `COLOR_0` cannot exceed 1, so a dark
    /// texture in bright light needs this room.
    brightest: f32,
}

/// The texture that an object's faces keep.
#[derive(Clone, Copy)]
struct Skin {
    texture: Texture,
    image: EmbeddedImage,
    /// Whether it is the texture of the emission, which outshines the other.
    emits: bool,
}

/// Floats as a key: equal if all their bits are.
type Bits<const N: usize> = [u32; N];

/// A mesh under construction.
#[derive(Default)]
struct Vertices {
    position: Vec<[f32; 3]>,
    color: Vec<[u16; 4]>,
    irradiance: Vec<[f32; 3]>,
    std_error: Vec<[f32; 3]>,
    uv: Vec<[f32; 2]>,
    known: HashMap<(Bits<3>, Bits<3>, Bits<2>, [u16; 4]), u32>,
}

impl Writer<'_> {
    /// Adds the mesh of an object and gives its index.
    fn add_object(&mut self, object: &Object, elements: &[u32]) -> Result<usize, Error> {
        let skin = self.skin(object)?;
        let mut vertices = Vertices::default();
        let mut indices = Vec::with_capacity(3 * elements.len());
        for &e in elements {
            if self.faces.is_inside(e) {
                continue;
            }
            for place in self.problem.mesh.pieces(e) {
                let add = |weights, position| self.add_vertex(place, weights, position, skin, &mut vertices);
                self.faces.draw(place, add, &mut indices);
            }
        }
        let mut attributes = json!({
            "POSITION": self.glb.add_f32x3(&vertices.position),
            "COLOR_0": self.glb.add_unorm16x4(&vertices.color),
            "_IRRADIANCE": self.glb.add_f32x3(&vertices.irradiance),
        });
        if self.field.is_error_known() {
            attributes["_STD_ERROR"] = json!(self.glb.add_f32x3(&vertices.std_error));
        }
        if skin.is_some() {
            attributes["TEXCOORD_0"] = json!(self.glb.add_f32x2(&vertices.uv));
        }
        let indices = self.glb.add_indices(&indices);
        let material = self.add_material(object, skin);
        let primitive = json!({ "attributes": attributes, "indices": indices, "material": material });
        Ok(self.glb.push("meshes", json!({ "name": object.name, "primitives": [primitive] })))
    }

    /// The vertex at the given weights of the corners of a place where an element lies.
    fn add_vertex(&self, at: Place, weights: Vec3, position: Vec3, skin: Option<Skin>, vertices: &mut Vertices) -> u32 {
        let material = self.problem.scene.material_of(at.triangle);
        let coating = self.faces.coating(at, weights);
        let texture_uv = skin.map_or(Vec2::ZERO, |skin| if skin.emits { coating.emission_uv } else { coating.uv });
        let corners = self.field.vertices_at(self.problem, at);
        let irradiance = mean(corners, weights, |v| self.field.irradiance(v));
        let std_error = mean(corners, weights, |v| self.field.std_error(v));
        let color = self.color(material.reflectivity * coating.tint * irradiance, material.emission, skin);
        let light = [irradiance, std_error].map(Rgb::to_array);
        vertices.number(position.to_array(), light, texture_uv.to_array(), color)
    }

    /// `COLOR_0` for reflected and emitted light [lm/m²] before textures.
    fn color(&self, reflected: Rgb, emitted: Rgb, skin: Option<Skin>) -> [u16; 4] {
        let shown = |radiosity: Rgb| self.exposure.display(radiosity * FRAC_1_PI);
        let color = match skin {
            None => shown(reflected + emitted),
            Some(Skin { image, emits, .. }) => {
                let radiosity = if emits { reflected + emitted * image.mean } else { reflected * image.mean + emitted };
                let shown = shown(radiosity).to_array();
                let mean = image.mean.to_array();
                Rgb::from(std::array::from_fn(|c| shown[c] / mean[c].max(1e-3) * image.brightest))
            }
        };
        let [r, g, b] = color.to_array().map(|v| (v.clamp(0.0, 1.0) * 65535.0).round() as u16);
        [r, g, b, u16::MAX]
    }

    fn skin(&mut self, object: &Object) -> Result<Option<Skin>, Error> {
        let scene = &self.problem.scene;
        let material = &scene.materials[object.material as usize];
        let emission_texture = material.emission_texture.filter(|_| material.is_emitter());
        let Some(texture) = emission_texture.or(material.reflectivity_texture) else { return Ok(None) };
        let image = match self.images.get(&texture.image) {
            Some(image) => *image,
            None => {
                let image = embed(&mut self.glb, &scene.images[texture.image as usize])?;
                self.images.insert(texture.image, image);
                image
            }
        };
        Ok(Some(Skin { texture, image, emits: emission_texture.is_some() }))
    }

    fn add_material(&mut self, object: &Object, skin: Option<Skin>) -> usize {
        let name = &self.problem.scene.materials[object.material as usize].name;
        let mut surface = json!({ "metallicFactor": 0.0, "roughnessFactor": 1.0 });
        if let Some(Skin { texture, image, .. }) = skin {
            let wrap = |wrap| match wrap {
                Wrap::Repeat => 10_497,
                Wrap::MirroredRepeat => 33_648,
                Wrap::ClampToEdge => 33_071,
            };
            let (wrap_s, wrap_t) = (wrap(texture.wrap_u), wrap(texture.wrap_v));
            // Linear between texels, and between the levels of a mipmap.
            let sampler = json!({ "magFilter": 9_729, "minFilter": 9_987, "wrapS": wrap_s, "wrapT": wrap_t });
            let sampler = self.glb.push("samplers", sampler);
            let texture = self.glb.push("textures", json!({ "sampler": sampler, "source": image.index }));
            surface["baseColorTexture"] = json!({ "index": texture });
        }
        let extensions = json!({ "KHR_materials_unlit": {} });
        self.glb.push("materials", json!({ "name": name, "pbrMetallicRoughness": surface, "extensions": extensions }))
    }
}

impl Vertices {
    /// Number of a vertex in the mesh with its `light`, irradiance and standard error: an earlier one, if all but the error is the same.
    fn number(&mut self, position: [f32; 3], light: [[f32; 3]; 2], uv: [f32; 2], color: [u16; 4]) -> u32 {
        let [irradiance, std_error] = light;
        let key = (position.map(f32::to_bits), irradiance.map(f32::to_bits), uv.map(f32::to_bits), color);
        *self.known.entry(key).or_insert_with(|| {
            self.position.push(position);
            self.color.push(color);
            self.irradiance.push(irradiance);
            self.std_error.push(std_error);
            self.uv.push(uv);
            self.position.len() as u32 - 1
        })
    }
}

/// Embeds an image, made as bright as it goes.
fn embed(glb: &mut GlbBuilder, image: &Image) -> Result<EmbeddedImage, Error> {
    let brightest_code = image.texels.iter().flatten().copied().max().unwrap_or(u8::MAX).max(1);
    let brightest = Rgb::from_srgb8([brightest_code; 3]).g;
    let code = |v: u8| (linear_to_srgb((Rgb::from_srgb8([v; 3]).g / brightest).min(1.0)) * 255.0).round() as u8;
    let codes: [u8; 256] = std::array::from_fn(|v| code(v as u8));
    let texels: Vec<[u8; 3]> = image.texels.iter().map(|texel| texel.map(|v| codes[usize::from(v)])).collect();
    let sums = image.texels.iter().fold([0.0f64; 3], |sums, &texel| {
        let linear = Rgb::from_srgb8(texel).to_array();
        std::array::from_fn(|c| sums[c] + f64::from(linear[c]))
    });
    let png = encode_png(image.width, image.height, &texels)?;
    Ok(EmbeddedImage {
        index: glb.add_image_png(&image.name, &png),
        mean: Rgb::from(sums.map(|sum| (sum / image.texels.len().max(1) as f64) as f32)),
        brightest,
    })
}

fn camera_json(camera: &Camera, far: f32) -> Value {
    match camera.projection {
        Projection::Perspective { vertical_angle } => {
            let mut perspective = json!({ "yfov": vertical_angle, "znear": 1e-4 * far });
            if let Some(aspect) = camera.aspect {
                perspective["aspectRatio"] = json!(aspect);
            }
            json!({ "name": camera.name, "type": "perspective", "perspective": perspective })
        }
        Projection::Orthographic { height } => {
            let (x, y) = (0.5 * height * camera.aspect.unwrap_or(1.0), 0.5 * height);
            let orthographic = json!({ "xmag": x, "ymag": y, "znear": 0.0, "zfar": far });
            json!({ "name": camera.name, "type": "orthographic", "orthographic": orthographic })
        }
    }
}

/// A glTF camera looks along its -z axis.
fn camera_node(camera: &Camera, number: usize) -> Value {
    let right = camera.forward.cross(camera.up);
    let rotation = Quat::from_mat3(&Mat3::from_cols(right, camera.up, -camera.forward)).normalize();
    json!({
        "name": camera.name,
        "camera": number,
        "translation": camera.position.to_array(),
        "rotation": rotation.to_array(),
    })
}

#[cfg(test)]
mod tests;
