//! `isolux merge`: one solution of several.

use crate::accuracy::Reached;
use crate::failure::Failure;
use crate::input;
use crate::numbers::in_words;
use crate::writing::{Made, WritingArguments};
use isolux_core::merge::merge;
use isolux_core::{Problem, Solution};
use std::path::PathBuf;

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

    #[command(flatten)]
    writing: WritingArguments,
}

impl Merge {
    pub fn run(self) -> Result<u8, Failure> {
        let Merge { solutions: paths, writing } = self;
        writing.run(paths.clone(), move |display| {
            display.stage("reading the solutions");
            let (problem, solutions) = read(&paths)?;
            let solution = merge(&problem, &solutions)?;
            let (rays, replicates) = (in_words(solution.work.rays as f64), solution.work.replicates);
            let error = Reached::by(&problem, &solution, None).in_words(&problem);
            let words = format!("{} solutions with {rays} rays and {replicates} replicates\n{error}", solutions.len());
            Ok(Made { problem, solution, words })
        })
    }
}

/// The problem, and its solutions.
fn read(paths: &[PathBuf]) -> Result<(Problem, Vec<Solution>), Failure> {
    let first = &paths[0];
    let (problem, solution) = input::solution(first)?;
    let mut solutions = vec![solution];
    for path in &paths[1..] {
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
