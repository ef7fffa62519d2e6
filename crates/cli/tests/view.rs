//! `isolux view`, and the options of `solve --live`. What the page shows is tested in a browser (`make test-viewer`).

#![allow(clippy::unwrap_used)]

mod common;

use common::{Folder, SMALL, with};

/// Whether the program has the viewer in it.
fn has_viewer(folder: &Folder) -> bool {
    let output = folder.run(&with(&["solve"], &with(&SMALL, &["-o", "probe.html"])));
    if output.status.success() {
        return true;
    }
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("without the viewer") && message.contains("make viewer"), "{message}");
    assert_eq!((output.status.code(), folder.names()), (Some(2), vec![]));
    false
}

#[test]
fn a_solution_becomes_a_page_beside_one() {
    let folder = Folder::new();
    if !has_viewer(&folder) {
        return;
    }
    folder.prints(&with(&["solve"], &with(&SMALL, &["-o", "lit.isolux"])));
    let said = folder.prints(&["view", "lit.isolux", "--no-open"]);
    assert!(said.starts_with("Wrote lit.html ("), "{said}");
    folder.prints(&["view", "lit.isolux", "-o", "again.HTML", "--before", "lit.isolux", "-q"]);
    assert!(folder.read("again.HTML").starts_with(b"<!doctype html>"));
    folder.prints(&["render", "lit.isolux", "-o", "rendered.html"]);
    assert!(folder.read("rendered.html") == folder.read("lit.html"), "one page, whoever writes it");
}

#[test]
fn what_cannot_be_viewed_is_refused_and_nothing_is_written() {
    let folder = Folder::new();
    if !has_viewer(&folder) {
        return;
    }
    folder.prints(&with(&["solve"], &with(&SMALL, &["-o", "lit.isolux"])));
    let names = folder.names();
    assert!(folder.fails(2, &["view", "lit.isolux", "-o", "lit.png"]).contains(".html file"));
    assert!(folder.fails(2, &["view", "none.isolux", "--no-open"]).contains("no file 'none.isolux'"));
    assert!(folder.fails(2, &["view", "lit.isolux", "--camera", "nowhere", "--no-open"]).contains("camera"));
    assert!(folder.fails(2, &["view", "lit.isolux", "--before", "none.isolux", "--no-open"]).contains("none.isolux"));
    folder.write("lit.html", b"mine");
    assert!(folder.fails(2, &["view", "lit.html", "--no-open"]).contains("would replace the input"));
    assert_eq!(folder.read("lit.html"), b"mine");
    assert_eq!(folder.names().len(), names.len() + 1);
}

#[test]
fn options_of_the_live_page_need_it() {
    let folder = Folder::new();
    for option in [&["--port", "8000"][..], &["--no-open"]] {
        assert!(folder.fails(2, &with(&["solve", "box"], option)).contains("--live"));
    }
    assert!(folder.fails(2, &["solve", "box", "--live", "--port", "0"]).contains("--port"));
}
