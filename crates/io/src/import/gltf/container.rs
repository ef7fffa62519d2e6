//! The shell of a glTF file: the chunks of a `.glb`, the JSON, its version and the extensions it needs.

use crate::Error;
use gltf::json::Root;
use std::path::Path;

/// Extensions that are understood.
const UNDERSTOOD: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Extensions that concern only what diffuse light does not see, so that a file can be read without them.
const HARMLESS: &[&str] = &[
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_variants",
    "KHR_materials_volume",
];

/// The JSON text and the binary chunk, if there is one. A file that is no GLB is JSON altogether.
///
/// # Errors
/// [`Error::Invalid`] for a broken GLB.
pub fn split<'a>(path: &Path, bytes: &'a [u8]) -> Result<(&'a [u8], Option<&'a [u8]>), Error> {
    let broken = |place: &str, what: String| Err(Error::invalid(path, place, what));
    let Some(rest) = bytes.strip_prefix(b"glTF") else {
        return Ok((bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes), None));
    };
    let Some((version, rest)) = read_u32(rest) else { return broken("header", "the file ends in it".into()) };
    if version != 2 {
        return broken("header", format!("version {version} of GLB is not supported; export the scene as glTF 2.0"));
    }
    let Some((length, rest)) = read_u32(rest) else { return broken("header", "the file ends in it".into()) };
    if length as usize > bytes.len() {
        return broken("header", format!("it says {length} bytes, but the file has only {}", bytes.len()));
    }
    let (mut json, mut binary) = (None, None);
    let mut rest = &rest[..(length as usize).saturating_sub(12).min(rest.len())];
    while !rest.is_empty() {
        let Some((size, after)) = read_u32(rest) else { return broken("chunks", "the file ends in a header".into()) };
        let Some((kind, after)) = after.split_at_checked(4) else {
            return broken("chunks", "the file ends in a header".into());
        };
        let Some((content, after)) = after.split_at_checked(size as usize) else {
            let what = format!("a chunk of {size} bytes does not fit into the {} bytes that are left", after.len());
            return broken("chunks", what);
        };
        match kind {
            b"JSON" if json.is_none() => json = Some(content),
            b"BIN\0" if binary.is_none() => binary = Some(content),
            _ => {}
        }
        rest = after;
    }
    match json {
        Some(json) => Ok((json, binary)),
        None => broken("chunks", "there is no JSON chunk".into()),
    }
}

fn read_u32(bytes: &[u8]) -> Option<(u32, &[u8])> {
    bytes.split_first_chunk().map(|(head, rest)| (u32::from_le_bytes(*head), rest))
}

/// What must be known before the rest can be understood.
#[derive(serde::Deserialize)]
#[serde(rename_all = "camelCase")]
struct Head {
    asset: Asset,
    #[serde(default)]
    extensions_required: Vec<String>,
}

#[derive(serde::Deserialize)]
struct Asset {
    version: String,
}

/// Parses the JSON of a glTF 2.x file.
///
/// # Errors
/// [`Error::Invalid`] for broken JSON, another version, a required extension that is not known, or a wrong type.
pub fn parse(path: &Path, json: &[u8]) -> Result<Root, Error> {
    let head: Head = from_json(path, json)?;
    if !head.asset.version.starts_with("2.") {
        let what = format!("glTF {} is not supported; export the scene as glTF 2.0", head.asset.version);
        return Err(Error::invalid(path, "asset/version", what));
    }
    for (k, name) in head.extensions_required.iter().enumerate() {
        if !UNDERSTOOD.contains(&name.as_str()) && !HARMLESS.contains(&name.as_str()) {
            let what = format!("the file cannot be read without {name}, which isolux does not know; export it without");
            return Err(Error::invalid(path, format!("extensionsRequired/{k}"), what));
        }
    }
    from_json(path, json)
}

fn from_json<T: serde::de::DeserializeOwned>(path: &Path, json: &[u8]) -> Result<T, Error> {
    let mut deserializer = serde_json::Deserializer::from_slice(json);
    serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let place = error.path().to_string().replace(['.', '['], "/").replace(']', "");
        let place = if place.is_empty() || place == "/" { "JSON".to_owned() } else { place };
        Error::invalid(path, place, error.into_inner().to_string())
    })
}

/// Whether the extension `name` is understood.
pub fn is_understood(name: &str) -> bool {
    UNDERSTOOD.contains(&name)
}
