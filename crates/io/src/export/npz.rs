//! NumPy arrays in a ZIP archive; `numpy.load` reads them without pickle.
//!
//! With n elements, k objects and p triangles that show the elements: `vertices` (p, 3, 3) [m], corners counter-clockwise seen from the
//! element's side; `element` (p), the element that each triangle shows, which is 0, 1, 2 ... unless elements are made of several triangles;
//! `area` (n) [m²]; `normal` (n, 3) of the side, in the middle of the element; `reflectivity`, `emission` [lm/m²],
//! `irradiance` [lux], `std_error` [lux], `radiosity` [lm/m²], each (n, 3), red green blue; `object` (n), an index into
//! `names` (k, text, cut off after 256 characters); `triangle` (n), its number in the scene file; `back` (n, boolean);
//! and `summary`, the text of the `.json` file. Numbers are 32 bits wide.

use super::elements::{self, EMISSION, IRRADIANCE, RADIOSITY, REFLECTIVITY, STD_ERROR};
use super::{ExportOptions, LitScene, cannot_encode, json};
use crate::Error;
use npyz::{DType, WriteOptions, WriterBuilder};
use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;

/// Every name takes as much room as the longest.
const LONGEST_NAME: usize = 256;

/// See the head of this module.
///
/// # Errors
/// None that an archive in memory could meet.
pub fn write(lit: &LitScene, options: &ExportOptions) -> Result<Vec<u8>, Error> {
    let LitScene { problem, solution, .. } = lit;
    let (scene, mesh) = (&problem.scene, &problem.mesh);
    let n = mesh.len() as u64;
    let mut archive = Archive::new();

    let pieces = elements::pieces(problem);
    let p = pieces.clone().count() as u64;
    let corners = pieces.clone().flat_map(|(_, place)| elements::corners(problem, place));
    archive.floats("vertices", &[p, 3, 3], corners.flat_map(|p| p.to_array()))?;
    archive.integers("element", p, pieces.map(|(e, _)| e))?;
    archive.floats("area", &[n], mesh.elements().map(|e| mesh.area(e)))?;
    let normals = mesh.elements().flat_map(|e| problem.centre(e).1.to_array());
    archive.floats("normal", &[n, 3], normals)?;
    for quantity in [REFLECTIVITY, EMISSION, IRRADIANCE, STD_ERROR, RADIOSITY] {
        let values = quantity.values(problem, solution).flat_map(|color| color.to_array());
        archive.floats(quantity.name, &[n, 3], values)?;
    }
    let source = |e| scene.triangles[mesh.triangle(e) as usize].source;
    archive.integers("triangle", n, mesh.elements().map(source))?;
    archive.integers("object", n, mesh.elements().map(|e| problem.object(e)))?;
    let back: Vec<u8> = mesh.elements().map(|e| u8::from(mesh.place(e).back)).collect();
    archive.array("back", "|b1", &[n], &back)?;
    let cut = |name: &String| name.chars().take(LONGEST_NAME).collect();
    let names: Vec<String> = scene.objects.iter().map(|object| cut(&object.name)).collect();
    archive.texts("names", &[names.len() as u64], &names)?;
    archive.texts("summary", &[], &[json::summary(problem, solution, &options.extras).to_string()])?;

    archive.finish()
}

/// Arrays in a ZIP archive in memory.
pub(super) struct Archive(zip::ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    pub(super) fn new() -> Archive {
        Archive(zip::ZipWriter::new(Cursor::new(Vec::new())))
    }

    pub(super) fn finish(self) -> Result<Vec<u8>, Error> {
        Ok(self.0.finish().map_err(cannot_encode("npz"))?.into_inner())
    }

    fn floats(&mut self, name: &str, shape: &[u64], values: impl Iterator<Item = f32>) -> Result<(), Error> {
        self.array(name, "<f4", shape, &values.flat_map(f32::to_le_bytes).collect::<Vec<u8>>())
    }

    fn integers(&mut self, name: &str, count: u64, values: impl Iterator<Item = u32>) -> Result<(), Error> {
        self.array(name, "<u4", &[count], &values.flat_map(u32::to_le_bytes).collect::<Vec<u8>>())
    }

    /// Texts of the same width, UTF-32, filled up with zeros.
    pub(super) fn texts(&mut self, name: &str, shape: &[u64], texts: &[String]) -> Result<(), Error> {
        let width = texts.iter().map(|text| text.chars().count()).max().unwrap_or(0).max(1);
        let fill = |text: &String| text.chars().map(u32::from).chain(std::iter::repeat(0)).take(width).collect();
        let codes: Vec<u32> = texts.iter().flat_map(|text| -> Vec<u32> { fill(text) }).collect();
        self.array(
            name,
            &format!("<U{width}"),
            shape,
            &codes.into_iter().flat_map(u32::to_le_bytes).collect::<Vec<u8>>(),
        )
    }

    /// An array of NumPy's type `kind`.
    pub(super) fn array(&mut self, name: &str, kind: &str, shape: &[u64], bytes: &[u8]) -> Result<(), Error> {
        let kind = kind.parse().map_err(cannot_encode("npz"))?;
        let large = bytes.len() as u64 >= u64::from(u32::MAX) / 2;
        let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default()).large_file(large);
        self.0.start_file(npyz::npz::file_name_from_array_name(name), options).map_err(cannot_encode("npz"))?;
        let header = WriteOptions::new_header_only().dtype(DType::Plain(kind)).shape(shape).writer(&mut self.0);
        header.write_header_only().map_err(cannot_encode("npz"))?;
        self.0.write_all(bytes).map_err(cannot_encode("npz"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use isolux_core::{Problem, Solution};
    use std::io::Read;

    #[test]
    fn arrays_read_back_with_shape_and_values() {
        let names =
            [fixture::lit_box(), fixture::lit_ball()].map(|(problem, solution)| reads_back(&problem, &solution));
        assert_eq!(names, ["größe", "ball"]);
    }

    /// The name of the last object.
    fn reads_back(problem: &Problem, solution: &Solution) -> String {
        let bytes = write(&LitScene::new(problem, solution), &ExportOptions::default()).unwrap();
        let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
        let mut array = |name: &str| {
            let mut npy = Vec::new();
            archive.by_name(&format!("{name}.npy")).unwrap().read_to_end(&mut npy).unwrap();
            npy
        };
        let n = problem.mesh.len() as u64;
        let npy = array("irradiance");
        let irradiance = npyz::NpyFile::new(&npy[..]).unwrap();
        assert_eq!(irradiance.shape(), [n, 3]);
        let expected: Vec<f32> = solution.irradiance.iter().flat_map(|c| c.to_array()).collect();
        assert_eq!(irradiance.into_vec::<f32>().unwrap(), expected);
        let npy = array("vertices");
        let pieces: Vec<u32> = elements::pieces(problem).map(|(e, _)| e).collect();
        assert_eq!(npyz::NpyFile::new(&npy[..]).unwrap().shape(), [pieces.len() as u64, 3, 3]);
        let npy = array("element");
        assert_eq!(npyz::NpyFile::new(&npy[..]).unwrap().into_vec::<u32>().unwrap(), pieces);
        let npy = array("names");
        let names: Vec<String> = npyz::NpyFile::new(&npy[..]).unwrap().into_vec().unwrap();
        names.last().unwrap().trim_end_matches('\0').to_owned()
    }
}
