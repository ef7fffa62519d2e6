//! `isolux solve` as a new user would try it.

#![allow(clippy::unwrap_used)]

mod common;

use common::{Folder, SMALL, with};
use isolux_io::export::writable;

#[test]
fn every_format_is_written_and_the_summary_says_so() {
    let folder = Folder::new();
    let names: Vec<String> = writable().map(|format| format!("a{}", format.ending)).collect();
    let outputs: Vec<&str> = names.iter().flat_map(|name| ["-o", name.as_str()]).collect();
    let text = folder.prints(&with(&["solve"], &with(&SMALL, &outputs)));
    for name in &names {
        assert!(!folder.read(name).is_empty() && text.contains(name.as_str()), "{name}: {text}");
    }
    assert_eq!(folder.names().len(), names.len(), "nothing else is left behind");
    for word in
        ["Error at most", "95 % confidence", "Mean irradiance", "±", "emitted", "absorbed", "escaped", "floor", "mean"]
    {
        assert!(text.contains(word), "{word}: {text}");
    }
    assert!(!text.contains('\x1b'), "no colours in a pipe");
}

#[test]
fn json_is_one_object_with_everything_that_was_promised() {
    let folder = Folder::new();
    let summary = folder.json(&with(&["solve", "--json", "-o", "a.csv", "--seed", "7", "--threads", "2"], &SMALL));
    for key in ["scene", "elements", "triangles", "rays", "seconds", "rays_per_second", "rms_error_estimate", "version"]
    {
        assert!(!summary[key].is_null(), "{key}: {summary}");
    }
    let flux = |key: &str| summary["balance"][key].as_f64().unwrap();
    let parts = flux("absorbed") + flux("escaped") + flux("back_face") + flux("unshot");
    assert!(flux("emitted") > 0.0 && (parts / flux("emitted") - 1.0).abs() < 1e-6);
    assert_eq!((summary["seed"].as_u64(), summary["threads"].as_u64()), (Some(7), Some(2)));
    assert_eq!(summary["outputs"][0]["path"], "a.csv");
    assert_eq!(summary["objects"].as_array().map(Vec::len), Some(6));
    assert_eq!((&summary["warnings"], &summary["interrupted"]), (&serde_json::json!([]), &serde_json::json!(false)));
}

#[test]
fn the_same_seed_gives_the_same_bytes_for_any_number_of_threads() {
    let folder = Folder::new();
    let files: Vec<String> = writable().map(|format| format!("a{}", format.ending)).collect();
    let outputs: Vec<&str> = files.iter().flat_map(|name| ["-o", name.as_str()]).collect();
    let mut first = Vec::new();
    for threads in ["1", "2", "3", "7"] {
        folder.prints(&with(&["solve", "--threads", threads], &with(&SMALL, &outputs)));
        let bytes: Vec<Vec<u8>> = files.iter().map(|name| folder.read(name)).collect();
        if first.is_empty() {
            first = bytes;
        } else {
            assert!(bytes == first, "{threads} threads");
        }
    }
    folder.prints(&with(&["solve", "--seed", "2"], &with(&SMALL, &outputs)));
    assert!(folder.read("a.csv") != first[writable().position(|f| f.ending == ".csv").unwrap()]);
}

#[test]
fn indirect_light_is_part_of_all_light_and_says_so() {
    let folder = Folder::new();
    let solve = |arguments: &[&str]| folder.json(&with(&with(&["solve", "--json"], arguments), &SMALL));
    let [all, indirect] = ["all", "indirect"].map(|light| solve(&["--light", light]));
    let mean = |summary: &serde_json::Value| summary["objects"][0]["mean"].as_f64().unwrap();
    assert!(0.0 < mean(&indirect) && mean(&indirect) < mean(&all), "{indirect}");
    assert_eq!(all["balance"]["emitted"], indirect["balance"]["emitted"]);
    // Stochastic Jacobi shoots the same rays for both, auto as many as are best.
    let shot = ["--method", "stochastic-jacobi", "--mesh", "uniform"];
    let [all_shot, indirect_shot] = ["all", "indirect"].map(|light| solve(&with(&shot, &["--light", light])));
    assert_eq!(all_shot["balance"], indirect_shot["balance"]);
    assert_eq!(indirect["parameters"]["light"], "indirect");
    assert!(
        indirect["remarks"].to_string().contains("reflected light alone") && all["remarks"] == serde_json::json!([])
    );
}

#[test]
fn a_time_limit_is_kept_and_written_down() {
    let folder = Folder::new();
    let summary = folder.json(&["solve", "box", "--elements", "100", "--time", "0.5s", "--json", "-o", "a.isolux"]);
    let seconds = summary["seconds"].as_f64().unwrap();
    assert!((0.5..30.0).contains(&seconds), "{seconds}");
    assert!(summary["rms_error_estimate"].as_f64().unwrap() < 1.0);
    assert_eq!(summary["parameters"]["stopped"], "by the time limit");
}

#[test]
fn too_little_time_for_an_error_bar_is_said_clearly() {
    let folder = Folder::new();
    let arguments = ["solve", "box", "--elements", "50k", "--time", "0.001", "-o", "a.json"];
    let output = folder.run(&arguments);
    assert_eq!(output.status.code(), Some(0));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no error estimate yet"));
    let summary: serde_json::Value = serde_json::from_slice(&folder.read("a.json")).unwrap();
    assert!(summary["rms_error_estimate"].is_null());
}

#[test]
fn nothing_is_said_that_was_not_asked_for() {
    let folder = Folder::new();
    let quiet = folder.run(&with(&["solve", "--quiet", "-o", "a.csv"], &SMALL));
    assert!(quiet.stdout.is_empty() && quiet.stderr.is_empty());
    let normal = folder.run(&with(&["solve"], &SMALL));
    assert!(normal.stderr.is_empty(), "no progress in a pipe: {}", String::from_utf8_lossy(&normal.stderr));
    assert!(!normal.stdout.is_empty());
}

#[test]
fn elements_of_any_kind_can_be_asked_for() {
    let folder = Folder::new();
    let elements = |arguments: &[&str]| {
        let all = with(&["solve", "box", "--rays", "1e4", "--json"], arguments);
        folder.json(&all)["elements"].as_u64().unwrap()
    };
    assert!((500..=1000).contains(&elements(&["--elements", "1k"])));
    assert!(elements(&["--max-edge", "0.5"]) > elements(&["--max-edge", "1"]));
}

#[test]
fn the_mesh_follows_the_light_and_not_the_seed_or_the_method() {
    let folder = Folder::new();
    let solve = |name: &str, arguments: &[&str]| {
        let all = ["solve", "cornell-box", "--elements", "3000", "--json", "-o", name];
        folder.json(&with(&all, arguments))
    };
    let follow = ["--rays", "300k"];
    let adaptive = solve("a.isolux", &follow);
    let uniform = solve("u.isolux", &["--mesh", "uniform", "--rays", "300k"]);
    let elements = |summary: &serde_json::Value| summary["elements"].as_u64().unwrap();
    assert!((2700..=3000).contains(&elements(&adaptive)) && elements(&uniform) <= 3000, "{adaptive}");
    assert!(folder.fails(2, &["merge", "a.isolux", "u.isolux", "-o", "n.csv"]).contains("different elements"));
    assert!(folder.prints(&["compare", "a.isolux", "u.isolux"]).contains("other elements"));
    // A part of the rays finds the mesh. (How many of the others are traced depends on what they are for.)
    let asked = |summary: &serde_json::Value| summary["parameters"]["rays"].as_str().unwrap().parse::<u64>().unwrap();
    assert!(asked(&adaptive) < asked(&uniform) && asked(&uniform) == 300_000);
    solve("b.isolux", &with(&follow, &["--seed", "2"]));
    solve("c.isolux", &["--method", "stochastic-jacobi", "--rays", "200k"]);
    folder.prints(&["merge", "a.isolux", "b.isolux", "-o", "m.isolux"]);
    folder.prints(&["compare", "a.isolux", "c.isolux"]);
    // Somebody who waits for a draft does not wait for a mesh.
    let drafts = solve("e.isolux", &["--rays", "300k", "--every", "1min", "-o", "e.png"]);
    assert_eq!(elements(&drafts), elements(&uniform));
    // Where there is no time to find it, it is uniform.
    let short = ["--elements", "3000", "--time", "0.01s", "-o", "d.isolux"];
    let short = folder.run(&with(&["solve", "cornell-box"], &short));
    assert!(String::from_utf8_lossy(&short.stderr).contains("the time is too short"), "{short:?}");
    folder.prints(&["compare", "d.isolux", "u.isolux"]);
}

#[test]
fn a_solve_ends_when_it_is_as_accurate_as_was_asked_for() {
    let folder = Folder::new();
    let solve =
        |arguments: &[&str]| folder.json(&[&["solve", "box", "--elements", "300", "--json"], arguments].concat());
    let reached = |summary: &serde_json::Value| summary["accuracy"]["reached"].as_f64().unwrap();
    let coarse = solve(&["--error", "10%"]);
    assert!(reached(&coarse) <= 0.1 && coarse["accuracy"]["met"] == true, "{coarse}");
    let fine = solve(&["--error", "2%", "--confidence", "0.99", "-o", "a.isolux"]);
    assert!(reached(&fine) <= 0.02 && fine["rays"].as_u64() > coarse["rays"].as_u64(), "{fine}");
    let object = solve(&["--error", "0.5%", "--error-of", "object:floor"]);
    assert!(reached(&object) <= 0.005 && object["accuracy"]["of"] == "mean irradiance of 'floor'", "{object}");
    let floor = object["objects"].as_array().unwrap().iter().find(|object| object["name"] == "floor").unwrap();
    let share = floor["mean_error"]["std_error"].as_f64().unwrap() / floor["mean"].as_f64().unwrap();
    assert!(share < 0.005 && 0.5 * share < reached(&object), "{floor}");

    let limited = solve(&["--error", "0.01%", "--rays", "50k"]);
    assert!(limited["rays"].as_u64().unwrap() < 60_000 && limited["accuracy"]["met"] == false, "{limited}");
    assert!(limited["warnings"].to_string().contains("not 0.0100 % as was asked for"), "{limited}");
}

#[test]
fn elements_are_cut_where_others_stand_on_them_if_that_is_asked_for() {
    let folder = Folder::new();
    // Equal elements have few areas.
    let areas = |arguments: &[&str]| {
        let all = ["solve", "cornell-box", "--elements", "2000", "--rays", "30k", "--json", "-o", "lit.csv"];
        assert!(folder.json(&with(&all, arguments))["elements"].as_u64().unwrap() <= 2000);
        let table = String::from_utf8(folder.read("lit.csv")).unwrap();
        let area = |line: &str| line.split(',').nth(10).unwrap().to_owned();
        table.lines().filter(|line| !line.starts_with('#')).map(area).collect::<std::collections::BTreeSet<_>>().len()
    };
    let equal = areas(&["--contacts", "ignore"]);
    assert!(areas(&["--contacts", "cut"]) > 3 * equal, "{equal}");
    areas(&["--contacts", "cut", "--mesh", "adaptive"]);
}
