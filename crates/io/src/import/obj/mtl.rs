//! MTL, the material files of OBJ: diffuse colour `Kd`, emission `Ke`, and their textures.

use super::super::builder::SceneBuilder;
use super::super::read_beside;
use super::numbers;
use crate::Error;
use isolux_core::math::Rgb;
use isolux_core::scene::{Material, Texture, Wrap};
use std::collections::BTreeMap;
use std::f32::consts::PI;

/// Reflectivity of a material that states none.
const DEFAULT_REFLECTIVITY: f32 = 0.5;

/// The materials of all MTL files of a scene.
#[derive(Default)]
pub struct Library {
    materials: BTreeMap<String, Definition>,
    /// Materials and images that are in the scene already, by name and by file.
    numbers: BTreeMap<String, u32>,
    images: BTreeMap<String, u32>,
}

/// One `newmtl`.
#[derive(Default)]
struct Definition {
    place: String,
    diffuse: Option<Rgb>,
    emission: Rgb,
    diffuse_map: Option<Map>,
    emission_map: Option<Map>,
}

/// A texture file.
struct Map {
    file: String,
    clamped: bool,
}

impl Library {
    /// Adds what the file `name` beside the OBJ file defines; a file that is not there is a remark.
    ///
    /// # Errors
    /// [`Error::Invalid`] for numbers that are none.
    pub fn read(&mut self, builder: &mut SceneBuilder, name: &str) -> Result<(), Error> {
        let bytes = match read_beside(builder.path, name) {
            Ok(bytes) => bytes,
            Err(error) => {
                builder.remark(format!("materials are missing: {error}"));
                return Ok(());
            }
        };
        let mut current: Option<&mut Definition> = None;
        for (k, line) in String::from_utf8_lossy(&bytes).lines().enumerate() {
            let place = format!("{name}, line {}", k + 1);
            let line = line.trim();
            let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
            if keyword == "newmtl" {
                let definition = Definition { place, ..Definition::default() };
                let entry = self.materials.entry(rest.trim().to_owned()).insert_entry(definition);
                current = Some(entry.into_mut());
            } else if let Some(material) = &mut current {
                material.line(builder, keyword, rest.trim()).map_err(|what| builder.error(&place, what))?;
            }
        }
        Ok(())
    }

    /// The number in the scene of the material called `name`.
    ///
    /// # Errors
    /// [`Error::Invalid`] for colours out of range or images that cannot be decoded.
    pub fn number(&mut self, builder: &mut SceneBuilder, name: &str) -> Result<u32, Error> {
        if let Some(&number) = self.numbers.get(name) {
            return Ok(number);
        }
        let number = match self.materials.get(name) {
            Some(definition) => {
                let mut texture = |map: &Option<Map>| match map {
                    Some(map) => texture(&mut self.images, builder, map),
                    None => Ok(None),
                };
                let reflectivity_texture = texture(&definition.diffuse_map)?;
                let emission_texture = texture(&definition.emission_map)?;
                let unset = if reflectivity_texture.is_some() { 1.0 } else { DEFAULT_REFLECTIVITY };
                let material = Material {
                    name: name.to_owned(),
                    reflectivity: definition.diffuse.unwrap_or(Rgb::grey(unset)),
                    reflectivity_texture,
                    emission: definition.emission * PI,
                    emission_texture,
                    two_sided: true,
                };
                if material.is_emitter() {
                    builder.remark("the emission Ke of materials is taken as a luminance in cd/m²");
                }
                builder.material(material, &definition.place)?
            }
            None => {
                if !name.is_empty() {
                    builder.remark(format!("the material '{name}' is not defined"));
                }
                builder.default_material()?
            }
        };
        self.numbers.insert(name.to_owned(), number);
        Ok(number)
    }
}

impl Definition {
    fn line(&mut self, builder: &mut SceneBuilder, keyword: &str, rest: &str) -> Result<(), String> {
        match keyword {
            "Kd" => self.diffuse = color(builder, rest)?,
            "Ke" => self.emission = color(builder, rest)?.unwrap_or_default(),
            "map_Kd" => self.diffuse_map = Some(map(builder, rest)),
            "map_Ke" => self.emission_map = Some(map(builder, rest)),
            _ => {}
        }
        Ok(())
    }
}

/// `r g b`, or `r` for grey. Colours as spectra or in XYZ are not read.
fn color(builder: &mut SceneBuilder, text: &str) -> Result<Option<Rgb>, String> {
    if text.starts_with("spectral") || text.starts_with("xyz") {
        builder.remark("colours given as spectra or XYZ were ignored");
        return Ok(None);
    }
    match numbers(text)?[..] {
        [grey] => Ok(Some(Rgb::grey(grey))),
        [r, g, b] => Ok(Some(Rgb::new(r, g, b))),
        _ => Err("a colour needs one number or three".to_owned()),
    }
}

/// The file of a texture behind its options, of which only `-clamp` counts.
fn map(builder: &mut SceneBuilder, text: &str) -> Map {
    let mut clamped = false;
    let mut rest = text;
    while let Some(option) = rest.strip_prefix('-') {
        let (name, mut after) = option.split_once(char::is_whitespace).unwrap_or((option, ""));
        while let Some((word, behind)) = after.trim_start().split_once(char::is_whitespace) {
            let is_argument = ["on", "off"].contains(&word) || word.parse::<f32>().is_ok();
            if !is_argument {
                break;
            }
            clamped |= name == "clamp" && word == "on";
            after = behind;
        }
        if name != "clamp" {
            builder.remark("options of textures other than -clamp were ignored");
        }
        rest = after.trim_start();
    }
    Map { file: rest.to_owned(), clamped }
}

/// The texture of a map; a file that is not there is a remark.
fn texture(
    images: &mut BTreeMap<String, u32>,
    builder: &mut SceneBuilder,
    map: &Map,
) -> Result<Option<Texture>, Error> {
    let wrap = if map.clamped { Wrap::ClampToEdge } else { Wrap::Repeat };
    let image = match images.get(&map.file) {
        Some(&image) => image,
        None => match read_beside(builder.path, &map.file) {
            Ok(bytes) => {
                let image = builder.image(&bytes, &map.file, &map.file)?;
                images.insert(map.file.clone(), image);
                image
            }
            Err(error) => {
                builder.remark(format!("a texture is missing: {error}"));
                return Ok(None);
            }
        },
    };
    Ok(Some(Texture { image, wrap_u: wrap, wrap_v: wrap }))
}
