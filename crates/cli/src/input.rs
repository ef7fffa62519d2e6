//! Where a scene comes from: a file, or a built-in one by its name.

use crate::failure::Failure;
use isolux_core::scene::Scene;
use isolux_core::scene::builtin::{builtin, is_builtin};
use isolux_core::{Error, Problem, Solution};
use isolux_io::checkpoint_file::{self, Checkpoint};
use isolux_io::import::{self, ImportOptions};
use isolux_io::{files, solution_file};
use std::path::Path;

/// Reads the scene that `name` names. A file of that name wins over a built-in scene.
///
/// # Errors
/// Those of the reader; a failure that names both possibilities if there is neither.
pub fn scene(name: &Path, options: &ImportOptions) -> Result<Scene, Failure> {
    let text = name.to_string_lossy();
    if name.exists() {
        if is_solution(name) {
            return Err(Failure::usage(format!("{text}: this is a solution, not a scene"))
                .with_help("'isolux render' takes pictures of it and writes it in other formats"));
        }
        if is_checkpoint(name) {
            return Err(Failure::usage(format!("{text}: this is a checkpoint, not a scene"))
                .with_help(format!("'isolux solve --resume {text}' goes on with it")));
        }
        return Ok(import::read_scene(name, options)?);
    }
    if is_builtin(&text) {
        return Ok(builtin(&text)?);
    }
    let failure = Failure::usage(format!("there is no file '{text}', and no built-in scene of that name"));
    Err(failure.with_help(advice(&text)))
}

fn advice(name: &str) -> String {
    match builtin(name) {
        Err(Error::UnknownName { nearest, .. }) if !name.contains(['.', '/', '\\']) => {
            format!("did you mean the built-in scene '{nearest}'? 'isolux list scenes' shows all of them")
        }
        _ => "check the name and the folder; 'isolux list scenes' shows the scenes that need no file".to_owned(),
    }
}

/// Reads a `.isolux` file.
///
/// # Errors
/// Those of the reader, with advice if `path` is a scene.
pub fn solution(path: &Path) -> Result<(Problem, Solution), Failure> {
    let text = path.to_string_lossy();
    if !path.exists() {
        return Err(Failure::usage(format!("there is no file '{text}'"))
            .with_help("'isolux solve SCENE -o NAME.isolux' makes such a file"));
    }
    solution_file::read(&text, &files::read(path)?).map_err(|error| {
        let failure = Failure::from(error);
        if is_solution(path) {
            return failure;
        }
        failure.with_help(format!("a solution is made by 'isolux solve {text} -o NAME.isolux'"))
    })
}

/// Reads a checkpoint.
///
/// # Errors
/// Those of the reader, with advice if `path` is something else.
pub fn checkpoint(path: &Path) -> Result<Checkpoint, Failure> {
    let text = path.to_string_lossy();
    if !path.exists() {
        return Err(Failure::usage(format!("there is no file '{text}'"))
            .with_help("'isolux solve SCENE --checkpoint FILE' makes such a file"));
    }
    checkpoint_file::read(&text, &files::read(path)?).map_err(|error| {
        let failure = Failure::from(error);
        if is_solution(path) {
            return failure.with_help("a solution cannot be gone on with; 'isolux merge' joins it with others");
        }
        failure
    })
}

fn is_solution(path: &Path) -> bool {
    has_extension(path, "isolux")
}

fn is_checkpoint(path: &Path) -> bool {
    has_extension(path, "checkpoint")
}

fn has_extension(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}
