//! Which texels lie under other geometry.
//!
//! A floor runs on below the cupboard that stands on it, and is black there. Nobody sees that, but a lookup just before
//! the cupboard reads a texel just below it, and so would every mipmap: a dark fringe around everything that stands
//! somewhere. So a texel that is darker than those beside it looks around, in a few directions; if it sees nothing but
//! darkness, it is covered. From there on the test spreads to its neighbours. The rule is that of pictures
//! ([`crate::view`], `cover.rs`), with texels in place of elements. Cost: some rays for each texel at an edge of light.

use super::{Atlas, Texel, Texels};
use crate::Problem;
use crate::geometry::{Hit, Ray};
use crate::math::warp::square_to_cosine_hemisphere;
use crate::math::{Frame, Rgb};
use crate::view::cover::sees_a_light;
use crate::view::{VertexField, plastic};
use rayon::prelude::*;

/// Texels with less than this share of the light beside them may be covered.
const DARKER: f32 = 0.85;
/// Directions in which a texel must see darkness to be covered.
const LOOKS: u32 = 16;
/// What has less than this share of the light beside the texel is darkness.
const DARKNESS: f32 = 0.02;

/// Whether each texel lies under other geometry. `irradiance` [lux] is that of the texels' points.
pub fn covered(
    problem: &Problem,
    field: &VertexField,
    atlas: &Atlas,
    texels: &Texels,
    irradiance: &[Rgb],
) -> Vec<bool> {
    let light = |texel: usize| irradiance[texel].luminance();
    let chart = |texel: usize| texels.list[texel].map(|texel| atlas.chart[texel.face as usize]);
    let beside = |texel: usize| texels.around(texel).filter(move |&other| chart(other) == chart(texel));
    let brightest = |texel: usize| beside(texel).map(light).fold(0.0, f32::max);
    let is_darker = |&(texel, around): &(usize, f32)| light(texel) < DARKER * around;
    let shown = (0..texels.list.len()).into_par_iter().filter(|&texel| texels.list[texel].is_some());
    // Texels that may be covered, each with the light [lux] beside it.
    let mut wave: Vec<(usize, f32)> = shown.map(|texel| (texel, brightest(texel))).filter(is_darker).collect();
    let mut is_tested = vec![false; texels.list.len()];
    let mut is_covered = vec![false; texels.list.len()];
    while !wave.is_empty() {
        wave.iter().for_each(|&(texel, _)| is_tested[texel] = true);
        let looks = |&&(texel, around): &&(usize, f32)| {
            texels.list[texel].is_some_and(|shown| sees_only_darkness(problem, field, atlas, shown, texel, around))
        };
        let found: Vec<(usize, f32)> = wave.par_iter().filter(looks).copied().collect();
        found.iter().for_each(|&(texel, _)| is_covered[texel] = true);
        let mut next: Vec<(usize, f32)> = Vec::new();
        for &(texel, around) in &found {
            next.extend(
                beside(texel).filter(|&other| !is_tested[other]).map(|other| (other, around)).filter(is_darker),
            );
        }
        // Each once, held against the brightest of the lights that lead to it.
        next.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
        next.dedup_by_key(|(texel, _)| *texel);
        wave = next;
    }
    is_covered
}

/// Whether the point that a texel shows sees nothing but darkness, beside texels with the illuminance `around` [lux].
fn sees_only_darkness(
    problem: &Problem,
    field: &VertexField,
    atlas: &Atlas,
    shown: Texel,
    number: usize,
    around: f32,
) -> bool {
    let face = &atlas.faces[shown.face as usize];
    let (position, normal) = face.surface(problem, shown.at);
    let start = Ray { origin: position + problem.geometry.lift() * normal, direction: normal, from: face.triangle };
    if sees_a_light(problem, &start) {
        return false;
    }
    (0..LOOKS).all(|look| {
        let local = square_to_cosine_hemisphere(plastic::point(number as u32, look));
        let mut hit = [Hit::MISS];
        let ray = Ray { direction: Frame::about(normal).to_world(local), ..start };
        problem.geometry.closest(&[ray], &mut hit);
        is_dark(problem, field, &hit[0], DARKNESS * around)
    })
}

/// Whether `hit` shows less light than `darkness` [lm/m²]. The open is not dark: who can see it can be seen from it.
fn is_dark(problem: &Problem, field: &VertexField, hit: &Hit, darkness: f32) -> bool {
    if hit.is_miss() {
        return false;
    }
    let emitted = problem.mesh.at(hit.triangle, hit.uv, hit.back).map_or(Rgb::BLACK, |e| problem.mesh.emission(e));
    let irradiance = field.irradiance_at(problem, hit.triangle, hit.uv, hit.back);
    (emitted + irradiance).luminance() < darkness
}
