//! `isolux list`: the tables of what there is.

use crate::failure::Failure;
use crate::terminal;
use isolux_core::sampling::SEQUENCES;
use isolux_core::scene::builtin::BUILT_IN;
use isolux_core::solvers::deterministic::{self, DETERMINISTIC};
use isolux_core::solvers::monte_carlo::orders::{Entry, ORDERS};
use isolux_core::solvers::monte_carlo::{METHODS, Method, NamedMethod};
use isolux_io::{export, import};

const EXAMPLES: &str = "\
Examples:
  isolux list
  isolux list scenes";

/// Show the built-in scenes, the file formats, the methods, their orders and the sample sequences
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct List {
    /// One of them only
    what: Option<What>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum What {
    /// Scenes that need no file
    Scenes,
    /// What is read and written
    Formats,
    /// Algorithms
    Methods,
    /// When landed light is shot again
    Orders,
    /// Sample numbers
    Sequences,
}

impl List {
    pub fn run(self) -> Result<u8, Failure> {
        let tables = [
            (What::Scenes, scenes as fn() -> String),
            (What::Formats, formats),
            (What::Methods, methods),
            (What::Orders, orders),
            (What::Sequences, sequences),
        ];
        let wanted = tables.iter().filter(|(what, _)| self.what.is_none_or(|wanted| wanted == *what));
        let text: Vec<String> = wanted.map(|(_, table)| table()).collect();
        terminal::print(&text.join("\n")).map(|()| 0)
    }
}

fn scenes() -> String {
    let mut text = "Built-in scenes, wherever a scene file may stand\n".to_owned();
    for scene in &BUILT_IN {
        text += &format!("  {:<12} {}\n", scene.name, scene.what);
        for parameter in scene.parameters {
            let with_default = format!("{}={}", parameter.name, parameter.default);
            text += &format!("  {:<12}   :{with_default:<11} {}\n", "", parameter.what);
        }
    }
    text
}

fn formats() -> String {
    let mut text = "Scenes are read from\n".to_owned();
    for format in import::FORMATS {
        let extensions: Vec<String> = format.extensions.iter().map(|extension| format!(".{extension}")).collect();
        text += &format!("  {:<14} {}: {}\n", extensions.join(" "), format.name, format.what);
    }
    text += "\nSolutions are written to (-o)\n";
    for format in export::FORMATS {
        text += &format!("  {:<14} {}\n", format.ending, format.what);
    }
    text += "\nLightmaps are written to (isolux bake -o)\n";
    for format in export::lightmap::FORMATS {
        text += &format!("  .{:<13} {}\n", format.extension, format.what);
    }
    text
}

fn methods() -> String {
    let mut text = "Methods of Monte Carlo, for --method; the axes below each may be changed\n".to_owned();
    for NamedMethod { name, what, source, method } in METHODS {
        text += &format!("  {name:<18} {}\n  {:<18} {}\n  {:<18} {source}\n", what[0], "", what[1], "");
        text += &format!("  {:<18} {}\n", "", point(method));
    }
    text += "\nDeterministic methods, for --method\n";
    for deterministic::Entry { name, what, source, .. } in DETERMINISTIC {
        text += &format!("  {name:<18} {}\n  {:<18} {}\n  {:<18} {source}\n", what[0], "", what[1], "");
    }
    text
}

/// The options that ask for a point of the axes.
fn point(method: &Method) -> String {
    let axes = method.parameters();
    axes.iter().map(|(axis, value)| format!("--{axis} {value}")).collect::<Vec<_>>().join(" ")
}

fn orders() -> String {
    let mut text = "Orders, for --order: when landed light is shot again, the default first\n".to_owned();
    for Entry { name, what, source, .. } in ORDERS {
        text += &format!("  {name:<17}  {what} ({source})\n");
    }
    text
}

fn sequences() -> String {
    let mut text = "Sample sequences, the default first\n".to_owned();
    for entry in SEQUENCES {
        text += &format!("  {:<17}  {} ({})\n", entry.name, entry.what, entry.source);
    }
    text
}
