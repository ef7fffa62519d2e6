//! Whether the claims of a study show in what was measured.

use crate::fit::{Place, curve, slope};
use crate::ratios;
use crate::results::{Table, short};
use crate::spec::{PlotSpec, Sign, Spec};

/// What became of one sign in one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    pub claim: String,
    pub scene: String,
    pub holds: bool,
    /// The numbers.
    pub found: String,
    pub robust: bool,
}

/// Looks for all signs of `spec`; those for which nothing was measured are left out.
pub fn verdicts(table: &Table, spec: &Spec) -> Vec<Verdict> {
    let mut verdicts = Vec::new();
    for sign in &spec.signs {
        let Some(plot) = spec.plots.iter().find(|plot| plot.file == sign.plot) else { continue };
        for scene in spec.scenes.iter().filter(|scene| sign.concerns(&scene.name)) {
            if let Some((holds, found)) = look(table, spec, plot, &scene.name, sign) {
                let (claim, scene) = (sign.claim.clone(), scene.name.clone());
                verdicts.push(Verdict { claim, scene, holds, found, robust: sign.robust });
            }
        }
    }
    verdicts
}

fn look(table: &Table, spec: &Spec, plot: &PlotSpec, scene: &str, sign: &Sign) -> Option<(bool, String)> {
    let of = |series: &str| slope(table, plot, scene, series).map(|fit| fit.slope);
    if let Some([low, high]) = sign.slope {
        let slope = of(&sign.series)?;
        // A single seed has no interval: its slope itself must lie there.
        let meets = if slope.low.is_nan() {
            (low..=high).contains(&slope.mean)
        } else {
            slope.low <= high && low <= slope.high
        };
        return Some((meets, format!("slope {}", in_words(slope.mean, slope.high - slope.mean))));
    }
    if let Some(other) = &sign.steeper_than {
        let [own, other] = [of(&sign.series)?, of(other)?];
        let words = [own, other].map(|slope| in_words(slope.mean, slope.high - slope.mean));
        return Some((own.mean < other.mean, format!("slopes {} and {}", words[0], words[1])));
    }
    if let (Some([low, high]), Some(x)) = (sign.value, sign.where_x) {
        let value = at(&curve(table, plot, scene, &sign.series), x)?;
        return Some(((low..=high).contains(&value), format!("{value:.3} at {}", short(x))));
    }
    if let Some([low, high]) = sign.faster {
        let ratio = ratios::ratio(table, plot, scene, &sign.series, spec.equal_error.as_ref()?)?;
        return Some(((low..=high).contains(&ratio.times), format!("{} times as long", ratio.in_words())));
    }
    let (Some([low, high]), Some(other)) = (sign.times, &sign.of) else { return None };
    let [own, other] = [&sign.series, other].map(|series| curve(table, plot, scene, series));
    let x = own.last()?.x.min(other.last()?.x);
    let ratio = at(&own, x)? / at(&other, x)?;
    Some(((low..=high).contains(&ratio), format!("{ratio:.3} times at {}", short(x.round()))))
}

/// The curve's value at `x`, on straight lines between its places in the doubly logarithmic plot.
fn at(curve: &[Place], x: f64) -> Option<f64> {
    let k = curve.iter().position(|place| place.x >= x * (1.0 - 1e-9))?;
    let (b, a) = (curve[k], curve[k.saturating_sub(1)]);
    let share = if b.x > a.x { (x / a.x).ln() / (b.x / a.x).ln() } else { 1.0 };
    Some((a.y.mean.ln() * (1.0 - share) + b.y.mean.ln() * share).exp())
}

/// `-0.52 ± 0.03`
pub fn in_words(mean: f64, half: f64) -> String {
    let mean = format!("{mean:.2}").replace('-', "−");
    if half.is_finite() { format!("{mean} ± {half:.2}") } else { mean }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::Row;

    const SPEC: &str = r#"
        title = "t"
        question = "q"
        measure = "convergence"
        scenes = [{ name = "s", scene = "cubes", elements = 1 }]
        at = [1, 2]
        seeds = 2
        series = [{ name = "a" }, { name = "b" }]
        plots = [{ file = "p", title = "", x = "x", y = "y", x-label = "", y-label = "" }]
        signs = [
            { claim = "a falls with the root", plot = "p", series = "a", slope = [-0.5, -0.5] },
            { claim = "b falls with the root", plot = "p", series = "b", slope = [-0.5, -0.5] },
            { claim = "b is steeper", plot = "p", series = "b", steeper-than = "a" },
            { claim = "b ends lower", plot = "p", series = "b", times = [0, 0.9], of = "a" },
            { claim = "b ends higher", plot = "p", series = "b", times = [1.1, 9], of = "a" },
        ]
        quick = {}
    "#;

    #[test]
    fn signs_are_found_where_they_are_and_nowhere_else() {
        let spec = Spec::parse("test", SPEC).unwrap();
        spec.check(&["x", "y"]).unwrap();
        let mut table = Table::new(&["x", "y"]);
        for (series, exponent) in [("a", -0.5f64), ("b", -0.8)] {
            for (seed, noise) in [(1, 0.01), (2, -0.01)] {
                for x in [10.0f64, 100.0, 1000.0] {
                    let y = x.powf(exponent + noise);
                    let (scene, series) = ("s".to_owned(), series.to_owned());
                    table.rows.push(Row { scene, series, at: x, seed, values: vec![x, y] });
                }
            }
        }
        let holds: Vec<bool> = verdicts(&table, &spec).into_iter().map(|verdict| verdict.holds).collect();
        assert_eq!(holds, [true, false, true, true, false]);
        let curve = curve(&table, &spec.plots[0], "s", "a");
        let [inside, end, beyond] = [50.0, 1000.0, 2000.0].map(|x| at(&curve, x));
        let root = |x: f64| x.powf(-0.5);
        assert!((inside.unwrap() / root(50.0) - 1.0).abs() < 1e-9 && (end.unwrap() / root(1000.0) - 1.0).abs() < 1e-9);
        assert_eq!(beyond, None);
    }
}
