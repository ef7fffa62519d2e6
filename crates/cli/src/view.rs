//! `isolux view`: a solution as a page in the browser.

use crate::arguments::{LookArguments, WorkArguments, check_camera};
use crate::failure::Failure;
use crate::input;
use crate::interrupt::watch;
use crate::live::open_in_browser;
use crate::output::{self, OpenFiles, Written};
use crate::progress::Display;
use crate::terminal;
use isolux_io::export::{self, ExportOptions, LitScene, html};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  isolux view lit.isolux                               writes lit.html here and opens it
  isolux view lit.isolux -o room.html                  only writes it
  isolux view evening.isolux --before day.isolux       two solutions, with a divider between them
  isolux view lit.isolux --camera 1 --exposure -6

The page is one file that needs nothing else and no network: it can be sent to anybody. docs/viewer.md explains what it shows.
'isolux solve --live' shows a solve while it runs, and -o NAME.html of other commands writes the same page.";

/// Look at a solution in the browser: walk about, read lux off the surfaces, dim lamps, compare
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct View {
    /// A .isolux file, as 'isolux solve' writes it
    solution: PathBuf,

    /// The page to write; it is then not opened unless --open asks for it [default: the solution's name, in this folder]
    #[arg(short, long, value_name = "PAGE.html")]
    output: Option<PathBuf>,

    /// Another solution to compare with, shown on the left
    #[arg(long, value_name = "SOLUTION")]
    before: Option<PathBuf>,

    /// Open the browser although -o names the page
    #[arg(long, conflicts_with = "no_open")]
    open: bool,

    /// Do not open the browser
    #[arg(long)]
    no_open: bool,

    /// The camera to begin with, by its name or its number from 0 [default: the first, or a view of the whole scene]
    #[arg(long, value_name = "CAMERA")]
    camera: Option<String>,

    #[command(flatten)]
    look: LookArguments,

    #[command(flatten)]
    work: WorkArguments,
}

impl View {
    pub fn run(self) -> Result<u8, Failure> {
        let path = self.page()?;
        let pool = self.work.pool()?;
        watch(move |_, files| {
            let inputs: Vec<&Path> =
                std::iter::once(&self.solution).chain(&self.before).map(PathBuf::as_path).collect();
            files.open(std::slice::from_ref(&path), &inputs)?;
            pool.install(|| self.write(&path, files))
        })
    }

    /// Where the page is written.
    fn page(&self) -> Result<PathBuf, Failure> {
        html::template()?;
        let Some(path) = &self.output else {
            return Ok(Path::new(self.solution.file_name().unwrap_or_default()).with_extension("html"));
        };
        if export::for_path(path)?.ending != export::PAGE {
            let what = format!("{}: what is looked at in the browser is a page, an .html file", path.display());
            return Err(Failure::usage(what).with_help("'isolux render' writes other formats"));
        }
        Ok(path.clone())
    }

    fn write(&self, path: &Path, files: &OpenFiles) -> Result<u8, Failure> {
        let mut display = self.work.display();
        let made = self.make(&mut display).and_then(|page| files.finish(0, &page).map(|()| page.len()));
        display.clear();
        let written = Written { path: path.to_owned(), bytes: made? };
        if !self.work.quiet {
            terminal::print(&format!("Wrote {}\n", output::in_words(&[written])))?;
        }
        if self.open || (self.output.is_none() && !self.no_open) {
            open_in_browser(&path.display().to_string(), &display);
        }
        Ok(0)
    }

    /// The page.
    fn make(&self, display: &mut Display) -> Result<Vec<u8>, Failure> {
        display.stage("reading the solution");
        let (problem, solution) = input::solution(&self.solution)?;
        check_camera(self.camera.as_deref(), &problem.scene)?;
        let before = self.before.as_deref().map(input::solution).transpose()?;
        let options: ExportOptions = self.look.options(self.camera.clone());
        display.stage("making the page");
        let lit = LitScene::smoothed(&problem, &solution, options.smoothing);
        let page = match &before {
            None => html::write(&lit, &options),
            Some((problem, solution)) => {
                let before = LitScene::smoothed(problem, solution, options.smoothing);
                let name = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let name_before = self.before.as_deref().map(name).unwrap_or_default();
                html::write_compared((&lit, &name(&self.solution)), (&before, &name_before), &options)
            }
        };
        page.map_err(|error| Failure::other(error.to_string()))
    }
}
