//! `isolux factors` as a new user would try it.

#![allow(clippy::unwrap_used)]

mod common;

use common::Folder;

#[test]
fn every_way_writes_every_format_and_says_how_good_it_is() {
    let folder = Folder::new();
    for by in ["contour", "hemicube", "local-lines"] {
        let files = ["npz", "csv", "mtx"].map(|extension| format!("{by}.{extension}"));
        let mut arguments = vec!["factors", "box", "--elements", "48", "--by", by];
        files.iter().for_each(|file| arguments.extend(["-o", file]));
        let text = folder.prints(&arguments);
        for word in ["48 elements", "row sums", "Reciprocity", "Wrote"] {
            assert!(text.contains(word), "{word}: {text}");
        }
        assert_eq!(text.contains("Standard error"), by == "local-lines");
        let table = String::from_utf8(folder.read(&files[1])).unwrap();
        let mut sums = [0.0; 48];
        for line in table.lines().skip(1) {
            let cells: Vec<&str> = line.split(',').collect();
            sums[cells[0].parse::<usize>().unwrap()] += cells[2].parse::<f64>().unwrap();
        }
        assert!(sums.iter().all(|sum| (sum - 1.0).abs() < 1e-6), "{by}: {sums:?}");
        let matrix = String::from_utf8(folder.read(&files[2])).unwrap();
        assert!(matrix.lines().any(|line| line == format!("48 48 {}", table.lines().count() - 1)));
        assert!(matrix.contains(&format!("% by = {by}")));
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes_for_any_number_of_threads() {
    let folder = Folder::new();
    let bytes = |threads: &str, seed: &str| {
        let arguments = ["factors", "cubes", "--elements", "100", "--by", "local-lines", "--rays", "1k"];
        folder.prints(&[&arguments[..], &["--threads", threads, "--seed", seed, "-o", "F.npz"]].concat());
        folder.read("F.npz")
    };
    let one = bytes("1", "1");
    assert!(one == bytes("3", "1") && one != bytes("1", "2"));
}

#[test]
fn corrections_are_made_and_reported() {
    let folder = Folder::new();
    let summary = |law: &str| {
        let arguments = ["factors", "box", "--elements", "48", "--by", "local-lines", "--rays", "200", "--json"];
        folder.json(&[&arguments[..], &["--correct", law]].concat())
    };
    assert!(summary("none")["reciprocity"]["relative_rms"].as_f64().unwrap() > 1e-3);
    let closed = summary("enclosure");
    assert!(closed["reciprocity"]["relative_rms"].as_f64().unwrap() < 1e-12);
    assert!((closed["row_sum"]["min"].as_f64().unwrap() - 1.0).abs() < 1e-9);
}

#[test]
fn what_cannot_be_done_is_said_before_the_work() {
    let folder = Folder::new();
    folder.write("F.npz", b"old");
    let fails = |arguments: &[&str]| folder.fails(2, &[&["factors"], arguments].concat());
    assert!(fails(&["box", "--elements", "20k", "-o", "F.npz"]).contains("100 million"));
    assert!(fails(&["box", "-o", "F.glb"]).contains(".npz, .csv, .mtx"));
    assert!(fails(&["box", "--by", "hemicube", "--resolution", "7", "-o", "F.npz"]).contains("even number"));
    assert!(fails(&["box", "--by", "sphere", "-o", "F.npz"]).contains("'sphere'"));
    assert!(fails(&["sphere", "-o", "F.npz"]).contains("flat elements"));
    assert_eq!((folder.read("F.npz"), folder.names()), (b"old".to_vec(), vec!["F.npz".to_owned()]));
}
