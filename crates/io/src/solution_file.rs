//! The `.isolux` file: a whole solution with its provenance, the scene, and how the scene was cut into elements, so that
//! it can be looked at, compared and gone on with where the scene's own file is not.
//!
//! ```text
//! bytes  0..6    "ISOLUX"
//!        6..8    version of the format            (little-endian, like all numbers)
//!        8..16   length of the payload, unpacked
//!       16..24   XXH3 of bytes 0..16 and of the packed payload
//!       24..     payload: scene, cut, solution (postcard encoding), packed with zlib
//! ```
//!
//! Elements are not stored: the same scene, cut the same way, has the same ones ([`Problem::with_cut`]).

use crate::Error;
use flate2::{Compression, read::ZlibDecoder, write::ZlibEncoder};
use isolux_core::mesh::Cut;
use isolux_core::scene::Scene;
use isolux_core::{Problem, Solution};
use std::borrow::Cow;
use std::io::{Read, Write};
use xxhash_rust::xxh3::Xxh3;

const MAGIC: &[u8; 6] = b"ISOLUX";
const VERSION: u16 = 3;
const HEADER: usize = 24;
/// Deflate never packs more bytes than this into one (RFC 1951: 258 bytes in two bits).
const HIGHEST_RATIO: u64 = 1032;

#[derive(serde::Serialize, serde::Deserialize)]
struct Payload<'a> {
    scene: Cow<'a, Scene>,
    cut: Cow<'a, Cut>,
    solution: Cow<'a, Solution>,
}

/// The bytes of the file.
///
/// # Errors
/// [`Error::Invalid`] if `problem` and `solution` do not belong together or are not fit to be read again.
pub fn write(problem: &Problem, solution: &Solution) -> Result<Vec<u8>, Error> {
    let payload = Payload {
        scene: Cow::Borrowed(&problem.scene),
        cut: Cow::Owned(problem.mesh.cut()),
        solution: Cow::Borrowed(solution),
    };
    check(".isolux output", &payload)?;
    let unpacked = postcard::to_stdvec(&payload).map_err(|e| invalid(".isolux output", "payload", e))?;
    pack(&unpacked)
}

/// The problem and the solution in the bytes of a file; `name` is for messages.
///
/// # Errors
/// [`Error::Invalid`] if the bytes are not what [`write`] made, [`Error::Core`] if the scene cannot be cut into elements.
pub fn read(name: &str, bytes: &[u8]) -> Result<(Problem, Solution), Error> {
    let unpacked = unpack(name, bytes)?;
    let (payload, rest) = postcard::take_from_bytes::<Payload>(&unpacked).map_err(|e| invalid(name, "payload", e))?;
    if !rest.is_empty() {
        return Err(invalid(name, "payload", format!("{} bytes too many", rest.len())));
    }
    check(name, &payload)?;
    let problem = Problem::with_cut(payload.scene.into_owned(), &payload.cut)?;
    Ok((problem, payload.solution.into_owned()))
}

fn pack(unpacked: &[u8]) -> Result<Vec<u8>, Error> {
    let mut file = Vec::with_capacity(HEADER + unpacked.len() / 2);
    file.extend_from_slice(MAGIC);
    file.extend_from_slice(&VERSION.to_le_bytes());
    file.extend_from_slice(&(unpacked.len() as u64).to_le_bytes());
    file.extend_from_slice(&[0; 8]);
    let mut encoder = ZlibEncoder::new(file, Compression::fast());
    let packed = encoder.write_all(unpacked).and_then(|()| encoder.finish());
    let mut file = packed.map_err(|e| invalid(".isolux output", "payload", e))?;
    let checksum = checksum(&file);
    file[16..HEADER].copy_from_slice(&checksum.to_le_bytes());
    Ok(file)
}

fn unpack(name: &str, bytes: &[u8]) -> Result<Vec<u8>, Error> {
    if !bytes.starts_with(MAGIC) {
        return Err(invalid(name, "start", "this is not an isolux file"));
    }
    if bytes.len() < HEADER {
        return Err(invalid(name, "start", "the file is cut off"));
    }
    let version = u16::from(bytes[6]) | u16::from(bytes[7]) << 8;
    if version != VERSION {
        let what = format!("format version {version} is not {VERSION}, the one this isolux can read");
        return Err(invalid(name, "start", if version > VERSION { what + "; a newer isolux wrote it" } else { what }));
    }
    if number(bytes, 16) != checksum(bytes) {
        return Err(invalid(name, "checksum", "the file is damaged or cut off"));
    }
    let length = number(bytes, 8);
    let packed = &bytes[HEADER..];
    if length / HIGHEST_RATIO > packed.len() as u64 {
        return Err(invalid(name, "start", format!("{length} bytes cannot have been packed into {}", packed.len())));
    }
    let mut unpacked = Vec::new();
    let mut decoder = ZlibDecoder::new(packed).take(length.saturating_add(1));
    decoder.read_to_end(&mut unpacked).map_err(|e| invalid(name, "payload", e))?;
    if unpacked.len() as u64 != length {
        return Err(invalid(name, "payload", format!("it does not unpack to the {length} bytes that were announced")));
    }
    Ok(unpacked)
}

/// Whether scene, cut and solution can be used, and used together.
fn check(name: &str, payload: &Payload) -> Result<(), Error> {
    let Payload { scene, cut, solution } = payload;
    scene.validate().map_err(|fault| invalid(name, &format!("scene/{}", fault.place), fault.what))?;
    // Known before the elements are made, so that a false number cannot ask for a huge mesh.
    let elements = cut.element_count(scene).map_err(|e| invalid(name, "cut", e))?;
    for (what, values) in [("irradiance", &solution.irradiance), ("std_error", &solution.std_error)] {
        if values.len() != elements {
            let fault = format!("{} values for {elements} elements", values.len());
            return Err(invalid(name, &format!("solution/{what}"), fault));
        }
    }
    match solution.irradiance.iter().position(|value| !value.is_finite()) {
        Some(e) => Err(invalid(name, &format!("solution/irradiance/{e}"), "not a finite number")),
        None => Ok(()),
    }
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

fn invalid(name: &str, place: &str, what: impl std::fmt::Display) -> Error {
    Error::Invalid { file: name.to_owned(), place: place.to_owned(), what: what.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use isolux_core::math::Rgb;

    fn bits(values: &[Rgb]) -> Vec<[u32; 3]> {
        values.iter().map(|c| c.to_array().map(f32::to_bits)).collect()
    }

    fn message(bytes: &[u8]) -> String {
        read("a.isolux", bytes).map(|_| ()).unwrap_err().to_string()
    }

    /// A small xorshift generator: mutations must be the same each time.
    fn next(state: &mut u64) -> usize {
        *state ^= *state << 13;
        *state ^= *state >> 7;
        *state ^= *state << 17;
        (*state >> 16) as usize
    }

    #[test]
    fn everything_comes_back_bit_for_bit() {
        let (problem, solution) = fixture::lit_box();
        let file = write(&problem, &solution).unwrap();
        let (read_problem, read) = read("a.isolux", &file).unwrap();
        assert_eq!(bits(&read.irradiance), bits(&solution.irradiance));
        assert_eq!(bits(&read.std_error), bits(&solution.std_error));
        assert_eq!(
            (read.balance, read.work, &read.provenance),
            (solution.balance, solution.work, &solution.provenance)
        );
        assert_eq!(read_problem.scene.hash(), problem.scene.hash());
        assert_eq!(read_problem.scene.cameras, problem.scene.cameras);
        assert!(problem.mesh.elements().all(|e| read_problem.mesh.place(e) == problem.mesh.place(e)));
        assert_eq!(write(&read_problem, &read).unwrap(), file);
    }

    #[test]
    fn messages_tell_what_is_wrong_with_a_file() {
        let (problem, solution) = fixture::lit_box();
        let file = write(&problem, &solution).unwrap();
        assert!(message(b"glTF").contains("not an isolux file"));
        assert!(message(&[]).contains("not an isolux file"));
        assert!(message(&file[..20]).contains("cut off"));
        assert!(message(&file[..file.len() - 1]).contains("cut off"));
        let mut newer = file.clone();
        newer[6] = VERSION as u8 + 1;
        assert!(message(&newer).contains("newer"));
        let mut damaged = file;
        damaged[100] ^= 1;
        assert!(message(&damaged).contains("damaged"));
    }

    #[test]
    fn what_does_not_belong_together_is_not_written() {
        let (problem, mut solution) = fixture::lit_box();
        solution.irradiance.pop();
        assert!(write(&problem, &solution).unwrap_err().to_string().contains("solution/irradiance"));
    }

    #[test]
    fn a_false_length_costs_no_memory() {
        let (problem, solution) = fixture::lit_box();
        let mut file = write(&problem, &solution).unwrap();
        for length in [u64::MAX, 1 << 40, number(&file, 8) + 1, number(&file, 8) - 1, 0] {
            file[8..16].copy_from_slice(&length.to_le_bytes());
            let signature = checksum(&file);
            file[16..24].copy_from_slice(&signature.to_le_bytes());
            assert!(message(&file).contains("bytes"), "{length}");
        }
    }

    #[test]
    fn mutated_files_are_damaged() {
        let (problem, solution) = fixture::lit_box();
        let file = write(&problem, &solution).unwrap();
        let mut state = 1;
        for _ in 0..500 {
            let mut bytes = file.clone();
            let at = next(&mut state) % bytes.len();
            bytes[at] ^= 1 << (next(&mut state) % 8);
            assert!(read("a.isolux", &bytes).is_err(), "byte {at}");
        }
    }

    /// The decoder must not rely on the checksum: whoever can change a file can sign it again.
    #[test]
    fn mutated_and_signed_payloads_never_panic() {
        let (problem, solution) = fixture::lit_box();
        let file = write(&problem, &solution).unwrap();
        let unpacked = unpack("a.isolux", &file).unwrap();
        let (mut state, mut refused) = (2, 0);
        for k in 0..2000 {
            let mut bytes = unpacked.clone();
            for _ in 0..1 + k % 4 {
                // Half of the mutations near the start, where lengths are.
                let within = if k % 2 == 0 { bytes.len() } else { 64 };
                let at = next(&mut state) % within;
                bytes[at] = next(&mut state) as u8;
            }
            if k % 10 == 0 {
                bytes.truncate(next(&mut state) % bytes.len());
            }
            refused += usize::from(read("a.isolux", &pack(&bytes).unwrap()).is_err());
        }
        assert!(refused > 200, "{refused}");
    }

    #[test]
    fn false_cuts_are_refused_before_a_mesh_is_made() {
        let (problem, solution) = fixture::lit_box();
        let cut = Cow::Owned(Cut::regular(&vec![30_000; problem.scene.triangles.len()]));
        let payload = Payload { scene: Cow::Owned(problem.scene), cut, solution: Cow::Owned(solution) };
        let file = pack(&postcard::to_stdvec(&payload).unwrap()).unwrap();
        assert!(message(&file).contains("elements"));
    }
}
