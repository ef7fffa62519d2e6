//! What the documentation says, is done: every command in it runs, and the reference has every option.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::print_stderr)]

mod common;

use common::Folder;
use isolux_io::export;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// Every page that shows commands, in the order in which a reader meets them.
fn pages() -> Vec<PathBuf> {
    let mut pages = vec![root().join("README.md")];
    for folder in ["docs", "docs/tutorial"] {
        let entries = std::fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path());
        let mut found: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|x| x == "md")).collect();
        found.sort();
        pages.extend(found);
    }
    pages
}

/// The lines of a page that are commands of isolux: in a block of code, with or without a prompt, without what is said behind them.
fn commands(page: &str) -> Vec<String> {
    let mut fenced = false;
    let mut found = Vec::new();
    for line in page.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        }
        let is_code = fenced || line.starts_with("    ");
        let line = line.trim_start().trim_start_matches("$ ");
        if is_code && line.starts_with("isolux ") {
            found.push(line.split("  #").next().unwrap_or(line).trim_end().to_owned());
        }
    }
    found
}

/// Whether it is a form with places to fill in, and not a command.
fn is_pattern(command: &str) -> bool {
    let word = |w: &str| w.len() > 1 && w.bytes().all(|b| b.is_ascii_uppercase());
    command.contains("...") || command.split_whitespace().any(|w| w.starts_with('[') || word(w))
}

/// The command with less to do, and otherwise as it stands: fewer elements, rays and seconds, smaller pictures.
fn shortened(command: &str) -> String {
    let mut words: Vec<String> = command.split(' ').map(str::to_owned).collect();
    let mut budget = false;
    for k in 1..words.len() {
        let small = match words[k - 1].as_str() {
            "--elements" => "400",
            "--rays" => "50k",
            "--time" => "1s",
            "--every" => "0.3s",
            "--width" => "160",
            "--error" => "50%",
            _ => continue,
        };
        budget |= ["--rays", "--time"].contains(&words[k - 1].as_str());
        words[k] = small.to_owned();
    }
    let is = |word: &str| words.iter().any(|w| w == word);
    let mut more = String::new();
    if words[1] == "solve" {
        if !is("--elements") && !is("--max-edge") && !is("--resume") {
            more += " --elements 400";
        }
        let deterministic = ["gauss-seidel", "direct", "hierarchical", "southwell"].iter().any(|name| is(name));
        if !budget && !deterministic && !is("--resume") {
            more += " --rays 50k";
        }
        if is("-o") && !is("--width") {
            more += " --width 160";
        }
    }
    // Nobody looks at the page, and a server that stays is sent home.
    if is("--live") || words[1] == "view" && !is("-o") {
        more += " --no-open";
    }
    let begin = if is("--live") { "timeout --foreground --preserve-status --signal INT 10 " } else { "" };
    format!("{begin}{}{more}", words.join(" "))
}

/// Whether it writes or serves a page, which an isolux that was built without npm cannot.
fn needs_viewer(command: &str) -> bool {
    command.contains("isolux view") || command.contains(".html") || command.contains("--live")
}

/// What a page may name without making it: a room as a file, solutions of it,
/// and a room that is no part of this repository.
fn prepare(folder: &Folder) {
    let scenes = folder.path("../shared/scenes");
    std::fs::create_dir_all(&scenes).unwrap();
    let room = std::fs::read(root().join("docs/tutorial/room.glb")).unwrap();
    folder.write("room.glb", &room);
    std::fs::write(scenes.join("living-room.glb"), &room).unwrap();
    for (seed, file) in
        [("1", "a.isolux"), ("2", "b.isolux"), ("1", "lit.isolux"), ("1", "day.isolux"), ("2", "evening.isolux")]
    {
        folder.prints(&["solve", "room.glb", "--elements", "400", "--rays", "50k", "--seed", seed, "-o", file]);
    }
}

#[test]
fn every_command_in_the_documentation_runs() {
    let mut count = 0;
    let has_viewer = export::writable().any(|format| format.ending == export::PAGE);
    if !has_viewer {
        eprintln!("isolux was built without the viewer: commands that write pages are skipped");
    }
    for page in pages() {
        let text = std::fs::read_to_string(&page).unwrap();
        let whole = Folder::new();
        std::fs::create_dir(whole.path("work")).unwrap();
        let folder = whole.within("work");
        prepare(&folder);
        for command in commands(&text).iter().filter(|command| !is_pattern(command) && !is_long(command)) {
            if needs_viewer(command) && !has_viewer {
                continue;
            }
            stop_a_run_for(&folder, command);
            let short = shortened(command);
            let path = Path::new(env!("CARGO_BIN_EXE_isolux")).parent().unwrap();
            let path = format!("{}:{}", path.display(), std::env::var("PATH").unwrap());
            let mut shell = Command::new("sh");
            shell.args(["-c", &short]).env("PATH", path).current_dir(folder.path("."));
            let output = shell.output().unwrap();
            let stderr = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{}: {command}\nas {short}: {}\n{stderr}", page.display(), output.status);
            count += 1;
        }
    }
    assert!(count > 60, "{count} commands were found");
}

/// Studies are run by tests of their own.
fn is_long(command: &str) -> bool {
    command.starts_with("isolux study ") && !command.contains("study list")
}

/// Makes the checkpoint that `command` goes on with, if it is one that does.
fn stop_a_run_for(folder: &Folder, command: &str) {
    let mut words = command.split_whitespace();
    let Some(checkpoint) = words.find(|w| *w == "--resume").and_then(|_| words.next()) else { return };
    folder.prints(&["solve", "room.glb", "--elements", "400", "--rays", "20k", "--checkpoint", checkpoint]);
}

/// Long options in a text.
fn options(text: &str) -> BTreeSet<String> {
    let is_part = |c: char| c.is_ascii_lowercase() || c == '-';
    let starts = text.match_indices("--").map(|(at, _)| &text[at..]);
    let option = |text: &str| text.chars().take_while(|c| is_part(*c)).collect::<String>();
    starts.map(option).filter(|o| o.len() > 3 && !o.ends_with('-') && !o.starts_with("---")).collect()
}

#[test]
fn the_reference_has_every_command_with_every_option() {
    let folder = Folder::new();
    let reference = std::fs::read_to_string(root().join("docs/commands.md")).unwrap();
    let help = folder.prints(&["--help"]);
    let list = help.split("Commands:").nth(1).unwrap().split("Options:").next().unwrap();
    let starts = list.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names: Vec<&str> = starts.filter_map(|line| line.split_whitespace().next()).filter(|n| *n != "help").collect();
    assert!(names.len() > 9, "{names:?}");
    let everywhere = options(reference.split("## everywhere").nth(1).unwrap().split("\n## ").next().unwrap());
    for name in names {
        let section = reference.split(&format!("\n## {name}\n")).nth(1);
        let section =
            section.unwrap_or_else(|| panic!("docs/commands.md lacks '{name}'")).split("\n## ").next().unwrap();
        let example = |line: &&str| line.starts_with("    ") && !is_pattern(line);
        let written = options(&section.lines().filter(|line| !example(line)).collect::<Vec<_>>().join("\n"));
        let help = folder.prints(&[name, "--help"]);
        let help = help.split("Examples:").next().unwrap();
        // Those that head a paragraph of their own.
        let heads = help.lines().filter_map(|line| {
            let line = line.trim_start();
            let line =
                if line.starts_with("--") { line } else { line.split_once(", ").filter(|(a, _)| a.len() == 2)?.1 };
            options(line).into_iter().next().filter(|_| line.starts_with("--"))
        });
        let known: BTreeSet<String> = heads.filter(|o| o != "--help" && o != "--version").collect();
        let missing: Vec<&String> =
            known.iter().filter(|o| !written.contains(*o) && !everywhere.contains(*o)).collect();
        assert!(missing.is_empty(), "docs/commands.md, {name}: {missing:?} are missing");
        let unknown: Vec<&String> = written.iter().filter(|o| !help.contains(o.as_str())).collect();
        assert!(unknown.is_empty(), "docs/commands.md, {name}: there is no {unknown:?}");
    }
}
