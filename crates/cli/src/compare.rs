//! `isolux compare`: how two solutions differ, and whether their error bars explain it.

use crate::failure::Failure;
use crate::input;
use crate::interrupt::watch;
use crate::numbers::{count, decimals_for, digits, percent};
use crate::terminal;
use isolux_core::compare::{Comparison, Means, compare};
use isolux_core::problem::name_of_side;
use isolux_core::{Error, Problem, Solution};
use serde_json::json;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  isolux solve room.glb --seed 1 -o a.isolux
  isolux solve room.glb --seed 2 -o b.isolux
  isolux compare a.isolux b.isolux

z is the difference of an element divided by its standard deviation. Of two independent, unbiased solutions with
honest error bars z has mean 0 and standard deviation 1, and 0.3 % of the elements are beyond 3. Behind ± are \
standard errors.";

/// Compare two solutions of the same scene
///
/// Differences are of irradiance in lux, weighted by area. If the scene is cut into other elements, the second solution is averaged on those of
/// the first: what elements hide is part of the difference then, and error bars are compared of means only.
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Compare {
    /// A .isolux file
    a: PathBuf,

    /// Another one
    b: PathBuf,

    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

impl Compare {
    pub fn run(self) -> Result<u8, Failure> {
        watch(move |_, _| {
            let (problem, a) = input::solution(&self.a)?;
            let (other, b) = input::solution(&self.b)?;
            let comparison = compare(&problem, &a, &other, &b).map_err(|error| {
                let help = match error {
                    Error::NotComparable { .. } => "solve the same file with the same lights and materials",
                    _ => "solve the scene again",
                };
                Failure::usage(format!("{}, {}: {error}", self.a.display(), self.b.display())).with_help(help)
            })?;
            drop(other);
            let remarks = remarks(&a, &b);
            if self.json {
                return terminal::print(&as_json(&comparison, [&a, &b], &remarks)).map(|()| 0);
            }
            remarks.iter().for_each(|remark| terminal::warn(remark));
            terminal::print(&in_words(&problem, &comparison)).map(|()| 0)
        })
    }
}

/// What speaks against taking the scores at their word.
fn remarks(a: &Solution, b: &Solution) -> Vec<String> {
    let mut remarks = Vec::new();
    if a.provenance.seed == b.provenance.seed {
        remarks.push(format!("both have seed {}: they may not be independent, so z says little", a.provenance.seed));
    }
    remarks
}

fn as_json(comparison: &Comparison, solutions: [&Solution; 2], remarks: &[String]) -> String {
    let mut object = json!(comparison);
    object["solutions"] = json!(solutions.map(|s| json!({ "provenance": s.provenance, "work": s.work })));
    object["remarks"] = json!(remarks);
    object["version"] = json!(isolux_core::VERSION);
    format!("{object}\n")
}

fn in_words(problem: &Problem, c: &Comparison) -> String {
    let mut text = format!("{}: {} elements\n", terminal::harmless(&problem.scene.name), count(c.elements as u64));
    if let Some(others) = c.other_elements {
        text += &format!("  other elements      {} of the second solution, averaged on these\n", count(others as u64));
    }
    text += &format!("  RMS difference      {} of the mean irradiance", percent(c.rms));
    if c.expected_rms.is_finite() {
        text += &format!("; the error bars let expect {}", percent(c.expected_rms));
    }
    text.push('\n');
    let [a, b] = c.largest.irradiance;
    if a == b {
        text += "  largest difference  none\n";
    } else {
        let object = &problem.scene.objects[problem.object(c.largest.element) as usize];
        let place = format!("element {} on '{}'", c.largest.element, terminal::harmless(&object.name));
        text += &format!("  largest difference  {} and {} lux, {place}\n", digits(a, 4), digits(b, 4));
    }
    let [a, b] = c.power;
    text += &format!("  power               {} and {} lm", digits(a, 6), digits(b, 6));
    if a != b {
        text += &format!(", {} apart", percent(2.0 * (a - b).abs() / (a + b)));
    }
    text.push('\n');
    if let Some(means) = &c.mean {
        text += &format!("  mean irradiance     {}\n", means_in_words(means));
    }
    if let Some(worst) = c.objects.iter().max_by(|a, b| a.means.z.abs().total_cmp(&b.means.z.abs())) {
        text += &format!(
            "  least alike object  {}, '{}'\n",
            means_in_words(&worst.means),
            terminal::harmless(&name_of_side(&worst.name, worst.side))
        );
    }
    text += &match c.z {
        None if c.other_elements.is_some() => {
            "  z                   unknown: the elements are not the same\n".to_owned()
        }
        None => "  z                   unknown: there are no error bars\n".to_owned(),
        Some(z) => format!(
            "  z                   mean {:.3}, standard deviation {:.3}, {} beyond 3, over {} elements\n",
            z.mean,
            z.std_dev,
            percent(z.beyond_3),
            count(z.elements as u64)
        ),
    };
    text
}

/// `312.1 ± 0.8 and 313.0 ± 0.9 lux, 0.75 standard deviations apart`, with standard errors.
fn means_in_words(means: &Means) -> String {
    let decimals = decimals_for(means.std_error[0].max(means.std_error[1]), 2);
    let [a, b] = [0, 1].map(|k| format!("{:.decimals$} ± {:.decimals$}", means.irradiance[k], means.std_error[k]));
    format!("{a} and {b} lux, {:.2} standard deviations apart", means.z.abs())
}
