//! `isolux render`: pictures and other formats of a solution that is there already.

use crate::failure::Failure;
use crate::input;
use crate::writing::{Made, WritingArguments};
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

    #[command(flatten)]
    writing: WritingArguments,
}

impl Render {
    pub fn run(self) -> Result<u8, Failure> {
        let Render { solution: path, writing } = self;
        writing.run(vec![path.clone()], move |display| {
            display.stage("reading the solution");
            let (problem, solution) = input::solution(&path)?;
            Ok(Made { problem, solution, words: String::new() })
        })
    }
}
