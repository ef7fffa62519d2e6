//! What a solve came to: for people in words and tables, for programs as one JSON object.

use crate::accuracy::{self, CONFIDENCE, Reached, mean_in_words};
use crate::light_groups;
use crate::numbers::{count, decimals_for, percent, time};
use crate::output::{self, Written};
use crate::progress::rays_in_words;
use crate::report::{Table, balance};
use isolux_core::problem::name_of_side;
use isolux_core::report::{ObjectSummary, per_object};
use isolux_core::solvers::deterministic::DETERMINISTIC;
use isolux_core::{Accuracy, Problem, Solution};
use isolux_io::export::json;
use serde_json::{Map, Value, json};

/// Share of the light that may be lost on the backs of surfaces, or escape, without a word [1].
const NOTICEABLE: f64 = 0.01;
/// What reflects more than this share of some colour is no surface of this world.
const MIRROR: f32 = 0.995;

/// Why a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// All rays were traced.
    Complete,
    TimeLimit,
    Interrupted,
}

/// Everything there is to say.
pub struct Summary<'a> {
    pub problem: &'a Problem,
    pub solution: &'a Solution,
    /// What was asked for.
    pub asked: Option<Accuracy>,
    /// Why the method is biased, if it is.
    pub bias: Option<&'static str>,
    pub ended: Ended,
    /// Time of solving [s], without reading and writing.
    pub seconds: f64,
    pub threads: usize,
    pub outputs: &'a [Written],
}

impl Summary<'_> {
    /// What may not be as it was meant.
    pub fn warnings(&self) -> Vec<String> {
        let balance = &self.solution.balance;
        let lost = balance.back_face / balance.emitted;
        let mut warnings = Vec::new();
        if balance.emitted <= 0.0 {
            warnings.push("nothing emits light, so everything is black; 'isolux check' says more".to_owned());
        }
        if lost > NOTICEABLE {
            warnings.push(format!(
                "{} of the light fell on the backs of one-sided surfaces and was lost: there are gaps, or normals point \
                 the wrong way. What is lit by it is too dark; 'isolux check' shows where to look.",
                percent(lost)
            ));
        }
        if let Some(name) = self.mirror() {
            warnings.push(format!(
                "surfaces of '{name}' reflect all light they receive, or nearly all; between such surfaces light never ends, and what \
                 leaks from there spoils the rest. Bring the base colour below 0.9; 'isolux check' shows where else."
            ));
        }
        if let Some(Reached { accuracy, bound, .. }) = self.missed() {
            let asked = percent(accuracy.error);
            warnings.push(if bound.is_finite() {
                format!("the error is {}, not {asked} as was asked for", percent(bound))
            } else {
                format!("the error is not known yet, so it may be more than the {asked} that was asked for")
            });
        }
        if self.ended == Ended::Interrupted {
            warnings.push("interrupted: this is the best result so far, less than was asked for".to_owned());
        }
        if self.solution.work.replicates < 2 && balance.emitted > 0.0 && !self.is_deterministic() {
            warnings.push(
                "there is no error estimate yet: it takes two complete solutions; give more time or fewer elements"
                    .to_owned(),
            );
        }
        warnings
    }

    /// An object that absorbs next to nothing of some colour.
    fn mirror(&self) -> Option<&str> {
        let mesh = &self.problem.mesh;
        let e = mesh.elements().find(|&e| mesh.reflectivity(e).max_channel() > MIRROR)?;
        Some(&self.problem.scene.objects[self.problem.object(e) as usize].name)
    }

    /// What was reached, if more was asked for.
    fn missed(&self) -> Option<Reached> {
        let is_lit = self.solution.balance.emitted > 0.0;
        Some(self.reached()).filter(|reached| self.asked.is_some() && is_lit && !reached.is_enough())
    }

    fn reached(&self) -> Reached {
        Reached::by(self.problem, self.solution, self.asked)
    }

    fn is_deterministic(&self) -> bool {
        DETERMINISTIC.iter().any(|entry| entry.name == self.solution.provenance.method)
    }

    /// What is good to know: what the reader of the scene assumed, and where light went.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = self.problem.scene.remarks.clone();
        if self.is_deterministic() {
            notes.push("a deterministic method has no error bars; a finer run tells how far it is off".to_owned());
        }
        if self.solution.provenance.parameters.contains(&("light".to_owned(), "indirect".to_owned())) {
            let what = "irradiance is that of reflected light alone, as --light indirect asks; the balance is that of all light";
            notes.push(what.to_owned());
        }
        if let Some(bias) = self.bias.filter(|_| self.asked.is_some()) {
            notes.push(format!("not in the error, as it is no matter of chance: {bias}"));
        }
        let escaped = self.solution.balance.escaped / self.solution.balance.emitted;
        if escaped > NOTICEABLE {
            notes.push(format!("{} of the light left the scene through openings", percent(escaped)));
        }
        notes
    }

    /// One object, without a line break at its end.
    pub fn json(&self) -> String {
        let mut extras = Map::new();
        if let Some(Accuracy { error, confidence, of }) = self.asked {
            let (of, reached) = (accuracy::in_words(of, &self.problem.scene), self.reached().bound);
            let met = self.missed().is_none();
            let accuracy =
                json!({ "asked": error, "confidence": confidence, "of": of, "reached": reached, "met": met });
            extras.insert("accuracy".into(), accuracy);
        }
        extras.insert("seconds".into(), json!(self.seconds));
        extras.insert("rays_per_second".into(), json!(self.solution.work.rays as f64 / self.seconds.max(1e-9)));
        extras.insert("threads".into(), json!(self.threads));
        extras.insert("interrupted".into(), json!(self.ended == Ended::Interrupted));
        extras.insert("outputs".into(), json!(self.outputs));
        extras.insert("remarks".into(), json!(self.notes()));
        extras.insert("warnings".into(), json!(self.warnings()));
        let summary: Value = json::summary(self.problem, self.solution, &extras);
        summary.to_string()
    }

    /// Paragraphs and tables; the table of objects has at most `most_objects` rows.
    pub fn in_words(&self, most_objects: usize) -> String {
        let (scene, work) = (&self.problem.scene, &self.solution.work);
        let mut text = format!(
            "{}: {} elements on {} triangles\n{}",
            crate::terminal::harmless(&scene.name),
            count(self.problem.mesh.len() as u64),
            count(scene.triangles.len() as u64),
            if work.rays > 0 {
                rays_in_words(work.rays, self.seconds)
            } else {
                format!("solved in {}", time(self.seconds))
            },
        );
        text +=
            &format!(", {} {}, seed {}\n", self.threads, plural(self.threads, "thread"), self.solution.provenance.seed);
        text += &self.error();
        text += &light_groups::table(self.problem, self.solution);
        text += &balance(&self.solution.balance);
        text += &self.objects(most_objects);
        if !self.outputs.is_empty() {
            text += &format!("\nWrote {}\n", output::in_words(self.outputs));
        }
        text
    }

    /// How accurate it is, and what more accuracy would cost.
    fn error(&self) -> String {
        let Some(certainty) = &self.solution.certainty else { return String::new() };
        let reached = self.reached();
        if !reached.bound.is_finite() {
            return String::new();
        }
        let mut text = reached.in_words(self.problem);
        text += &mean_in_words(certainty);
        let next = if reached.is_enough() { 0.5 * reached.bound } else { reached.accuracy.error };
        let more = (reached.bound / next).powi(2) - 1.0;
        let (rays, seconds) = (round(more * self.solution.work.rays as f64), time(more * self.seconds));
        text + &format!("For {} it takes about {rays} more rays, {seconds}\n", percent(next))
    }

    fn objects(&self, most: usize) -> String {
        let mut objects = per_object(self.problem, self.solution);
        objects.sort_by(|a, b| b.area.total_cmp(&a.area));
        let shown = &objects[..most.min(objects.len())];
        let decimals = decimals_for(middle(shown.iter().map(|o| o.mean)), 4);
        let area_decimals = decimals_for(middle(shown.iter().map(|o| o.area)), 3);
        let mut table = Table::new(&["object", "area [m²]", "mean", "± 95 %", "min", "max"]);
        for ObjectSummary { name, side, area, mean, min, max, certainty, .. } in shown {
            let lux = |value: f64| format!("{value:.decimals$}");
            let margin = certainty.map_or(String::new(), |mean| lux(mean.margin(CONFIDENCE)));
            table.row(
                &name_of_side(name, *side),
                [format!("{area:.area_decimals$}"), lux(*mean), margin, lux(*min), lux(*max)],
            );
        }
        let mut text = format!("\nIrradiance [lux], largest objects first\n{}", table.lines());
        if shown.len() < objects.len() {
            text += &format!("  and {} more; --objects all shows them\n", count((objects.len() - shown.len()) as u64));
        }
        text
    }
}

/// A number of rays with two digits, as `--rays` takes it: `3.8M`.
fn round(rays: f64) -> String {
    let step = 10f64.powi(rays.log10().floor() as i32 - 1);
    match (rays / step).ceil() * step {
        n if n < 1e6 => format!("{}k", (n / 1e3).ceil()),
        n if n < 1e7 => format!("{:.1}M", n / 1e6),
        n if n < 1e9 => format!("{:.0}M", n / 1e6),
        n => format!("{:.1}G", n / 1e9),
    }
}

/// The median, 0 of nothing.
fn middle(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or_default()
}

/// `word`, in the plural unless `number` is one.
pub fn plural(number: usize, word: &str) -> String {
    if number == 1 { word.to_owned() } else { format!("{word}s") }
}
