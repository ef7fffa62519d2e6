//! `isolux solve --checkpoint` and `--resume`: a run that is written down, and one that goes on.

use crate::budget::BudgetArguments;
use crate::checkpoints::Checkpoints;
use crate::failure::Failure;
use crate::input;
use crate::numbers::parse_time;
use crate::output::Outputs;
use isolux_io::checkpoint_file::{Checkpoint, Clock};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What a checkpoint decides: these options cannot be chosen again.
const DECIDED: [&str; 12] = [
    "scene",
    "UnitArguments",
    "elements",
    "max_edge",
    "contacts",
    "MeshArguments",
    "seed",
    "replicates",
    "leaving",
    "light",
    "light_groups",
    "MethodArguments",
];

/// Where a run is written down, and which one goes on.
#[derive(Clone, Debug, clap::Args)]
pub struct ResumeArguments {
    /// Write the state of the solve to this file, every 2 seconds, or so rarely that it takes 2 % of the time, and at the end;
    /// --resume goes on with it
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,

    /// Time between two checkpoints, whatever they take
    #[arg(long, value_name = "TIME", value_parser = parse_time)]
    checkpoint_every: Option<Duration>,

    /// Instead of SCENE: go on with the solve of a checkpoint, to the end that was asked for, with the same bits. --error E extends it
    /// until it is so accurate, --rays N to N rays in all, --time T by so much time. Checkpoints go on into the same file, unless --checkpoint names another
    #[arg(long, value_name = "FILE", conflicts_with_all = DECIDED)]
    pub resume: Option<PathBuf>,
}

impl ResumeArguments {
    /// Where checkpoints are written, if anywhere.
    ///
    /// # Errors
    /// A failure if only the time between them is said.
    pub fn file(&self) -> Result<Option<&Path>, Failure> {
        let file = self.checkpoint.as_deref().or(self.resume.as_deref());
        if file.is_none() && self.checkpoint_every.is_some() {
            return Err(
                Failure::usage("--checkpoint-every says when, but not where").with_help("add --checkpoint FILE")
            );
        }
        Ok(file)
    }

    /// Who writes them, if anybody does.
    ///
    /// # Errors
    /// Those of [`ResumeArguments::file`].
    pub fn checkpoints<'a>(
        &self,
        outputs: &'a Outputs,
        start: Instant,
        clock: Clock,
    ) -> Result<Option<Checkpoints<'a>>, Failure> {
        Ok(self.file()?.map(|_| Checkpoints::new(outputs, self.checkpoint_every, start, clock)))
    }

    /// A file that is read and must not be written.
    pub fn input(&self) -> Option<&Path> {
        self.resume.as_deref().filter(|&resumed| self.checkpoint.as_deref().is_some_and(|file| file != resumed))
    }
}

/// The run in the checkpoint `file`, extended to what `more` asks for: an accuracy, so many rays in all, or so much more time.
///
/// # Errors
/// Those of the reader, and of [`Solver::go_on`](isolux_core::solvers::Solver::go_on).
pub fn resume(file: &Path, more: &BudgetArguments) -> Result<Checkpoint, Failure> {
    let mut run = input::checkpoint(file)?;
    if let Some(budget) = more.budget(&run.problem.scene)? {
        run.solver.go_on(&run.problem, budget)?;
        run.clock.limit = more.time.map(|time| run.clock.solved + time);
    }
    Ok(run)
}

/// Time that is left, if it is limited.
pub fn time_left(clock: Clock) -> Option<Duration> {
    clock.limit.map(|limit| limit.saturating_sub(clock.solved))
}
