//! The numbers of the study, as two tables: ratios of means, and what the single points are like.

use crate::Trial;
use isolux_testing::reference::{CHANNELS, LUMINANCE, Value};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Objects with fewer points than this get no line of their own.
const FEWEST_POINTS: usize = 20;
/// Where the tail of the points begins, in standard errors.
const TAIL: f64 = 3.0;

/// Two CSV files, growing.
pub struct Tables {
    pub ratios: String,
    pub points: String,
}

impl Default for Tables {
    fn default() -> Tables {
        let ratios = "room,elements,rays,of,points,value,channel,ratio,std_error,agrees\n".to_owned();
        let points = "room,elements,rays,median_element_cm,std_error,error_bar_ratio,mean_z,median_abs_z,share_beyond_3,\
            steep_share_of_tail,steep_share_of_rest,rms_beyond_noise,rms_beyond_noise_without_tail,\
            back_face,leaked\n";
        Tables { ratios, points: points.to_owned() }
    }
}

impl Tables {
    pub fn add(&mut self, trial: &Trial) {
        let points = &trial.comparison.points;
        let nodes: BTreeSet<&str> = points.iter().map(|p| p.node.as_str()).collect();
        let head = format!("{},{},{}", trial.room, trial.problem.mesh.len(), trial.rays);
        let mut line = |of: &str, node: Option<&str>, value: Value, channel: usize| {
            let belongs = |name: &str| node.is_none_or(|node| node == name);
            let count = points.iter().filter(|p| belongs(&p.node)).count();
            if count >= FEWEST_POINTS {
                let ratio = trial.comparison.ratio(value, channel, |p| belongs(&p.node));
                let (name, agrees) = (CHANNELS[channel], ratio.agrees());
                let numbers = format!("{:.5},{:.5},{agrees}", ratio.value, ratio.std_error);
                let _ = writeln!(self.ratios, "{head},{of},{count},{},{name},{numbers}", value.name());
            }
        };
        for value in Value::ALL {
            (0..CHANNELS.len()).for_each(|channel| line("all", None, value, channel));
            nodes.iter().for_each(|node| line(node, Some(node), value, LUMINANCE));
        }
        let _ = writeln!(self.points, "{head},{}", points_line(trial));
    }
}

fn points_line(trial: &Trial) -> String {
    let comparison = &trial.comparison;
    let all: Vec<usize> = (0..comparison.points.len()).collect();
    let z: Vec<f64> = all.iter().map(|&i| comparison.z(i, LUMINANCE)).collect();
    let (tail, rest): (Vec<usize>, Vec<usize>) = all.iter().partition(|&&i| z[i].abs() > TAIL);

    let variance = |i: usize| comparison.mean(i).std_error[LUMINANCE].powi(2);
    let value = |i: usize| comparison.mean(i).value[LUMINANCE];
    let stated: f64 = all.iter().map(|&i| variance(i)).sum();
    let seen: f64 = all.iter().map(|&i| comparison.spread(i, LUMINANCE).powi(2)).sum();
    let mean = all.iter().map(|&i| comparison.points[i].irradiance.value[LUMINANCE]).sum::<f64>() / all.len() as f64;
    // What is left of the squared differences when the squares of both standard errors are taken off.
    let beyond_noise = |points: &[usize]| {
        let excess = |&i: &usize| {
            let theirs = comparison.points[i].irradiance;
            (value(i) - theirs.value[LUMINANCE]).powi(2) - variance(i) - theirs.std_error[LUMINANCE].powi(2)
        };
        let sum: f64 = points.iter().map(excess).sum();
        (sum / all.len() as f64).max(0.0).sqrt() / mean
    };
    let steep =
        |points: &[usize]| points.iter().filter(|&&i| is_steep(trial, i)).count() as f64 / points.len().max(1) as f64;
    let columns = [
        100.0 * median(all.iter().map(|&i| diameter(trial, i))),
        (stated / all.len() as f64).sqrt() / mean,
        (stated / seen).sqrt(),
        z.iter().sum::<f64>() / all.len() as f64,
        median(z.iter().map(|z| z.abs())),
        tail.len() as f64 / all.len() as f64,
        steep(&tail),
        steep(&rest),
        beyond_noise(&all),
        beyond_noise(&rest),
        trial.back_face,
        trial.dark.total(LUMINANCE) / comparison.total(LUMINANCE),
    ];
    columns.map(|value| format!("{value:.5}")).join(",")
}

/// Longest edge of the element at point `i` [m].
fn diameter(trial: &Trial, i: usize) -> f64 {
    let element = trial.comparison.elements[i];
    let [a, b, c] = trial.problem.scene.corners(trial.problem.mesh.triangle(element));
    let [p, q, r] = trial.problem.mesh.corners(element).map(|uv| a + uv.x * (b - a) + uv.y * (c - a));
    f64::from(p.distance(q).max(q.distance(r)).max(r.distance(p)))
}

/// Whether a neighbour of the element at point `i`, across an edge within its triangle, has another irradiance: by a tenth,
/// and by three standard errors. So a shadow edge, or the fall of light beside a lamp, runs through this place.
fn is_steep(trial: &Trial, i: usize) -> bool {
    let mesh = &trial.problem.mesh;
    let here = trial.comparison.elements[i];
    let corners = mesh.corners(here);
    let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
    let differs = |there: u32| {
        let [(a, a_variance), (b, b_variance)] = [here, there].map(|e| trial.light[e as usize]);
        (a - b).abs() > (3.0 * (a_variance + b_variance).sqrt()).max(0.1 * a)
    };
    (0..3).any(|k| {
        let beyond = corners[k] + corners[(k + 1) % 3] - centre;
        let inside = beyond.min_element() > 0.0 && beyond.x + beyond.y < 1.0;
        inside && mesh.at(mesh.triangle(here), beyond, false).is_some_and(differs)
    })
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
