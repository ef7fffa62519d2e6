//! VTK XML unstructured grid, for ParaView, VisIt and meshio: one triangle cell for each element, or for each triangle of an element that is
//! made of several, with `Element`, its number, `Irradiance` and `StandardError` [lux], `Radiosity` and `Emission` [lm/m²] and `Reflectivity` in three channels, and
//! `Object`, the number of an object, whose names are in a comment at the top.
//!
//! Numbers are appended to the XML as raw little-endian blocks, each after its length in 64 bits (VTK file formats,
//! "XML file formats").

use super::elements::{self, EMISSION, IRRADIANCE, RADIOSITY, REFLECTIVITY, STD_ERROR};
use super::{ExportOptions, LitScene};
use crate::Error;
use isolux_core::{Problem, Solution};

/// VTK's number for a triangle.
const VTK_TRIANGLE: u8 = 5;

/// See the head of this module.
///
/// # Errors
/// None.
pub fn write(lit: &LitScene, _: &ExportOptions) -> Result<Vec<u8>, Error> {
    let LitScene { problem, solution, .. } = lit;
    let pieces = elements::pieces(problem);
    let count = pieces.clone().count();
    let mut blocks = Blocks::default();

    let corners = pieces.clone().flat_map(|(_, place)| elements::corners(problem, place)).flat_map(|p| p.to_array());
    let points = blocks.floats("Points", corners);
    let mut cells = blocks.array("connectivity", "Int64", 1, (0..3 * count as i64).flat_map(i64::to_le_bytes));
    cells += &blocks.array("offsets", "Int64", 1, (1..=count as i64).flat_map(|k| (3 * k).to_le_bytes()));
    cells += &blocks.array("types", "UInt8", 1, std::iter::repeat_n(VTK_TRIANGLE, count));
    let mut data = String::new();
    for quantity in [IRRADIANCE, STD_ERROR, RADIOSITY, REFLECTIVITY, EMISSION] {
        let values = pieces.clone().flat_map(|(e, _)| (quantity.of)(problem, solution, e).to_array());
        data += &blocks.floats(quantity.title, values);
    }
    data += &blocks.array("Element", "UInt32", 1, pieces.clone().flat_map(|(e, _)| e.to_le_bytes()));
    let objects = pieces.flat_map(|(e, _)| problem.object(e).to_le_bytes());
    data += &blocks.array("Object", "UInt32", 1, objects);

    let xml = format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         {}<UnstructuredGrid>\n\
         <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{count}\">\n\
         <Points>\n{points}</Points>\n<Cells>\n{cells}</Cells>\n\
         <CellData Scalars=\"Irradiance\">\n{data}</CellData>\n\
         </Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_",
        comment(problem, solution),
        3 * count,
    );
    let mut file = xml.into_bytes();
    file.append(&mut blocks.0);
    file.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
    Ok(file)
}

/// The appended part.
#[derive(Default)]
struct Blocks(Vec<u8>);

impl Blocks {
    /// Appends vectors of three; gives the XML element that points to them.
    fn floats(&mut self, name: &str, values: impl Iterator<Item = f32>) -> String {
        self.array(name, "Float32", 3, values.flat_map(f32::to_le_bytes))
    }

    fn array(&mut self, name: &str, kind: &str, components: u32, bytes: impl Iterator<Item = u8>) -> String {
        let start = self.0.len();
        self.0.extend_from_slice(&[0; 8]);
        self.0.extend(bytes);
        let length = (self.0.len() - start - 8) as u64;
        self.0[start..start + 8].copy_from_slice(&length.to_le_bytes());
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" \
             offset=\"{start}\"/>\n"
        )
    }
}

/// Where the numbers come from and the names of the objects, as an XML comment: fields of text are not understood by all
/// readers.
fn comment(problem: &Problem, solution: &Solution) -> String {
    let p = &solution.provenance;
    let smoothed = elements::smoothed_in_words(solution);
    let mut text = format!("isolux {}: {}, {}, seed {}{smoothed}\n", p.version, p.scene, p.method, p.seed);
    for (k, object) in problem.scene.objects.iter().enumerate() {
        text += &format!("object {k} {}\n", object.name);
    }
    // A comment may hold neither two hyphens in a row nor what XML takes for no character.
    let forbidden = |c: char| (c.is_control() && c != '\n') || c == '\u{fffe}' || c == '\u{ffff}';
    let text = text.replace("--", "- -").replace("--", "- -").replace(forbidden, " ");
    format!("<!--\n{text}-->\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    /// Position of `pattern` in `bytes`.
    fn find(bytes: &[u8], pattern: &str) -> usize {
        bytes.windows(pattern.len()).position(|window| window == pattern.as_bytes()).expect(pattern)
    }

    #[test]
    fn offsets_in_the_xml_lead_to_the_numbers() {
        [fixture::lit_box(), fixture::lit_ball()].iter().for_each(|(problem, solution)| leads(problem, solution));
    }

    fn leads(problem: &Problem, solution: &Solution) {
        let file = write(&LitScene::new(problem, solution), &ExportOptions::default()).unwrap();
        let marker = "encoding=\"raw\">\n_";
        let appended = find(&file, marker) + marker.len();
        let xml = std::str::from_utf8(&file[..appended]).unwrap();
        let block = |name: &str| {
            let attribute = xml.split(&format!("Name=\"{name}\"")).nth(1).unwrap().split("offset=\"").nth(1).unwrap();
            let start = appended + attribute.split('"').next().unwrap().parse::<usize>().unwrap();
            let length = u64::from_le_bytes(file[start..start + 8].try_into().unwrap()) as usize;
            file[start + 8..start + 8 + length].to_vec()
        };
        let pieces: Vec<u32> = elements::pieces(problem).map(|(e, _)| e).collect();
        let of_pieces = pieces.iter().flat_map(|&e| solution.irradiance[e as usize].to_array());
        assert_eq!(block("Irradiance"), of_pieces.flat_map(f32::to_le_bytes).collect::<Vec<u8>>());
        assert_eq!(block("Element"), pieces.iter().flat_map(|e| e.to_le_bytes()).collect::<Vec<u8>>());
        assert_eq!(block("types"), vec![VTK_TRIANGLE; pieces.len()]);
        assert_eq!(block("Points").len(), pieces.len() * 36);
    }

    #[test]
    fn names_cannot_end_the_comment() {
        let (mut problem, solution) = fixture::lit_box();
        problem.scene.objects[0].name = "-->---<!--\u{1}".into();
        let comment = comment(&problem, &solution);
        let inside = comment.strip_prefix("<!--").unwrap().strip_suffix("-->\n").unwrap();
        assert!(!inside.contains("--") && !inside.contains('\u{1}'), "{inside}");
    }
}
