//! Studies: the published experiments, and those of other people.

use crate::background::in_background;
use crate::fail::Fail;
use isolux_studies::fit::Fit;
use isolux_studies::signs::Verdict;
use isolux_studies::spec::{PlotSpec, Spec};
use isolux_studies::{Error, Options, Outcome, Progress, Study, run};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// The entries of a dict.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Asked {
    /// One of the table, or a name for what `text` says.
    name: String,
    /// A `study.toml`.
    text: Option<String>,
    quick: bool,
    seeds: Option<u64>,
    folder: PathBuf,
    scenes: Option<PathBuf>,
}

/// Runs a study into its folder; `watch(what, points_done, points, share)` is told how far it is. What it found, as JSON, or nothing
/// if it was interrupted; the same call goes on then.
#[pyfunction]
pub fn study(py: Python, asked: Asked, threads: Option<usize>, watch: &Bound<PyAny>) -> Result<Option<String>, Fail> {
    let study = match asked.text {
        // Its text is kept as long as the program runs, like those that come with isolux.
        Some(text) => Study { name: asked.name.leak(), text: text.leak() },
        None => Study::named(&asked.name)?,
    };
    let spec = study.spec()?;
    let options = Options { quick: asked.quick, seeds: asked.seeds, scenes: asked.scenes };
    let folder = asked.folder;
    std::fs::create_dir_all(&folder).map_err(|source| isolux_io::Error::File {
        path: folder.clone(),
        action: "make",
        source,
    })?;

    let latest: Mutex<Option<Progress>> = Mutex::new(None);
    let is_stopped = AtomicBool::new(false);
    let look = || {
        let progress = latest.lock().unwrap_or_else(PoisonError::into_inner).take();
        let told = progress.map_or(Ok(()), |Progress { what, points_done, points, share, .. }| {
            watch.call1((what, points_done, points, share)).map(drop)
        });
        let looked = py.check_signals().and(told);
        is_stopped.fetch_or(looked.is_err(), Ordering::Relaxed);
        looked
    };
    let work = || {
        run(study, options, &folder, |progress| {
            *latest.lock().unwrap_or_else(PoisonError::into_inner) = Some(progress.clone());
            if is_stopped.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
    };
    let outcome: Result<Outcome, Error> = in_background(py, threads, look, work)?;
    match outcome? {
        Outcome::Complete(report) => {
            let fits: Vec<Value> = report.fits.iter().map(fit).collect();
            let verdicts: Vec<Value> = report.verdicts.iter().map(verdict).collect();
            let found = json!({ "title": spec.title, "question": spec.question, "plots": plots(&spec), "fits": fits,
                                "verdicts": verdicts });
            Ok(Some(found.to_string()))
        }
        Outcome::Stopped { .. } => Ok(None),
    }
}

fn plots(spec: &Spec) -> Vec<Value> {
    let plot = |PlotSpec { file, title, x, y, x_label, y_label, guides, series, .. }: &PlotSpec| {
        json!({ "file": file, "title": title, "x": x, "y": y, "x_label": x_label, "y_label": y_label,
                "guides": guides, "series": series })
    };
    spec.plots.iter().map(plot).collect()
}

fn fit(Fit { plot, scene, series, slope }: &Fit) -> Value {
    json!({ "plot": plot, "scene": scene, "series": series, "slope": slope.mean, "low": slope.low, "high": slope.high })
}

fn verdict(Verdict { claim, scene, holds, found, robust }: &Verdict) -> Value {
    json!({ "claim": claim, "scene": scene, "holds": holds, "found": found, "robust": robust })
}
