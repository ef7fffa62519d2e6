//! `form-factor-variance`: how the variance of estimated form factors depends on the area of the element.
//!
//! `at` is the mean number of lines an element has. Two independent estimates `a`, `b` of a row have `Σ_j (a_ij - b_ij)² / 2` for
//! the variance of the whole row, summed over columns, without bias. Expected of independent lines is `(1 - Σ_j F_ij²) / n_i`,
//! with `n_i` the lines that element i has: as many as asked for with local lines; `N A_i / (2 pi R²)` with global ones.
//! Rows are averaged over elements of like area. Each row has a place of its own: the mean area of its elements.

use super::Measure;
use super::bins::by_area;
use crate::Error;
use crate::results::Row as ResultRow;
use crate::task::{Task, rows_by};
use isolux_core::Problem;
use isolux_core::form_factors::{Row, Settings, Way};
use rayon::prelude::*;

/// Elements of each bin that are looked at.
const MOST: usize = 400;

pub struct FormFactorVariance;

impl Measure for FormFactorVariance {
    fn columns(&self) -> &'static [&'static str] {
        &["area", "variance", "expected"]
    }

    fn has_own_places(&self) -> bool {
        true
    }

    fn measure(&mut self, task: &mut Task) -> Result<Option<Vec<ResultRow>>, Error> {
        let (problem, point) = (task.problem()?, task.point);
        let name = task.series().axis("factors").unwrap_or_default();
        let estimate = |seed| rows_by(name, &problem, &Settings { rays: point.at as u32, seed, ..Settings::default() });
        let pair = [estimate(2 * point.seed)?, estimate(2 * point.seed + 1)?];
        let mean_area = problem.mesh.total_area() / problem.mesh.len() as f64;
        let mut rows = Vec::new();
        for bin in by_area(&problem, MOST) {
            if task.is_stopped() {
                return Ok(None);
            }
            let of_element = |&e: &u32| {
                let relative_area = f64::from(problem.mesh.area(e)) / mean_area;
                let lines = if name == "global-lines" { point.at * relative_area } else { point.at };
                let [variance, squares] = pair_of_rows(&pair, &problem, e);
                [variance, (1.0 - squares) / lines]
            };
            let of_elements: Vec<[f64; 2]> = bin.elements.par_iter().map(of_element).collect();
            let mean = |k: usize| of_elements.iter().map(|both| both[k]).sum::<f64>() / of_elements.len() as f64;
            rows.push(task.row(bin.area, vec![bin.area, mean(0), mean(1)]));
        }
        Ok(Some(rows))
    }
}

/// Estimates of `Σ_j Var F_ij` and of `Σ_j F_ij²`.
fn pair_of_rows(pair: &[Box<dyn Way>; 2], problem: &Problem, element: u32) -> [f64; 2] {
    let [a, b] = [pair[0].row(problem, element), pair[1].row(problem, element)];
    let square = |row: &Row| row.entries.iter().map(|(_, value)| value * value).sum::<f64>();
    let product = |(column, value): &(u32, f64)| {
        let other = b.entries.binary_search_by_key(column, |(column, _)| *column);
        other.map_or(0.0, |k| value * b.entries[k].1)
    };
    let products: f64 = a.entries.iter().map(product).sum();
    [0.5 * (square(&a) + square(&b)) - products, products]
}
