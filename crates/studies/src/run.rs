//! One run of a study: point by point, each kept as soon as it is there.

use crate::bench::Bench;
use crate::report::{self, Report};
use crate::results::{Row, Table};
use crate::spec::Spec;
use crate::task::Task;
use crate::{Error, Study, machine, measures};
use isolux_io::files::{self, OutputFile};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Where scenes are that are no part of isolux, unless told otherwise.
pub const SCENES: &str = "../shared/scenes";

#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Fewer scenes, samples and seeds: under two minutes.
    pub quick: bool,
    /// Runs of each point, if not what the study says.
    pub seeds: Option<u64>,
    /// Folder of the scenes that are files, if not [`SCENES`].
    pub scenes: Option<PathBuf>,
}

impl Options {
    fn scenes(&self) -> PathBuf {
        self.scenes.clone().unwrap_or_else(|| PathBuf::from(SCENES))
    }
}

/// A point of a curve, measured with one seed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Numbers of its scene and series in the spec.
    pub scene: usize,
    pub series: usize,
    pub at: f64,
    pub seed: u64,
}

impl Point {
    /// Expected work, in arbitrary units: it grows with what `at` counts.
    fn work(&self) -> f64 {
        self.at.max(1.0)
    }
}

/// How far a run is.
#[derive(Clone, Debug)]
pub struct Progress {
    /// What is being measured.
    pub what: String,
    pub points_done: usize,
    pub points: usize,
    /// Share of the expected work that is done, of all and of what was left when the run began.
    pub share: f64,
    pub share_of_left: f64,
}

/// How a run ended.
#[derive(Debug)]
pub enum Outcome {
    Complete(Report),
    /// Stopped; so many points are kept.
    Stopped {
        points_done: usize,
        points: usize,
    },
}

/// What was asked.
const STUDY: &str = "study.toml";
/// The file in which the table grows.
const RESULT: &str = "result.csv";

/// Runs `study` into `folder`, from where an earlier run was stopped. `watch` is called many times a second.
///
/// # Errors
/// [`Error::OtherRun`] if the folder holds results of another study or of other options; those of files.
pub fn run(
    study: Study,
    options: Options,
    folder: &Path,
    mut watch: impl FnMut(&Progress) -> ControlFlow<()>,
) -> Result<Outcome, Error> {
    let spec = effective(study, &options)?;
    let mut measure = measures::named(&spec.measure)?;
    spec.check(measure.columns()).map_err(|what| Error::Spec { study: study.name.to_owned(), what })?;
    let points = points(&spec);
    identify(study, &options, folder)?;
    let path = folder.join(RESULT);
    let mut table = if path.exists() { Table::read(&path, measure.columns())? } else { Table::new(measure.columns()) };
    let is_done = |table: &Table, point: &Point| {
        let (scene, series) = (&spec.scenes[point.scene].name, &spec.series[point.series].name);
        let same = |row: &Row| row.scene == *scene && row.series == *series && row.seed == point.seed;
        table.rows.iter().any(|row| same(row) && (row.at == point.at || measure.has_own_places()))
    };
    let left: Vec<Point> = points.iter().copied().filter(|point| !is_done(&table, point)).collect();
    let work_of = |points: &[Point]| points.iter().map(Point::work).sum::<f64>();
    let (all, all_left) = (work_of(&points), work_of(&left));
    let mut bench = Bench::new(folder, &options.scenes());
    let mut done = 0.0;
    for (k, point) in left.iter().enumerate() {
        let (scene, series) = (&spec.scenes[point.scene], &spec.series[point.series]);
        let name = format!("{}, {}", scene.name, series.name);
        let mut watch_step = |doing: &str| {
            watch(&Progress {
                what: if doing.is_empty() { name.clone() } else { format!("{name}, {doing}") },
                points_done: points.len() - left.len() + k,
                points: points.len(),
                share: (all - all_left + done) / all,
                share_of_left: done / all_left,
            })
        };
        let mut task = Task { bench: &mut bench, spec: &spec, point: *point, watch: &mut watch_step };
        let Some(rows) = measure.measure(&mut task)? else {
            return Ok(Outcome::Stopped { points_done: points.len() - left.len() + k, points: points.len() });
        };
        table.rows.extend(rows);
        OutputFile::create(&path)?.finish(&table.to_csv())?;
        done += point.work();
    }
    // What is concluded follows from the file, as it does in a run that was stopped and goes on, and from the seeds that were asked
    // for, even if there are more.
    let mut table = Table::read(&path, measure.columns())?;
    table.rows.retain(|row| row.seed <= spec.seeds);
    Ok(Outcome::Complete(report::write(&spec, &table, folder)?))
}

/// The files of scenes that `study` would measure in and that are not there: these scenes are left out.
///
/// # Errors
/// Those of [`Study::spec`].
pub fn left_out(study: Study, options: &Options) -> Result<Vec<PathBuf>, Error> {
    let files = asked(study, options)?.scenes.into_iter().filter_map(|scene| scene.file);
    Ok(files.map(|file| options.scenes().join(file)).filter(|path| !path.exists()).collect())
}

/// What is asked for, whatever is there.
fn asked(study: Study, options: &Options) -> Result<Spec, Error> {
    let spec = study.spec()?;
    let mut spec = if options.quick { spec.quick() } else { spec };
    spec.seeds = options.seeds.unwrap_or(spec.seeds).max(1);
    Ok(spec)
}

/// What is measured: all but the scenes that are not there.
fn effective(study: Study, options: &Options) -> Result<Spec, Error> {
    let mut spec = asked(study, options)?;
    spec.scenes.retain(|scene| scene.file.as_ref().is_none_or(|file| options.scenes().join(file).exists()));
    Ok(spec)
}

/// All points: scene by scene, and within one from the cheapest to the dearest, so that a run that is stopped has curves.
fn points(spec: &Spec) -> Vec<Point> {
    let mut points = Vec::new();
    for scene in 0..spec.scenes.len() {
        for &at in &spec.at {
            for seed in 1..=spec.seeds {
                let within = |last: Option<f64>| last.is_none_or(|last| at <= last);
                let measured = |series: &usize| within(spec.series[*series].up_to) && within(spec.scenes[scene].up_to);
                let series = (0..spec.series.len()).filter(measured);
                points.extend(series.map(|series| Point { scene, series, at, seed }));
            }
        }
    }
    points
}

/// Says in the folder whose results it holds, or holds what it says against this run.
fn identify(study: Study, options: &Options, folder: &Path) -> Result<(), Error> {
    let path = folder.join("run.toml");
    let own =
        format!("study = \"{}\"\nquick = {}\nversion = \"{}\"\n", study.name, options.quick, isolux_core::VERSION);
    let text = format!("{own}machine = \"{}\"\n", machine::description());
    if path.exists() {
        let found = String::from_utf8_lossy(&files::read(&path)?).into_owned();
        if !found.starts_with(&own) {
            let what = format!("it was written by {}", found.lines().take(3).collect::<Vec<_>>().join(", "));
            return Err(Error::OtherRun { path, what });
        }
        let path = folder.join(STUDY);
        if path.exists() {
            let measured = Spec::parse(study.name, &String::from_utf8_lossy(&files::read(&path)?))?;
            if !measured.measures_as(&study.spec()?) {
                return Err(Error::OtherRun { path, what: "the study measures something else now".to_owned() });
            }
        }
        return Ok(OutputFile::create(&path)?.finish(study.text.as_bytes())?);
    }
    if folder.join(RESULT).exists() {
        return Err(Error::OtherRun { path: folder.join(RESULT), what: "it is of no known run".to_owned() });
    }
    OutputFile::create(&folder.join(STUDY))?.finish(study.text.as_bytes())?;
    Ok(OutputFile::create(&path)?.finish(text.as_bytes())?)
}
