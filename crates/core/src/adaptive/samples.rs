//! Light at points that are spread evenly over a patch: what a single element there would be wrong by, and what it gains if it is bisected.

use super::light::Light;
use crate::mesh::{cells, halved};
use glam::Vec2;

/// Barycentric coordinates of the corners of a triangle on itself.
pub const WHOLE: [Vec2; 3] = [Vec2::ZERO, Vec2::X, Vec2::Y];
/// A patch with fewer samples gets new ones of its own.
const FEWEST: usize = 6;
/// Samples along the edge of a patch that gets new ones, and of an element of a whole triangle; most of them along the edge of that.
const ALONG_EDGE: u16 = 4;
const MOST_ALONG_EDGE: u16 = 512;

/// Barycentric coordinates on a patch, and the light there [lux] on the front and on the back.
pub struct Samples(Vec<(Vec2, [f32; 2])>);

impl Samples {
    /// On the patch with these corners on `triangle`.
    pub fn of(light: &Light, triangle: u32, corners: [Vec2; 3]) -> Samples {
        Samples::along(light, triangle, corners, ALONG_EDGE)
    }

    /// On a whole triangle, so many that each element on which the light is known has some.
    pub fn of_triangle(light: &Light, triangle: u32) -> Samples {
        Samples::along_elements(light, triangle, ALONG_EDGE)
    }

    /// On a whole triangle, so few as mean and variance need: where light is linear, on a single element, four samples have them exactly.
    pub fn for_moments(light: &Light, triangle: u32) -> Samples {
        Samples::along_elements(light, triangle, 2)
    }

    /// On a whole triangle, so many along the edge of each element on which the light is known.
    fn along_elements(light: &Light, triangle: u32, divisions: u16) -> Samples {
        let along = f64::from(divisions) * f64::from(light.elements_on(triangle)).sqrt();
        Samples::along(light, triangle, WHOLE, (along.ceil() as u16).min(MOST_ALONG_EDGE))
    }

    /// In the middles of the cells of the patch with these corners on `triangle`, so many divisions along its edge.
    fn along(light: &Light, triangle: u32, [a, b, c]: [Vec2; 3], divisions: u16) -> Samples {
        let sample = |cell| {
            let uv = cells::corners(cell, divisions).iter().sum::<Vec2>() / 3.0;
            (uv, light.at(triangle, a + uv.x * (b - a) + uv.y * (c - a)))
        };
        Samples((0..cells::count(divisions)).map(sample).collect())
    }

    /// Whether they are too few to tell what the patch is like.
    pub fn are_few(&self) -> bool {
        self.0.len() < FEWEST
    }

    /// Those on the halves of the patch, if it is bisected from its corner `from`.
    pub fn halved(self, from: u8) -> [Samples; 2] {
        let mut halves = [Vec::new(), Vec::new()];
        for (uv, light) in self.0 {
            let (half, within) = halved(uv, from);
            halves[half as usize].push((within, light));
        }
        halves.map(Samples)
    }

    /// Mean [lux] of the light on both sides, and its variance [lux²], both sides added.
    pub fn mean_and_variance(&self) -> ([f32; 2], f32) {
        let count = self.0.len() as f32;
        let mean = [0, 1].map(|side| self.0.iter().map(|(_, light)| light[side]).sum::<f32>() / count);
        let square = |(_, light): &(Vec2, [f32; 2])| (light[0] - mean[0]).powi(2) + (light[1] - mean[1]).powi(2);
        (mean, self.0.iter().map(square).sum::<f32>() / (count - 1.0))
    }

    /// Variance [lux²] between the halves of the patch, if it is bisected from its corner `from`, both sides added.
    pub fn between(&self, from: u8) -> f32 {
        let (mut sums, mut counts) = ([[0.0; 2]; 2], [0.0; 2]);
        for (uv, light) in &self.0 {
            let half = halved(*uv, from).0 as usize;
            counts[half] += 1.0;
            (0..2).for_each(|side| sums[half][side] += light[side]);
        }
        if counts.contains(&0.0) {
            return 0.0;
        }
        let difference = |side: usize| sums[0][side] / counts[0] - sums[1][side] / counts[1];
        let weight: f32 = counts[0] * counts[1] / (counts[0] + counts[1]).powi(2);
        weight * (difference(0).powi(2) + difference(1).powi(2))
    }
}
