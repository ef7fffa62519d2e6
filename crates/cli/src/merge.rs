//! `isolux merge`: one solution of several.

use crate::arguments::{PictureArguments, ThreadArguments};
use crate::failure::Failure;
use crate::interrupt::{Interrupt, watch};
use crate::numbers::{in_words, percent};
use crate::output::{self, Outputs};
use crate::progress::ProgressArguments;
use crate::{input, terminal};
use isolux_core::merge::merge;
use isolux_core::{Problem, Solution};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  isolux solve room.glb --seed 1 -o a.isolux
  isolux solve room.glb --seed 2 -o b.isolux      perhaps on another machine
  isolux merge a.isolux b.isolux -o both.isolux -o both.png

Solutions of equal quality count the same, better ones more. All must be of the same scene, elements and method, and no two may have \
the same seed. Interrupted and merged solutions can be merged, too.";

/// Make one better solution of several with different seeds
///
/// The error bars shrink as if one run had traced all rays. The files are written as 'isolux solve' writes them.
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Merge {
    /// .isolux files, two at least
    #[arg(required = true, num_args = 2.., value_name = "SOLUTION")]
    solutions: Vec<PathBuf>,

    /// A file to write, in the format of its extension; repeat it for several
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    outputs: Vec<PathBuf>,

    #[command(flatten)]
    picture: PictureArguments,

    #[command(flatten)]
    threads: ThreadArguments,

    /// Print nothing but errors
    #[arg(short, long)]
    quiet: bool,

    #[command(flatten)]
    progress: ProgressArguments,
}

impl Merge {
    pub fn run(self) -> Result<u8, Failure> {
        let inputs: Vec<&Path> = self.solutions.iter().map(PathBuf::as_path).collect();
        let outputs = Outputs::open(&self.outputs, &inputs)?;
        let pool = self.threads.pool()?;
        let (files, quiet) = (outputs.files.clone(), self.quiet);
        let report = watch(&files, move |interrupt| pool.install(|| self.work(&outputs, interrupt)))?;
        if !quiet {
            terminal::print(&report)?;
        }
        Ok(0)
    }

    /// Reads, merges and writes; what there is to say.
    fn work(&self, outputs: &Outputs, interrupt: &Interrupt) -> Result<String, Failure> {
        let mut display = self.progress.display(self.quiet);
        display.stage("reading the solutions");
        let (problem, solutions) = self.read()?;
        self.picture.check_camera(&problem.scene)?;
        let merged = merge(&problem, &solutions)?;
        drop(solutions);
        let written = outputs.write(&problem, &merged, &self.picture.options(), &mut display, interrupt);
        display.clear();
        let (rays, replicates) = (in_words(merged.work.rays as f64), merged.work.replicates);
        let error = percent(merged.rms_error());
        Ok(format!(
            "{} solutions with {rays} rays and {replicates} replicates\n\
             Estimated error {error} of the mean irradiance (RMS over all elements)\n\
             Wrote {}\n",
            self.solutions.len(),
            output::in_words(&written?)
        ))
    }

    /// The problem, and its solutions.
    fn read(&self) -> Result<(Problem, Vec<Solution>), Failure> {
        let first = &self.solutions[0];
        let (problem, solution) = input::solution(first)?;
        let mut solutions = vec![solution];
        for path in &self.solutions[1..] {
            let (other, solution) = input::solution(path)?;
            if let Some(what) = problem.difference(&other) {
                let what = format!("{}, {}: they cannot be merged: {what}", first.display(), path.display());
                return Err(Failure::usage(what)
                    .with_help("solve the same scene with the same --elements or --max-edge, and another --seed"));
            }
            solutions.push(solution);
        }
        Ok((problem, solutions))
    }
}
