//! Every study runs quick, and shows what is robust in its claims; and a study that is stopped goes on as if it had not been.

#![allow(clippy::unwrap_used)]

use isolux_studies::{Error, Options, Outcome, Progress, STUDIES, Study, run};
use std::ops::ControlFlow;
use std::path::Path;

const QUICK: Options = Options { quick: true, seeds: None, scenes: None };

fn shows_its_robust_signs(name: &str) {
    let folder = tempfile::tempdir().unwrap();
    let outcome = run(Study::named(name).unwrap(), QUICK, folder.path(), |_| ControlFlow::Continue(())).unwrap();
    let Outcome::Complete(report) = outcome else { panic!("nobody has stopped it") };
    let robust: Vec<_> = report.verdicts.iter().filter(|verdict| verdict.robust).collect();
    assert!(!robust.is_empty(), "{name} claims nothing that is robust");
    for verdict in robust {
        assert!(verdict.holds, "{name}, {}: {} ({})", verdict.scene, verdict.claim, verdict.found);
    }
    for file in &report.files {
        assert!(std::fs::metadata(file).unwrap().len() > 100, "{}", file.display());
    }
}

macro_rules! quick {
    ($($test:ident = $name:literal),+ $(,)?) => {
        $(#[test] fn $test() { shows_its_robust_signs($name); })+

        #[test]
        fn every_study_is_tried() {
            let tried = [$($name),+];
            assert!(STUDIES.iter().map(|study| study.name).eq(tried), "{tried:?}");
        }
    };
}

quick! {
    order = "order",
    lines = "lines",
    walk = "walk",
    sequences = "sequences",
    form_factor_variance = "form-factor-variance",
    warm_up = "warm-up",
    variance = "variance",
    cost = "cost",
    ray_count = "ray-count",
    speed = "speed",
    coverage = "coverage",
}

/// Runs the study of ray counts until `points` are measured.
fn stopped_after(points: usize, folder: &Path) -> Outcome {
    let study = Study::named("ray-count").unwrap();
    let stop = |progress: &Progress| {
        if progress.points_done >= points { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    run(study, Options { seeds: Some(2), ..QUICK }, folder, stop).unwrap()
}

#[test]
fn a_study_that_is_stopped_goes_on_from_there() {
    let [whole, parts] = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    assert!(matches!(stopped_after(usize::MAX, whole.path()), Outcome::Complete(_)));
    for points in [0, 5, 11] {
        let Outcome::Stopped { points_done, .. } = stopped_after(points, parts.path()) else { panic!("{points}") };
        assert_eq!(points_done, points);
    }
    assert!(matches!(stopped_after(usize::MAX, parts.path()), Outcome::Complete(_)));
    for file in ["result.csv", "fits.csv", "ninety.svg", "ninety.png"] {
        let [a, b] = [&whole, &parts].map(|folder| std::fs::read(folder.path().join(file)).unwrap());
        assert!(a == b, "{file} differs");
    }
}

#[test]
fn a_folder_of_another_study_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    stopped_after(1, folder.path());
    let before = std::fs::read(folder.path().join("result.csv")).unwrap();
    for (name, quick) in [("order", true), ("ray-count", false)] {
        let options = Options { quick, seeds: Some(1), scenes: None };
        let error = run(Study::named(name).unwrap(), options, folder.path(), |_| ControlFlow::Break(())).unwrap_err();
        assert!(matches!(error, Error::OtherRun { .. }), "{error}");
        assert!(error.to_string().contains("choose another folder"), "{error}");
    }
    assert_eq!(std::fs::read(folder.path().join("result.csv")).unwrap(), before);
}
