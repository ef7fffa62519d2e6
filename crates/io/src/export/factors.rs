//! Writers of form factors: sparse matrices, entry (i, j) the share of the light leaving element i that reaches j.
//!
//! `.npz` has the arrays of SciPy's `save_npz` in compressed sparse rows (`data`, `indices`, `indptr`, `shape`, `format`),
//! and beside them `area` [m²], `std_error` in the order of `data` if there is one, and `parameters` as text. `.csv` has a
//! line for each entry, `i,j,factor[,std_error]`, numbers from 0. `.mtx` is MatrixMarket's coordinate format (Boisvert, Pozo
//! & Remington 1996), numbers from 1.

use super::cannot_encode;
use super::npz::Archive;
use crate::Error;
use isolux_core::form_factors::FormFactors;
use std::fmt::Write;
use std::path::Path;

/// Entries that are written as text; more would take gigabytes.
const MOST_AS_TEXT: usize = 20_000_000;

/// A matrix to be written.
#[derive(Clone, Copy, Debug)]
pub struct FactorFile<'a> {
    pub factors: &'a FormFactors,
    /// Where they come from, as name and value.
    pub parameters: &'a [(&'static str, String)],
}

/// One format of form factors.
#[derive(Clone, Copy, Debug)]
pub struct FactorFormat {
    /// Lower case, without the dot.
    pub extension: &'static str,
    /// What is in the file, in a few words.
    pub what: &'static str,
    pub write: fn(FactorFile<'_>) -> Result<Vec<u8>, Error>,
}

/// All formats of form factors.
pub const FACTOR_FORMATS: &[FactorFormat] = &[
    FactorFormat { extension: "npz", what: "sparse rows, for scipy.sparse.load_npz", write: npz },
    FactorFormat { extension: "csv", what: "a table with a row for each form factor", write: csv },
    FactorFormat { extension: "mtx", what: "a MatrixMarket file", write: mtx },
];

/// The format for `path`, by its extension in upper or lower case.
///
/// # Errors
/// [`Error::UnknownFormat`], which lists the known ones.
pub fn for_path(path: &Path) -> Result<&'static FactorFormat, Error> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    FACTOR_FORMATS.iter().find(|format| format.extension == extension).ok_or_else(|| {
        let known: Vec<String> = FACTOR_FORMATS.iter().map(|format| format!(".{}", format.extension)).collect();
        let known = format!("form factors can be written as {}", known.join(", "));
        Error::UnknownFormat { path: path.to_owned(), known }
    })
}

fn npz(FactorFile { factors, parameters }: FactorFile) -> Result<Vec<u8>, Error> {
    let n = factors.len() as u64;
    let entries = [factors.values().len() as u64];
    let mut archive = Archive::new();
    archive.array("format", "|S3", &[], b"csr")?;
    archive.array("shape", "<i8", &[2], &bytes([n as i64; 2], i64::to_le_bytes))?;
    archive.array("data", "<f8", &entries, &bytes(factors.values().iter().copied(), f64::to_le_bytes))?;
    let columns = factors.columns().iter().map(|&column| column as i32);
    archive.array("indices", "<i4", &entries, &bytes(columns, i32::to_le_bytes))?;
    let starts = factors.starts().iter().map(|&start| start as i32);
    archive.array("indptr", "<i4", &[n + 1], &bytes(starts, i32::to_le_bytes))?;
    archive.array("area", "<f8", &[n], &bytes(factors.areas().iter().copied(), f64::to_le_bytes))?;
    if !factors.std_errors().is_empty() {
        let errors = factors.std_errors().iter().copied();
        archive.array("std_error", "<f4", &entries, &bytes(errors, f32::to_le_bytes))?;
    }
    let text: Vec<String> = parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    archive.texts("parameters", &[], &[text.join("\n")])?;
    archive.finish()
}

fn bytes<T, const N: usize>(values: impl IntoIterator<Item = T>, to_bytes: fn(T) -> [u8; N]) -> Vec<u8> {
    values.into_iter().flat_map(to_bytes).collect()
}

fn csv(FactorFile { factors, .. }: FactorFile) -> Result<Vec<u8>, Error> {
    let with_errors = !factors.std_errors().is_empty();
    let head = if with_errors { "i,j,factor,std_error\n" } else { "i,j,factor\n" };
    text("csv", factors, head.to_owned(), |text, i, k| {
        let (column, value) = (factors.columns()[k], factors.values()[k]);
        match factors.std_errors().get(k) {
            Some(error) => writeln!(text, "{i},{column},{value:?},{error:?}"),
            None => writeln!(text, "{i},{column},{value:?}"),
        }
    })
}

fn mtx(FactorFile { factors, parameters }: FactorFile) -> Result<Vec<u8>, Error> {
    let mut head = "%%MatrixMarket matrix coordinate real general\n".to_owned();
    head += "% Form factors: entry (i, j) is the share of the light leaving element i that reaches j\n";
    for (name, value) in parameters {
        let harmless: String = value.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        head += &format!("% {name} = {harmless}\n");
    }
    head += &format!("{} {} {}\n", factors.len(), factors.len(), factors.values().len());
    text("mtx", factors, head, |text, i, k| {
        writeln!(text, "{} {} {:?}", i + 1, factors.columns()[k] + 1, factors.values()[k])
    })
}

/// `head`, and what `line` writes for every entry k of row i.
fn text(
    format: &'static str,
    factors: &FormFactors,
    head: String,
    line: impl Fn(&mut String, usize, usize) -> std::fmt::Result,
) -> Result<Vec<u8>, Error> {
    if factors.values().len() > MOST_AS_TEXT {
        let what = format!("{} form factors are too many for text; write them as .npz", factors.values().len());
        return Err(Error::Invalid { file: format!(".{format} output"), place: "size".to_owned(), what });
    }
    let mut text = head;
    for i in 0..factors.len() {
        for k in factors.starts()[i]..factors.starts()[i + 1] {
            line(&mut text, i, k).map_err(cannot_encode(format))?;
        }
    }
    Ok(text.into_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolux_core::form_factors::Row;
    use std::io::{Cursor, Read};

    fn written(format: &str) -> Vec<u8> {
        let row = |element, entries: &[(u32, f64)], std_errors: &[f32]| Row {
            element,
            entries: entries.to_vec(),
            std_errors: std_errors.to_vec(),
            back_face: 0.0,
        };
        let rows = vec![row(0, &[(1, 0.25), (2, 0.5)], &[0.125, 0.5]), row(1, &[], &[]), row(2, &[(0, 1.0)], &[0.0])];
        let factors = FormFactors::from_rows(vec![1.0, 2.0, 3.0], rows);
        let parameters = [("scene", "a\nb".to_owned())];
        let file = FactorFile { factors: &factors, parameters: &parameters };
        (for_path(Path::new(&format!("F.{format}"))).unwrap().write)(file).unwrap()
    }

    #[test]
    fn texts_are_as_their_formats_ask() {
        let table = String::from_utf8(written("csv")).unwrap();
        assert_eq!(table, "i,j,factor,std_error\n0,1,0.25,0.125\n0,2,0.5,0.5\n2,0,1.0,0.0\n");
        let matrix = String::from_utf8(written("MTX")).unwrap();
        assert!(matrix.starts_with("%%MatrixMarket matrix coordinate real general\n"));
        assert!(matrix.ends_with("% scene = a b\n3 3 3\n1 2 0.25\n1 3 0.5\n3 1 1.0\n"), "{matrix}");
    }

    #[test]
    fn arrays_are_the_compressed_sparse_rows_of_scipy() {
        let mut archive = zip::ZipArchive::new(Cursor::new(written("npz"))).unwrap();
        let mut array = |name: &str| {
            let mut npy = Vec::new();
            archive.by_name(&format!("{name}.npy")).unwrap().read_to_end(&mut npy).unwrap();
            npy
        };
        let data: Vec<f64> = npyz::NpyFile::new(&array("data")[..]).unwrap().into_vec().unwrap();
        assert_eq!(data, [0.25, 0.5, 1.0]);
        for (name, expected) in [("indices", vec![1, 2, 0]), ("indptr", vec![0, 2, 2, 3])] {
            let found: Vec<i32> = npyz::NpyFile::new(&array(name)[..]).unwrap().into_vec().unwrap();
            assert_eq!(found, expected, "{name}");
        }
        let shape: Vec<i64> = npyz::NpyFile::new(&array("shape")[..]).unwrap().into_vec().unwrap();
        assert_eq!(shape, [3, 3]);
        assert!(array("format").ends_with(b"csr"));
    }

    #[test]
    fn other_extensions_are_refused() {
        assert!(for_path(Path::new("F.glb")).unwrap_err().to_string().contains(".npz, .csv, .mtx"));
    }
}
