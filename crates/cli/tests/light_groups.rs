//! `isolux solve --light-groups` and `isolux mix` as a new user would try them.

#![allow(clippy::unwrap_used)]

mod common;

use common::{Folder, with};
use serde_json::Value;

/// A room with a few lamps, of different names and kinds, in two files.
const OFFICE: [&str; 6] = ["office:size=1", "--elements", "10k", "--rays", "400k", "--width=40"];

fn office(folder: &Folder, more: &[&str]) -> String {
    folder.prints(&with(&["solve"], &with(&OFFICE, more)))
}

fn summary(folder: &Folder, name: &str) -> Value {
    serde_json::from_slice(&folder.read(name)).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn lamps_are_solved_apart_and_mixed() {
    let folder = Folder::new();
    let text = office(&folder, &["--light-groups", "materials", "-o", "a.isolux", "-o", "a.csv", "-o", "a.json"]);
    assert!(text.contains("light group") && text.contains("error at most"), "{text}");
    let solved = summary(&folder, "a.json");
    let groups = solved["light_groups"].as_array().unwrap();
    let emitted: f64 = groups.iter().map(|group| number(&group["emitted"])).sum();
    assert!(groups.len() > 2 && (emitted / number(&solved["balance"]["emitted"]) - 1.0).abs() < 1e-6, "{groups:?}");
    let names: Vec<&str> = groups.iter().map(|group| group["name"].as_str().unwrap()).collect();
    assert_eq!(solved["parameters"]["light groups"], names.join("; "));

    // Without anything to set, what there is.
    let listed = folder.prints(&["mix", "a.isolux"]);
    assert!(names.iter().all(|name| listed.contains(name)) && !listed.contains("factor"), "{listed}");
    folder.prints(&["mix", "a.isolux", "-o", "same.isolux", "-o", "same.csv", "--quiet"]);
    assert!(folder.read("same.isolux") == folder.read("a.isolux") && folder.read("same.csv") == folder.read("a.csv"));

    // One lamp alone, in red; and from there to the light of all of them again.
    let set = format!("{}=0.5*#ff0000", names[1]);
    let mixed = folder.prints(&["mix", "a.isolux", "--set", "*=0", "--set", &set, "-o", "b.isolux", "-o", "b.json"]);
    assert!(mixed.contains("0.500 0 0") && mixed.contains("Wrote b.isolux"), "{mixed}");
    let mixed = summary(&folder, "b.json");
    assert_eq!(mixed["light_groups"][1]["factor"], serde_json::json!([0.5, 0.0, 0.0]));
    assert!(number(&mixed["balance"]["emitted"]) < 0.2 * number(&groups[1]["emitted"]));
    assert!(number(&mixed["mean"]) > 0.0 && mixed["scene"]["hash"] != solved["scene"]["hash"]);
    folder.prints(&["mix", "b.isolux", "--set", "*=1", "-o", "c.csv"]);
    assert!(folder.read("c.csv") == folder.read("a.csv"));
    // The mixture is a solution like any other.
    folder.prints(&["render", "b.isolux", "-o", "b.png", "--width=40"]);
    assert!(folder.fails(2, &["compare", "a.isolux", "b.isolux"]).contains("different scenes"));
}

#[test]
fn lists_put_lamps_together_and_runs_go_on() {
    let folder = Folder::new();
    let groups = ["--mesh", "uniform", "--light-groups", "day=window*;evening=desk lamp*, pendant*"];
    let text = office(&folder, &with(&groups, &["--checkpoint", "a.checkpoint", "-o", "a.isolux", "--json"]));
    let solved: Value = serde_json::from_str(&text).unwrap();
    let names: Vec<&Value> = solved["light_groups"].as_array().unwrap().iter().map(|group| &group["name"]).collect();
    assert_eq!(names, ["day", "evening", "rest"]);
    folder.prints(&["solve", "--resume", "a.checkpoint", "-o", "b.isolux", "--quiet"]);
    assert!(folder.read("a.isolux") == folder.read("b.isolux"));
    let more = folder.json(&["solve", "--resume", "a.checkpoint", "--rays", "800k", "--json", "-o", "b.isolux"]);
    assert!(number(&more["rays"]) >= 8e5 && number(&more["rays"]) < 1e6, "{}", more["rays"]);
    assert!(more["parameters"]["extended from"].as_str().unwrap().contains("400000"));
    assert!(folder.prints(&["mix", "b.isolux"]).contains("evening"));
    // Merged solutions have the groups merged.
    office(&folder, &with(&groups, &["--seed", "2", "-o", "c.isolux"]));
    folder.prints(&["merge", "a.isolux", "c.isolux", "-o", "merged.isolux", "-o", "merged.csv"]);
    let mixed = folder.prints(&["mix", "merged.isolux", "-o", "mixed.csv"]);
    assert!(mixed.contains("evening") && folder.read("mixed.csv") == folder.read("merged.csv"));
    office(&folder, &["--mesh", "uniform", "--light-groups", "objects", "--seed", "3", "-o", "d.isolux"]);
    assert!(folder.fails(2, &["merge", "a.isolux", "d.isolux", "-o", "e.csv"]).contains("number 2"));
}

#[test]
fn what_cannot_be_mixed_is_explained() {
    let folder = Folder::new();
    folder.prints(&["solve", "box", "--elements", "300", "--rays", "30k", "-o", "plain.isolux"]);
    assert!(folder.fails(2, &["mix", "plain.isolux"]).contains("--light-groups"));
    let lamp = ["box", "--elements", "300", "--rays", "30k", "--light-groups", "objects", "-o", "a.isolux"];
    folder.prints(&with(&["solve"], &lamp));
    let message = folder.fails(2, &["mix", "a.isolux", "--set", "lamb=0", "-o", "b.csv"]);
    assert!(message.contains("did you mean") && message.contains("there are"), "{message}");
    for (arguments, explained) in [
        (&["mix", "a.isolux", "--set", "lamp"][..], "NAME=FACTOR"),
        (&["mix", "a.isolux", "--set", "lamp=-1"], "nothing below 0"),
        (&["mix", "a.isolux", "--set", "lamp=#abc"], "no factor"),
        (&["mix", "a.isolux", "-o", "./a.isolux"], "replace the input"),
        (&["solve", "box", "--light-groups", "lamps"], "objects, materials, or a list"),
        (&["solve", "box", "--light-groups", "a=lamb;b=lamb"], "did you mean"),
        (&["solve", "labyrinth", "--light-groups", "objects", "--elements", "3000", "--rays", "9"], "ask for more"),
        (&["solve", "--resume", "a.checkpoint", "--light-groups", "objects"], "cannot be used with"),
        (&["solve", "--resume", "a.checkpoint", "--seed", "2"], "cannot be used with"),
    ] {
        let message = folder.fails(2, arguments);
        assert!(message.contains(explained), "{arguments:?}: {message}");
    }
    assert_eq!(folder.names(), ["a.isolux", "plain.isolux"]);
}
