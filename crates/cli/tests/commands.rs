//! The other commands as a new user would try them.

#![allow(clippy::unwrap_used)]

mod common;

use common::{Folder, SMALL, with};

#[test]
fn a_solution_is_rendered_to_the_same_bytes_as_when_it_was_solved() {
    let folder = Folder::new();
    folder.prints(&with(&["solve", "-o", "a.isolux", "-o", "a.csv", "-o", "a.png"], &SMALL));
    let text = folder.prints(&["render", "a.isolux", "-o", "b.csv", "-o", "b.png", "-o", "b.isolux", "--width", "40"]);
    assert!(text.contains("b.png"));
    for kind in ["csv", "png", "isolux"] {
        assert!(folder.read(&format!("a.{kind}")) == folder.read(&format!("b.{kind}")), "{kind}");
    }
}

#[test]
fn tables_are_smoothed_if_asked_pictures_unless_not_and_solutions_never() {
    let folder = Folder::new();
    folder.prints(&with(&["solve", "-o", "a.isolux", "-o", "a.csv", "-o", "a.exr"], &SMALL));
    for smooth in ["pictures", "all", "none"] {
        let files = ["isolux", "csv", "exr", "json"].map(|kind| format!("{smooth}.{kind}"));
        let [isolux, csv, exr, json] = files.each_ref().map(String::as_str);
        let render = ["render", "a.isolux", "--smooth", smooth, "--width", "40"];
        folder.prints(&[&render[..], &["-o", isolux, "-o", csv, "-o", exr, "-o", json]].concat());
        assert!(folder.read(isolux) == folder.read("a.isolux"));
        assert_eq!(folder.read(csv) != folder.read("a.csv"), smooth == "all", "{csv}");
        assert_eq!(folder.read(exr) != folder.read("a.exr"), smooth == "none", "{exr}");
        assert_eq!(String::from_utf8_lossy(&folder.read(json)).contains("\"smoothed\""), smooth == "all", "{json}");
    }
    assert!(
        folder.fails(2, &["render", "a.isolux", "--smooth", "much", "-o", "b.png"]).contains("pictures, all, none")
    );
}

#[test]
fn solutions_of_two_seeds_differ_as_their_error_bars_say() {
    let folder = Folder::new();
    for seed in ["1", "2"] {
        let file = format!("{seed}.isolux");
        folder.prints(&with(&["solve", "--seed", seed, "-o", &file], &SMALL));
    }
    let c = folder.json(&["compare", "1.isolux", "2.isolux", "--json"]);
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    assert!(number(&c["rms"]) > 0.0 && number(&c["rms"]) < 3.0 * number(&c["expected_rms"]));
    assert!((0.7..1.5).contains(&number(&c["z"]["std_dev"])) && number(&c["z"]["mean"]).abs() < 0.5, "{c}");
    let text = folder.prints(&["compare", "1.isolux", "2.isolux"]);
    assert!(text.contains("RMS difference") && text.contains("beyond 3"));
    let same = folder.run(&["compare", "1.isolux", "1.isolux"]);
    assert!(String::from_utf8_lossy(&same.stderr).contains("may not be independent"));
    assert!(String::from_utf8_lossy(&same.stdout).contains("largest difference  none"));
}

#[test]
fn solutions_of_several_seeds_are_merged() {
    let folder = Folder::new();
    let solve = |seed: &str, elements: &str| {
        let file = format!("{seed}-{elements}.isolux");
        folder.prints(&["solve", "box", "--elements", elements, "--rays", "30k", "--seed", seed, "-o", &file]);
        file
    };
    let [one, two, other] = [solve("1", "300"), solve("2", "300"), solve("3", "500")];
    let text = folder.prints(&["merge", &one, &two, "-o", "m.isolux", "-o", "m.json", "-o", "m.png", "--width=40"]);
    assert!(text.contains("2 solutions") && text.contains("Error at most") && text.contains("m.png"), "{text}");
    let summary: serde_json::Value = serde_json::from_slice(&folder.read("m.json")).unwrap();
    assert_eq!(summary["parameters"]["merged seeds"], "1, 2");
    let error = |name: &str| {
        folder.prints(&["render", name, "-o", "s.json"]);
        let summary: serde_json::Value = serde_json::from_slice(&folder.read("s.json")).unwrap();
        summary["rms_error_estimate"].as_f64().unwrap()
    };
    assert!(error("m.isolux") < 0.8 * error(&one).min(error(&two)));
    assert!(folder.fails(2, &["merge", &one, &one, "-o", "n.csv"]).contains("not independent"));
    assert!(folder.fails(2, &["merge", "m.isolux", &two, "-o", "n.csv"]).contains("seed 2"));
    assert!(folder.fails(2, &["merge", &one, &other, "-o", "n.csv"]).contains("different elements"));
    assert!(folder.fails(2, &["merge", &one, &two, "-o", &one]).contains("replace the input"));
    assert!(folder.fails(2, &["merge", &one, "-o", "n.csv"]).contains("values required"));
}

#[test]
fn a_built_in_scene_is_written_checked_and_solved_as_a_file() {
    let folder = Folder::new();
    assert!(folder.prints(&["scene", "cornell-box", "-o", "c.glb"]).contains("c.glb"));
    let (file, name) = (folder.json(&["check", "c.glb", "--json"]), folder.json(&["check", "cornell-box", "--json"]));
    for key in ["triangles", "objects", "cameras"] {
        assert_eq!(file[key], name[key], "{key}");
    }
    let flux = |report: &serde_json::Value| report["emitted_flux"].as_f64().unwrap();
    assert!((flux(&file) / flux(&name) - 1.0).abs() < 1e-4);
    let text = folder.prints(&["check", "cornell-box"]);
    assert!(text.contains("emitted flux") && text.contains("warning: "), "its boxes are open: {text}");
    folder.prints(&["solve", "c.glb", "--elements", "200", "--rays", "1e4", "-o", "c.csv"]);
}

#[test]
fn a_file_wins_over_a_built_in_scene() {
    let folder = Folder::new();
    folder.prints(&["scene", "cubes", "-o", "c.glb"]);
    std::fs::rename(folder.path("c.glb"), folder.path("box")).unwrap();
    assert!(folder.fails(2, &["check", "box"]).contains("unknown file type"));
}

#[test]
fn lists_help_and_version_teach() {
    let folder = Folder::new();
    let all = folder.prints(&["list"]);
    for word in ["cornell-box", ":rho=", ".glb", ".isolux", "stochastic-jacobi", "owen-sobol"] {
        assert!(all.contains(word), "{word}: {all}");
    }
    assert!(!folder.prints(&["list", "formats"]).contains("cornell-box"));
    assert!(folder.prints(&["list", "orders"]).contains("breadth-first"));
    assert!(folder.prints(&["list", "sequences"]).contains("scrambled-halton"));
    assert!(folder.prints(&[]).contains("Usage: isolux"));
    assert!(folder.prints(&["--version"]).starts_with("isolux "));
    for command in ["solve", "render", "bake", "check", "compare", "merge", "mix", "scene", "factors", "list"] {
        assert!(folder.prints(&[command, "--help"]).contains("Examples:"), "{command}");
        assert!(folder.prints(&["--help"]).contains(command));
    }
}
