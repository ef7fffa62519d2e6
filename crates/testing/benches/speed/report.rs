//! Turns criterion's medians into the page `docs/performance.md`: rates, and ratios to Embree.

use crate::rays::RAYS;
use crate::{ROUNDS, end_to_end};
use anyhow::{Context, Result};
use isolux_studies::machine::processor;
use std::env;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Name of the group that measures the build.
pub const BUILD: &str = "build";

/// What is asked about a scene.
#[derive(Clone, Copy, Debug)]
pub enum Question {
    Incoherent,
    Sorted,
    Shadow,
    ShadowClosest,
}

impl Question {
    pub const ALL: [Question; 4] = [Question::Incoherent, Question::Sorted, Question::Shadow, Question::ShadowClosest];

    fn name(self) -> &'static str {
        match self {
            Question::Incoherent => "closest hit, incoherent",
            Question::Sorted => "closest hit, sorted",
            Question::Shadow => "any hit, shadow rays",
            Question::ShadowClosest => "closest hit, shadow rays",
        }
    }

    /// Name of the group that asks it about `scene`.
    pub fn group(self, scene: &str) -> String {
        format!("{scene}, {}", self.name())
    }
}

/// What was counted rather than timed about a scene.
pub struct Facts {
    pub name: &'static str,
    pub triangles: usize,
    /// Memory of the ray structure.
    pub bytes: usize,
    /// Rays that the last contestant sees end elsewhere than the first.
    pub differing: usize,
}

/// Writes the page to the path in `BENCH_REPORT`, if that is set, from what criterion left in `CRITERION_HOME`.
pub fn write(facts: &[Facts]) -> Result<()> {
    let Some(path) = env::var_os("BENCH_REPORT") else { return Ok(()) };
    let home = env::var_os("CRITERION_HOME").context("CRITERION_HOME is where the medians are: set it")?;
    let page = page(facts, &PathBuf::from(home))?;
    std::fs::write(&path, page).with_context(|| format!("{} cannot be written", PathBuf::from(&path).display()))
}

fn page(facts: &[Facts], home: &Path) -> Result<String> {
    let embree = cfg!(feature = "embree");
    let mut page = include_str!("head.md").to_owned();
    let cores = std::thread::available_parallelism()?;
    let date = env::var("BENCH_DATE").unwrap_or_else(|_| "unknown".to_owned());
    writeln!(page, "Machine: {}, {cores} cores. Date: {date}.\n", processor())?;
    if !embree {
        page += "This run was made without Embree: its columns are empty. `make bench EMBREE=1` fills them.\n\n";
    }
    page += "| scene | triangles | question | isolux | portable | Embree | isolux / Embree |\n|---|---|---|---|---|---|---|\n";
    for scene in facts {
        for question in Question::ALL {
            let group = question.group(scene.name);
            let isolux = medians(home, &group, "isolux", ROUNDS)?;
            let portable = medians(home, &group, "isolux, portable", ROUNDS)?;
            let embree = if embree { medians(home, &group, "Embree", ROUNDS)? } else { Vec::new() };
            let rate = |ns: &[f64]| {
                if ns.is_empty() { String::new() } else { format!("{:.2}", RAYS as f64 * 1e3 / middle(ns)) }
            };
            let ratios: Vec<f64> = embree.iter().zip(&isolux).map(|(embree, isolux)| embree / isolux).collect();
            let ratio = if ratios.is_empty() { String::new() } else { format!("**{:.2}**", middle(&ratios)) };
            let (name, triangles, question) = (scene.name, scene.triangles, question.name());
            let rates = [&isolux, &portable, &embree].map(|ns| rate(ns));
            writeln!(page, "| {name} | {triangles} | {question} | {} | {ratio} |", rates.join(" | "))?;
        }
    }
    page += "\n| scene | bytes a triangle |";
    page += if embree { " rays that end elsewhere in Embree |\n|---|---|---|\n" } else { "\n|---|---|\n" };
    for scene in facts {
        write!(page, "| {} | {:.0} |", scene.name, scene.bytes as f64 / scene.triangles as f64)?;
        page += &if embree { format!(" {} of {RAYS} |\n", scene.differing) } else { "\n".to_owned() };
    }
    let seconds = |who| medians(home, BUILD, who, 1).map(|ns| format!("{:.2} s", middle(&ns) * 1e-9));
    let (name, triangles) = facts.last().map_or(("", 0), |scene| (scene.name, scene.triangles));
    write!(page, "\nBuild of {name}, {triangles} triangles, on all cores: isolux {}", seconds("isolux")?)?;
    page += &if embree { format!(", Embree {}.\n", seconds("Embree")?) } else { ".\n".to_owned() };
    page += include_str!("notes.md");
    page += include_str!("end_to_end.md");
    page += &end_to_end::table()?;
    Ok(page)
}

/// Median time of each round [ns].
fn medians(home: &Path, group: &str, who: &str, rounds: usize) -> Result<Vec<f64>> {
    let median = |round: usize| {
        let path = home.join(group).join(who).join(round.to_string()).join("new/estimates.json");
        let text = std::fs::read(&path).with_context(|| format!("{} is missing", path.display()))?;
        let estimates: serde_json::Value = serde_json::from_slice(&text)?;
        estimates["median"]["point_estimate"].as_f64().with_context(|| format!("{} has no median", path.display()))
    };
    (0..rounds).map(median).collect()
}

/// The median of a few numbers.
fn middle(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}
