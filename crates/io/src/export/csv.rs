//! A table in comma-separated values (RFC 4180, UTF-8), one row for each element, units in the header.
//!
//! `triangle` is the number of the element's triangle in the scene file. `side` is `front` or `back`; the normal is that
//! of the side. Luminances are weighted as in Rec. 709. A standard error that is not known is `nan`.

use super::elements::{EMISSION, IRRADIANCE, Quantity, RADIOSITY, REFLECTIVITY, STD_ERROR};
use super::{ExportOptions, LitScene, cannot_encode};
use crate::Error;
use isolux_core::{Problem, Solution};

/// The quantities in the order of the columns, and whether their luminance has a column as well.
const COLUMNS: [(Quantity, bool); 5] =
    [(REFLECTIVITY, false), (EMISSION, false), (IRRADIANCE, true), (STD_ERROR, true), (RADIOSITY, false)];

/// See the head of this module.
///
/// # Errors
/// None that a table in memory could meet.
pub fn write(lit: &LitScene, _: &ExportOptions) -> Result<Vec<u8>, Error> {
    let LitScene { problem, solution, .. } = lit;
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(header()).map_err(cannot_encode("csv"))?;
    for e in problem.mesh.elements() {
        table.write_record(row(problem, solution, e)).map_err(cannot_encode("csv"))?;
    }
    table.into_inner().map_err(cannot_encode("csv"))
}

fn header() -> Vec<String> {
    let place = ["element", "object", "triangle", "side", "x [m]", "y [m]", "z [m]", "nx", "ny", "nz", "area [m²]"];
    let mut names: Vec<String> = place.map(String::from).to_vec();
    for (quantity, luminance) in COLUMNS {
        let unit = if quantity.unit.is_empty() { String::new() } else { format!(" [{}]", quantity.unit) };
        let channels = ["r", "g", "b", "luminance"].into_iter().take(if luminance { 4 } else { 3 });
        names.extend(channels.map(|channel| format!("{}_{channel}{unit}", quantity.name)));
    }
    names
}

fn row(problem: &Problem, solution: &Solution, e: u32) -> Vec<String> {
    let scene = &problem.scene;
    let place = problem.mesh.place(e);
    let triangle = &scene.triangles[place.triangle as usize];
    let (position, normal) = problem.centre(e);
    let mut fields = vec![
        e.to_string(),
        scene.objects[triangle.object as usize].name.clone(),
        triangle.source.to_string(),
        if place.back { "back" } else { "front" }.to_owned(),
    ];
    fields.extend(position.to_array().map(number));
    fields.extend(normal.to_array().map(number));
    fields.push(number(problem.mesh.area(e)));
    for (quantity, luminance) in COLUMNS {
        let value = (quantity.of)(problem, solution, e);
        fields.extend(value.to_array().map(number));
        fields.extend(luminance.then(|| number(value.luminance())));
    }
    fields
}

/// The shortest text that reads back as the same number.
fn number(value: f32) -> String {
    if value.is_nan() { "nan".to_owned() } else { format!("{value:?}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn the_table_reads_back_as_the_solution() {
        [fixture::lit_box(), fixture::lit_ball()].iter().for_each(|(problem, solution)| reads_back(problem, solution));
    }

    fn reads_back(problem: &Problem, solution: &Solution) {
        let bytes = write(&LitScene::new(problem, solution), &ExportOptions::default()).unwrap();
        let mut reader = csv::Reader::from_reader(&bytes[..]);
        let header = reader.headers().unwrap().clone();
        let column = |name: &str| header.iter().position(|n| n == name).expect(name);
        let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        assert_eq!(rows.len(), problem.mesh.len());
        for (e, row) in rows.iter().enumerate() {
            let value = |name: &str| row[column(name)].parse::<f32>().unwrap();
            assert_eq!(value("irradiance_g [lux]"), solution.irradiance[e].g);
            assert_eq!(value("irradiance_luminance [lux]"), solution.irradiance[e].luminance());
            assert_eq!(value("radiosity_b [lm/m²]"), solution.radiosity(problem, e as u32).b);
            assert_eq!(value("std_error_r [lux]").to_bits(), solution.std_error[e].r.to_bits());
            assert_eq!(value("area [m²]"), problem.mesh.area(e as u32));
            let place = problem.mesh.place(e as u32);
            assert_eq!(&row[column("side")], if place.back { "back" } else { "front" });
            let object = problem.object(e as u32) as usize;
            assert_eq!(row[column("object")], problem.scene.objects[object].name);
        }
    }
}
