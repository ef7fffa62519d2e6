//! `isolux render`: pictures and other formats of a solution that is there already.

use crate::arguments::{PictureArguments, ThreadArguments};
use crate::failure::Failure;
use crate::interrupt::watch;
use crate::output::{self, Outputs};
use crate::progress::ProgressArguments;
use crate::{input, terminal};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  isolux render lit.isolux -o view.png
  isolux render lit.isolux -o view.png --camera 1 --width 1920
  isolux render lit.isolux -o linear.exr -o elements.csv
  isolux render lit.isolux -o raw.png --smooth none
  isolux render lit.isolux -o smoothed.npz --smooth all";

/// Take a picture of a solution, or write it in another format
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Render {
    /// A .isolux file, as 'isolux solve' writes it
    solution: PathBuf,

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

impl Render {
    pub fn run(self) -> Result<u8, Failure> {
        let outputs = Outputs::open(&self.outputs, &[&self.solution])?;
        let pool = self.threads.pool()?;
        let (files, quiet) = (outputs.files.clone(), self.quiet);
        let written = watch(&files, move |interrupt| {
            pool.install(|| {
                let mut display = self.progress.display(self.quiet);
                display.stage("reading the solution");
                let (problem, solution) = input::solution(&self.solution)?;
                self.picture.check_camera(&problem.scene)?;
                let written = outputs.write(&problem, &solution, &self.picture.options(), &mut display, interrupt);
                display.clear();
                written
            })
        })?;
        if !quiet {
            terminal::print(&format!("Wrote {}\n", output::in_words(&written)))?;
        }
        Ok(0)
    }
}
