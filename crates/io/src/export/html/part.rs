//! A part of what a page shows: a header of JSON and arrays of numbers, packed.
//!
//! Little-endian: `isoluxv1`, the length of the header in bytes (u32), the header, and the sections one after the other. The
//! header's `sections` say of each its `type`, where it starts (`offset`, from the first section) and its `bytes`; `record`
//! is the number of bytes that belong together. They are stored byte by byte: the first bytes of all records, then the
//! second ones, which packs better. A `u32-delta` holds differences to the number before; an `f16`
//! is to be multiplied by `scale`. All of it is one zlib stream, whose checksum shows damage.

use crate::Error;
use crate::export::cannot_encode;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use half::f16;
use serde_json::{Map, Value, json};
use std::io::Write;

const MAGIC: &[u8] = b"isoluxv1";
/// The largest 16-bit float after scaling: half of what they can hold.
const MOST: f32 = 32_768.0;

/// A part under construction.
#[derive(Default)]
pub struct Part {
    header: Map<String, Value>,
    sections: Map<String, Value>,
    bytes: Vec<u8>,
}

impl Part {
    /// Sets an entry of the header.
    pub fn set(&mut self, name: &str, value: Value) {
        self.header.insert(name.to_owned(), value);
    }

    /// Records of N floats.
    pub fn add_f32<const N: usize>(&mut self, name: &str, records: impl Iterator<Item = [f32; N]>) {
        let bytes: Vec<u8> = records.flatten().flat_map(f32::to_le_bytes).collect();
        self.add(name, json!({ "type": "f32", "record": 4 * N }), &bytes);
    }

    /// Records of N floats, kept to 11 binary digits, with the largest at half of what 16 bits can hold.
    pub fn add_f16<const N: usize>(&mut self, name: &str, records: &[[f32; N]]) {
        let most = records.as_flattened().iter().fold(0.0, |most: f32, v| if *v > most { *v } else { most });
        let scale = if most > 0.0 && most.is_finite() { most / MOST } else { 1.0 };
        let bytes: Vec<u8> =
            records.as_flattened().iter().flat_map(|v| f16::from_f32(v / scale).to_le_bytes()).collect();
        self.add(name, json!({ "type": "f16", "record": 2 * N, "scale": scale }), &bytes);
    }

    /// Whole numbers, one a record.
    pub fn add_u32(&mut self, name: &str, numbers: impl Iterator<Item = u32>) {
        let mut before = 0u32;
        let mut difference = |number: u32| number.wrapping_sub(std::mem::replace(&mut before, number)).to_le_bytes();
        let bytes: Vec<u8> = numbers.flat_map(&mut difference).collect();
        self.add(name, json!({ "type": "u32-delta", "record": 4 }), &bytes);
    }

    /// A file, as it is.
    pub fn add_file(&mut self, name: &str, bytes: &[u8]) {
        self.add(name, json!({ "type": "bytes", "record": 1 }), bytes);
    }

    fn add(&mut self, name: &str, mut section: Value, bytes: &[u8]) {
        section["offset"] = json!(self.bytes.len());
        section["bytes"] = json!(bytes.len());
        let record = section["record"].as_u64().unwrap_or(1) as usize;
        for k in 0..record {
            self.bytes.extend(bytes.iter().skip(k).step_by(record));
        }
        self.sections.insert(name.to_owned(), section);
    }

    /// The part, packed.
    ///
    /// # Errors
    /// None that a part in memory could meet.
    pub fn finish(mut self, packing: Compression) -> Result<Vec<u8>, Error> {
        self.header.insert("sections".to_owned(), Value::Object(self.sections));
        let header = serde_json::to_vec(&self.header).map_err(cannot_encode("html"))?;
        let length = u32::try_from(header.len()).map_err(cannot_encode("html"))?;
        let mut packed = ZlibEncoder::new(Vec::new(), packing);
        let whole = [MAGIC, &length.to_le_bytes(), &header, &self.bytes];
        whole.iter().try_for_each(|bytes| packed.write_all(bytes)).map_err(cannot_encode("html"))?;
        packed.finish().map_err(cannot_encode("html"))
    }
}
