//! `isolux solve`: from a scene to a solution, in files.

use crate::arguments::{PictureArguments, ThreadArguments, UnitArguments};
use crate::budget::BudgetArguments;
use crate::checkpoints::Checkpoints;
use crate::drafts::Drafts;
use crate::drive::Drive;
use crate::failure::{Failure, INTERRUPTED};
use crate::interrupt::{Interrupt, watch};
use crate::live::LiveArguments;
use crate::mesh::{self, MeshArguments};
use crate::numbers::{parse_count, parse_time};
use crate::output::Outputs;
use crate::progress::{Display, ProgressArguments};
use crate::resume::{Place, ResumeArguments, resume, time_left};
use crate::solver::SolverArguments;
use crate::summary::Summary;
use crate::{input, terminal};
use isolux_core::Problem;
use isolux_core::adaptive::{Meshed, Spread, Wish};
use isolux_core::solvers::Progress;
use isolux_core::solvers::monte_carlo::Budget;
use isolux_io::checkpoint_file::{Checkpoint, Clock};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const EXAMPLES: &str = "\
Examples:
  isolux solve cornell-box -o cornell.png
  isolux solve room.glb -o lit.glb -o lit.png -o lit.isolux
  isolux solve room.glb --error 2% -o lit.glb
  isolux solve room.glb --error 1% --error-of object:Floor --time 10min -o lit.csv
  isolux solve room.glb --elements 1e6 --time 10min -o lit.isolux
  isolux solve room.glb --time 1min --every 5s -o lit.png
  isolux solve room.glb --time 5min --live -o lit.isolux
  isolux solve room.glb --rays 1G --checkpoint room.checkpoint -o lit.isolux
  isolux solve --resume room.checkpoint -o lit.isolux
  isolux solve --resume room.checkpoint --rays 4G -o better.isolux
  isolux solve labyrinth:rho=0.9 --rays 50M --seed 7 --json > summary.json
  isolux solve room.glb --light indirect -o bounced.csv
  isolux solve room.glb --light-groups objects -o lit.isolux
  isolux solve cubes --method random-walk --estimator absorption --sequence halton
  isolux solve cubes --method gauss-seidel --factors hemicube --elements 1000

Formats, by the extension of -o: 'isolux list formats' explains them.

Elements are the pieces of surface that get one value each: more of them show finer shadows and take more rays. \
With --error 2% the solve goes on until the error is at most 2 % of the mean irradiance, in 95 of 100 solves; --rays and \
--time limit it, and the summary says how far it came. Without any of these the number of rays follows from the elements, and \
is enough for a first look. Half the error takes four times as many rays.

The same scene, options and seed give the same files, bit for bit, for any number of threads (but not with --time).

Ctrl-C ends the solve and keeps the best result so far: the files are written, and the exit code is 130. A second \
Ctrl-C stops at once and leaves old files as they were. SIGTERM does the same.

Nothing is lost that was computed more than a few seconds before, whatever happens: 'isolux solve --resume \
lit.png.checkpoint' goes on, and ends with the same bits as if nothing had happened (but not with --time). That file is \
there while a solve runs, and stays if it is stopped or an output cannot be written; --checkpoint FILE keeps it in any case, \
--no-checkpoint does without.";

/// Compute the light on every surface of a scene
///
/// Irradiance is in lux, flux in lumens, lengths in metres. Every element gets a standard error.
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Solve {
    /// A scene file (.glb .gltf .obj .ply .stl), or the name of a built-in scene
    ///
    /// A file of that name wins over a built-in scene. Built-in scenes take parameters: labyrinth:rho=0.9
    #[arg(required_unless_present = "resume")]
    scene: Option<PathBuf>,

    #[command(flatten)]
    units: UnitArguments,

    /// A file to write, in the format of its extension; repeat it for several
    #[arg(short, long = "output", value_name = "OUT")]
    outputs: Vec<PathBuf>,

    /// Number of elements to aim at, like 50000 or 1e6: large triangles are cut, and small ones of a smooth surface put
    /// together, but for deterministic methods [default: 400k; 2000 for deterministic methods]
    #[arg(long, value_name = "N", value_parser = parse_count, conflicts_with = "max_edge")]
    elements: Option<u64>,

    /// Instead: longest edge of an element in metres
    #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
    max_edge: Option<f32>,

    #[command(flatten)]
    mesh: MeshArguments,

    #[command(flatten)]
    budget: BudgetArguments,

    /// Write the files while solving, too, with so much time between: first drafts after half a second, without
    /// smoothing and with one ray a pixel. The time they take is part of that to solve
    #[arg(long, value_name = "TIME", value_parser = parse_time, requires = "outputs")]
    every: Option<Duration>,

    #[command(flatten)]
    threads: ThreadArguments,

    #[command(flatten)]
    solver: SolverArguments,

    #[command(flatten, next_help_heading = "Stop and resume")]
    resume: ResumeArguments,

    #[command(flatten, next_help_heading = "Watch")]
    live: LiveArguments,

    #[command(flatten)]
    picture: PictureArguments,

    /// Print the summary as one JSON object
    #[arg(long, help_heading = "Report")]
    json: bool,

    /// Objects in the table of irradiance: a number, or 'all'
    #[arg(long, value_name = "N", default_value = "20", value_parser = parse_objects, help_heading = "Report")]
    objects: usize,

    /// Print nothing but errors
    #[arg(short, long, help_heading = "Report", conflicts_with = "json")]
    quiet: bool,

    #[command(flatten, next_help_heading = "Report")]
    progress: ProgressArguments,
}

fn parse_objects(text: &str) -> Result<usize, String> {
    let number = if text == "all" { Ok(usize::MAX) } else { text.parse() };
    number.map_err(|_| "give a number or 'all'".to_owned())
}

/// What happens to the checkpoint that nobody asked for: it is removed, unless somebody may want to go on with it.
fn keep_or_remove(checkpoint: &Path, all_is_written: bool, interrupt: &Interrupt) {
    if all_is_written && !interrupt.is_asked() {
        // One that cannot be removed does no harm.
        let _ = isolux_io::files::remove(checkpoint);
    } else {
        let name = checkpoint.display();
        terminal::note(&format!("the run is kept: 'isolux solve --resume {name}' goes on with it"));
    }
}

impl Solve {
    pub fn run(self) -> Result<u8, Failure> {
        let pool = self.threads.pool()?;
        watch(move |interrupt, files| {
            let inputs: Vec<&Path> = self.scene.as_deref().into_iter().chain(self.resume.input()).collect();
            let place = self.resume.place(&self.outputs)?;
            let checkpoint = place.as_ref().map(Place::path);
            let outputs = Outputs::open_with_checkpoint(files, &self.outputs, checkpoint, &inputs)?;
            pool.install(|| self.work(&outputs, place, interrupt))
        })
    }

    /// Reads, solves, writes and reports.
    fn work(&self, outputs: &Outputs, place: Option<Place>, interrupt: &Interrupt) -> Result<u8, Failure> {
        let mut display = self.progress.display(self.quiet);
        let result = self.work_watched(outputs, place, interrupt, &mut display);
        display.clear();
        result
    }

    fn work_watched(
        &self,
        outputs: &Outputs,
        place: Option<Place>,
        interrupt: &Interrupt,
        display: &mut Display,
    ) -> Result<u8, Failure> {
        let mut live = self.live.serve(self.picture.options(), self.quiet, display)?;
        let Checkpoint { problem, mut solver, clock } = match &self.resume.resume {
            Some(file) => self.resumed(file, display)?,
            None => self.begun(display)?,
        };

        interrupt.keep_result();
        let start = Instant::now();
        let mut checkpoints = place.map(|place| self.resume.checkpoints(place, outputs, start, clock));
        let drive = Drive {
            start,
            left: time_left(clock),
            drafts: self.every.map(|every| Drafts::new(outputs, self.picture.options(), every, start)),
            live: live.as_mut(),
            checkpoints: checkpoints.as_mut(),
            interrupt,
        };
        let (solution, ended) = drive.run(solver.as_mut(), &problem, display);
        let seconds = (clock.solved + start.elapsed()).as_secs_f64();
        let Progress { asked, bias, .. } = solver.progress();
        drop(solver);

        let written = outputs.write(&problem, &solution, &self.picture.options(), display, interrupt);
        if let Some(checkpoint) = checkpoints.as_ref().and_then(Checkpoints::beside) {
            display.clear();
            keep_or_remove(checkpoint, written.is_ok(), interrupt);
        }
        let written = written?;
        if let Some(live) = &mut live {
            display.stage("showing the result");
            live.finish(&problem, &solution)?;
        }
        display.clear();
        let threads = rayon::current_num_threads();
        let summary =
            Summary { problem: &problem, solution: &solution, asked, bias, ended, seconds, threads, outputs: &written };
        self.report(&summary)?;
        if interrupt.is_asked() {
            return Ok(INTERRUPTED);
        }
        live.iter().for_each(|live| live.stay(interrupt));
        Ok(0)
    }

    /// The run in a checkpoint, with more to do if more is asked for.
    fn resumed(&self, file: &Path, display: &mut Display) -> Result<Checkpoint, Failure> {
        display.stage("reading the checkpoint");
        let run = resume(file, &self.budget)?;
        self.picture.check_camera(&run.problem.scene)?;
        Ok(run)
    }

    /// A run that has not begun.
    fn begun(&self, display: &mut Display) -> Result<Checkpoint, Failure> {
        let chosen = self.solver.chosen(&self.budget)?;
        display.stage("reading the scene");
        let scene = input::scene(self.scene.as_deref().unwrap_or(Path::new("")), &self.units.options())?;
        self.picture.check_camera(&scene)?;
        let budget = self.budget.budget(&scene)?.unwrap_or(Budget::Heuristic);
        let resolution = chosen.resolution(self.elements, self.max_edge);
        let check = |problem: &Problem| self.solver.solver(&chosen, problem, budget).map(drop);
        let wish = Wish {
            resolution,
            spread: self.mesh.spread().or(self.shows_drafts().then_some(Spread::Uniform)),
            along_contacts: self.mesh.along_contacts(),
            budget,
            light: self.solver.light(),
        };
        let (Meshed { problem, budget }, took) = mesh::cut(wish, scene, self.budget.time, display, check)?;
        let solver = self.solver.solver(&chosen, &problem, budget)?;
        Ok(Checkpoint { problem, solver, clock: Clock { solved: took, limit: self.budget.time } })
    }

    /// Whether somebody waits for the first light, which is there sooner where no mesh is to be found.
    fn shows_drafts(&self) -> bool {
        self.every.is_some() || self.live.is_asked()
    }

    fn report(&self, summary: &Summary) -> Result<(), Failure> {
        if self.json {
            return terminal::print(&(summary.json() + "\n"));
        }
        if self.quiet {
            return Ok(());
        }
        summary.warnings().iter().for_each(|warning| terminal::warn(warning));
        summary.notes().iter().for_each(|note| terminal::note(&terminal::harmless(note)));
        terminal::print(&summary.in_words(self.objects))
    }
}
