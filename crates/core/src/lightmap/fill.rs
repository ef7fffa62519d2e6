//! Texels that have no light of their own continue the charts beside them (dilation).
//!
//! Wave by wave, each texel takes the mean of its neighbours that are known and on the same chart: those beside it
//! count fully, those across a corner half. Constant light stays exactly constant.

use super::{Atlas, Texels};
use crate::math::Rgb;

/// "No chart".
const NONE: u32 = u32::MAX;

/// Gives `covered` texels the light of their charts around them, as deep as the padding: what is deeper is read by
/// nobody, and keeps what it has.
pub fn continue_under(atlas: &Atlas, texels: &Texels, covered: &[bool], irradiance: &mut [Rgb]) {
    let chart = charts(atlas, texels);
    let mut known: Vec<u32> =
        chart.iter().zip(covered).map(|(&chart, &hidden)| if hidden { NONE } else { chart }).collect();
    let may_take = |texel: usize, from: u32| covered[texel] && chart[texel] == from;
    let start = (0..covered.len()).filter(|&texel| covered[texel]).collect();
    continue_into(texels, &mut known, irradiance, start, may_take, Some(atlas.padding));
}

/// Gives all texels between charts the light of the nearest chart: no level of a mipmap reads darkness.
pub fn continue_between(atlas: &Atlas, texels: &Texels, irradiance: &mut [Rgb]) {
    let mut known = charts(atlas, texels);
    let start = (0..known.len()).filter(|&texel| known[texel] == NONE).collect();
    continue_into(texels, &mut known, irradiance, start, |_, _| true, None);
}

/// Chart of every texel.
fn charts(atlas: &Atlas, texels: &Texels) -> Vec<u32> {
    texels.list.iter().map(|texel| texel.map_or(NONE, |texel| atlas.chart[texel.face as usize])).collect()
}

/// Fills the texels `waiting` from those of `known` charts, for so many waves or as long as there is anything to fill.
fn continue_into(
    texels: &Texels,
    known: &mut [u32],
    irradiance: &mut [Rgb],
    mut waiting: Vec<usize>,
    may_take: impl Fn(usize, u32) -> bool,
    waves: Option<u32>,
) {
    waiting.retain(|&texel| known[texel] == NONE);
    let mut wave: Vec<usize> = waiting.into_iter().filter(|&t| texels.around(t).any(|n| known[n] != NONE)).collect();
    for _ in 0..waves.unwrap_or(u32::MAX) {
        let mean =
            |&texel: &usize| mean_around(texels, known, irradiance, texel, &may_take).map(|found| (texel, found));
        let found: Vec<(usize, (u32, Rgb))> = wave.iter().filter_map(mean).collect();
        if found.is_empty() {
            break;
        }
        for &(texel, (chart, light)) in &found {
            known[texel] = chart;
            irradiance[texel] = light;
        }
        wave =
            found.iter().flat_map(|&(texel, _)| texels.around(texel)).filter(|&texel| known[texel] == NONE).collect();
        wave.sort_unstable();
        wave.dedup();
    }
}

/// Mean light of the known texels around `texel` on one chart, the one of the lowest number, and that chart.
fn mean_around(
    texels: &Texels,
    known: &[u32],
    irradiance: &[Rgb],
    texel: usize,
    may_take: &impl Fn(usize, u32) -> bool,
) -> Option<(u32, Rgb)> {
    let usable = |&other: &usize| known[other] != NONE && may_take(texel, known[other]);
    let chart = texels.around(texel).filter(usable).map(|other| known[other]).min()?;
    let mut of_chart = texels.around(texel).filter(|&other| known[other] == chart).peekable();
    // Summed as deviations from the first, so that equal values have exactly that value as their mean.
    let base = irradiance[*of_chart.peek()?];
    let (mut deviation, mut total) = (Rgb::BLACK, 0.0);
    for other in of_chart {
        let weight = if texels.is_across_corner(texel, other) { 0.5 } else { 1.0 };
        deviation += (irradiance[other] - base) * weight;
        total += weight;
    }
    Some((chart, base + deviation / total))
}
