//! `isolux solve --live`: the solve, looked at in the browser while it runs.
//!
//! The page gets the surfaces once, and new light as long as somebody watches: drafts, as `--every` writes them, that take a tenth of the time
//! at most. In the end it gets the result.

use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::numbers::in_words;
use crate::progress::Display;
use crate::server::{Server, Shown};
use crate::terminal;
use isolux_core::solvers::Solver;
use isolux_core::view::VertexField;
use isolux_core::{Problem, Solution};
use isolux_io::export::html::{self, Surfaces};
use isolux_io::export::{ExportOptions, LitScene, Smoothing};
use std::time::{Duration, Instant};

/// Least time between two lights, and how many times as long it is as making one takes.
const EVERY: Duration = Duration::from_secs(1);
const PATIENCE: u32 = 10;

/// Whether and where the solve is shown.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct LiveArguments {
    /// Show the solve in the browser while it runs. The page is served to this machine only, and stays after the end until
    /// Ctrl-C
    #[arg(long)]
    live: bool,

    /// Port of the page [default: any that is free]
    #[arg(long, value_name = "PORT", requires = "live", value_parser = clap::value_parser!(u16).range(1..))]
    port: Option<u16>,

    /// Do not open the browser: the address is printed
    #[arg(long, requires = "live")]
    no_open: bool,
}

/// A page that is open.
pub struct Live {
    server: Server,
    options: ExportOptions,
    quiet: bool,
    surfaces: Option<Surfaces>,
    /// Of the last draft, whose vertices serve the next one.
    field: Option<VertexField>,
    last: Option<Instant>,
    wait: Duration,
}

impl LiveArguments {
    /// Whether the solve is shown.
    pub fn is_asked(self) -> bool {
        self.live
    }

    /// Serves the page and opens the browser, if that was asked for.
    ///
    /// # Errors
    /// A failure if this program has no page, or the port cannot be had.
    pub fn serve(self, options: ExportOptions, quiet: bool, display: &Display) -> Result<Option<Live>, Failure> {
        if !self.live {
            return Ok(None);
        }
        let server = Server::start(html::live_page()?, self.port.unwrap_or(0))?;
        let address = server.address();
        if !quiet {
            display.say(&format!("the solve is shown at {address}, to this machine only"));
        }
        if !self.no_open {
            open_in_browser(&address, display);
        }
        let wait = Duration::ZERO;
        Ok(Some(Live { server, options, quiet, surfaces: None, field: None, last: None, wait }))
    }
}

impl Live {
    /// Shows what `solver` has so far, if it is time to and somebody watches. A draft that cannot be made is left out.
    pub fn show(&mut self, solver: &dyn Solver, problem: &Problem) {
        let too_early = self.last.is_some_and(|last| last.elapsed() < self.wait);
        if too_early || !self.server.is_watched() {
            return;
        }
        let start = Instant::now();
        let solution = solver.solution(problem);
        let lit = LitScene::draft(problem, &solution, self.field.take());
        let options = ExportOptions { smoothing: Smoothing::None, ..self.options.clone() };
        let words = format!("solving · {} rays", in_words(solver.progress().rays as f64));
        let _ = put(&self.server, &mut self.surfaces, &lit, &options, words, false);
        self.field = lit.into_field();
        self.wait = EVERY.max(PATIENCE * start.elapsed());
        self.last = Some(Instant::now());
    }

    /// Shows the result.
    ///
    /// # Errors
    /// A failure if it cannot be shown.
    pub fn finish(&mut self, problem: &Problem, solution: &Solution) -> Result<(), Failure> {
        let lit = LitScene::smoothed(problem, solution, self.options.smoothing);
        let words = format!("done · {} rays", in_words(solution.work.rays as f64));
        let shown = put(&self.server, &mut self.surfaces, &lit, &self.options, words, true);
        shown.map_err(|error| Failure::other(format!("the page cannot show the result: {error}")))
    }

    /// Keeps the page until somebody asks for the end.
    pub fn stay(&self, interrupt: &Interrupt) {
        if !self.quiet {
            terminal::note(&format!("the result stays at {} until Ctrl-C", self.server.address()));
        }
        while !interrupt.is_asked() {
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

/// Puts `lit` on the page, on its surfaces, which are made if there are none.
fn put(
    server: &Server,
    surfaces: &mut Option<Surfaces>,
    lit: &LitScene,
    options: &ExportOptions,
    words: String,
    finished: bool,
) -> Result<(), isolux_io::Error> {
    let is_first = surfaces.is_none();
    let surfaces = surfaces.get_or_insert_with(|| html::surfaces(lit));
    let part = if is_first { Some(surfaces.part(lit.problem)?) } else { None };
    let light = html::light_part(lit, surfaces, options)?;
    let mut shown = server.shown();
    if let Some(part) = part {
        shown.surfaces = part.into();
    }
    let Shown { revision, .. } = *shown;
    (shown.light, shown.revision, shown.finished, shown.words) = (light.into(), revision + 1, finished, words);
    Ok(())
}

/// Opens `what`, an address or a file, in the browser. That there is none is no failure.
pub fn open_in_browser(what: &str, display: &Display) {
    if open::that_detached(what).is_err() {
        display.say(&format!("no browser could be opened; open {what} yourself"));
    }
}
