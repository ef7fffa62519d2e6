//! Batches: all triangles that are drawn in one go, because they reflect and emit alike.
//!
//! What a batch emits is what it emitted when its light group was solved, so scenes that differ in how their lamps are dimmed
//! (`isolux mix`) have the same batches.

use super::part::Part;
use crate::Error;
use crate::export::cannot_encode;
use crate::export::image::encode_png;
use ::image::codecs::jpeg::JpegEncoder;
use ::image::{ExtendedColorType, ImageEncoder};
use isolux_core::Problem;
use isolux_core::scene::{Emitter, Image, Texture, Wrap};
use isolux_core::solution::GroupLight;
use serde_json::{Value, json};
use std::collections::{BTreeSet, HashMap};

/// Images with more texels are stored as JPEG, of this quality.
const LARGE: usize = 1 << 16;
const QUALITY: u8 = 92;

/// How a batch looks, and the objects that belong to it.
pub struct Batch {
    /// As the page reads it.
    pub look: Value,
    pub objects: Vec<u32>,
    /// Whether its vertices need coordinates in a texture of the reflectivity, and in one of the emission.
    pub has_uv: bool,
    pub has_emission_uv: bool,
}

/// The batches of `problem`, in the order of their first objects, with lamps that are dimmed as the `groups` say.
pub fn batches(problem: &Problem, groups: &[GroupLight]) -> Vec<Batch> {
    let scene = &problem.scene;
    let mut group_of = HashMap::new();
    for (number, part) in groups.iter().enumerate() {
        for source in &part.group.sources {
            if let Emitter::Object(k) = source.emitter {
                group_of.insert(k, (number, source.emission));
            }
        }
    }
    let mut batches: Vec<Batch> = Vec::new();
    let mut known: HashMap<String, usize> = HashMap::new();
    for (k, object) in (0..).zip(&scene.objects) {
        let material = &scene.materials[object.material as usize];
        let group = group_of.get(&k);
        let emission = group.map_or(material.emission, |(_, emission)| *emission);
        let emission_texture = material.emission_texture.filter(|_| !emission.is_black());
        let look = json!({
            "material": material.name,
            "reflectivity": material.reflectivity.to_array(),
            "reflectivity_texture": material.reflectivity_texture.map(texture),
            "emission": emission.to_array(),
            "emission_texture": emission_texture.map(texture),
            "group": group.map(|(number, _)| number),
        });
        let number = *known.entry(look.to_string()).or_insert(batches.len());
        if number == batches.len() {
            let (has_uv, has_emission_uv) = (material.reflectivity_texture.is_some(), emission_texture.is_some());
            batches.push(Batch { look, objects: Vec::new(), has_uv, has_emission_uv });
        }
        batches[number].objects.push(k);
    }
    batches
}

fn texture(texture: Texture) -> Value {
    let wrap = |wrap| match wrap {
        Wrap::Repeat => "repeat",
        Wrap::MirroredRepeat => "mirror",
        Wrap::ClampToEdge => "clamp",
    };
    json!({ "image": texture.image, "wrap": [wrap(texture.wrap_u), wrap(texture.wrap_v)] })
}

/// Adds the images that `batches` use as files `image 0`, `image 1` ... to `part`: PNG, or JPEG if they are large.
///
/// # Errors
/// Those of the encoders.
pub fn add_images(part: &mut Part, batches: &[Batch], images: &[Image]) -> Result<(), Error> {
    let of = |batch: &Batch, name: &str| batch.look[name]["image"].as_u64();
    let textures = ["reflectivity_texture", "emission_texture"];
    let used: BTreeSet<u64> = batches.iter().flat_map(|batch| textures.map(|name| of(batch, name))).flatten().collect();
    for number in used {
        let image = &images[number as usize];
        let large = image.texels.len() > LARGE;
        let file = if large { encode_jpeg(image)? } else { encode_png(image.width, image.height, &image.texels)? };
        part.add_file(&format!("image {number}"), &file);
    }
    Ok(())
}

fn encode_jpeg(image: &Image) -> Result<Vec<u8>, Error> {
    let mut file = Vec::new();
    JpegEncoder::new_with_quality(&mut file, QUALITY)
        .write_image(image.texels.as_flattened(), image.width, image.height, ExtendedColorType::Rgb8)
        .map_err(cannot_encode("html"))?;
    Ok(file)
}
