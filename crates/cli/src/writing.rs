//! Commands that read solutions, make one of them, and write it.

use crate::arguments::{PictureArguments, WorkArguments};
use crate::failure::Failure;
use crate::interrupt::watch;
use crate::output::{self, Outputs};
use crate::progress::Display;
use crate::terminal;
use isolux_core::{Problem, Solution};
use std::path::{Path, PathBuf};

/// What is written, and how.
#[derive(Clone, Debug, clap::Args)]
pub struct WritingArguments {
    /// A file to write, in the format of its extension; repeat it for several
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    outputs: Vec<PathBuf>,

    #[command(flatten)]
    picture: PictureArguments,

    #[command(flatten)]
    work: WorkArguments,
}

/// A solution to write, and what there is to say about it.
pub struct Made {
    pub problem: Problem,
    pub solution: Solution,
    /// Whole lines, or nothing.
    pub words: String,
}

impl WritingArguments {
    /// Writes what `make` makes of `inputs`, which are not replaced, and says so; the exit code.
    ///
    /// # Errors
    /// Those of `make`, and failures for what cannot be written.
    pub fn run(
        self,
        inputs: Vec<PathBuf>,
        make: impl FnOnce(&mut Display) -> Result<Made, Failure> + Send + 'static,
    ) -> Result<u8, Failure> {
        let pool = self.work.pool()?;
        let quiet = self.work.quiet;
        let words = watch(move |interrupt, files| {
            let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
            let outputs = Outputs::open(files, &self.outputs, &inputs)?;
            pool.install(|| {
                let mut display = self.work.display();
                let Made { problem, solution, words } = make(&mut display)?;
                self.picture.check_camera(&problem.scene)?;
                let written = outputs.write(&problem, &solution, &self.picture.options(), &mut display, interrupt);
                display.clear();
                Ok(match written? {
                    nothing if nothing.is_empty() => words,
                    written => format!("{words}Wrote {}\n", output::in_words(&written)),
                })
            })
        })?;
        if !quiet {
            terminal::print(&words)?;
        }
        Ok(0)
    }
}
