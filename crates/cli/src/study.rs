//! `isolux study`: the published experiments, each reproduced by one command.

use crate::arguments::ThreadArguments;
use crate::failure::{Failure, INTERRUPTED};
use crate::interrupt::{Interrupt, watch};
use crate::numbers::time;
use crate::progress::ProgressArguments;
use crate::report::Table;
use crate::terminal;
use isolux_studies::ratios::Ratio;
use isolux_studies::report::Report;
use isolux_studies::{Error, Options, Outcome, Progress, SCENES, STUDIES, Study, left_out, run};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const EXAMPLES: &str = "\
Examples:
  isolux study list
  isolux study order --quick
  isolux study sequences --seeds 10 -o sequences

The folder gets study.toml (what was asked), result.csv (every measurement), fits.csv (slopes with their confidence \
intervals), the plots as SVG and PNG, and run.toml (version and machine). Every measurement is kept as soon as it is there: \
Ctrl-C stops, and the same command goes on from there. The same study and seeds give the same numbers on every machine, but \
for seconds.";

/// Reproduce a published experiment with Monte Carlo radiosity
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct StudyCommand {
    /// Name of the study, or 'list'
    name: String,

    /// Fewer scenes, samples and seeds: under two minutes on two cores
    #[arg(long)]
    quick: bool,

    /// Runs of each point, with seeds from 1 [default: what the study says]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    seeds: Option<u64>,

    /// Folder for the results [default: study-NAME]
    #[arg(short, long = "output", value_name = "DIR")]
    output: Option<PathBuf>,

    /// Folder of scenes that are no part of isolux, which 'speed' asks for: living-room.glb and classroom.glb. Without them it does
    /// with the others
    #[arg(long, value_name = "DIR", default_value = SCENES)]
    scenes: PathBuf,

    #[command(flatten)]
    threads: ThreadArguments,

    #[command(flatten)]
    progress: ProgressArguments,
}

impl StudyCommand {
    pub fn run(self) -> Result<u8, Failure> {
        if self.name == "list" {
            return terminal::print(&list()?).map(|()| 0);
        }
        let study = Study::named(&self.name).map_err(failure)?;
        let pool = self.threads.pool()?;
        watch(move |interrupt, _| pool.install(|| self.work(study, interrupt)))
    }

    fn work(&self, study: Study, interrupt: &Interrupt) -> Result<u8, Failure> {
        let folder = self.output.clone().unwrap_or_else(|| PathBuf::from(format!("study-{}", study.name)));
        std::fs::create_dir_all(&folder)
            .map_err(|error| Failure::usage(format!("{}: cannot make this folder: {error}", folder.display())))?;
        interrupt.keep_result();
        let mut display = self.progress.display(false);
        let options = Options { quick: self.quick, seeds: self.seeds, scenes: Some(self.scenes.clone()) };
        let left_out = left_out(study, &options).map_err(failure)?;
        if !left_out.is_empty() {
            terminal::note(&format!(
                "{}: not there, so these scenes are left out; --scenes names the folder",
                named(&left_out)
            ));
        }
        let (start, mut next_line) = (Instant::now(), Duration::ZERO);
        let outcome = run(study, options, &folder, |progress| {
            display.work(progress.share, &mut next_line, start, || in_short(progress, start));
            if interrupt.is_asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        display.clear();
        match outcome.map_err(failure)? {
            Outcome::Complete(report) => terminal::print(&in_words(&report, &folder, &left_out)).map(|()| 0),
            Outcome::Stopped { points_done, points } => {
                let kept = format!("stopped: {points_done} of {points} measurements are kept in {}", folder.display());
                terminal::note(&format!("{kept}; the same command goes on from there"));
                Ok(INTERRUPTED)
            }
        }
    }
}

fn failure(error: Error) -> Failure {
    match error {
        Error::Plot { .. } | Error::Io(isolux_io::Error::File { action: "write", .. }) => {
            Failure::other(error.to_string())
        }
        error => Failure::usage(error.to_string()),
    }
}

fn list() -> Result<String, Failure> {
    let mut text = "Studies, for isolux study NAME\n".to_owned();
    for study in STUDIES {
        text += &format!("  {:<21} {}\n", study.name, study.spec().map_err(failure)?.title);
    }
    Ok(text)
}

/// `3 min left · 120 of 480 · cubes, random walk, Halton`
fn in_short(progress: &Progress, start: Instant) -> String {
    let (done, elapsed) = (progress.share_of_left, start.elapsed().as_secs_f64());
    let left = if done < 0.01 || elapsed < 1.0 {
        "estimating time".to_owned()
    } else {
        format!("{} left", time((elapsed * (1.0 - done) / done).ceil()))
    };
    format!("{left} · {} of {} · {}", progress.points_done, progress.points, progress.what)
}

fn named(files: &[PathBuf]) -> String {
    files.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
}

fn in_words(report: &Report, folder: &Path, left_out: &[PathBuf]) -> String {
    let mut text = format!("{}\n", report.title);
    if !report.fits.is_empty() {
        text += "\nSlopes, with 95 % confidence\n";
    }
    let width = |names: &mut dyn Iterator<Item = &str>| names.map(|name| name.chars().count()).max().unwrap_or(0);
    let scene = width(&mut report.fits.iter().map(|fit| fit.scene.as_str()));
    let series = width(&mut report.fits.iter().map(|fit| fit.series.as_str()));
    for fit in &report.fits {
        let slope = isolux_studies::signs::in_words(fit.slope.mean, fit.slope.high - fit.slope.mean);
        text += &format!("  {:<12} {:<scene$}  {:<series$}  {slope}\n", fit.plot, fit.scene, fit.series);
    }
    text += &equal_errors(&report.ratios);
    text += "\nWhat was claimed, and whether it shows here\n";
    for verdict in &report.verdicts {
        let mark = if verdict.holds { "yes" } else { "no " };
        text += &format!("  {mark}  {:<scene$}  {} ({})\n", verdict.scene, verdict.claim, verdict.found);
    }
    if !left_out.is_empty() {
        text += &format!("\nLeft out, for there is no {}\n", named(left_out));
    }
    text += &format!("\nWritten to {}: result.csv", folder.display());
    for file in &report.files {
        text += &format!(", {}", file.file_name().unwrap_or_default().to_string_lossy());
    }
    text + "\n"
}

/// A table of how much faster series are, a column for each plot; nothing if nothing was compared.
fn equal_errors(ratios: &[Ratio]) -> String {
    let Some(Ratio { at, against, .. }) = ratios.first() else { return String::new() };
    let mut plots: Vec<&str> = ratios.iter().map(|ratio| ratio.plot.as_str()).collect();
    plots.dedup();
    let mut rows: Vec<(&str, &str)> = Vec::new();
    for ratio in ratios {
        let row = (ratio.scene.as_str(), ratio.series.as_str());
        if !rows.contains(&row) {
            rows.push(row);
        }
    }
    let mut table = Table::new(&[&["scene, series"], plots.as_slice()].concat());
    for (scene, series) in rows {
        let cell = |plot: &&str| {
            let is_here = |ratio: &&Ratio| ratio.plot == **plot && (&*ratio.scene, &*ratio.series) == (scene, series);
            ratios.iter().find(is_here).map_or_else(|| "-".to_owned(), Ratio::in_words)
        };
        table.row(&format!("{scene}, {series}"), plots.iter().map(cell).collect::<Vec<_>>());
    }
    let head = format!(
        "Time of {against} to the error of each after {at} s, in multiples of that (~ beyond what was measured)"
    );
    format!("\n{head}\n{}", table.lines())
}
