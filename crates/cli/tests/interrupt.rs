//! Ctrl-C ends cleanly and keeps the best result so far.
#![cfg(unix)]
#![allow(clippy::unwrap_used)]

mod common;

use common::Folder;
use serde_json::Value;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

fn start(folder: &Folder, arguments: &[&str]) -> Child {
    folder.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

/// Waits for the end; a program that hangs is a failure, not an endless test.
fn end(mut child: Child) -> Output {
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > Duration::from_secs(120) {
            child.kill().unwrap();
            panic!("it did not end");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    child.wait_with_output().unwrap()
}

#[test]
fn the_first_signal_keeps_the_result() {
    for signal in ["-INT", "-TERM"] {
        let folder = Folder::new();
        let arguments =
            ["solve", "box", "--elements", "200", "--time", "1h", "--json", "-o", "a.isolux", "-o", "a.csv"];
        let child = start(&folder, &arguments);
        std::thread::sleep(Duration::from_secs(2));
        send(signal, &child);
        let output = end(child);
        assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
        let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!((&summary["interrupted"], &summary["parameters"]["stopped"]), (&true.into(), &"by the user".into()));
        assert!(summary["rays"].as_u64().unwrap() > 0 && summary["rms_error_estimate"].is_number());
        assert_eq!(folder.names(), ["a.csv", "a.isolux"]);
        folder.prints(&["render", "a.isolux", "-o", "b.csv"]);
        assert!(folder.read("a.csv") == folder.read("b.csv"));
    }
}

#[test]
fn drafts_are_written_whole_and_again_and_again() {
    let folder = Folder::new();
    let child =
        start(&folder, &["solve", "box", "--elements", "200", "--time", "1h", "--every", "0.05s", "-o", "a.isolux"]);
    let rays_of_draft = || -> u64 {
        folder.prints(&["render", "a.isolux", "-o", "b.json"]);
        let summary: Value = serde_json::from_slice(&folder.read("b.json")).unwrap();
        assert_eq!(summary["parameters"]["stopped"], "not yet");
        summary["rays"].as_u64().unwrap()
    };
    let begin = Instant::now();
    let patient = || assert!(begin.elapsed() < Duration::from_secs(120), "no draft");
    while !folder.names().contains(&"a.isolux".to_owned()) {
        patient();
        std::thread::sleep(Duration::from_millis(5));
    }
    let first = rays_of_draft();
    while rays_of_draft() == first {
        patient();
    }
    send("-INT", &child);
    assert_eq!(end(child).status.code(), Some(130));
    assert_eq!(folder.names(), ["a.isolux", "b.json"]);
    folder.prints(&["render", "a.isolux", "-o", "b.json"]);
    let summary: Value = serde_json::from_slice(&folder.read("b.json")).unwrap();
    assert_eq!(summary["parameters"]["stopped"], "by the user");
}

#[test]
fn before_there_is_a_result_the_first_signal_ends_it_and_leaves_old_files() {
    let folder = Folder::new();
    folder.write("a.csv", b"old");
    // Cutting the scene into this many elements takes long enough to be interrupted.
    let child = start(&folder, &["solve", "box", "--elements", "30M", "-o", "a.csv"]);
    while folder.names().len() < 2 {
        std::thread::sleep(Duration::from_millis(5));
    }
    send("-INT", &child);
    let output = end(child);
    assert_eq!(output.status.code(), Some(130));
    assert!(String::from_utf8_lossy(&output.stderr).starts_with("error: interrupted"));
    assert_eq!((folder.read("a.csv"), folder.names()), (b"old".to_vec(), vec!["a.csv".to_owned()]));
}

#[test]
fn the_second_signal_stops_at_once_and_leaves_old_files() {
    let folder = Folder::new();
    folder.write("a.png", b"old");
    // A picture with so many samples takes minutes to write.
    let picture = ["--width", "4000", "--samples", "60000", "-o", "a.png"];
    let child = start(&folder, &common::with(&["solve", "box", "--elements", "200", "--time", "1h"], &picture));
    std::thread::sleep(Duration::from_secs(2));
    send("-INT", &child);
    std::thread::sleep(Duration::from_secs(1));
    send("-INT", &child);
    let output = end(child);
    assert_eq!(output.status.code(), Some(130));
    assert_eq!((folder.read("a.png"), folder.names()), (b"old".to_vec(), vec!["a.png".to_owned()]));
}
