//! Irradiance at points of real rooms, computed by an independent renderer, and how solutions compare with it.
//!
//! A solution has one value for each element, the reference one for each point, so single points differ where the light
//! changes within an element; the mean over many points is what both must agree on. The mean of an element that lies half
//! behind another surface contains its dark half, though all good points lie on the other: between the elements, as pictures and
//! models show it ([`VertexField`]), the light belongs to the open half.

use anyhow::{Context, Result, ensure};
use glam::{Vec2, Vec3};
use isolux_core::math::Rgb;
use isolux_core::math::moments::Moments;
use isolux_core::view::VertexField;
use isolux_core::{Problem, Solution};
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

/// What is compared, in the order of all arrays of four: three channels, and their Rec. 709 luminance.
pub const CHANNELS: [&str; 4] = ["red", "green", "blue", "luminance"];
/// Index of the luminance in [`CHANNELS`].
pub const LUMINANCE: usize = 3;
/// Relative standard error that all points of a reference have in common.
pub const SHARED_ERROR: f64 = 0.0005;
/// Relative deviation of a mean that is put down to the size of the elements.
pub const ELEMENT_ALLOWANCE: f64 = 0.005;

/// Irradiance [lux] for each of [`CHANNELS`], with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Irradiance {
    pub value: [f64; 4],
    pub std_error: [f64; 4],
}

/// What of a solution is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Value {
    /// The value of the element at the point.
    OfElement,
    /// The value at the point as it is shown, interpolated between elements.
    AtPoint,
}

impl Value {
    pub const ALL: [Value; 2] = [Value::OfElement, Value::AtPoint];

    pub fn name(self) -> &'static str {
        match self {
            Value::OfElement => "element",
            Value::AtPoint => "point",
        }
    }
}

/// Where the reference is known.
#[derive(Clone, Debug)]
pub struct Point {
    /// Number of the triangle in the scene file.
    pub source: u32,
    /// Barycentric coordinates on it.
    pub uv: Vec2,
    /// World position [m].
    pub position: Vec3,
    /// Name of the node of the scene file.
    pub node: String,
    /// On the side that the triangle faces.
    pub irradiance: Irradiance,
}

/// Mean irradiance of solutions over that of the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    pub value: f64,
    /// From the spread of the runs, the reference's standard errors and its [`SHARED_ERROR`].
    pub std_error: f64,
}

/// The folder `shared/scenes` beside the workspace or above it, with the rooms and, in `ref`, their references.
pub fn scenes_folder() -> Option<PathBuf> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().skip(2);
    workspace.map(|folder| folder.join("shared/scenes")).find(|folder| folder.join("ref").is_dir())
}

/// Points of a reference.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Good to compare with: lit, known to 3 %, nothing closer than 2 mm.
    pub good: Vec<Point>,
    /// No light reached these: insides of furniture and walls, faces that lie on others.
    pub dark: Vec<Point>,
}

/// Reads the reference at `path`.
///
/// # Errors
/// If the file cannot be read or has not the expected arrays.
pub fn read(path: &Path) -> Result<Reference> {
    let mut archive = zip::ZipArchive::new(Cursor::new(isolux_io::files::read(path)?))?;
    let good: Vec<bool> = array(&mut archive, "good", 1)?;
    let triangle: Vec<i64> = array(&mut archive, "triangle", 1)?;
    let node: Vec<String> = array(&mut archive, "node_name", 1)?;
    let [point, bary, value, std_error] = ["point", "bary", "E", "se"].map(|name| array::<f64>(&mut archive, name, 3));
    let (point, bary, value, std_error) = (point?, bary?, value?, std_error?);
    let [luminance, luminance_error] = ["E_lum", "se_lum"].map(|name| array::<f64>(&mut archive, name, 1));
    let (luminance, luminance_error) = (luminance?, luminance_error?);
    let n = good.len();
    ensure!([triangle.len(), node.len(), luminance.len(), luminance_error.len()] == [n; 4], "arrays differ in length");
    ensure!([&point, &bary, &value, &std_error].map(Vec::len) == [3 * n; 4], "arrays differ in length");
    let three = |values: &[f64], i: usize| [values[3 * i], values[3 * i + 1], values[3 * i + 2]];
    let with = |[r, g, b]: [f64; 3], luminance: f64| [r, g, b, luminance];
    let read_point = |i: usize| {
        let [_, u, v] = three(&bary, i);
        Ok(Point {
            source: u32::try_from(triangle[i]).context("triangle number")?,
            uv: Vec2::new(u as f32, v as f32),
            position: Vec3::from_array(three(&point, i).map(|x| x as f32)),
            node: node[i].trim_end_matches('\0').to_owned(),
            irradiance: Irradiance {
                value: with(three(&value, i), luminance[i]),
                std_error: with(three(&std_error, i), luminance_error[i]),
            },
        })
    };
    Ok(Reference {
        good: (0..n).filter(|&i| good[i]).map(read_point).collect::<Result<_>>()?,
        dark: (0..n).filter(|&i| luminance[i] == 0.0).map(read_point).collect::<Result<_>>()?,
    })
}

/// An array of the archive with `width` numbers a row, rows one after the other.
fn array<T: npyz::Deserialize>(
    archive: &mut zip::ZipArchive<Cursor<Vec<u8>>>,
    name: &str,
    width: u64,
) -> Result<Vec<T>> {
    let mut bytes = Vec::new();
    archive.by_name(&format!("{name}.npy")).context(name.to_owned())?.read_to_end(&mut bytes)?;
    let file = npyz::NpyFile::new(&bytes[..])?;
    ensure!(width == 1 || file.order() == npyz::Order::C, "'{name}' is stored by columns");
    ensure!(file.shape().get(1).copied().unwrap_or(1) == width, "'{name}' has the wrong shape");
    Ok(file.into_vec()?)
}

/// Independent solutions of the same problem at the points of a reference.
#[derive(Clone, Debug)]
pub struct Comparison {
    pub points: Vec<Point>,
    /// The element at each point.
    pub elements: Vec<u32>,
    /// The triangle at each point.
    triangles: Vec<u32>,
    /// For each solution the irradiance of the element at each point.
    runs: Vec<Vec<Irradiance>>,
    /// For each solution the irradiance that is shown at each point.
    shown: Vec<Vec<[f64; 4]>>,
}

impl Comparison {
    /// # Errors
    /// If a point is not where its triangle and barycentric coordinates put it in `problem`, by 0.1 mm or more.
    pub fn new(points: Vec<Point>, problem: &Problem) -> Result<Comparison> {
        let last = problem.scene.triangles.iter().map(|t| t.source).max().unwrap_or(0);
        let mut triangle_of = vec![None; last as usize + 1];
        for (t, triangle) in problem.scene.triangles.iter().enumerate() {
            triangle_of[triangle.source as usize] = Some(t as u32);
        }
        let place = |point: &Point| {
            let triangle = triangle_of.get(point.source as usize).copied().flatten();
            let triangle = triangle.with_context(|| format!("the scene has no triangle {}", point.source))?;
            let [a, b, c] = problem.scene.corners(triangle);
            let distance = (a + point.uv.x * (b - a) + point.uv.y * (c - a)).distance(point.position);
            ensure!(distance < 1e-4, "a point of triangle {} is {distance} m from its place", point.source);
            let element = problem.mesh.at(triangle, point.uv, false).context("an element has no front")?;
            Ok((element, triangle))
        };
        let places: Vec<(u32, u32)> = points.iter().map(place).collect::<Result<_>>()?;
        let (elements, triangles) = places.into_iter().unzip();
        Ok(Comparison { points, elements, triangles, runs: Vec::new(), shown: Vec::new() })
    }

    /// Takes in one more solution, and how it is shown; its random numbers must be independent of those before.
    pub fn push(&mut self, problem: &Problem, solution: &Solution, field: &VertexField) {
        let with_luminance = |color: Rgb| {
            let [r, g, b] = color.to_array().map(f64::from);
            [r, g, b, color.luminance_f64()]
        };
        let at = |&e: &u32| Irradiance {
            value: with_luminance(solution.irradiance[e as usize]),
            std_error: with_luminance(solution.std_error[e as usize]),
        };
        self.runs.push(self.elements.iter().map(at).collect());
        let places = self.points.iter().zip(&self.triangles);
        let shown = places.map(|(point, &triangle)| field.irradiance_at(problem, triangle, point.uv, false));
        self.shown.push(shown.map(with_luminance).collect());
    }

    /// Luminance irradiance [lux] at all points in solution `run`: of the element, or as it is shown.
    pub fn luminances(&self, run: usize, of: Value) -> impl Iterator<Item = f64> + '_ {
        let value = move |i: usize| match of {
            Value::OfElement => self.runs[run][i].value[LUMINANCE],
            Value::AtPoint => self.shown[run][i][LUMINANCE],
        };
        (0..self.points.len()).map(value)
    }

    /// RMS error of luminance irradiance over all points and runs, in the mean of the reference, and median relative error.
    pub fn errors(&self, of: Value) -> (f64, f64) {
        let exact: Vec<f64> = self.points.iter().map(|point| point.irradiance.value[LUMINANCE]).collect();
        let differences: Vec<(f64, f64)> = (0..self.runs.len())
            .flat_map(|run| self.luminances(run, of).zip(&exact).map(|(value, exact)| (value - exact, *exact)))
            .collect();
        let count = differences.len() as f64;
        let mean = differences.iter().map(|(_, exact)| exact).sum::<f64>() / count;
        let rms = (differences.iter().map(|(error, _)| error * error).sum::<f64>() / count).sqrt();
        let mut relative: Vec<f64> = differences.iter().map(|(error, exact)| (error / exact).abs()).collect();
        relative.sort_by(f64::total_cmp);
        (rms / mean, relative[relative.len() / 2])
    }

    /// Ratio of the means over the points to which `belongs` says yes.
    pub fn ratio(&self, of: Value, channel: usize, belongs: impl Fn(&Point) -> bool) -> Ratio {
        let chosen: Vec<usize> = (0..self.points.len()).filter(|&i| belongs(&self.points[i])).collect();
        let reference = |i: &usize| &self.points[*i].irradiance;
        let total: f64 = chosen.iter().map(|i| reference(i).value[channel]).sum();
        let variance: f64 = chosen.iter().map(|i| reference(i).std_error[channel].powi(2)).sum();
        let value = |run: usize, i: usize| match of {
            Value::OfElement => self.runs[run][i].value[channel],
            Value::AtPoint => self.shown[run][i][channel],
        };
        let ratio = |run: usize| chosen.iter().map(|&i| value(run, i)).sum::<f64>() / total;
        let runs: Moments = (0..self.runs.len()).map(ratio).collect();
        let std_error = runs.std_error().hypot(variance.sqrt() / total).hypot(SHARED_ERROR);
        Ratio { value: runs.mean, std_error }
    }

    /// Sum over all points of the mean over the runs.
    pub fn total(&self, channel: usize) -> f64 {
        (0..self.points.len()).map(|i| self.mean(i).value[channel]).sum()
    }

    /// Mean over the runs at point `i`, with the standard error that the runs themselves state.
    pub fn mean(&self, i: usize) -> Irradiance {
        let count = self.runs.len() as f64;
        let sum = |of: &dyn Fn(&Irradiance) -> f64| self.runs.iter().map(|run| of(&run[i])).sum::<f64>();
        Irradiance {
            value: std::array::from_fn(|c| sum(&|run| run.value[c]) / count),
            std_error: std::array::from_fn(|c| sum(&|run| run.std_error[c].powi(2)).sqrt() / count),
        }
    }

    /// Spread of the runs at point `i`: the standard error of their mean, from nothing but the means.
    pub fn spread(&self, i: usize, channel: usize) -> f64 {
        self.runs.iter().map(|run| run[i].value[channel]).collect::<Moments>().std_error()
    }

    /// Difference from the reference at point `i` in standard errors of both.
    pub fn z(&self, i: usize, channel: usize) -> f64 {
        let (ours, theirs) = (self.mean(i), self.points[i].irradiance);
        (ours.value[channel] - theirs.value[channel]) / ours.std_error[channel].hypot(theirs.std_error[channel])
    }
}

impl Ratio {
    /// Whether it is one, within three standard errors and the [`ELEMENT_ALLOWANCE`].
    pub fn agrees(&self) -> bool {
        (self.value - 1.0).abs() <= 3.0 * self.std_error + ELEMENT_ALLOWANCE
    }
}
