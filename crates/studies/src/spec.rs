//! `study.toml`: the question, and all that is needed to answer it.

use crate::Error;
use serde::Deserialize;
use std::collections::BTreeMap;

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Spec {
    /// A few words for lists.
    pub title: String,
    /// What it asks, and what was published.
    pub question: String,
    /// What is measured, by its name in [`crate::measures::MEASURES`].
    pub measure: String,
    pub scenes: Vec<SceneSpec>,
    /// Where each series is measured: numbers of rays, of lines or of elements, as the measure says.
    pub at: Vec<f64>,
    /// Runs of each point, with seeds from 1.
    pub seeds: u64,
    /// Rays of the reference solution of a scene without an exact one.
    pub reference_rays: Option<f64>,
    pub series: Vec<Series>,
    pub plots: Vec<PlotSpec>,
    /// Whether to say how much faster series are at equal error.
    pub equal_error: Option<EqualError>,
    #[serde(default)]
    pub signs: Vec<Sign>,
    /// What differs in a quick run.
    quick: Quick,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SceneSpec {
    /// As plots call it.
    pub name: String,
    /// A built-in scene with its parameters.
    pub scene: Option<String>,
    /// Instead: a file in the folder of scenes that are no part of isolux. Without it the scene is left out.
    pub file: Option<String>,
    pub elements: u64,
    /// Irradiance [lux] on all elements, where it is known.
    pub exact: Option<f64>,
    /// The last place where anything is measured in it.
    pub up_to: Option<f64>,
}

/// How much faster series are at equal error, in every plot of an error against time: see [`crate::ratios`].
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct EqualError {
    /// The series that all are held against.
    pub against: String,
    /// When a series has the error that the other one has to reach.
    pub at: f64,
}

/// A curve of a plot.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Series {
    pub name: String,
    /// The last place where it is measured.
    pub up_to: Option<f64>,
    /// Number of its colour, and whether its line is dashed.
    #[serde(default)]
    pub colour: usize,
    #[serde(default)]
    pub dashed: bool,
    /// What else the measure is told: `method`, and the axes as the command line calls them.
    #[serde(flatten)]
    pub axes: BTreeMap<String, String>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PlotSpec {
    /// Name of the files, without extension.
    pub file: String,
    pub title: String,
    /// Columns of the table.
    pub x: String,
    pub y: String,
    pub x_label: String,
    pub y_label: String,
    /// Slopes that are drawn for comparison.
    #[serde(default)]
    pub guides: Vec<f64>,
    /// Whether slopes are fitted, and from which x.
    #[serde(default = "yes")]
    pub fit: bool,
    #[serde(default)]
    pub fit_from: f64,
    /// Series that are drawn; all if empty.
    #[serde(default)]
    pub series: Vec<String>,
}

fn yes() -> bool {
    true
}

/// How a claim shows in the fits of a plot.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Sign {
    pub claim: String,
    pub plot: String,
    pub series: String,
    /// Names of scenes; all if empty.
    #[serde(default)]
    pub scenes: Vec<String>,
    /// The confidence interval of the slope meets this interval.
    pub slope: Option<[f64; 2]>,
    /// The slope is lower than that of this series.
    pub steeper_than: Option<String>,
    /// At the last common place, y is between so many times that of a series: `[low, high]`.
    pub times: Option<[f64; 2]>,
    pub of: Option<String>,
    /// At this x, y lies between `value[0]` and `value[1]`.
    pub where_x: Option<f64>,
    pub value: Option<[f64; 2]>,
    /// The series that all are held against takes so many times as long to the same error: `[low, high]`.
    pub faster: Option<[f64; 2]>,
    /// Whether continuous integration holds it in quick runs.
    #[serde(default)]
    pub robust: bool,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Quick {
    scenes: Option<Vec<String>>,
    at: Option<Vec<f64>>,
    seeds: Option<u64>,
    reference_rays: Option<f64>,
}

impl Spec {
    /// # Errors
    /// [`Error::Spec`] with the place in `text`.
    pub fn parse(study: &str, text: &str) -> Result<Spec, Error> {
        toml::from_str(text).map_err(|error| Error::Spec { study: study.to_owned(), what: error.to_string() })
    }

    /// The same with what differs in a quick run.
    pub fn quick(&self) -> Spec {
        let mut spec = self.clone();
        if let Some(names) = &self.quick.scenes {
            spec.scenes.retain(|scene| names.contains(&scene.name));
        }
        spec.at = self.quick.at.clone().unwrap_or(spec.at);
        spec.seeds = self.quick.seeds.unwrap_or(spec.seeds);
        spec.reference_rays = self.quick.reference_rays.or(spec.reference_rays);
        spec
    }

    /// Whether a point of both is measured in the same way; plots, signs and where they measure may differ.
    pub fn measures_as(&self, other: &Spec) -> bool {
        let same =
            |a: &SceneSpec, b: &SceneSpec| (a.source(), a.elements, a.exact) == (b.source(), b.elements, b.exact);
        let common =
            |scene: &SceneSpec| other.scenes.iter().all(|known| known.name != scene.name || same(known, scene));
        let agrees =
            |series: &Series| other.series.iter().all(|known| known.name != series.name || known.axes == series.axes);
        let what = |spec: &Spec| (spec.measure.clone(), spec.reference_rays);
        what(self) == what(other) && self.series.iter().all(agrees) && self.scenes.iter().all(common)
    }

    /// Looks for names that are not there.
    ///
    /// # Errors
    /// A sentence.
    pub fn check(&self, columns: &[&str]) -> Result<(), String> {
        let series: Vec<&str> = self.series.iter().map(|series| series.name.as_str()).collect();
        let plots: Vec<&str> = self.plots.iter().map(|plot| plot.file.as_str()).collect();
        let among = |name: &String, names: &[&str]| match names.contains(&name.as_str()) {
            true => Ok(()),
            false => Err(format!("there is no '{name}' among {}", names.join(", "))),
        };
        for plot in &self.plots {
            for column in [&plot.x, &plot.y].into_iter().filter(|&column| column != "at") {
                among(column, columns)?;
            }
            plot.series.iter().try_for_each(|name| among(name, &series))?;
        }
        if let Some(wrong) = self.scenes.iter().find(|scene| scene.scene.is_some() == scene.file.is_some()) {
            return Err(format!("'{}' is either a scene or a file", wrong.name));
        }
        if let Some(equal_error) = &self.equal_error {
            among(&equal_error.against, &series)?;
        }
        for sign in &self.signs {
            among(&sign.plot, &plots)?;
            let names = [Some(&sign.series), sign.steeper_than.as_ref(), sign.of.as_ref()];
            names.into_iter().flatten().try_for_each(|name| among(name, &series))?;
        }
        let tests = |sign: &Sign| {
            let relative = [sign.steeper_than.is_some(), sign.times.is_some(), sign.faster.is_some()];
            [&[sign.slope.is_some(), sign.value.is_some()], &relative[..]].concat()
        };
        match self.signs.iter().find(|sign| tests(sign).iter().filter(|&&is| is).count() != 1) {
            Some(sign) => Err(format!("'{}' needs one of slope, steeper-than, times, value and faster", sign.claim)),
            None if self.scenes.is_empty() || self.at.is_empty() => Err("there is nothing to measure".to_owned()),
            None => Ok(()),
        }
    }
}

impl SceneSpec {
    /// The built-in scene, or the file.
    pub fn source(&self) -> &str {
        self.file.as_ref().or(self.scene.as_ref()).map_or("", String::as_str)
    }
}

impl Sign {
    /// Whether it is looked for in the scene of that name.
    pub fn concerns(&self, scene: &str) -> bool {
        self.scenes.is_empty() || self.scenes.iter().any(|name| name == scene)
    }
}

impl PlotSpec {
    pub fn shows(&self, series: &str) -> bool {
        self.series.is_empty() || self.series.iter().any(|name| name == series)
    }
}
