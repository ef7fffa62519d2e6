//! No seam along the borders of charts: texels just outside are set so that lookups on the border find the field's light.
//!
//! The field is continuous where charts of a smooth surface meet, whatever objects they belong to. So if a bilinear
//! lookup on a border gives the field's value from either side, both sides agree. Texels whose centres lie on the
//! surface stay what they are; those beyond the border, which only lookups near it read, are the unknowns `x` of a
//! least squares problem with a row for each point of the borders: `sum w_j x_j = E - sum w_k t_k`, solved by
//! simultaneous iterative reconstruction (Gilbert 1972), which starts at the light of the nearest point of the surface
//! and changes it no more than needed. On straight gradients the rows can be met exactly: then lookups extrapolate the
//! light of the surface.

use super::texels::stencil;
use super::{Atlas, Border, Texels};
use crate::Problem;
use crate::math::Rgb;
use crate::view::VertexField;
use glam::Vec2;
use rayon::prelude::*;

/// Points on a border for each texel of its length.
const POINTS: f64 = 2.0;
/// Rows that depend on the unknowns by less than this count less, or small errors would move texels far.
const LEAST_WEIGHT: f32 = 0.25;
const ITERATIONS: u32 = 40;

/// A point of a border.
struct Row {
    /// What a lookup reads.
    texels: [(u32, f32); 4],
    /// Sum of the weights of the unknowns.
    weight: f32,
    /// What it should find [lux].
    light: Rgb,
}

/// Sets the texels beyond the borders of charts. Points that are `covered` do not count.
pub fn fit(
    problem: &Problem,
    field: &VertexField,
    atlas: &Atlas,
    texels: &Texels,
    covered: &[bool],
    irradiance: &mut [Rgb],
) {
    let is_free = |texel: usize| texels.list[texel].is_some_and(|texel| !texel.inside) && !covered[texel];
    let rows_of = |border: &Border| rows(problem, field, atlas, texels, covered, border, is_free);
    let rows: Vec<Row> = atlas.borders.par_iter().flat_map_iter(rows_of).collect();
    let mut total = vec![0.0; irradiance.len()];
    let unknowns = |row: &Row| row.texels.map(|(texel, weight)| (texel as usize, weight)).into_iter();
    for row in &rows {
        unknowns(row).filter(|&(texel, _)| is_free(texel)).for_each(|(texel, weight)| total[texel] += weight);
    }
    let mut change = vec![Rgb::BLACK; irradiance.len()];
    let mut free: Vec<usize> =
        rows.iter().flat_map(unknowns).map(|(texel, _)| texel).filter(|&t| total[t] > 0.0).collect();
    free.sort_unstable();
    free.dedup();
    for _ in 0..ITERATIONS {
        for row in &rows {
            let lacks = |&(texel, weight): &(u32, f32)| (row.light - irradiance[texel as usize]) * weight;
            let missing = row.texels.iter().map(lacks).sum::<Rgb>() / row.weight.max(LEAST_WEIGHT);
            unknowns(row).for_each(|(texel, weight)| change[texel] += missing * weight);
        }
        for &texel in &free {
            let step = std::mem::take(&mut change[texel]) / total[texel];
            irradiance[texel] = (irradiance[texel] + step).map(|value| value.max(0.0));
        }
    }
}

/// The rows of points along a border that read an unknown.
fn rows(
    problem: &Problem,
    field: &VertexField,
    atlas: &Atlas,
    texels: &Texels,
    covered: &[bool],
    border: &Border,
    is_free: impl Fn(usize) -> bool,
) -> Vec<Row> {
    const CORNERS: [Vec2; 3] = [Vec2::ZERO, Vec2::X, Vec2::Y];
    let (from, to) = (usize::from(border.edge), (usize::from(border.edge) + 1) % 3);
    let (corners, uv) = (atlas.in_texels(border.face), atlas.uv[border.face as usize]);
    let face = &atlas.faces[border.face as usize];
    let chart = atlas.chart[border.face as usize];
    let count = (POINTS * corners[from].distance(corners[to])).ceil().max(1.0) as u32;
    let row = |k: u32| {
        let t = (k as f32 + 0.5) / count as f32;
        let read = stencil(uv[from].lerp(uv[to], t), atlas.width, atlas.height);
        let is_own = |texel: usize| texels.list[texel].is_some_and(|texel| atlas.chart[texel.face as usize] == chart);
        if read.iter().any(|&(texel, weight)| weight > 0.0 && (covered[texel] || !is_own(texel))) {
            return None;
        }
        let weight = read.iter().filter(|&&(texel, _)| is_free(texel)).map(|(_, weight)| weight).sum();
        let light = face.irradiance(problem, field, CORNERS[from].lerp(CORNERS[to], t));
        (weight > 0.0).then(|| Row { texels: read.map(|(texel, weight)| (texel as u32, weight)), weight, light })
    };
    (0..count).filter_map(row).collect()
}
