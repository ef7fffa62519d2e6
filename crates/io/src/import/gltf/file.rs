//! A parsed glTF file with its buffers; looks up what the JSON refers to by number.

use crate::Error;
use crate::import::read_beside;
use base64::Engine;
use base64::engine::general_purpose::GeneralPurpose;
use base64::engine::{DecodePaddingMode, GeneralPurposeConfig};
use gltf::json::{Index, Root, buffer, validation::USize64};
use std::borrow::Cow;
use std::path::Path;

/// Base64 as data URIs have it, with or without padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

pub struct File<'a> {
    pub path: &'a Path,
    pub root: Root,
    buffers: Vec<Cow<'a, [u8]>>,
}

impl<'a> File<'a> {
    /// Fetches all buffers; `binary` is the binary chunk of a GLB.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a buffer shorter than it says, [`Error::File`] for one that is not there.
    pub fn new(path: &'a Path, root: Root, binary: Option<&'a [u8]>) -> Result<File<'a>, Error> {
        let mut file = File { path, root, buffers: Vec::new() };
        for (k, buffer) in file.root.buffers.iter().enumerate() {
            let place = format!("buffers/{k}");
            let bytes = match (&buffer.uri, binary) {
                (Some(uri), _) => Cow::Owned(file.fetch(uri, &place)?),
                (None, Some(chunk)) if k == 0 => Cow::Borrowed(chunk),
                (None, _) => return Err(file.error(&place, "it has no uri, and there is no binary chunk for it")),
            };
            let (said, there) = (buffer.byte_length.0, bytes.len());
            if said > there as u64 {
                return Err(file.error(&place, format!("it should have {said} bytes, but only {there} are there")));
            }
            file.buffers.push(bytes);
        }
        Ok(file)
    }

    /// The thing with number `index` in the top-level `list` called `kind`, wanted by `place`.
    ///
    /// # Errors
    /// [`Error::Invalid`] if there is none.
    pub fn get<'f, T>(&self, list: &'f [T], index: Index<T>, kind: &str, place: &str) -> Result<&'f T, Error> {
        list.get(index.value()).ok_or_else(|| {
            self.error(place, format!("it refers to {kind}/{}, but there are only {}", index.value(), list.len()))
        })
    }

    /// Bytes of a buffer view, and their stride if it has one.
    ///
    /// # Errors
    /// [`Error::Invalid`] if it does not exist or does not fit into its buffer.
    pub fn view(&self, index: Index<buffer::View>, place: &str) -> Result<(&[u8], Option<usize>), Error> {
        let view = self.get(&self.root.buffer_views, index, "bufferViews", place)?;
        let own_place = format!("bufferViews/{}", index.value());
        self.get(&self.root.buffers, view.buffer, "buffers", &own_place)?;
        let bytes = &self.buffers[view.buffer.value()];
        let start = view.byte_offset.unwrap_or_default();
        let slice = slice(bytes, start, view.byte_length).ok_or_else(|| {
            let (buffer, start, length) = (view.buffer.value(), start.0, view.byte_length.0);
            let what = format!("{length} bytes from {start} do not fit into the {} of buffers/{buffer}", bytes.len());
            self.error(&own_place, what)
        })?;
        Ok((slice, view.byte_stride.map(|stride| stride.0)))
    }

    /// The content behind a URI: the data in it, or a file beside the glTF file.
    ///
    /// # Errors
    /// [`Error::Invalid`] for data that is not base64 or an address on the net, [`Error::File`] for a file that cannot be read.
    pub fn fetch(&self, uri: &str, place: &str) -> Result<Vec<u8>, Error> {
        if let Some(data) = uri.strip_prefix("data:") {
            let Some((_, encoded)) = data.split_once(";base64,") else {
                return Err(self.error(place, "its data URI is not in base64"));
            };
            return BASE64.decode(encoded).map_err(|what| self.error(place, format!("its data URI is broken: {what}")));
        }
        if uri.contains("://") {
            return Err(self.error(place, format!("{uri} is not a file beside this one; download it first")));
        }
        read_beside(self.path, &percent_decoded(uri))
    }

    pub fn error(&self, place: &str, what: impl Into<String>) -> Error {
        Error::invalid(self.path, place, what)
    }
}

/// `length` bytes from `start`, if there are so many.
pub fn slice(bytes: &[u8], start: USize64, length: USize64) -> Option<&[u8]> {
    let start = usize::try_from(start.0).ok()?;
    bytes.get(start..start.checked_add(usize::try_from(length.0).ok()?)?)
}

/// Replaces `%20` and the like.
fn percent_decoded(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let code = after.get(..2).filter(|_| first == b'%').and_then(|hex| std::str::from_utf8(hex).ok());
        match code.and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &after[2..];
            }
            None => {
                bytes.push(first);
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_are_decoded() {
        assert_eq!(percent_decoded("a%20b%C3%A9%zz%2"), "a bé%zz%2");
    }
}
