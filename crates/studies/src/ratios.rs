//! How much faster a series is than another, at equal error.
//!
//! A series has an error e after a given time t; the one that all are held against has that error after t'. The ratio t' / t is read
//! off the curves, on straight lines between their places in the doubly logarithmic plot. Beyond the ends of a curve errors fall with
//! the root of time; what was found there is marked.

use crate::fit::{Place, curve};
use crate::results::{Table, short};
use crate::spec::{EqualError, PlotSpec, Spec};

/// What became of one series in one plot and scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Ratio {
    pub plot: String,
    pub scene: String,
    pub series: String,
    /// The series that it is held against.
    pub against: String,
    /// The time [s] after which it has this error.
    pub at: f64,
    pub error: f64,
    /// Time that the other takes to this error, in multiples of `at`.
    pub times: f64,
    /// Whether either was beyond what was measured.
    pub extrapolated: bool,
}

impl Ratio {
    /// `5.2`, or `~5.2` if it is extrapolated.
    pub fn in_words(&self) -> String {
        let digits = if self.times < 9.95 { 1 } else { 0 };
        format!("{}{:.digits$}", if self.extrapolated { "~" } else { "" }, self.times)
    }
}

/// The ratios of all plots, scenes and series, if `spec` asks for them.
pub fn ratios(table: &Table, spec: &Spec) -> Vec<Ratio> {
    let Some(asked) = &spec.equal_error else { return Vec::new() };
    let mut ratios = Vec::new();
    for plot in &spec.plots {
        for scene in &spec.scenes {
            let shown = spec.series.iter().filter(|series| plot.shows(&series.name));
            ratios.extend(shown.filter_map(|series| ratio(table, plot, &scene.name, &series.name, asked)));
        }
    }
    ratios
}

/// The ratio of one series; none if it, or what it is held against, was not measured.
pub fn ratio(table: &Table, plot: &PlotSpec, scene: &str, series: &str, asked: &EqualError) -> Option<Ratio> {
    let [own, other] = [series, asked.against.as_str()].map(|series| curve(table, plot, scene, series));
    let (error, own_beyond) = error_at(&own, asked.at)?;
    let (time, other_beyond) = time_of(&other, error)?;
    Some(Ratio {
        plot: plot.file.clone(),
        scene: scene.to_owned(),
        series: series.to_owned(),
        against: asked.against.clone(),
        at: asked.at,
        error,
        times: time / asked.at,
        extrapolated: own_beyond || other_beyond,
    })
}

/// A line for each ratio.
pub fn as_csv(ratios: &[Ratio]) -> String {
    let line = |ratio: &Ratio| {
        let Ratio { plot, scene, series, extrapolated, .. } = ratio;
        let numbers = [ratio.at, ratio.error, ratio.times].map(short).join(",");
        format!("{plot},\"{scene}\",\"{series}\",\"{}\",{numbers},{extrapolated}\n", ratio.against)
    };
    "plot,scene,series,against,at,error,times,extrapolated\n".to_owned() + &ratios.iter().map(line).collect::<String>()
}

/// The error of a curve at `time`, and whether that lies beyond its ends.
fn error_at(curve: &[Place], time: f64) -> Option<(f64, bool)> {
    let falling = |from: &Place| (from.y.mean * (from.x / time).sqrt(), true);
    match curve.iter().position(|place| place.x >= time) {
        Some(0) => curve.first().map(falling),
        Some(k) => {
            let (a, b) = (&curve[k - 1], &curve[k]);
            let share = (time / a.x).ln() / (b.x / a.x).ln();
            Some(((a.y.mean.ln() * (1.0 - share) + b.y.mean.ln() * share).exp(), false))
        }
        None => curve.last().map(falling),
    }
}

/// When a curve first falls to `error`, and whether that lies beyond its ends.
fn time_of(curve: &[Place], error: f64) -> Option<(f64, bool)> {
    let falling = |from: &Place| (from.x * (from.y.mean / error).powi(2), true);
    match curve.iter().position(|place| place.y.mean <= error) {
        Some(0) => curve.first().map(falling),
        Some(k) => {
            let (a, b) = (&curve[k - 1], &curve[k]);
            let share = (a.y.mean / error).ln() / (a.y.mean / b.y.mean).ln();
            Some(((a.x.ln() * (1.0 - share) + b.x.ln() * share).exp(), false))
        }
        None => curve.last().map(falling),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::Interval;
    use crate::results::Row;

    /// Errors `factor x^slope` after 1/4 to 32 s.
    fn power_law(factor: f64, slope: f64) -> Vec<Place> {
        let place = |x: f64| Place { x, y: Interval { mean: factor * x.powf(slope), low: f64::NAN, high: f64::NAN } };
        (-2..=5).map(|k| place(2f64.powi(k))).collect()
    }

    #[track_caller]
    fn assert_near((found, beyond): (f64, bool), (exact, is_beyond): (f64, bool)) {
        assert!((found / exact - 1.0).abs() < 1e-12 && beyond == is_beyond, "{found} instead of {exact}, {beyond}");
    }

    #[test]
    fn between_places_a_power_law_is_read_off_exactly() {
        for slope in [-0.3, -0.5, -0.9] {
            let curve = power_law(0.4, slope);
            for x in [0.3, 1.0, 20.0, 31.9] {
                let error = 0.4 * f64::powf(x, slope);
                assert_near(error_at(&curve, x).unwrap(), (error, false));
                assert_near(time_of(&curve, error).unwrap(), (x, false));
            }
        }
    }

    #[test]
    fn beyond_the_ends_errors_fall_with_the_root_of_time() {
        let curve = power_law(0.4, -0.8);
        let end = 0.4 * 32f64.powf(-0.8);
        assert_near(error_at(&curve, 128.0).unwrap(), (0.5 * end, true));
        assert_near(time_of(&curve, 0.1 * end).unwrap(), (3200.0, true));
        let start = 0.4 * 0.25f64.powf(-0.8);
        assert_near(error_at(&curve, 0.0625).unwrap(), (2.0 * start, true));
        assert_near(time_of(&curve, 2.0 * start).unwrap(), (0.0625, true));
    }

    #[test]
    fn noise_that_lifts_a_place_does_not_hide_that_the_error_was_reached_before() {
        let mut curve = power_law(1.0, -0.5);
        curve[4].y.mean = 2.0;
        assert_near(time_of(&curve, 2f64.powf(-0.25)).unwrap(), (2f64.sqrt(), false));
        assert_eq!((error_at(&[], 1.0), time_of(&[], 1.0)), (None, None));
    }

    const SPEC: &str = r#"
        title = "t"
        question = "q"
        measure = "speed"
        scenes = [{ name = "s", scene = "cubes", elements = 1 }]
        at = [32]
        seeds = 1
        series = [{ name = "slow" }, { name = "fast" }, { name = "absent" }]
        plots = [{ file = "p", title = "", x = "x", y = "y", x-label = "", y-label = "" }]
        equal-error = { against = "slow", at = 20 }
        signs = [
            { claim = "four times as fast", plot = "p", series = "fast", faster = [3.9, 4.1] },
            { claim = "five times as fast", plot = "p", series = "fast", faster = [5, inf] },
        ]
        quick = {}
    "#;

    #[test]
    fn half_the_error_is_four_times_as_fast() {
        let spec = Spec::parse("test", SPEC).unwrap();
        spec.check(&["x", "y"]).unwrap();
        let mut table = Table::new(&["x", "y"]);
        for (series, factor) in [("slow", 0.8), ("fast", 0.4)] {
            for Place { x, y } in power_law(factor, -0.5) {
                let (scene, series) = ("s".to_owned(), series.to_owned());
                table.rows.push(Row { scene, series, at: x, seed: 1, values: vec![x, y.mean] });
            }
        }
        let ratios = ratios(&table, &spec);
        let words: Vec<_> = ratios.iter().map(|ratio| (ratio.series.as_str(), ratio.in_words())).collect();
        assert_eq!(words, [("slow", "1.0".to_owned()), ("fast", "~4.0".to_owned())]);
        assert!(as_csv(&ratios).ends_with("p,\"s\",\"fast\",\"slow\",20,0.0894427,4,true\n"), "{}", as_csv(&ratios));
        let holds: Vec<bool> = crate::signs::verdicts(&table, &spec).iter().map(|verdict| verdict.holds).collect();
        assert_eq!(holds, [true, false]);
    }
}
