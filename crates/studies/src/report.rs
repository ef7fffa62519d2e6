//! What a complete run leaves: slopes, ratios, plots and verdicts.

use crate::fit::{self, Fit};
use crate::ratios::{self, Ratio};
use crate::results::{Table, short};
use crate::signs::{self, Verdict};
use crate::spec::Spec;
use crate::{Error, plot};
use isolux_io::files::OutputFile;
use std::path::{Path, PathBuf};

#[derive(Clone, Debug)]
pub struct Report {
    pub title: String,
    pub fits: Vec<Fit>,
    pub verdicts: Vec<Verdict>,
    /// How much faster series are at equal error.
    pub ratios: Vec<Ratio>,
    /// What was written beside the table of results.
    pub files: Vec<PathBuf>,
}

/// Fits, draws and judges `table`, and writes `fits.csv` and `ratios.csv`, if the spec asks for them, and the plots into `folder`.
///
/// # Errors
/// If a file cannot be written.
pub fn write(spec: &Spec, table: &Table, folder: &Path) -> Result<Report, Error> {
    let (fits, verdicts) = (fit::slopes(table, spec), signs::verdicts(table, spec));
    let ratios = ratios::ratios(table, spec);
    let mut files = Vec::new();
    let mut keep = |name: String, bytes: &[u8]| -> Result<(), Error> {
        let path = folder.join(name);
        OutputFile::create(&path)?.finish(bytes)?;
        files.push(path);
        Ok(())
    };
    if !fits.is_empty() {
        keep("fits.csv".to_owned(), slopes_as_csv(&fits).as_bytes())?;
    }
    if !ratios.is_empty() {
        keep("ratios.csv".to_owned(), ratios::as_csv(&ratios).as_bytes())?;
    }
    for spec_of_plot in &spec.plots {
        let svg = plot::svg(spec, spec_of_plot, table)?;
        keep(format!("{}.svg", spec_of_plot.file), svg.as_bytes())?;
        keep(format!("{}.png", spec_of_plot.file), &plot::png(&spec_of_plot.file, &svg)?)?;
    }
    Ok(Report { title: spec.title.clone(), fits, verdicts, ratios, files })
}

fn slopes_as_csv(fits: &[Fit]) -> String {
    let line = |fit: &Fit| {
        let numbers = [fit.slope.mean, fit.slope.low, fit.slope.high].map(short).join(",");
        format!("{},\"{}\",\"{}\",{numbers}\n", fit.plot, fit.scene, fit.series)
    };
    "plot,scene,series,slope,low,high\n".to_owned() + &fits.iter().map(line).collect::<String>()
}
