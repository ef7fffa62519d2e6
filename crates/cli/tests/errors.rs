//! What goes wrong is said in a line, with exit code 2, before anything is written.

#![allow(clippy::unwrap_used)]

mod common;

use common::{Folder, SMALL, with};

#[test]
fn unknown_scenes_name_both_possibilities_and_the_nearest() {
    let folder = Folder::new();
    let message = folder.fails(2, &["solve", "cornel-box"]);
    assert!(message.contains("no file 'cornel-box'") && message.contains("built-in scene 'cornell-box'"), "{message}");
    assert!(folder.fails(2, &["check", "rooms/none.glb"]).contains("check the name and the folder"));
    assert!(folder.fails(2, &["solve", "labyrinth:roh=0.5"]).contains("did you mean 'rho'"));
    assert!(folder.fails(2, &["scene", "bix", "-o", "a.glb"]).contains("'box'"));
}

#[test]
fn bad_outputs_are_refused_before_the_work() {
    let folder = Folder::new();
    let long = ["solve", "box", "--rays", "1e12"];
    let refused = |outputs: &[&str]| folder.fails(2, &with(&long, outputs));
    assert!(refused(&["-o", "a.doc"]).contains("unknown file type"));
    assert!(refused(&["-o", "no/a.csv"]).contains("no folder"));
    assert!(refused(&["-o", "a.csv", "-o", "b.csv", "-o", "./a.csv"]).contains("named twice"));
    assert!(refused(&["-o", "a.csv", "--camera", "nobody"]).contains("camera"));
    assert_eq!(folder.names(), [""; 0]);
}

#[test]
fn the_input_is_never_replaced() {
    let folder = Folder::new();
    folder.prints(&["scene", "box", "-o", "a.glb"]);
    folder.prints(&with(&["solve", "-o", "a.isolux"], &SMALL));
    let before = (folder.read("a.glb"), folder.read("a.isolux"));
    assert!(folder.fails(2, &["solve", "a.glb", "-o", "./a.glb"]).contains("replace the input"));
    assert!(folder.fails(2, &["render", "a.isolux", "-o", "a.isolux"]).contains("replace the input"));
    assert!(before == (folder.read("a.glb"), folder.read("a.isolux")));
}

#[test]
fn bad_files_leave_old_outputs_as_they_were() {
    let folder = Folder::new();
    folder.write("old.csv", b"old");
    folder.write("bad.glb", b"glTF nonsense");
    folder.write("bad.isolux", b"nonsense");
    assert!(folder.fails(2, &["solve", "bad.glb", "-o", "old.csv"]).contains("bad.glb"));
    assert!(folder.fails(2, &["render", "bad.isolux", "-o", "old.csv"]).contains("bad.isolux"));
    assert!(folder.fails(2, &["render", "none.isolux", "-o", "old.csv"]).contains("no file"));
    assert!(folder.fails(2, &["render", "bad.glb", "-o", "old.csv"]).contains("isolux solve bad.glb"));
    assert!(folder.fails(2, &["solve", "bad.isolux", "-o", "old.csv"]).contains("a solution, not a scene"));
    assert_eq!(folder.read("old.csv"), b"old");
    assert_eq!(folder.names(), ["bad.glb", "bad.isolux", "old.csv"]);
}

#[test]
fn solutions_of_other_scenes_cannot_be_compared() {
    let folder = Folder::new();
    folder.prints(&with(&["solve", "-o", "a.isolux"], &SMALL));
    folder.prints(&["solve", "cubes", "--elements", "600", "--rays", "1e4", "-o", "b.isolux"]);
    assert!(folder.fails(2, &["compare", "a.isolux", "b.isolux"]).contains("different scenes"));
}

#[test]
fn bad_usage_is_explained() {
    let folder = Folder::new();
    for (arguments, explained) in [
        (&["solve"][..], "<SCENE>"),
        (&["solv", "box"], "solve"),
        (&["solve", "box", "--rays", "many"], "200k"),
        (&["solve", "box", "--rays", "0"], "200k"),
        (&["solve", "box", "--time", "soon"], "2min"),
        (&["solve", "box", "--threads", "0"], "1 to 1024"),
        (&["solve", "box", "--error", "200%"], "2%"),
        (&["solve", "box", "--error", "1%", "--confidence", "0"], "0.02"),
        (&["solve", "box", "--confidence", "90%"], "--error"),
        (&["solve", "box", "--error", "1%", "--error-of", "worst"], "object:NAME"),
        (&["solve", "box", "--error", "1%", "--error-of", "object:flor"], "did you mean 'floor'"),
        (&["solve", "box", "--error", "1%", "--replicates", "1"], "at least 8"),
        (&["solve", "box", "--error", "1%", "--method", "gauss-seidel"], "no use for --error"),
        (&["solve", "box", "--elements", "9", "--max-edge", "1"], "cannot be used with"),
        (&["solve", "box", "--replicates", "3"], "at least 8"),
        (&["solve", "box", "--max-edge", "1", "--mesh", "adaptive"], "--elements"),
        (&["solve", "box", "--mesh", "fine"], "adaptive"),
        (&["solve", "box", "--max-edge", "-1"], "max-edge"),
        (&["solve", "box", "--max-edge", "0"], "positive length"),
        (&["solve", "box", "--elements", "1e12"], "more than"),
        (&["solve", "box", "--address", "here"], "per-iteration"),
        (&["render", "a.isolux"], "--output"),
        (&["scene", "box", "-o", "a.obj"], ".glb"),
    ] {
        let message = folder.fails(2, arguments);
        assert!(message.contains(explained), "{arguments:?}: {message}");
    }
    assert_eq!(folder.names(), [""; 0]);
}

#[cfg(unix)]
#[test]
fn indirect_light_is_refused_by_methods_that_cannot_tell_it() {
    let folder = Folder::new();
    let refused = |method: &str| folder.fails(2, &["solve", "box", "--method", method, "--light", "indirect"]);
    assert!(refused("random-walk").contains("cannot be told apart afterwards"));
    assert!(refused("gauss-seidel").contains("all light together"));
    assert!(folder.fails(2, &["solve", "box", "--light", "direct"]).contains("one of all, indirect"));
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let folder = Folder::new();
    let mut child = folder.command(&["list"]).stdout(std::process::Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
}
