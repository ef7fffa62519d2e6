//! Slopes in doubly logarithmic plots.
//!
//! Every seed is a run of its own: its slope is fitted by least squares to `ln y` over `ln x`, and the slopes of K seeds give
//! mean and confidence interval by Student's t with K - 1 degrees of freedom. No assumption about the noise along a curve.

use crate::results::{Row, Table};
use crate::spec::{PlotSpec, Spec};
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::collections::BTreeMap;

/// Mean with its confidence interval of 95 %; without one if there is a single value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub mean: f64,
    pub low: f64,
    pub high: f64,
}

/// The slope of a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    pub plot: String,
    pub scene: String,
    pub series: String,
    pub slope: Interval,
}

/// A place on a curve: means over the seeds, of y in its logarithm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    pub x: f64,
    pub y: Interval,
}

/// Mean and 95 % interval of independent values, by Student's t.
pub fn interval(values: &[f64]) -> Interval {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    if values.len() < 2 {
        return Interval { mean, low: f64::NAN, high: f64::NAN };
    }
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let t = StudentsT::new(0.0, 1.0, count - 1.0).map_or(f64::NAN, |student| student.inverse_cdf(0.975));
    let half = t * (variance / count).sqrt();
    Interval { mean, low: mean - half, high: mean + half }
}

/// Rows of one series in one scene with finite, positive `x` and `y`, as `(row, x, y)`.
fn points<'a>(
    table: &'a Table,
    plot: &'a PlotSpec,
    scene: &'a str,
    series: &'a str,
) -> impl Iterator<Item = (&'a Row, f64, f64)> {
    let rows = table.rows.iter().filter(move |row| row.scene == scene && row.series == series);
    let point = |row| Some((row, table.value(row, &plot.x)?, table.value(row, &plot.y)?));
    rows.filter_map(point).filter(|(_, x, y)| *x > 0.0 && *y > 0.0 && x.is_finite() && y.is_finite())
}

/// The curve of `series` in `scene`, in the order of its places.
pub fn curve(table: &Table, plot: &PlotSpec, scene: &str, series: &str) -> Vec<Place> {
    // Places are compared by their bits, which for positive numbers have the numbers' order.
    let mut places: BTreeMap<u64, Vec<(f64, f64)>> = BTreeMap::new();
    for (row, x, y) in points(table, plot, scene, series) {
        places.entry(row.at.to_bits()).or_default().push((x, y.ln()));
    }
    let place = |values: Vec<(f64, f64)>| {
        let x = values.iter().map(|(x, _)| x.ln()).sum::<f64>() / values.len() as f64;
        let y = interval(&values.iter().map(|&(_, y)| y).collect::<Vec<_>>());
        Place { x: x.exp(), y: Interval { mean: y.mean.exp(), low: y.low.exp(), high: y.high.exp() } }
    };
    places.into_values().map(place).collect()
}

/// The slope of `series` in `scene`, if there are two places to fit.
pub fn slope(table: &Table, plot: &PlotSpec, scene: &str, series: &str) -> Option<Fit> {
    let mut seeds: BTreeMap<u64, Vec<(f64, f64)>> = BTreeMap::new();
    for (row, x, y) in points(table, plot, scene, series).filter(|(_, x, _)| *x >= plot.fit_from) {
        seeds.entry(row.seed).or_default().push((x.ln(), y.ln()));
    }
    let slopes: Vec<f64> = seeds.values().filter_map(|points| least_squares(points)).collect();
    let fit = || {
        let slope = interval(&slopes);
        Fit { plot: plot.file.clone(), scene: scene.to_owned(), series: series.to_owned(), slope }
    };
    (!slopes.is_empty()).then(fit)
}

/// All slopes of a study.
pub fn slopes(table: &Table, spec: &Spec) -> Vec<Fit> {
    let mut fits = Vec::new();
    for plot in spec.plots.iter().filter(|plot| plot.fit) {
        for scene in &spec.scenes {
            let shown = spec.series.iter().filter(|series| plot.shows(&series.name));
            fits.extend(shown.filter_map(|series| slope(table, plot, &scene.name, &series.name)));
        }
    }
    fits
}

/// Slope of the line through `points` with the least squares in y; none for fewer than two different x.
fn least_squares(points: &[(f64, f64)]) -> Option<f64> {
    let count = points.len() as f64;
    let [mean_x, mean_y] = [points.iter().map(|p| p.0).sum::<f64>(), points.iter().map(|p| p.1).sum::<f64>()];
    let (mean_x, mean_y) = (mean_x / count, mean_y / count);
    let (sxx, sxy) = points
        .iter()
        .fold((0.0, 0.0), |(sxx, sxy), (x, y)| (sxx + (x - mean_x).powi(2), sxy + (x - mean_x) * (y - mean_y)));
    (sxx > 1e-12).then(|| sxy / sxx)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_of_a_power_law_is_its_exponent() {
        let points: Vec<(f64, f64)> = (1..=6).map(|k| (f64::from(k), 3.0 - 0.7 * f64::from(k))).collect();
        assert!((least_squares(&points).unwrap() + 0.7).abs() < 1e-12);
        assert_eq!(least_squares(&points[..1]), None);
    }

    #[test]
    fn intervals_are_those_of_student() {
        // t of 0.975 with two degrees of freedom is 4.302653.
        let Interval { mean, low, high } = interval(&[1.0, 2.0, 3.0]);
        assert_eq!(mean, 2.0);
        assert!((high - 2.0 - 4.302653 / 3f64.sqrt()).abs() < 1e-5 && (mean - low - (high - mean)).abs() < 1e-12);
        assert!(interval(&[1.0]).low.is_nan());
    }
}
