//! `isolux factors`: the matrix of form factors, as a file.

use crate::arguments::{SceneArguments, ThreadArguments};
use crate::failure::Failure;
use crate::interrupt::watch;
use crate::numbers::{count, digits, parse_count, percent, time};
use crate::output::{self, OpenFiles, Written};
use crate::progress::{Display, ProgressArguments};
use crate::report::Table;
use crate::{input, terminal};
use isolux_core::form_factors::{self, Correction, FormFactors, Settings, WAYS};
use isolux_core::mesh::Resolution;
use isolux_core::solvers::DETERMINISTIC_ELEMENTS;
use isolux_core::{Error, Problem};
use isolux_io::export::factors::{FactorFile, FactorFormat, for_path};
use serde_json::json;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

const EXAMPLES: &str = "\
Examples:
  isolux factors cornell-box -o F.npz
  isolux factors room.glb --by local-lines --rays 1e5 --elements 5000 -o F.npz -o F.csv
  isolux factors box --by hemicube --resolution 128 --correct enclosure -o F.mtx

Ways:
  contour      contour integrals, exact where nothing blocks the view; where something does, on a grid of points
  hemicube     rays through the pixels of half a cube over the middle of each element
  local-lines  cosine-distributed lines from each element; every form factor gets a standard error
  global-lines lines across the whole scene, which serve both ends of each span; with standard errors, reciprocal

Entry (i, j) is the share of the light leaving element i that reaches element j. Rows sum to 1 in a closed scene. The \
elements are those of 'isolux solve' with the same --elements. Without -o only the summary is printed.

In Python: F = scipy.sparse.load_npz('F.npz'); area = numpy.load('F.npz')['area']

The matrix grows like the square of the number of elements; one that could have more than 100 million entries is \
refused. Ctrl-C stops at once and leaves old files as they were.";

/// Compute the form factors between all elements
///
/// By contour integrals, hemicubes or local lines, as a sparse matrix; says how well rows sum to one and how reciprocal it is.
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Factors {
    #[command(flatten)]
    scene: SceneArguments,

    /// A file to write: .npz .csv .mtx; repeat it for several
    #[arg(short, long = "output", value_name = "OUT")]
    outputs: Vec<PathBuf>,

    /// How they are computed: contour, hemicube, local-lines, global-lines
    #[arg(long, value_name = "WAY", default_value = WAYS[0].name, value_parser = parse_way)]
    by: &'static str,

    /// Number of elements to aim at [default: 2000]
    #[arg(long, value_name = "N", value_parser = parse_count, conflicts_with = "max_edge")]
    elements: Option<u64>,

    /// Instead: longest edge of an element in metres
    #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
    max_edge: Option<f32>,

    /// local-lines and global-lines: lines from each element (of mean area)
    #[arg(long, value_name = "N", default_value = "4096", value_parser = parse_rays)]
    rays: u32,

    /// hemicube: pixels along its edge, an even number
    #[arg(long, value_name = "R", default_value_t = Settings::default().resolution)]
    resolution: u16,

    /// hemicube: cut every element K times along its edge, and put a hemicube on each part
    #[arg(long, value_name = "K", default_value_t = Settings::default().hemicubes)]
    hemicubes: u16,

    /// contour: divisions of an element along its edge where something blocks the view
    #[arg(long, value_name = "K", default_value_t = Settings::default().visibility)]
    visibility: u16,

    /// Make the matrix obey a law it misses by its errors: none, reciprocity, enclosure (and rows that sum to one)
    #[arg(long, value_name = "LAW", default_value = Correction::default().name(), value_parser = parse_correction)]
    correct: Correction,

    /// Seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = Settings::default().seed)]
    seed: u64,

    #[command(flatten)]
    threads: ThreadArguments,

    /// Print the summary as one JSON object
    #[arg(long, help_heading = "Report")]
    json: bool,

    /// Print nothing but errors
    #[arg(short, long, help_heading = "Report", conflicts_with = "json")]
    quiet: bool,

    #[command(flatten, next_help_heading = "Report")]
    progress: ProgressArguments,
}

fn parse_way(text: &str) -> Result<&'static str, String> {
    let names = WAYS.iter().map(|way| way.name);
    let unknown = || Error::unknown_name("way to form factors", text, names.clone()).to_string();
    names.clone().find(|name| *name == text).ok_or_else(unknown)
}

fn parse_rays(text: &str) -> Result<u32, String> {
    u32::try_from(parse_count(text)?).map_err(|_| "give a number of lines below 4 billion".to_owned())
}

fn parse_correction(text: &str) -> Result<Correction, String> {
    let found = Correction::ALL.into_iter().find(|correction| correction.name() == text);
    found.ok_or_else(|| format!("it is one of {}", Correction::ALL.map(Correction::name).join(", ")))
}

/// What is said of a matrix.
struct Summary<'a> {
    problem: &'a Problem,
    factors: &'a FormFactors,
    by: &'static str,
    seconds: f64,
    outputs: &'a [Written],
}

impl Factors {
    pub fn run(self) -> Result<u8, Failure> {
        let formats: Result<Vec<_>, _> = self.outputs.iter().map(|path| for_path(path)).collect();
        let formats = formats?;
        let pool = self.threads.pool()?;
        watch(move |_, files| {
            files.open(&self.outputs, &[&self.scene.scene])?;
            pool.install(|| {
                let mut display = self.progress.display(self.quiet);
                let done = self.work(&formats, files, &mut display);
                display.clear();
                done.map(|()| 0)
            })
        })
    }

    fn work(&self, formats: &[&FactorFormat], files: &OpenFiles, display: &mut Display) -> Result<(), Failure> {
        display.stage("reading the scene");
        let scene = input::scene(&self.scene.scene, &self.scene.units.options())?;
        let problem = Problem::new(scene, self.element_size())?;
        let way = form_factors::way(self.by, &problem, &self.settings()).map_err(|error| {
            Failure::from(error).with_help("choose with --by, --elements and the option of the way; see --help")
        })?;
        let start = Instant::now();
        let computed = form_factors::compute(&problem, &*way, |done, all| {
            display.stage(&format!("computing form factors · {}", percent(done as f64 / all as f64)));
            ControlFlow::Continue(())
        });
        let factors = self.correct.apply(computed.unwrap_or_default());
        let seconds = start.elapsed().as_secs_f64();
        let parameters = self.parameters(&problem);
        let mut written = Vec::new();
        for (k, (path, format)) in self.outputs.iter().zip(formats).enumerate() {
            display.stage(&format!("writing {}", path.display()));
            let bytes = (format.write)(FactorFile { factors: &factors, parameters: &parameters })
                .map_err(|error| Failure::other(format!("{}: {error}", path.display())))?;
            files.finish(k, &bytes)?;
            written.push(Written { path: path.clone(), bytes: bytes.len() });
        }
        display.clear();
        let summary = Summary { problem: &problem, factors: &factors, by: self.by, seconds, outputs: &written };
        match (self.quiet, self.json) {
            (true, _) => Ok(()),
            (_, true) => terminal::print(&summary.json()),
            (_, false) => terminal::print(&summary.in_words()),
        }
    }

    fn element_size(&self) -> Resolution {
        match (self.elements, self.max_edge) {
            (_, Some(edge)) => Resolution::MaxEdge(edge),
            (elements, None) => Resolution::Elements(elements.unwrap_or(DETERMINISTIC_ELEMENTS)),
        }
    }

    fn settings(&self) -> Settings {
        let Factors { rays, resolution, hemicubes, visibility, seed, .. } = *self;
        Settings { rays, resolution, hemicubes, visibility, seed }
    }

    /// What the files say of where the matrix comes from.
    fn parameters(&self, problem: &Problem) -> Vec<(&'static str, String)> {
        let of_way = match self.by {
            "hemicube" => vec![("resolution", self.resolution.into()), ("hemicubes", self.hemicubes.into())],
            "local-lines" => vec![("rays", u64::from(self.rays)), ("seed", self.seed)],
            _ => vec![("visibility", self.visibility.into())],
        };
        let mut parameters = vec![
            ("scene", problem.scene.name.clone()),
            ("scene_hash", format!("{:016x}", problem.scene.hash())),
            ("by", self.by.to_owned()),
        ];
        parameters.extend(of_way.into_iter().map(|(name, value): (_, u64)| (name, value.to_string())));
        parameters.push(("correction", self.correct.name().to_owned()));
        parameters.push(("version", isolux_core::VERSION.to_owned()));
        parameters
    }
}

impl Summary<'_> {
    /// Least, mean and greatest row sum.
    fn row_sums(&self) -> [f64; 3] {
        let sums = (0..self.factors.len()).map(|i| self.factors.row_sum(i));
        let (least, total, most) = sums.fold((f64::INFINITY, 0.0, f64::NEG_INFINITY), |(least, total, most), sum| {
            (sum.min(least), total + sum, sum.max(most))
        });
        [least, total / self.factors.len() as f64, most]
    }

    /// RMS standard error of a form factor, if there are any.
    fn std_error(&self) -> Option<f64> {
        let errors = self.factors.std_errors();
        let sum: f64 = errors.iter().map(|&error| f64::from(error).powi(2)).sum();
        (!errors.is_empty()).then(|| (sum / errors.len() as f64).sqrt())
    }

    fn json(&self) -> String {
        let [min, mean, max] = self.row_sums();
        let reciprocity = self.factors.reciprocity();
        let object = json!({
            "scene": self.problem.scene.name,
            "elements": self.factors.len(),
            "form_factors": self.factors.values().len(),
            "by": self.by,
            "row_sum": { "min": min, "mean": mean, "max": max },
            "reciprocity": { "relative_rms": reciprocity.relative_rms, "largest": reciprocity.largest },
            "std_error_rms": self.std_error(),
            "seconds": self.seconds,
            "outputs": self.outputs,
            "version": isolux_core::VERSION,
        });
        format!("{object}\n")
    }

    fn in_words(&self) -> String {
        let [min, mean, max] = self.row_sums().map(|sum| format!("{sum:.6}"));
        let reciprocity = self.factors.reciprocity();
        let mut text = format!(
            "{}: {} elements, {} form factors by {} in {}\n\n",
            terminal::harmless(&self.problem.scene.name),
            count(self.factors.len() as u64),
            count(self.factors.values().len() as u64),
            self.by,
            time(self.seconds),
        );
        let mut table = Table::new(&["", "min", "mean", "max"]);
        table.row("row sums", [min, mean, max]);
        text += &table.lines();
        text += &format!(
            "\nReciprocity A_i F_ij = A_j F_ji: RMS difference {} of the RMS exchange area, largest {:.2e} m²\n",
            percent(reciprocity.relative_rms),
            reciprocity.largest,
        );
        if let Some(error) = self.std_error() {
            text += &format!("Standard error of a form factor: {} (RMS)\n", digits(error, 3));
        }
        if !self.outputs.is_empty() {
            text += &format!("\nWrote {}\n", output::in_words(self.outputs));
        }
        text
    }
}
