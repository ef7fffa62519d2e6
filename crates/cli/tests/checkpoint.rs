//! Whatever stops a solve, it goes on where it was, to the same bits.
#![cfg(unix)]
#![allow(clippy::unwrap_used)]

mod common;

use common::{Folder, SMALL, with};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

const KILLS: u32 = 100;
/// Something that takes about a second, in two files.
const JOB: [&str; 5] = ["cornell-box", "--elements", "300", "--rays", "3M"];
const FILES: [&str; 4] = ["-o", "a.isolux", "-o", "a.csv"];

/// A small xorshift generator: the moments must be the same each time.
fn random(state: &mut u64) -> u64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state >> 16
}

/// Goes on with `a.checkpoint`, or begins if there is none; sends `signal` after a while, and gives how it ended.
fn run_and_send(folder: &Folder, signal: &str, after: Duration) -> ExitStatus {
    let goes_on = folder.names().contains(&"a.checkpoint".to_owned());
    let run: Vec<&str> = match goes_on {
        true => vec!["--resume", "a.checkpoint"],
        false => with(&JOB, &["--checkpoint", "a.checkpoint"]),
    };
    let all = with(&["solve", "--quiet", "--checkpoint-every", "0.01s"], &with(&run, &FILES));
    let mut child = folder.command(&all).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(after);
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
    let begin = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begin.elapsed() > Duration::from_secs(120) {
            child.kill().unwrap();
            panic!("it did not end");
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let output = child.wait_with_output().unwrap();
    let known = [None, Some(0), Some(130)].contains(&output.status.code());
    assert!(known, "{signal} after {after:?}: {}", String::from_utf8_lossy(&output.stderr));
    output.status
}

#[test]
fn a_hundred_kills_at_random_moments_cost_no_bit() {
    let folder = Folder::new();
    folder.prints(&with(&["solve", "-o", "whole.isolux", "-o", "whole.csv"], &JOB));
    let same =
        || ["isolux", "csv"].iter().all(|x| folder.read(&format!("a.{x}")) == folder.read(&format!("whole.{x}")));
    let (mut state, mut resumed) = (4, 0);
    for kill in 0..KILLS {
        let signal = ["-KILL", "-TERM", "-KILL", "-INT"][kill as usize % 4];
        let after = Duration::from_millis(random(&mut state) % 200);
        resumed += u32::from(folder.names().contains(&"a.checkpoint".to_owned()));
        if run_and_send(&folder, signal, after).code() == Some(0) {
            assert!(same(), "after {kill} kills");
            std::fs::remove_file(folder.path("a.checkpoint")).unwrap();
        }
    }
    assert!(resumed > KILLS / 4, "{resumed}");
    if !folder.names().contains(&"a.checkpoint".to_owned()) {
        run_and_send(&folder, "-TERM", Duration::from_millis(100));
    }
    folder.prints(&with(&["solve", "--resume", "a.checkpoint"], &FILES));
    assert!(same());
    // A finished run gives its files again.
    folder.write("a.csv", b"");
    folder.prints(&with(&["solve", "--resume", "a.checkpoint", "--threads", "1"], &FILES));
    assert!(same());
}

#[test]
fn a_full_disk_is_told_once_and_costs_nothing() {
    let folder = Folder::new();
    folder.prints(&with(&["solve", "--checkpoint", "a.checkpoint"], &SMALL));
    let before = folder.read("a.checkpoint");
    // No file may grow beyond a few kilobytes.
    let limited = "trap '' XFSZ; ulimit -f 8; exec \"$0\" \"$@\"";
    let mut command = Command::new("sh");
    command.args(["-c", limited, env!("CARGO_BIN_EXE_isolux"), "solve", "--resume", "a.checkpoint", "--json"]);
    command.args(["--rays", "1M", "--checkpoint-every", "0.001s"]).current_dir(folder.path("."));
    let output = command.output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    assert_eq!(stderr.matches("no checkpoint: ").count(), 1, "{stderr}");
    assert!(stderr.contains("the solve goes on") && stderr.contains("a.checkpoint"), "{stderr}");
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(summary["rays"].as_u64().unwrap() > 300_000);
    assert!(folder.read("a.checkpoint") == before);
    assert_eq!(folder.names(), ["a.checkpoint"]);
}

/// The job with checkpoints that nobody asked for.
fn unasked() -> Vec<&'static str> {
    with(&["solve", "--checkpoint-every", "0.01s"], &with(&JOB, &FILES))
}

#[test]
fn who_asks_for_no_checkpoint_can_go_on_all_the_same() {
    for signal in ["-KILL", "-INT"] {
        let folder = Folder::new();
        folder.prints(&with(&["solve", "-o", "whole.isolux", "-o", "whole.csv"], &JOB));
        let mut child = folder.command(&unasked()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        while !folder.names().contains(&"a.isolux.checkpoint".to_owned()) {
            assert!(child.try_wait().unwrap().is_none(), "it ended without a checkpoint");
            std::thread::sleep(Duration::from_millis(1));
        }
        Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        let stderr = child.wait_with_output().unwrap().stderr;
        let told = String::from_utf8(stderr).unwrap().contains("solve --resume a.isolux.checkpoint' goes on");
        assert_eq!(told, signal == "-INT");
        // Who asks for the same again is told, and loses nothing.
        let kept = folder.read("a.isolux.checkpoint");
        let again = folder.run(&unasked());
        assert!(String::from_utf8_lossy(&again.stderr).contains("a.isolux.checkpoint is there, of an earlier run"));
        assert!(folder.read("a.isolux.checkpoint") == kept);
        folder.prints(&with(&["solve", "--resume", "a.isolux.checkpoint"], &FILES));
        assert!(["isolux", "csv"].iter().all(|x| folder.read(&format!("a.{x}")) == folder.read(&format!("whole.{x}"))));
    }
}

#[test]
fn a_checkpoint_that_nobody_asked_for_is_gone_in_the_end() {
    let folder = Folder::new();
    let said = folder.run(&unasked());
    assert!(said.status.success() && !String::from_utf8_lossy(&said.stderr).contains("checkpoint"));
    assert_eq!(folder.names(), ["a.csv", "a.isolux"]);
    let none = with(&["solve", "--no-checkpoint"], &with(&SMALL, &["-o", "a.csv"]));
    folder.prints(&none);
    assert!(folder.fails(2, &with(&none, &["--checkpoint-every", "1s"])).contains("cannot be used with"));
}

#[test]
fn an_output_that_cannot_be_written_costs_no_ray() {
    let folder = Folder::new();
    // The checkpoint fits on this disk, the output does not.
    let limited = "trap '' XFSZ; ulimit -f 400; exec \"$0\" \"$@\"";
    let mut command = Command::new("sh");
    command.args(["-c", limited, env!("CARGO_BIN_EXE_isolux"), "solve", "--checkpoint-every", "0.01s"]);
    command.args(JOB).args(["-o", "a.exr", "--width", "800"]).current_dir(folder.path("."));
    let output = command.output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(stderr.contains("solve --resume a.exr.checkpoint' goes on"), "{stderr}");
    assert_eq!(folder.names(), ["a.exr.checkpoint"]);
    folder.prints(&["solve", "--resume", "a.exr.checkpoint", "-o", "a.exr", "--width", "800"]);
}

#[test]
fn a_finished_run_is_extended_by_further_rounds() {
    let folder = Folder::new();
    // Of a uniform mesh, which takes no rays to find.
    let job = ["solve", "--json", "--mesh", "uniform", "--checkpoint", "a.checkpoint"];
    let first = folder.json(&with(&job, &SMALL));
    let more = ["solve", "--json", "--resume", "a.checkpoint", "--rays", "300k", "--checkpoint", "b.checkpoint"];
    let second = folder.json(&more);
    let number = |summary: &serde_json::Value, key: &str| summary[key].as_f64().unwrap();
    assert!((200e3..400e3).contains(&number(&second, "rays")), "{second}");
    assert!(number(&second, "rms_error_estimate") < 0.5 * number(&first, "rms_error_estimate"), "{second}");
    assert_eq!(number(&second, "replicates"), 2.0 * number(&first, "replicates"));
    assert_eq!(second["parameters"]["extended from"], "rays 30000");
    // The extension has the same bits each time, and who asks for no more than before gets no more.
    assert_eq!(folder.json(&more)["objects"], second["objects"]);
    let again = folder.json(&["solve", "--json", "--resume", "b.checkpoint", "--rays", "300k"]);
    assert_eq!(again["objects"], second["objects"]);
}

#[test]
fn time_is_extended_by_time() {
    let folder = Folder::new();
    let solve = |arguments: &[&str]| folder.json(&with(&["solve", "--json"], arguments));
    let first = solve(&["box", "--elements", "300", "--time", "0.3s", "--checkpoint", "a.checkpoint"]);
    let again = solve(&["--resume", "a.checkpoint"]);
    assert_eq!((&again["rays"], &again["parameters"]["stopped"]), (&first["rays"], &"by the time limit".into()));
    let more = solve(&["--resume", "a.checkpoint", "--time", "0.3s"]);
    assert!(more["rays"].as_u64() > first["rays"].as_u64() && more["seconds"].as_f64().unwrap() >= 0.6, "{more}");
}

#[test]
fn a_deterministic_run_goes_on_and_cannot_be_given_rays() {
    let folder = Folder::new();
    let method = ["solve", "box", "--method", "gauss-seidel", "--elements", "200"];
    folder.prints(&with(&method, &["-o", "a.csv", "--checkpoint", "a.checkpoint"]));
    folder.prints(&["solve", "--resume", "a.checkpoint", "-o", "b.csv"]);
    assert!(folder.read("a.csv") == folder.read("b.csv"));
    assert!(folder.fails(2, &["solve", "--resume", "a.checkpoint", "--rays", "1M"]).contains("no random numbers"));
}

#[test]
fn what_a_checkpoint_decides_cannot_be_chosen_again() {
    let folder = Folder::new();
    folder.prints(&with(&["solve", "--checkpoint", "a.checkpoint", "-o", "a.isolux"], &SMALL));
    let refused = |arguments: &[&str]| folder.fails(2, &with(&["solve", "--resume", "a.checkpoint"], arguments));
    let options: [&[&str]; 9] = [
        &["box"],
        &["--elements", "100"],
        &["--max-edge", "1"],
        &["--mesh", "uniform"],
        &["--seed", "2"],
        &["--replicates", "8"],
        &["--light", "all"],
        &["--method", "auto"],
        &["--light-units", "raw"],
    ];
    for option in options {
        assert!(refused(option).contains("cannot be used with"), "{option:?}");
    }
    assert!(refused(&["--rays", "10k"]).contains("ask for more"));
    assert!(refused(&["-o", "a.checkpoint"]).contains("unknown file type"));
}

#[test]
fn what_is_no_checkpoint_is_refused_with_advice() {
    let folder = Folder::new();
    folder.prints(&with(&["solve", "--checkpoint", "a.checkpoint", "-o", "a.isolux"], &SMALL));
    assert!(folder.fails(2, &["solve"]).contains("<SCENE>"));
    assert!(folder.fails(2, &["solve", "--resume", "none.checkpoint"]).contains("--checkpoint FILE"));
    assert!(folder.fails(2, &["solve", "--resume", "a.isolux"]).contains("this is not a checkpoint"));
    assert!(folder.fails(2, &["solve", "a.checkpoint"]).contains("--resume a.checkpoint"));
    assert!(folder.fails(2, &with(&["solve", "--checkpoint-every", "1s"], &SMALL)).contains("not where"));
    assert!(folder.fails(2, &with(&["solve", "--checkpoint", "b.csv", "-o", "b.csv"], &SMALL)).contains("named twice"));
    assert!(folder.fails(2, &with(&["solve", "--checkpoint", "no/b"], &SMALL)).contains("make it first"));
    let mut damaged = folder.read("a.checkpoint");
    damaged[200] ^= 1;
    folder.write("b.checkpoint", &damaged);
    assert!(folder.fails(2, &["solve", "--resume", "b.checkpoint"]).contains("b.checkpoint: checksum: "));
    folder.write("b.checkpoint", &damaged[..1000]);
    assert!(folder.fails(2, &["solve", "--resume", "b.checkpoint"]).contains("cut off"));
}
