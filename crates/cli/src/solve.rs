//! `isolux solve`: from a scene to a solution, in files.

use crate::accuracy::AccuracyArguments;
use crate::arguments::{PictureArguments, ThreadArguments, UnitArguments};
use crate::drafts::Drafts;
use crate::drive::Drive;
use crate::failure::{Failure, INTERRUPTED};
use crate::interrupt::{Interrupt, watch};
use crate::method::MethodArguments;
use crate::numbers::{parse_count, parse_time};
use crate::output::Outputs;
use crate::progress::{Display, ProgressArguments};
use crate::resume::{ResumeArguments, resume, time_left};
use crate::summary::Summary;
use crate::{input, terminal};
use isolux_core::mesh::Resolution;
use isolux_core::solvers::deterministic;
use isolux_core::solvers::monte_carlo::{Budget, LightPart, MonteCarlo, Settings};
use isolux_core::solvers::{Progress, Solver};
use isolux_core::transport::Leaving;
use isolux_core::{Accuracy, Problem};
use isolux_io::checkpoint_file::{Checkpoint, Clock};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Elements that deterministic methods aim at unless said otherwise: their cost grows with the square.
const DETERMINISTIC_ELEMENTS: u64 = 2000;

const EXAMPLES: &str = "\
Examples:
  isolux solve cornell-box -o cornell.png
  isolux solve room.glb -o lit.glb -o lit.png -o lit.isolux
  isolux solve room.glb --error 2% -o lit.glb
  isolux solve room.glb --error 1% --error-of object:Floor --time 10min -o lit.csv
  isolux solve room.glb --elements 1e6 --time 10min -o lit.isolux
  isolux solve room.glb --time 1min --every 5s -o lit.png
  isolux solve room.glb --rays 1G --checkpoint room.checkpoint -o lit.isolux
  isolux solve --resume room.checkpoint -o lit.isolux
  isolux solve --resume room.checkpoint --rays 4G -o better.isolux
  isolux solve labyrinth:rho=0.9 --rays 50M --seed 7 --json > summary.json
  isolux solve room.glb --light indirect -o bounced.csv
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

With --checkpoint FILE nothing is lost that was computed more than a few seconds before, whatever happens: \
'isolux solve --resume FILE' goes on, and ends with the same bits as if nothing had happened (but not with --time).";

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
    accuracy: AccuracyArguments,

    /// Number of rays, like 1e6, 200k or 3M; with --error at most so many [default: by the number of elements]
    #[arg(long, value_name = "N", value_parser = parse_count)]
    rays: Option<u64>,

    /// Time to solve, at most, like 90, 90s, 2min or 1.5h; reading and writing come on top
    #[arg(long, value_name = "TIME", value_parser = parse_time)]
    time: Option<Duration>,

    /// Write the files while solving, too, with so much time between: first drafts after half a second, without
    /// smoothing and with one ray a pixel. The time they take is part of that to solve
    #[arg(long, value_name = "TIME", value_parser = parse_time, requires = "outputs")]
    every: Option<Duration>,

    /// Seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = Settings::default().seed)]
    seed: u64,

    #[command(flatten)]
    threads: ThreadArguments,

    /// Independent solutions that the error is estimated from, at least 8 [default: 16, and 8 for auto]
    #[arg(long, value_name = "R")]
    replicates: Option<u32>,

    /// From where on an element reflected light leaves: where-landed hardly leaks under walls and behind
    /// frames, whole-element is the radiosity system to the letter [default: where-landed]
    #[arg(long, value_parser = parse_leaving)]
    leaving: Option<Leaving>,

    /// Which light on each element: all, or indirect, what was reflected at least once, for those who add direct light by
    /// themselves. The balance is that of all light either way [default: all]
    #[arg(long, value_name = "PART", value_parser = parse_light)]
    light: Option<LightPart>,

    #[command(flatten, next_help_heading = "Stop and resume")]
    resume: ResumeArguments,

    #[command(flatten)]
    method: MethodArguments,

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

fn parse_leaving(text: &str) -> Result<Leaving, String> {
    let found = Leaving::ALL.into_iter().find(|leaving| leaving.name() == text);
    found.ok_or_else(|| format!("it is one of {}", Leaving::ALL.map(Leaving::name).join(", ")))
}

fn parse_light(text: &str) -> Result<LightPart, String> {
    let found = LightPart::ALL.into_iter().find(|part| part.name() == text);
    found.ok_or_else(|| format!("it is one of {}", LightPart::ALL.map(LightPart::name).join(", ")))
}

fn parse_objects(text: &str) -> Result<usize, String> {
    let number = if text == "all" { Ok(usize::MAX) } else { text.parse() };
    number.map_err(|_| "give a number or 'all'".to_owned())
}

/// A method with what it is told.
enum Chosen {
    MonteCarlo(Settings),
    Deterministic(&'static deterministic::Entry, deterministic::Settings),
}

impl Chosen {
    fn solver(&self, problem: &Problem, budget: Budget) -> Result<Box<dyn Solver>, Failure> {
        match self {
            Chosen::MonteCarlo(settings) => {
                let settings = Settings { budget, ..*settings };
                Ok(Box::new(MonteCarlo::new(problem, settings)?))
            }
            Chosen::Deterministic(entry, settings) => Ok((entry.make)(problem, settings)?),
        }
    }
}

impl Solve {
    pub fn run(self) -> Result<u8, Failure> {
        let inputs: Vec<&Path> = self.scene.as_deref().into_iter().chain(self.resume.input()).collect();
        let outputs = Outputs::open_with_checkpoint(&self.outputs, self.resume.file()?, &inputs)?;
        let pool = self.threads.pool()?;
        let files = outputs.files.clone();
        watch(&files, move |interrupt| pool.install(|| self.work(&outputs, interrupt)))
    }

    /// Reads, solves, writes and reports.
    fn work(&self, outputs: &Outputs, interrupt: &Interrupt) -> Result<u8, Failure> {
        let mut display = self.progress.display(self.quiet);
        let result = self.work_watched(outputs, interrupt, &mut display);
        display.clear();
        result
    }

    fn work_watched(&self, outputs: &Outputs, interrupt: &Interrupt, display: &mut Display) -> Result<u8, Failure> {
        let Checkpoint { problem, mut solver, clock } = match &self.resume.resume {
            Some(file) => self.resumed(file, display)?,
            None => self.begun(display)?,
        };

        interrupt.keep_result();
        let start = Instant::now();
        let drive = Drive {
            start,
            left: time_left(clock),
            drafts: self.every.map(|every| Drafts::new(outputs, self.picture.options(), every, start)),
            checkpoints: self.resume.checkpoints(outputs, start, clock)?,
            interrupt,
        };
        let (solution, ended) = drive.run(solver.as_mut(), &problem, display);
        let seconds = (clock.solved + start.elapsed()).as_secs_f64();
        let Progress { asked: accuracy, bias, .. } = solver.progress();
        drop(solver);

        let written = outputs.write(&problem, &solution, &self.picture.options(), display, interrupt)?;
        display.clear();
        let threads = rayon::current_num_threads();
        let summary = Summary {
            problem: &problem,
            solution: &solution,
            accuracy,
            bias,
            ended,
            seconds,
            threads,
            outputs: &written,
        };
        self.report(&summary)?;
        Ok(if interrupt.is_asked() { INTERRUPTED } else { 0 })
    }

    /// The run in a checkpoint, with more to do if more is asked for.
    fn resumed(&self, file: &Path, display: &mut Display) -> Result<Checkpoint, Failure> {
        display.stage("reading the checkpoint");
        let run = resume(file, &self.accuracy, self.rays, self.time)?;
        self.picture.check_camera(&run.problem.scene)?;
        Ok(run)
    }

    /// A run that has not begun.
    fn begun(&self, display: &mut Display) -> Result<Checkpoint, Failure> {
        let chosen = self.chosen()?;
        display.stage("reading the scene");
        let scene = input::scene(self.scene.as_deref().unwrap_or(Path::new("")), &self.units.options())?;
        self.picture.check_camera(&scene)?;
        let accuracy = self.accuracy.accuracy(&scene)?;
        display.stage("cutting the surfaces into elements");
        let problem = Problem::new(scene, self.resolution())?;
        let solver = chosen.solver(&problem, self.budget(accuracy))?;
        Ok(Checkpoint { problem, solver, clock: Clock { limit: self.time, ..Clock::default() } })
    }

    fn resolution(&self) -> Resolution {
        match (self.elements, self.max_edge) {
            (Some(elements), _) if self.method.deterministic().is_some() => Resolution::Elements(elements),
            (Some(elements), _) => Resolution::Clustered(elements),
            (None, Some(edge)) => Resolution::MaxEdge(edge),
            (None, None) if self.method.deterministic().is_some() => Resolution::Elements(DETERMINISTIC_ELEMENTS),
            (None, None) => Resolution::default(),
        }
    }

    /// The method that was asked for, before there is anything to solve.
    fn chosen(&self) -> Result<Chosen, Failure> {
        let Some(entry) = self.method.deterministic() else { return Ok(Chosen::MonteCarlo(self.settings()?)) };
        let asked = [
            ("error", self.accuracy.is_asked()),
            ("rays", self.rays.is_some()),
            ("replicates", self.replicates.is_some()),
            ("leaving", self.leaving.is_some()),
        ];
        if let Some((name, _)) = asked.into_iter().find(|(_, is_asked)| *is_asked) {
            let what = format!("{} draws no random numbers: it has no --{name}", entry.name);
            return Err(Failure::usage(what).with_help("leave it out; --time limits every method"));
        }
        if self.light == Some(LightPart::Indirect) {
            let what = format!("{} solves for all light together: it has no --light indirect", entry.name);
            return Err(Failure::usage(what).with_help("choose a method of Monte Carlo, like stochastic-jacobi"));
        }
        Ok(Chosen::Deterministic(entry, self.method.deterministic_settings(entry, self.seed)?))
    }

    /// When to stop, but for the time.
    fn budget(&self, accuracy: Option<Accuracy>) -> Budget {
        match (accuracy, self.rays, self.time) {
            (Some(accuracy), most_rays, _) => Budget::Accuracy { accuracy, most_rays },
            (None, Some(rays), _) => Budget::Rays(rays),
            (None, None, Some(_)) => Budget::Endless,
            (None, None, None) => Budget::Heuristic,
        }
    }

    /// All of them but the budget, which may depend on the scene.
    fn settings(&self) -> Result<Settings, Failure> {
        let method = self.method.method()?;
        if self.leaving.is_some() && !method.has_leaving() {
            let what = format!("{} has no use for --leaving", method.name());
            return Err(
                Failure::usage(what).with_help("it is for light that is pooled on elements and shot along local lines")
            );
        }
        let default = Settings::default();
        let light = self.light.unwrap_or(default.light);
        method.check_light(light)?;
        Ok(Settings {
            method,
            seed: self.seed,
            budget: default.budget,
            replicates: self.replicates.unwrap_or(method.natural_replicates()),
            leaving: self.leaving.unwrap_or(default.leaving),
            light,
        })
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
