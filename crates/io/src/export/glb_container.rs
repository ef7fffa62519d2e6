//! The binary glTF 2.0 container: one chunk of JSON, one of numbers, and the accessors that tie them together
//! (Khronos glTF 2.0 specification, sections 3.6 and 4.4).
//!
//! [`GlbBuilder::push`] appends to any of the lists of the JSON (`meshes`, `nodes`, ...) and gives the index by which the
//! others refer to the new item; the `add_*` functions put numbers and images into the binary chunk.

use crate::Error;
use serde_json::{Map, Value, json};

const ARRAY_BUFFER: u32 = 34_962;
const ELEMENT_ARRAY_BUFFER: u32 = 34_963;
const UNSIGNED_SHORT: u32 = 5_123;
const UNSIGNED_INT: u32 = 5_125;
const FLOAT: u32 = 5_126;

/// A `.glb` file under construction.
pub struct GlbBuilder {
    root: Map<String, Value>,
    binary: Vec<u8>,
}

impl GlbBuilder {
    /// A file without scenes.
    pub fn new() -> GlbBuilder {
        let mut root = Map::new();
        let generator = format!("isolux {}", isolux_core::VERSION);
        root.insert("asset".to_owned(), json!({ "version": "2.0", "generator": generator }));
        GlbBuilder { root, binary: Vec::new() }
    }

    /// Sets a property of the root that is no list: `scene`, `extensions`, `extras`.
    pub fn set(&mut self, property: &str, value: Value) {
        self.root.insert(property.to_owned(), value);
    }

    /// Appends `item` to a list of the root, say `meshes`, and gives its index.
    pub fn push(&mut self, list: &str, item: Value) -> usize {
        match self.root.entry(list).or_insert_with(|| json!([])) {
            Value::Array(items) => {
                items.push(item);
                items.len() - 1
            }
            other => {
                *other = json!([item]);
                0
            }
        }
    }

    /// Says that the file uses an extension; once is enough, more do no harm.
    pub fn use_extension(&mut self, name: &str) {
        let known = self.root.get("extensionsUsed").and_then(Value::as_array);
        if !known.is_some_and(|names| names.iter().any(|n| n == name)) {
            self.push("extensionsUsed", json!(name));
        }
    }

    /// Positions, normals or colours; gives the accessor's index. Least and greatest values are written as well, as
    /// positions need them.
    pub fn add_f32x3(&mut self, values: &[[f32; 3]]) -> usize {
        let accessor = json!({ "componentType": FLOAT, "type": "VEC3", "count": values.len() });
        self.add_accessor(&f32_bytes(values.as_flattened()), ARRAY_BUFFER, with_bounds(accessor, values))
    }

    /// Texture coordinates; gives the accessor's index.
    pub fn add_f32x2(&mut self, values: &[[f32; 2]]) -> usize {
        let accessor = json!({ "componentType": FLOAT, "type": "VEC2", "count": values.len() });
        self.add_accessor(&f32_bytes(values.as_flattened()), ARRAY_BUFFER, accessor)
    }

    /// Colours with alpha in [0, 1] as 16-bit fractions: half the size of floats, and no banding in linear values.
    pub fn add_unorm16x4(&mut self, values: &[[u16; 4]]) -> usize {
        let accessor =
            json!({ "componentType": UNSIGNED_SHORT, "normalized": true, "type": "VEC4", "count": values.len() });
        let bytes: Vec<u8> = values.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect();
        self.add_accessor(&bytes, ARRAY_BUFFER, accessor)
    }

    /// Vertex indices of triangles; gives the accessor's index.
    pub fn add_indices(&mut self, indices: &[u32]) -> usize {
        let accessor = json!({ "componentType": UNSIGNED_INT, "type": "SCALAR", "count": indices.len() });
        let bytes: Vec<u8> = indices.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.add_accessor(&bytes, ELEMENT_ARRAY_BUFFER, accessor)
    }

    /// Embeds a PNG file; gives the image's index.
    pub fn add_image_png(&mut self, name: &str, png: &[u8]) -> usize {
        let view = self.add_view(png, None);
        self.push("images", json!({ "name": name, "mimeType": "image/png", "bufferView": view }))
    }

    fn add_accessor(&mut self, bytes: &[u8], target: u32, mut accessor: Value) -> usize {
        accessor["bufferView"] = json!(self.add_view(bytes, Some(target)));
        self.push("accessors", accessor)
    }

    /// Appends bytes to the binary chunk, aligned to four as every component type wants.
    fn add_view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        let mut view = json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.binary.extend_from_slice(bytes);
        pad(&mut self.binary, 0);
        self.push("bufferViews", view)
    }

    /// The bytes of the file.
    ///
    /// # Errors
    /// [`Error::Invalid`] beyond the 4 GiB that the container can hold.
    pub fn finish(mut self) -> Result<Vec<u8>, Error> {
        if !self.binary.is_empty() {
            let buffer = json!({ "byteLength": self.binary.len() });
            self.push("buffers", buffer);
        }
        let mut json = Value::Object(self.root).to_string().into_bytes();
        pad(&mut json, b' ');

        let mut chunks: Vec<(&[u8; 4], &[u8])> = vec![(b"JSON", &json)];
        if !self.binary.is_empty() {
            chunks.push((b"BIN\0", &self.binary));
        }
        let length = 12 + chunks.iter().map(|(_, bytes)| 8 + bytes.len()).sum::<usize>();
        let Ok(length_in_file) = u32::try_from(length) else {
            let what =
                format!("{length} bytes are more than the 4 GiB that a GLB file can hold; ask for fewer elements");
            return Err(Error::Invalid { file: "GLB".into(), place: "size".into(), what });
        };
        let mut file = Vec::with_capacity(length);
        file.extend_from_slice(b"glTF");
        file.extend_from_slice(&2u32.to_le_bytes());
        file.extend_from_slice(&length_in_file.to_le_bytes());
        for (kind, bytes) in chunks {
            file.extend_from_slice(&(bytes.len() as u32).to_le_bytes());
            file.extend_from_slice(kind);
            file.extend_from_slice(bytes);
        }
        Ok(file)
    }
}

impl Default for GlbBuilder {
    fn default() -> GlbBuilder {
        GlbBuilder::new()
    }
}

fn with_bounds(mut accessor: Value, values: &[[f32; 3]]) -> Value {
    if let Some(&first) = values.first() {
        let fold = |pick: fn(f32, f32) -> f32| {
            values.iter().fold(first, |bound, v| std::array::from_fn(|k| pick(bound[k], v[k])))
        };
        accessor["min"] = json!(fold(f32::min));
        accessor["max"] = json!(fold(f32::max));
    }
    accessor
}

fn f32_bytes(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// Fills up to a multiple of four bytes.
fn pad(bytes: &mut Vec<u8>, with: u8) {
    bytes.resize(bytes.len().next_multiple_of(4), with);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_read_back_by_the_gltf_crate() {
        let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 1.0]];
        let mut glb = GlbBuilder::new();
        let positions = glb.add_f32x3(&corners);
        let colors = glb.add_unorm16x4(&[[65535, 0, 32768, 65535]; 3]);
        let indices = glb.add_indices(&[2, 0, 1]);
        let attributes = json!({ "POSITION": positions, "COLOR_0": colors });
        glb.push("meshes", json!({ "primitives": [{ "attributes": attributes, "indices": indices }] }));
        let file = glb.finish().unwrap();

        let gltf = gltf::Gltf::from_slice(&file).unwrap();
        let primitive = gltf.meshes().next().unwrap().primitives().next().unwrap();
        let reader = primitive.reader(|_| gltf.blob.as_deref());
        assert_eq!(reader.read_positions().unwrap().collect::<Vec<_>>(), corners);
        assert_eq!(reader.read_indices().unwrap().into_u32().collect::<Vec<_>>(), [2, 0, 1]);
        assert_eq!(primitive.bounding_box(), gltf::mesh::BoundingBox { min: [0.0; 3], max: [2.0, 3.0, 1.0] });
        assert_eq!(file.len() % 4, 0);
    }

    #[test]
    fn an_empty_file_is_valid_and_extensions_are_named_once() {
        let mut glb = GlbBuilder::new();
        glb.use_extension("KHR_materials_unlit");
        glb.use_extension("KHR_materials_unlit");
        let gltf = gltf::Gltf::from_slice(&glb.finish().unwrap()).unwrap();
        assert_eq!(gltf.extensions_used().collect::<Vec<_>>(), ["KHR_materials_unlit"]);
        assert!(gltf.blob.is_none());
    }
}
