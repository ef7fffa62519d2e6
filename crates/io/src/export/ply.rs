//! Stanford PLY, binary little-endian: what MeshLab, Blender and CloudCompare open.
//!
//! Every element, or triangle of an element that is made of several, is a face with three vertices of its own, so that light does not run over its edges. Vertices and faces carry the
//! radiosity as `red green blue` (sRGB, scaled so that the brightest hundredth of the reflecting surfaces is white), for
//! looking at; faces carry the numbers themselves as floats: `irradiance_*` and `std_error_*` [lux], `radiosity_*`
//! [lm/m²], `element`, its number, and `object`, an index into the `comment object` lines.

use super::elements::{self, IRRADIANCE, Quantity, RADIOSITY, STD_ERROR};
use super::{ExportOptions, LitScene, cannot_encode};
use crate::Error;
use isolux_core::{Problem, Solution};

const FACE_QUANTITIES: [Quantity; 3] = [IRRADIANCE, STD_ERROR, RADIOSITY];

/// See the head of this module.
///
/// # Errors
/// [`Error::Invalid`] with more corners than 32 bits can number.
pub fn write(lit: &LitScene, _: &ExportOptions) -> Result<Vec<u8>, Error> {
    let LitScene { problem, solution, .. } = lit;
    let pieces = elements::pieces(problem);
    let count = pieces.clone().count();
    if i32::try_from(3 * count).is_err() {
        return Err(cannot_encode("ply")(format!("{count} faces have too many corners for this format")));
    }
    let mut file = header(problem, solution, count).into_bytes();
    let colors = elements::display_colors(problem, solution);
    for (e, place) in pieces.clone() {
        for corner in elements::corners(problem, place) {
            file.extend(corner.to_array().into_iter().flat_map(f32::to_le_bytes));
            file.extend(colors[e as usize]);
        }
    }
    for (k, (e, _)) in (0u32..).zip(pieces) {
        file.push(3);
        file.extend([3 * k, 3 * k + 1, 3 * k + 2].into_iter().flat_map(u32::to_le_bytes));
        file.extend(colors[e as usize]);
        for quantity in FACE_QUANTITIES {
            let value = (quantity.of)(problem, solution, e).to_array();
            file.extend(value.into_iter().flat_map(f32::to_le_bytes));
        }
        file.extend(e.to_le_bytes());
        file.extend(problem.object(e).to_le_bytes());
    }
    Ok(file)
}

fn header(problem: &Problem, solution: &Solution, faces: usize) -> String {
    const COLOR: &str = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    let provenance = &solution.provenance;
    let mut header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment isolux {}: {}, {}, seed {}, {} rays{}\n",
        one_line(&provenance.version),
        one_line(&provenance.scene),
        one_line(&provenance.method),
        provenance.seed,
        solution.work.rays,
        elements::smoothed_in_words(solution)
    );
    for (k, object) in problem.scene.objects.iter().enumerate() {
        header += &format!("comment object {k} {}\n", one_line(&object.name));
    }
    header += &format!("element vertex {}\n", 3 * faces);
    header += "property float x\nproperty float y\nproperty float z\n";
    header += COLOR;
    header += &format!("element face {faces}\nproperty list uchar int vertex_indices\n");
    header += COLOR;
    for quantity in FACE_QUANTITIES {
        header.extend(["r", "g", "b"].map(|channel| format!("property float {}_{channel}\n", quantity.name)));
    }
    header + "property uint element\nproperty uint object\nend_header\n"
}

/// A header line ends at the first line break, so names must have none.
fn one_line(text: &str) -> String {
    text.replace(char::is_control, " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use ply_rs_bw::{parser::Parser, ply::DefaultElement, ply::Property};

    #[test]
    fn another_reader_finds_the_same_numbers() {
        [fixture::lit_box(), fixture::lit_ball()].iter().for_each(|(problem, solution)| finds(problem, solution));
    }

    fn finds(problem: &Problem, solution: &Solution) {
        let file = write(&LitScene::new(problem, solution), &ExportOptions::default()).unwrap();
        let ply = Parser::<DefaultElement>::new().read_ply(&mut &file[..]).unwrap();
        let (vertices, faces) = (&ply.payload["vertex"], &ply.payload["face"]);
        let pieces: Vec<_> = elements::pieces(problem).collect();
        assert_eq!((vertices.len(), faces.len()), (3 * pieces.len(), pieces.len()));
        for (&(e, place), face) in pieces.iter().zip(faces) {
            assert_eq!(face["element"], Property::UInt(e));
            assert_eq!(face["irradiance_g"], Property::Float(solution.irradiance[e as usize].g));
            assert_eq!(face["radiosity_b"], Property::Float(solution.radiosity(problem, e).b));
            assert_eq!(face["object"], Property::UInt(problem.object(e)));
            let Property::ListInt(corners) = &face["vertex_indices"] else { panic!("{face:?}") };
            let y = elements::corners(problem, place).map(|p| Property::Float(p.y));
            assert!(corners.iter().zip(y).all(|(&k, y)| vertices[k as usize]["y"] == y));
        }
    }

    #[test]
    fn names_cannot_end_the_header() {
        let (mut problem, solution) = fixture::lit_box();
        problem.scene.objects[0].name = "floor\nend_header\n".into();
        let header = header(&problem, &solution, problem.mesh.len());
        assert_eq!(header.lines().filter(|line| *line == "end_header").count(), 1);
    }
}
