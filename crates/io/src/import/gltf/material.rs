//! Materials, reduced to what is diffuse in them.
//!
//! Reflectivity is base colour times its texture, for metals too: the engine knows no mirrors, and a metal's base colour
//! is the share of light it reflects, if not where to. Emission is an exitance, pi times the luminance in cd/m².

use super::Reading;
use super::ignored::Ignored;
use super::texture::{Mapping, Textures};
use crate::Error;
use crate::import::builder::SceneBuilder;
use gltf::json;
use gltf::json::material::AlphaMode;
use gltf::json::texture::Info;
use gltf::json::validation::Checked;
use isolux_core::math::Rgb;
use isolux_core::scene::{Material, Texture};
use std::collections::BTreeMap;
use std::f32::consts::PI;

/// A material of the scene, and where the coordinates of its textures come from.
#[derive(Clone, Copy)]
pub struct Read {
    pub number: u32,
    pub reflectivity: Option<Mapping>,
    pub emission: Option<Mapping>,
}

/// The materials read so far, by their number in the file; `None` is the default material.
#[derive(Default)]
pub struct Materials {
    read: BTreeMap<Option<usize>, Read>,
    textures: Textures,
    metals: usize,
    unlit: usize,
}

impl Materials {
    /// The material `index` of the file, wanted by `place`, or the default one.
    ///
    /// # Errors
    /// [`Error::Invalid`] for broken references, colours or images, [`Error::File`] for an image that cannot be read.
    pub fn get(
        &mut self,
        reading: &mut Reading,
        index: Option<json::Index<json::Material>>,
        place: &str,
    ) -> Result<Read, Error> {
        let key = index.map(|i| i.value());
        if let Some(&known) = self.read.get(&key) {
            return Ok(known);
        }
        let read = match index {
            Some(index) => {
                let material = reading.file.get(&reading.file.root.materials, index, "materials", place)?;
                self.read(reading, material, &format!("materials/{}", index.value()))?
            }
            None => self.read(reading, &json::Material::default(), "default material")?,
        };
        self.read.insert(key, read);
        Ok(read)
    }

    fn read(&mut self, reading: &mut Reading, json: &json::Material, place: &str) -> Result<Read, Error> {
        let extensions = json.extensions.as_ref();
        let pbr = &json.pbr_metallic_roughness;
        let mut base = (pbr.base_color_factor.0, pbr.base_color_texture.as_ref());
        if let Some(specular) = extensions.and_then(|e| e.pbr_specular_glossiness.as_ref()) {
            base = (specular.diffuse_factor.0, specular.diffuse_texture.as_ref());
            reading.ignored.note("specular reflection and glossiness");
        } else if extensions.is_some_and(|e| e.unlit.is_some()) {
            self.unlit += 1;
        } else if place != "default material" && pbr.metallic_factor.0 >= 0.5 {
            self.metals += 1;
        }
        note_ignored(json, &mut reading.ignored);

        let [red, green, blue, _] = base.0;
        let strength = extensions.and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |e| e.emissive_strength.0);
        let emission = Rgb::from(json.emissive_factor.0) * strength * PI;
        let mut texture = |info: Option<&Info>, kind: &str| -> Result<(Option<Texture>, Option<Mapping>), Error> {
            let Some(info) = info else { return Ok((None, None)) };
            let (texture, mapping) = self.textures.read(reading, info, &format!("{place}/{kind}"))?;
            Ok((Some(texture), Some(mapping)))
        };
        let (reflectivity_texture, reflectivity_mapping) = texture(base.1, "baseColorTexture")?;
        let emissive_texture = json.emissive_texture.as_ref().filter(|_| !emission.is_black());
        let (emission_texture, emission_mapping) = texture(emissive_texture, "emissiveTexture")?;
        let material = Material {
            name: json.name.clone().unwrap_or_else(|| place.to_owned()),
            reflectivity: Rgb::new(red, green, blue),
            reflectivity_texture,
            emission,
            emission_texture,
            two_sided: json.double_sided,
        };
        let number = reading.builder.material(material, place)?;
        Ok(Read { number, reflectivity: reflectivity_mapping, emission: emission_mapping })
    }

    /// Says what was assumed.
    pub fn remark(&self, builder: &mut SceneBuilder) {
        let all = self.read.len();
        if self.metals > 0 {
            let metals = self.metals;
            builder.remark(format!(
                "{metals} of {all} materials are metallic (metallicFactor 0.5 or more): their base colour is kept as diffuse reflectivity"
            ));
        }
        if self.unlit > 0 {
            let unlit = self.unlit;
            builder.remark(format!("{unlit} of {all} materials are unlit: their colour is taken as reflectivity"));
        }
    }
}

fn note_ignored(json: &json::Material, ignored: &mut Ignored) {
    let pbr = &json.pbr_metallic_roughness;
    let notes = [
        (pbr.metallic_roughness_texture.is_some(), "metallic-roughness textures"),
        (json.normal_texture.is_some(), "normal maps"),
        (json.occlusion_texture.is_some(), "occlusion maps"),
        (matches!(json.alpha_mode, Checked::Valid(AlphaMode::Blend)), "transparent materials, taken as opaque"),
        (matches!(json.alpha_mode, Checked::Valid(AlphaMode::Mask)), "cut-out materials, taken as opaque"),
    ];
    notes.into_iter().filter(|(is_there, _)| *is_there).for_each(|(_, what)| ignored.note(what));
}
