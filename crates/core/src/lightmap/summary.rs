//! What a lightmap holds for each object, and how well lookups agree with the solution.

use super::Lightmap;
use super::atlas::{area, area_in_texels};
use crate::math::Rgb;
use crate::mesh::cells;
use crate::{Problem, Solution};
use glam::{DVec2, Vec2};

/// Most divisions along each edge of a face at which it is looked up.
const MOST_DIVISIONS: u16 = 256;

/// The texels of one object.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ObjectTexels {
    /// Index into [`crate::scene::Scene::objects`].
    pub object: u32,
    pub name: String,
    pub charts: u32,
    /// Texels that lookups on it read.
    pub texels: u64,
    /// Area of what is shown of it [m²]; both sides of two-sided surfaces count where both are shown.
    pub area: f64,
    /// Mean illuminance by area of lookups all over it [lux], and of the elements there. They differ by what is
    /// covered, and by what a texel cannot show.
    pub mean: f64,
    pub mean_of_solution: f64,
}

/// One entry for each object that is shown, in the order of the scene's objects.
pub fn per_object(problem: &Problem, solution: &Solution, lightmap: &Lightmap) -> Vec<ObjectTexels> {
    let atlas = &lightmap.atlas;
    let empty = |(k, object): (usize, &crate::scene::Object)| ObjectTexels {
        object: k as u32,
        name: object.name.clone(),
        charts: 0,
        texels: 0,
        area: 0.0,
        mean: 0.0,
        mean_of_solution: 0.0,
    };
    let mut objects: Vec<ObjectTexels> = problem.scene.objects.iter().enumerate().map(empty).collect();
    let mut is_counted = vec![false; atlas.chart_count as usize];
    for (f, face) in atlas.faces.iter().enumerate() {
        let object = &mut objects[face.object(problem) as usize];
        object.charts += u32::from(!std::mem::replace(&mut is_counted[atlas.chart[f] as usize], true));
        let (own, [baked, solved]) = (area(problem, face), light_on(problem, solution, lightmap, f));
        object.area += own;
        object.mean += own * baked;
        object.mean_of_solution += own * solved;
    }
    for texel in lightmap.texels.list.iter().flatten() {
        objects[atlas.faces[texel.face as usize].object(problem) as usize].texels += 1;
    }
    objects.retain(|object| object.area > 0.0);
    for object in &mut objects {
        object.mean /= object.area;
        object.mean_of_solution /= object.area;
    }
    objects
}

/// Mean illuminance [lux] on face `f`: of lookups about a texel apart, and of the elements there.
fn light_on(problem: &Problem, solution: &Solution, lightmap: &Lightmap, f: usize) -> [f64; 2] {
    let (face, [a, b, c]) = (&lightmap.atlas.faces[f], lightmap.atlas.uv[f]);
    let size = DVec2::new(f64::from(lightmap.atlas.width), f64::from(lightmap.atlas.height));
    let texels = area_in_texels(&lightmap.atlas.uv[f], size);
    let divisions = (texels.sqrt().ceil() as u16).clamp(1, MOST_DIVISIONS);
    let count = cells::count(divisions);
    let (mut baked, mut solved) = (0.0, 0.0);
    for cell in 0..count {
        let at = cells::corners(cell, divisions).iter().sum::<Vec2>() / 3.0;
        baked += lightmap.lookup(a + at.x * (b - a) + at.y * (c - a)).luminance_f64();
        let element = problem.mesh.at(face.triangle, face.on_triangle(at), face.back);
        solved += element.map_or(Rgb::BLACK, |e| solution.irradiance[e as usize]).luminance_f64();
    }
    [baked, solved].map(|sum| sum / f64::from(count))
}
