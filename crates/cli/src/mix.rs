//! `isolux mix`: the lamps of a solution dimmed and coloured, without solving again.

use crate::accuracy::{Reached, mean_in_words};
use crate::failure::Failure;
use crate::numbers::count;
use crate::writing::{Made, WritingArguments};
use crate::{input, light_groups, report, terminal};
use isolux_core::math::Rgb;
use isolux_core::solution::GroupLight;
use isolux_core::superposition::mix;
use isolux_core::{Error, Problem, Solution};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  isolux solve office --light-groups objects -o lit.isolux
  isolux mix lit.isolux                                     what groups there are, and what each gives
  isolux mix lit.isolux --set 'window 1=0' -o evening.png
  isolux mix lit.isolux --set '*=0' --set 'pendant 1=1.5*#ff8040' -o one-lamp.png -o one-lamp.isolux
  isolux mix lit.isolux --set 'window 1=1,0.9,0.7' -o warm.glb

A factor is of what a group emitted when it was solved, so 1 is that again, and a lamp that was mixed to 0 can be switched on again from \
the new file. Colours work like a filter before the lamp: #rrggbb is sRGB, as on a screen, and #ffffff changes nothing; \
three numbers are linear red, green and blue. All that is not set stays as it is in the file; of several settings of a group the last one counts.

Irradiance and its error bars are exact for any factors. Error bars of means and where the light went are known as luminance only, so \
with colours they are taken to change with the means and with the emitted flux.";

/// Dim and colour the lamps of a solution without solving again
///
/// It takes a solution of 'isolux solve --light-groups'. The result is a solution like any other, of a scene whose lamps
/// emit so much: pictures show the lamps dimmed, too. The groups are kept, so it can be mixed again.
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = EXAMPLES, mut_arg("outputs", |outputs| outputs.required(false)))]
pub struct Mix {
    /// A .isolux file, solved with --light-groups
    solution: PathBuf,

    /// What a group emits: NAME=0.3 is a factor, NAME=#ffcc88 a filter, NAME=0.3*#ffcc88 both, NAME=1,0.8,0.5 a linear
    /// factor for each channel; the name * means all groups. Repeat it for several
    #[arg(long = "set", value_name = "NAME=FACTOR", value_parser = parse_setting)]
    settings: Vec<Setting>,

    #[command(flatten)]
    writing: WritingArguments,
}

/// One `--set`.
#[derive(Clone, Debug, PartialEq)]
struct Setting {
    name: String,
    factor: Rgb,
}

/// Names may have an equals sign in them, factors have none.
fn parse_setting(text: &str) -> Result<Setting, String> {
    let (name, factor) = text.rsplit_once('=').ok_or("give NAME=FACTOR, like 'Lamp 1=0.3'")?;
    let is_known = |factor: &Rgb| factor.is_finite() && factor.to_array().iter().all(|&channel| channel >= 0.0);
    let factor = parse_factor(factor.trim()).filter(is_known).ok_or_else(|| {
        format!("'{factor}' is no factor: give 0.3, #ffcc88, 0.3*#ffcc88, or 1,0.8,0.5, with nothing below 0")
    })?;
    Ok(Setting { name: name.trim().to_owned(), factor })
}

fn parse_factor(text: &str) -> Option<Rgb> {
    if let Some((factor, color)) = text.split_once('*') {
        return Some(parse_color(color.trim())? * factor.trim().parse::<f32>().ok()?);
    }
    if text.starts_with('#') {
        return parse_color(text);
    }
    let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    match numbers?[..] {
        [grey] => Some(Rgb::grey(grey)),
        [r, g, b] => Some(Rgb::new(r, g, b)),
        _ => None,
    }
}

/// Linear value of `#rrggbb`.
fn parse_color(text: &str) -> Option<Rgb> {
    let digits = text
        .strip_prefix('#')
        .filter(|digits| digits.len() == 6 && digits.bytes().all(|digit| digit.is_ascii_hexdigit()))?;
    let [_, r, g, b] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
    Some(Rgb::from_srgb8([r, g, b]))
}

impl Mix {
    pub fn run(self) -> Result<u8, Failure> {
        let Mix { solution: path, settings, writing } = self;
        writing.run(vec![path.clone()], move |display| {
            display.stage("reading the solution");
            let (problem, solution) = input::solution(&path)?;
            let factors = factors(&path, &solution.groups, &settings)?;
            display.stage("mixing");
            let (problem, solution) = mix(&problem, solution, &factors)?;
            let words = in_words(&problem, &solution);
            Ok(Made { problem, solution, words })
        })
    }
}

/// The factor of each group, as it is in the file but for the `settings`.
fn factors(path: &Path, groups: &[GroupLight], settings: &[Setting]) -> Result<Vec<Rgb>, Failure> {
    if groups.is_empty() {
        let what = format!("{}: it has no light groups: all light was solved together", path.display());
        return Err(Failure::usage(what).with_help("'isolux solve SCENE --light-groups objects' keeps the lamps apart"));
    }
    let mut factors: Vec<Rgb> = groups.iter().map(|part| part.factor).collect();
    for Setting { name, factor } in settings {
        let mut is_known = false;
        for (part, of_group) in groups.iter().zip(&mut factors) {
            if name == "*" || *name == part.group.name {
                (*of_group, is_known) = (*factor, true);
            }
        }
        if !is_known {
            let names = || groups.iter().map(|part| part.group.name.as_str());
            let error = Failure::from(Error::unknown_name("light group", name, names()));
            return Err(error.with_help(format!("there are {}", names().collect::<Vec<_>>().join(", "))));
        }
    }
    Ok(factors)
}

fn in_words(problem: &Problem, solution: &Solution) -> String {
    let mut text = format!(
        "{}: {} elements, {} light groups\n{}",
        terminal::harmless(&problem.scene.name),
        count(problem.mesh.len() as u64),
        solution.groups.len(),
        Reached::by(problem, solution, None).in_words(problem)
    );
    text += &solution.certainty.as_ref().map_or(String::new(), mean_in_words);
    text + &light_groups::table(problem, solution) + &report::balance(&solution.balance)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor(text: &str) -> Rgb {
        parse_setting(&format!("a = b={text}")).unwrap().factor
    }

    #[test]
    fn a_lamp_is_dimmed_or_coloured_or_both() {
        assert_eq!(parse_setting("a=b=0.5"), Ok(Setting { name: "a=b".to_owned(), factor: Rgb::grey(0.5) }));
        assert_eq!(factor("0"), Rgb::BLACK);
        assert_eq!(factor("#ffffff"), Rgb::WHITE);
        assert_eq!(factor("2*#ff0000"), Rgb::new(2.0, 0.0, 0.0));
        assert_eq!(factor("1, 0.5,0.25"), Rgb::new(1.0, 0.5, 0.25));
        // A code of 188 is half of the light, in sRGB.
        assert!((factor("#bcbcbc").g - 0.5).abs() < 0.01);
    }

    #[test]
    fn what_is_no_factor_is_refused() {
        for text in
            ["", "a", "a=", "a=-1", "a=nan", "a=1e99", "a=#fff", "a=#gggggg", "a=1,2", "a=1*2", "a=#ffé11", "a=#+12345"]
        {
            assert!(parse_setting(text).is_err(), "{text}");
        }
    }
}
