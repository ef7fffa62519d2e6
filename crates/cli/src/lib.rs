//! The command line of isolux, one subcommand a file.
//!
//! [`run`] takes the arguments and gives the exit code: 0 all went well, 2 bad input or usage, 130 interrupted, 1 anything
//! else. What is asked for goes to stdout, everything else (progress, warnings, errors) to stderr.

mod accuracy;
mod arguments;
mod bake;
mod budget;
mod check;
mod checkpoints;
mod compare;
mod drafts;
mod drive;
mod factors;
mod failure;
mod input;
mod interrupt;
mod light_groups;
mod list;
mod live;
mod merge;
mod mesh;
mod method;
mod mix;
mod numbers;
mod output;
mod progress;
mod render;
mod report;
mod resume;
mod scene;
mod server;
mod solve;
mod solver;
mod study;
mod summary;
mod terminal;
mod view;
mod writing;

use clap::{CommandFactory, Parser, Subcommand};
use failure::{Failure, USAGE};
use std::ffi::OsString;

const EXAMPLES: &str = "\
Examples:
  isolux solve cornell-box -o cornell.png         light a built-in room and take a picture
  isolux solve room.glb -o lit.glb -o lit.isolux  a lit model for any viewer, and the solution
  isolux render lit.isolux -o view.png            another picture, without solving again
  isolux view lit.isolux                          walk about in it, in the browser
  isolux bake lit.isolux -o room-lightmap.glb     light in a texture, for engines
  isolux merge a.isolux b.isolux -o both.isolux   one better solution of two seeds
  isolux mix lit.isolux --set Lamp=0.3 -o dim.png lamps dimmed, after solve --light-groups
  isolux check room.glb                           what is in a file, and what is wrong with it
  isolux list                                     built-in scenes, formats, methods

Exit codes:
  0    all went well
  1    something else failed, such as a full disk
  2    bad input or bad usage; nothing was written
  130  interrupted (Ctrl-C)";

/// View-independent diffuse global illumination by Monte Carlo radiosity, with error bars.
///
/// Reads a scene, computes how much light falls on every piece of its surfaces, and says how sure that is.
/// Lengths are in metres, light is in lumens, lux and candela.
#[derive(Parser)]
#[command(name = "isolux", version, after_help = EXAMPLES, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    Solve(Box<solve::Solve>),
    Render(render::Render),
    View(view::View),
    Bake(bake::Bake),
    Check(check::Check),
    Compare(compare::Compare),
    Merge(merge::Merge),
    Mix(mix::Mix),
    Scene(scene::SceneCommand),
    Factors(factors::Factors),
    Study(study::StudyCommand),
    List(list::List),
}

/// Runs the command line `args`, the first of which is the program's name, and gives the exit code.
pub fn run(args: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> u8 {
    let done = match Cli::try_parse_from(args) {
        Ok(cli) => execute(cli.command),
        // Help and version, too, come as an "error" of code 0.
        Err(error) => return if error.print().is_err() && !error.use_stderr() { 1 } else { error.exit_code() as u8 },
    };
    done.unwrap_or_else(|failure| {
        terminal::say(&failure.to_string());
        failure.code
    })
}

fn execute(command: Option<Command>) -> Result<u8, Failure> {
    match command {
        None => terminal::print(&Cli::command().render_help().ansi().to_string()).map(|()| 0),
        Some(Command::Solve(solve)) => solve.run(),
        Some(Command::Render(render)) => render.run(),
        Some(Command::View(view)) => view.run(),
        Some(Command::Bake(bake)) => bake.run(),
        Some(Command::Check(check)) => check.run(),
        Some(Command::Compare(compare)) => compare.run(),
        Some(Command::Merge(merge)) => merge.run(),
        Some(Command::Mix(mix)) => mix.run(),
        Some(Command::Scene(scene)) => scene.run(),
        Some(Command::Factors(factors)) => factors.run(),
        Some(Command::Study(study)) => study.run(),
        Some(Command::List(list)) => list.run(),
    }
}

/// The exit code of a check that found something wrong: as that of an input that cannot be used.
const FOUND_WRONG: u8 = USAGE;
