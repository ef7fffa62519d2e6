//! Textures of materials: image, wrap modes, and where on the vertex their coordinates are.

use super::Reading;
use crate::Error;
use glam::{Mat2, Vec2};
use gltf::json::texture::{Info, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Index, image};
use isolux_core::scene::{Texture, Wrap};
use std::collections::BTreeMap;

/// How the coordinates of one texture follow from those of a vertex.
#[derive(Clone, Copy, Debug)]
pub struct Mapping {
    /// The texture coordinates it takes: `TEXCOORD_0`, `TEXCOORD_1`, ...
    pub set: u32,
    linear: Mat2,
    offset: Vec2,
}

impl Mapping {
    /// That of a texture reference, with KHR_texture_transform: scale, then rotation, then offset. The sense of the
    /// rotation is counter-clockwise as seen on an image with v downwards (KhronosGroup/glTF issue 1563).
    fn new(info: &Info) -> Mapping {
        let Some(transform) = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref()) else {
            return Mapping { set: info.tex_coord, linear: Mat2::IDENTITY, offset: Vec2::ZERO };
        };
        let (sin, cos) = transform.rotation.0.sin_cos();
        let rotation = Mat2::from_cols(Vec2::new(cos, -sin), Vec2::new(sin, cos));
        Mapping {
            set: transform.tex_coord.unwrap_or(info.tex_coord),
            linear: rotation * Mat2::from_diagonal(Vec2::from(transform.scale.0)),
            offset: Vec2::from(transform.offset.0),
        }
    }

    pub fn apply(&self, uv: Vec2) -> Vec2 {
        self.linear * uv + self.offset
    }
}

/// The images of a file that were read already: by number in the file, their number in the scene.
#[derive(Default)]
pub struct Textures {
    images: BTreeMap<usize, u32>,
}

impl Textures {
    /// The texture that `info` refers to; its image is read if it is new.
    ///
    /// # Errors
    /// [`Error::Invalid`] for broken references or images, [`Error::File`] for an image file that cannot be read.
    pub fn read(&mut self, reading: &mut Reading, info: &Info, place: &str) -> Result<(Texture, Mapping), Error> {
        let file = reading.file;
        let texture = file.get(&file.root.textures, info.index, "textures", place)?;
        let own_place = format!("textures/{}", info.index.value());
        let (mut wrap_u, mut wrap_v) = (Wrap::Repeat, Wrap::Repeat);
        if let Some(index) = texture.sampler {
            let sampler = file.get(&file.root.samplers, index, "samplers", &own_place)?;
            let wrap = |mode: Checked<WrappingMode>, name: &str| match mode {
                Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
                Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::MirroredRepeat),
                Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::ClampToEdge),
                Checked::Invalid => {
                    let place = format!("samplers/{}/{name}", index.value());
                    Err(file.error(&place, "it is none of 10497, 33648 and 33071"))
                }
            };
            (wrap_u, wrap_v) = (wrap(sampler.wrap_s, "wrapS")?, wrap(sampler.wrap_t, "wrapT")?);
        }
        let image = self.image(reading, texture.source, &own_place)?;
        Ok((Texture { image, wrap_u, wrap_v }, Mapping::new(info)))
    }

    fn image(&mut self, reading: &mut Reading, index: Index<image::Image>, place: &str) -> Result<u32, Error> {
        let Reading { file, builder, .. } = reading;
        if let Some(&known) = self.images.get(&index.value()) {
            return Ok(known);
        }
        let image = file.get(&file.root.images, index, "images", place)?;
        let place = format!("images/{}", index.value());
        let name = image.name.clone().unwrap_or_else(|| place.clone());
        let number = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => builder.image(&file.fetch(uri, &place)?, &name, &place)?,
            (None, Some(view)) => builder.image(file.view(view, &place)?.0, &name, &place)?,
            (None, None) => return Err(file.error(&place, "it has neither uri nor bufferView")),
        };
        self.images.insert(index.value(), number);
        Ok(number)
    }
}
