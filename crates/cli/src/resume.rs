//! `isolux solve --checkpoint` and `--resume`: a run that is written down, and one that goes on.

use crate::budget::BudgetArguments;
use crate::checkpoints::Checkpoints;
use crate::failure::Failure;
use crate::input;
use crate::numbers::parse_time;
use crate::output::Outputs;
use crate::terminal;
use isolux_io::checkpoint_file::{Checkpoint, Clock};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What a checkpoint decides: these options cannot be chosen again.
const DECIDED: [&str; 11] = [
    "scene",
    "UnitArguments",
    "elements",
    "max_edge",
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
    /// --resume goes on with it. Without this option a solve of more than 5 seconds writes it beside its first output
    /// (lit.png.checkpoint), and removes it when all outputs are there
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,

    /// Time between two checkpoints, whatever they take
    #[arg(long, value_name = "TIME", value_parser = parse_time)]
    checkpoint_every: Option<Duration>,

    /// Write no checkpoint
    #[arg(long, conflicts_with_all = ["checkpoint", "checkpoint_every", "resume"])]
    no_checkpoint: bool,

    /// Instead of SCENE: go on with the solve of a checkpoint, to the end that was asked for, with the same bits. --error E extends it
    /// until it is so accurate, --rays N to N rays in all, --time T by so much time. Checkpoints go on into the same file, unless --checkpoint names another
    #[arg(long, value_name = "FILE", conflicts_with_all = DECIDED)]
    pub resume: Option<PathBuf>,
}

/// The file of checkpoints.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// Somebody asked for it; it stays.
    Asked(PathBuf),
    /// Beside the first output, and there only as long as it may be of use.
    Beside(PathBuf),
}

impl Place {
    pub fn path(&self) -> &Path {
        let (Place::Asked(path) | Place::Beside(path)) = self;
        path
    }
}

impl ResumeArguments {
    /// Where checkpoints of a solve with `outputs` are written, if anywhere. What is there of an earlier run is not replaced but where
    /// that was asked for.
    ///
    /// # Errors
    /// A failure if only the time between them is said.
    pub fn place(&self, outputs: &[PathBuf]) -> Result<Option<Place>, Failure> {
        if let Some(file) = self.checkpoint.as_ref().or(self.resume.as_ref()) {
            return Ok(Some(Place::Asked(file.clone())));
        }
        if self.no_checkpoint {
            return Ok(None);
        }
        let Some(first) = outputs.first() else {
            return match self.checkpoint_every {
                Some(_) => Err(Failure::usage("--checkpoint-every says when, but not where")
                    .with_help("add --checkpoint FILE, or an output")),
                None => Ok(None),
            };
        };
        let mut beside = first.clone().into_os_string();
        beside.push(".checkpoint");
        let beside = PathBuf::from(beside);
        if beside.exists() {
            let name = beside.display();
            terminal::note(&format!(
                "{name} is there, of an earlier run, and is left alone: this one writes no checkpoint. 'isolux solve --resume \
                 {name}' goes on with that run; or delete the file"
            ));
            return Ok(None);
        }
        Ok(Some(Place::Beside(beside)))
    }

    /// Who writes them to `place`.
    pub fn checkpoints<'a>(&self, place: Place, outputs: &'a Outputs, start: Instant, clock: Clock) -> Checkpoints<'a> {
        Checkpoints::new(outputs, place, self.checkpoint_every, start, clock)
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
