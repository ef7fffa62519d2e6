//! Holds the code against the picture of the layers in ARCHITECTURE.md: imports run one way.

#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

/// The rooms of the core, lowest first; a room may import from rooms above it in this list that are lower, never from
/// its own level or higher.
const LAYERS: &[(usize, &[&str])] = &[
    (0, &["math", "error", "VERSION"]),
    (1, &["choice", "certainty", "precision"]),
    (2, &["scene", "sampling"]),
    (3, &["mesh"]),
    (4, &["geometry"]),
    (5, &["problem"]),
    (6, &["transport", "solution"]),
    (7, &["form_factors", "accuracy", "superposition"]),
    (8, &["solvers"]),
    (9, &["run", "view", "report", "compare", "merge"]),
    (10, &["adaptive", "lightmap"]),
];

/// Names re-exported at the root, and where they live.
const ROOT_NAMES: &[(&str, &str)] = &[
    ("Problem", "problem"),
    ("Solution", "solution"),
    ("Error", "error"),
    ("Certainty", "certainty"),
    ("Accuracy", "accuracy"),
    ("Quantity", "accuracy"),
];

#[test]
fn imports_of_the_core_run_one_way() {
    let root = workspace().join("crates/core/src");
    let mut wrong = Vec::new();
    for file in rust_files(&root) {
        let path = file.strip_prefix(&root).unwrap();
        let room = path.components().next().unwrap().as_os_str().to_str().unwrap().trim_end_matches(".rs");
        if room == "lib" {
            continue;
        }
        for imported in imports(&std::fs::read_to_string(&file).unwrap()) {
            let imported = ROOT_NAMES.iter().find(|(name, _)| *name == imported).map_or(imported.as_str(), |(_, m)| m);
            if imported != room && layer(imported) >= layer(room) {
                wrong.push(format!("{} imports crate::{imported}", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "against the layers:\n{}", wrong.join("\n"));
}

#[test]
fn the_core_opens_no_file_and_reads_no_clock() {
    for file in rust_files(&workspace().join("crates/core/src")) {
        let text = std::fs::read_to_string(&file).unwrap();
        let product = text.split("#[cfg(test)]").next().unwrap();
        for forbidden in ["std::fs", "std::io", "std::time", "std::env", "std::process"] {
            assert!(!product.contains(forbidden), "{} uses {forbidden}", file.display());
        }
    }
}

#[test]
fn only_one_file_of_the_io_crate_opens_files() {
    let root = workspace().join("crates/io/src");
    for file in rust_files(&root).into_iter().filter(|f| f.file_name().unwrap() != "files.rs") {
        let text = std::fs::read_to_string(&file).unwrap();
        let product = text.split("#[cfg(test)]").next().unwrap();
        for forbidden in ["std::fs", "File::open", "File::create", "read_to_string("] {
            assert!(!product.contains(forbidden), "{} uses {forbidden}", file.display());
        }
    }
}

fn layer(room: &str) -> usize {
    let found = LAYERS.iter().find(|(_, rooms)| rooms.contains(&room));
    found.unwrap_or_else(|| panic!("'{room}' has no place in the table of layers")).0
}

/// First path segments behind `crate::` in code lines, groups included.
fn imports(text: &str) -> Vec<String> {
    let code: String = text.lines().filter(|l| !l.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let mut names = Vec::new();
    for (at, _) in code.match_indices("crate::") {
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '$') {
            continue;
        }
        let rest = &code[at + "crate::".len()..];
        let first = |s: &str| s.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
        match rest.strip_prefix('{') {
            None => names.push(first(rest)),
            Some(group) => {
                let mut depth = 0;
                let mut start = 0;
                for (i, c) in group.char_indices() {
                    match c {
                        '{' => depth += 1,
                        '}' if depth > 0 => depth -= 1,
                        ',' | '}' if depth == 0 => {
                            names.push(first(&group[start..i]));
                            start = i + 1;
                            if c == '}' {
                                break;
                            }
                        }
                        _ => {}
                    }
                }
            }
        }
    }
    names.retain(|n| !n.is_empty());
    names
}

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

#[test]
fn grouped_imports_are_understood() {
    let text = "use crate::{Problem, math::{Rgb, hash}, mesh};\n// use crate::view;\nlet x = crate::scene::Scene;";
    assert_eq!(imports(text), ["Problem", "math", "mesh", "scene"]);
}
