//! `--light-groups`: which lamps are solved apart, and the table that says what each gives.

use crate::accuracy::{CONFIDENCE, Reached};
use crate::numbers::{decimals_for, digits, percent};
use crate::report::Table;
use isolux_core::math::Rgb;
use isolux_core::scene::Grouping;
use isolux_core::{Problem, Solution, superposition};

/// Reads `objects`, `materials`, or a list like `Ceiling=Lamp 1,Lamp 2;Window`, where `Window` alone is a group of itself.
///
/// # Errors
/// A sentence, if it is none of these.
pub fn parse_grouping(text: &str) -> Result<Grouping, String> {
    match text {
        "objects" => return Ok(Grouping::Objects),
        "materials" => return Ok(Grouping::Materials),
        _ => {}
    }
    let names = |list: &str| list.split(',').map(|name| name.trim().to_owned()).collect::<Vec<_>>();
    let group = |list: &str| match list.split_once('=') {
        Some((name, members)) => (name.trim().to_owned(), names(members)),
        None => (list.trim().to_owned(), vec![list.trim().to_owned()]),
    };
    let lists: Vec<(String, Vec<String>)> = text.split(';').map(group).collect();
    let is_empty = |(name, members): &(String, Vec<String>)| name.is_empty() || members.iter().any(String::is_empty);
    if !text.contains(['=', ';']) || lists.iter().any(is_empty) {
        return Err("it is objects, materials, or a list like 'Ceiling=Lamp 1,Lamp 2;Windows=Window*'".to_owned());
    }
    Ok(Grouping::Listed(lists))
}

/// What each group of `solution` gives at its factor; nothing without groups.
pub fn table(problem: &Problem, solution: &Solution) -> String {
    if solution.groups.is_empty() {
        return String::new();
    }
    let alone: Vec<Solution> = (0..solution.groups.len()).map(|k| superposition::alone(problem, solution, k)).collect();
    let means: Vec<f64> = alone.iter().map(|alone| mean(problem, alone)).collect();
    let lumens = decimals_for(solution.balance.emitted, 4);
    let lux = decimals_for(means.iter().sum::<f64>() / means.len() as f64, 4);
    let is_mixed = solution.groups.iter().any(|part| part.factor != Rgb::WHITE);
    let mut heads = vec!["light group", "factor", "emitted [lm]", "mean [lux]", "± 95 %", "error at most"];
    heads.retain(|head| is_mixed || *head != "factor");
    let mut table = Table::new(&heads);
    for (part, (alone, mean)) in solution.groups.iter().zip(alone.iter().zip(means)) {
        let scene = alone.certainty.as_ref().map(|certainty| certainty.scene);
        let margin = scene.map_or(String::new(), |scene| format!("{:.lux$}", scene.margin(CONFIDENCE)));
        let bound = Reached::by(problem, alone, None).bound;
        let error = if bound.is_finite() { percent(bound) } else { String::new() };
        let cells = [format!("{:.lumens$}", alone.balance.emitted), format!("{mean:.lux$}"), margin, error];
        table.row(&part.group.name, is_mixed.then(|| factor_in_words(part.factor)).into_iter().chain(cells));
    }
    format!("\nLight of each group alone, errors of all elements (RMS, 95 %)\n{}", table.lines())
}

/// Mean irradiance by area [lux].
fn mean(problem: &Problem, solution: &Solution) -> f64 {
    let flux = |e: u32| f64::from(problem.mesh.area(e)) * solution.irradiance[e as usize].luminance_f64();
    problem.mesh.elements().map(flux).sum::<f64>() / problem.mesh.total_area()
}

/// `0.3`, or three numbers if it has a colour.
fn factor_in_words(factor: Rgb) -> String {
    match factor.to_array() {
        [r, g, b] if r == g && g == b => r.to_string(),
        channels => channels.map(|channel| digits(channel.into(), 3)).join(" "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_named_or_listed() {
        assert_eq!(parse_grouping("materials"), Ok(Grouping::Materials));
        let owned = |name: &str, members: &[&str]| (name.to_owned(), members.iter().map(|&m| m.to_owned()).collect());
        let lists = vec![owned("Ceiling", &["Lamp 1", "Lamp 2"]), owned("Window", &["Window"])];
        assert_eq!(parse_grouping("Ceiling=Lamp 1, Lamp 2; Window"), Ok(Grouping::Listed(lists)));
        for text in ["", "lamps", "a=;b", "=a", "a=b,,c", ";"] {
            assert!(parse_grouping(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_factor_is_short_unless_it_has_a_colour() {
        assert_eq!(factor_in_words(Rgb::grey(0.3)), "0.3");
        assert_eq!(factor_in_words(Rgb::new(1.0, 0.25, 0.0)), "1.00 0.250 0");
    }
}
