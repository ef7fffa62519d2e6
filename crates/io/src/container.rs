//! What the binary files of isolux have in common: a header, a checksum, and a payload of plain data.
//!
//! ```text
//! bytes  0..6    magic, which says what kind of file it is
//!        6..8    version of the format            (little-endian, like all numbers)
//!        8..16   length of the payload, unpacked
//!       16..24   XXH3 of bytes 0..16 and of the packed payload
//!       24..     payload (postcard encoding), packed with zlib
//! ```
//!
//! The checksum guards against accidents, not against people: a payload is still checked before it is used. A false length costs no
//! memory.

use crate::Error;
use flate2::{Compression, read::ZlibDecoder, write::ZlibEncoder};
use isolux_core::mesh::Cut;
use isolux_core::scene::Scene;
use serde::{Serialize, de::DeserializeOwned};
use std::io::{Read, Write};
use xxhash_rust::xxh3::Xxh3;

const HEADER: usize = 24;
/// Deflate never packs more bytes than this into one (RFC 1951: 258 bytes in two bits).
const HIGHEST_RATIO: u64 = 1032;

/// A kind of file.
#[derive(Clone, Copy, Debug)]
pub struct Container {
    pub magic: &'static [u8; 6],
    pub version: u16,
    /// For messages, like "an isolux file".
    pub what: &'static str,
    /// From 0, which only stores, to 9, which packs best.
    pub packing: u32,
}

impl Container {
    /// The bytes of a file with this payload.
    ///
    /// # Errors
    /// [`Error::Invalid`] if it cannot be encoded.
    pub fn write(&self, payload: &impl Serialize) -> Result<Vec<u8>, Error> {
        let unpacked = postcard::to_stdvec(payload).map_err(|e| invalid(self.what, "payload", e))?;
        self.pack(&unpacked)
    }

    /// The payload in the bytes of a file; `name` is for messages.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a file of another kind or version, and for a damaged one.
    pub fn read<T: DeserializeOwned>(&self, name: &str, bytes: &[u8]) -> Result<T, Error> {
        let unpacked = self.unpack(name, bytes)?;
        let (payload, rest) = postcard::take_from_bytes(&unpacked).map_err(|e| invalid(name, "payload", e))?;
        if rest.is_empty() {
            Ok(payload)
        } else {
            Err(invalid(name, "payload", format!("{} bytes too many", rest.len())))
        }
    }

    pub(crate) fn pack(&self, unpacked: &[u8]) -> Result<Vec<u8>, Error> {
        let mut file = Vec::with_capacity(HEADER + unpacked.len() / 2);
        file.extend_from_slice(self.magic);
        file.extend_from_slice(&self.version.to_le_bytes());
        file.extend_from_slice(&(unpacked.len() as u64).to_le_bytes());
        file.extend_from_slice(&[0; 8]);
        let mut encoder = ZlibEncoder::new(file, Compression::new(self.packing));
        let packed = encoder.write_all(unpacked).and_then(|()| encoder.finish());
        let mut file = packed.map_err(|e| invalid(self.what, "payload", e))?;
        sign(&mut file);
        Ok(file)
    }

    pub(crate) fn unpack(&self, name: &str, bytes: &[u8]) -> Result<Vec<u8>, Error> {
        if !bytes.starts_with(self.magic) {
            return Err(invalid(name, "start", format!("this is not {}", self.what)));
        }
        if bytes.len() < HEADER {
            return Err(invalid(name, "start", "the file is cut off"));
        }
        let (version, known) = (u16::from(bytes[6]) | u16::from(bytes[7]) << 8, self.version);
        if version != known {
            let what = format!("format version {version} is not {known}, the one this isolux can read");
            return Err(invalid(
                name,
                "start",
                if version > known { what + "; a newer isolux wrote it" } else { what },
            ));
        }
        if number(bytes, 16) != checksum(bytes) {
            return Err(invalid(name, "checksum", "the file is damaged or cut off"));
        }
        let length = number(bytes, 8);
        let packed = &bytes[HEADER..];
        if length / HIGHEST_RATIO > packed.len() as u64 {
            let what = format!("{length} bytes cannot have been packed into {}", packed.len());
            return Err(invalid(name, "start", what));
        }
        let mut unpacked = Vec::new();
        let mut decoder = ZlibDecoder::new(packed).take(length.saturating_add(1));
        decoder.read_to_end(&mut unpacked).map_err(|e| invalid(name, "payload", e))?;
        if unpacked.len() as u64 != length {
            let what = format!("it does not unpack to the {length} bytes that were announced");
            return Err(invalid(name, "payload", what));
        }
        Ok(unpacked)
    }
}

/// Number of elements that a file's scene and cut make, known before they are made: a false number cannot ask for a huge mesh.
///
/// # Errors
/// [`Error::Invalid`] if the scene cannot be used, or the cut is not one of it.
pub fn element_count(name: &str, scene: &Scene, cut: &Cut) -> Result<usize, Error> {
    scene.validate().map_err(|fault| invalid(name, &format!("scene/{}", fault.place), fault.what))?;
    cut.element_count(scene).map_err(|e| invalid(name, "cut", e))
}

/// What the file called `name` says at `place` is wrong.
pub fn invalid(name: &str, place: &str, what: impl std::fmt::Display) -> Error {
    Error::Invalid { file: name.to_owned(), place: place.to_owned(), what: what.to_string() }
}

/// Writes its checksum into a whole file.
pub(crate) fn sign(file: &mut [u8]) {
    let checksum = checksum(file);
    file[16..HEADER].copy_from_slice(&checksum.to_le_bytes());
}

/// Of a whole file with at least a header.
fn checksum(file: &[u8]) -> u64 {
    let mut hasher = Xxh3::new();
    hasher.update(&file[..16]);
    hasher.update(&file[HEADER..]);
    hasher.digest()
}

/// The eight bytes from `at` as a number.
fn number(bytes: &[u8], at: usize) -> u64 {
    bytes[at..at + 8].iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::random;

    const LETTERS: Container = Container { magic: b"LETTER", version: 3, what: "a letter", packing: 1 };

    fn letter() -> Vec<u8> {
        LETTERS.write(&(7u64, "dear all ".repeat(100))).unwrap()
    }

    fn message(bytes: &[u8]) -> String {
        LETTERS.read::<(u64, String)>("a.letter", bytes).unwrap_err().to_string()
    }

    #[test]
    fn what_was_written_comes_back_packed_or_stored() {
        for packing in [0, 1, 9] {
            let letters = Container { packing, ..LETTERS };
            let file = letters.write(&(7u64, "dear all")).unwrap();
            assert_eq!(LETTERS.read::<(u64, String)>("a.letter", &file).unwrap(), (7, "dear all".to_owned()));
        }
    }

    #[test]
    fn messages_tell_what_is_wrong_with_a_file() {
        let file = letter();
        assert!(message(b"glTF").contains("a.letter: start: this is not a letter"));
        assert!(message(&[]).contains("not a letter"));
        assert!(message(&file[..20]).contains("cut off"));
        assert!(message(&file[..file.len() - 1]).contains("cut off"));
        let mut newer = file.clone();
        newer[6] += 1;
        assert!(message(&newer).contains("newer"));
        let mut damaged = file;
        damaged[40] ^= 1;
        assert!(message(&damaged).contains("damaged"));
        assert!(message(&LETTERS.write(&(7u64, "dear all", 1u8)).unwrap()).contains("1 bytes too many"));
    }

    #[test]
    fn a_false_length_costs_no_memory() {
        let mut file = letter();
        for length in [u64::MAX, 1 << 40, number(&file, 8) + 1, number(&file, 8) - 1, 0] {
            file[8..16].copy_from_slice(&length.to_le_bytes());
            sign(&mut file);
            assert!(message(&file).contains("bytes"), "{length}");
        }
    }

    #[test]
    fn mutated_files_are_damaged() {
        let file = letter();
        let mut state = 1;
        for _ in 0..500 {
            let mut bytes = file.clone();
            let at = random(&mut state) % bytes.len();
            bytes[at] ^= 1 << (random(&mut state) % 8);
            assert!(!message(&bytes).is_empty(), "byte {at}");
        }
    }
}
