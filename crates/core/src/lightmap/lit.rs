//! A lightmap multiplied with the materials: what the surfaces look like, for viewers that know no lightmaps.

use super::{Lightmap, Texel, fill};
use crate::Problem;
use crate::math::Rgb;
use glam::{DVec2, Vec2};
use rayon::prelude::*;

/// Points across a texel at which textures are read.
const POINTS: u32 = 4;

/// Radiosity `B = Be + rho E` [lm/m²] of every texel, rows from the top; textures are averaged over the texel.
pub fn radiosity(problem: &Problem, lightmap: &Lightmap) -> Vec<Rgb> {
    let lit = |(number, (texel, &irradiance)): (usize, (&Option<Texel>, &Rgb))| {
        texel.map_or(Rgb::BLACK, |texel| {
            let (reflectivity, emission) = colors(problem, lightmap, number, texel);
            emission + reflectivity * irradiance
        })
    };
    let texels = lightmap.texels.list.par_iter().zip(&lightmap.irradiance);
    let mut radiosity: Vec<Rgb> = texels.enumerate().map(lit).collect();
    fill::continue_between(&lightmap.atlas, &lightmap.texels, &mut radiosity);
    radiosity
}

/// Mean reflectivity and emission [lm/m²] of the part of a texel that its face has.
fn colors(problem: &Problem, lightmap: &Lightmap, number: usize, texel: Texel) -> (Rgb, Rgb) {
    let face = &lightmap.atlas.faces[texel.face as usize];
    let material = problem.scene.material_of(face.triangle);
    let at = |at: Vec2| problem.scene.colors_at(face.triangle, face.on_triangle(at));
    if material.reflectivity_texture.is_none() && material.emission_texture.is_none() {
        return at(texel.at);
    }
    let width = lightmap.atlas.width as usize;
    let corner = DVec2::new((number % width) as f64, (number / width) as f64);
    let [a, b, c] = lightmap.atlas.in_texels(texel.face);
    let area = (b - a).perp_dot(c - a);
    let (mut sum, mut count) = ((Rgb::BLACK, Rgb::BLACK), 0);
    for k in 0..POINTS * POINTS {
        let p = corner + (DVec2::new(f64::from(k % POINTS), f64::from(k / POINTS)) + 0.5) / f64::from(POINTS);
        let (u, v) = ((p - a).perp_dot(c - a) / area, (b - a).perp_dot(p - a) / area);
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
            let (reflectivity, emission) = at(DVec2::new(u, v).as_vec2());
            sum = (sum.0 + reflectivity, sum.1 + emission);
            count += 1;
        }
    }
    if count == 0 { at(texel.at) } else { (sum.0 / count as f32, sum.1 / count as f32) }
}
