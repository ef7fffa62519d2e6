//! Global lines: chosen without regard to any surface, so that they meet all of them (Sbert 1993).
//!
//! A global line joins two uniform points of the bounding sphere, radius R. Such lines are uniform: of N lines `N A / (2 pi
//! R²)` are expected to cross a plane surface of area A, uniformly over it and cosine-distributed about its normal. So a
//! crossing is a local line, `N_ij / N_i` tends to the form factor `F_ij`, and each span serves both its ends. The density
//! cannot be steered: small elements get few lines.
//!
//! Unbiased. Cost: one ray of all hits a line.

use super::Crossing;
use super::span::{Span, spans};
use crate::Problem;
use crate::geometry::{HitLists, Ray};
use crate::math::Frame;
use crate::math::warp::square_to_sphere;
use crate::sampling::{Sample, Sequence};
use glam::{Vec2, Vec3};
use std::f64::consts::TAU;
use std::ops::Range;

/// The stream of a sequence that global lines draw, beyond those of all elements and lamps.
pub const STREAM: u64 = 1 << 32;
/// Lines traced at once.
const BATCH: u64 = 512;

/// The global line that belongs to `sample` in a sphere (centre, radius [m]): each half of it chooses a point.
pub fn ray([x1, x2, x3, x4]: Sample, (center, radius): (Vec3, f32)) -> Ray {
    let (p, q) = (square_to_sphere(Vec2::new(x1, x2)), square_to_sphere(Vec2::new(x3, x4)));
    // Where both points are one, the line touches the sphere there.
    let direction = (q - p).try_normalize().unwrap_or(Frame::about(p).x);
    Ray::whole_line(center + 0.5 * radius * (p + q), direction, radius)
}

/// How many of `lines` global lines in a sphere of `radius` [m] are expected to cross a plane surface of `area` [m²]:
/// `N A / (2 pi R²)`.
pub fn expected_crossings(lines: u64, area: f32, radius: f32) -> f64 {
    lines as f64 * f64::from(area) / (TAU * f64::from(radius).powi(2))
}

/// Traces global lines `lines` of `sequence` and hands their spans to `each`, line by line.
pub fn trace(problem: &Problem, sequence: &dyn Sequence, lines: Range<u64>, mut each: impl FnMut(Span)) {
    let sphere = problem.geometry.bounding_sphere();
    let (mut samples, mut rays, mut lists) = ([[0.0; 4]; BATCH as usize], Vec::new(), HitLists::default());
    let mut next = lines.start;
    while next < lines.end {
        let count = (lines.end - next).min(BATCH);
        let samples = &mut samples[..count as usize];
        sequence.fill(STREAM, next, samples);
        rays.clear();
        rays.extend(samples.iter().map(|&sample| ray(sample, sphere)));
        problem.geometry.all(&rays, &mut lists);
        for hits in lists.iter() {
            spans(problem.geometry.lift(), hits.iter().map(|hit| Crossing::of(problem, hit)), &mut each);
        }
        next += count;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Resolution;
    use crate::sampling::OwenSobol;
    use crate::scene::builtin::builtin;

    #[test]
    fn lines_pass_through_their_points_and_begin_outside() {
        let (center, radius) = (Vec3::new(1.0, -2.0, 3.0), 2.0);
        for k in 0..1000u32 {
            // The first has two equal points.
            let x = |a: f32| (k as f32 * a).fract();
            let sample = [x(0.618), x(0.414), x(0.732), x(0.236)];
            let line = ray(sample, (center, radius));
            assert!(line.origin.distance(center) > 1.49 * radius && line.direction.is_normalized());
            for end in [Vec2::new(sample[0], sample[1]), Vec2::new(sample[2], sample[3])] {
                let to = center + radius * square_to_sphere(end) - line.origin;
                assert!(to.cross(line.direction).length() < 1e-4 && to.dot(line.direction) > 0.0, "{sample:?}");
            }
        }
    }

    #[test]
    fn spans_do_not_depend_on_how_lines_are_cut_into_ranges() {
        let problem = Problem::new(builtin("cubes").unwrap(), Resolution::Elements(500)).unwrap();
        let sequence = OwenSobol::new(3);
        let of = |ranges: &[Range<u64>]| {
            let mut found = Vec::new();
            ranges.iter().for_each(|range| trace(&problem, &sequence, range.clone(), |s| found.push(s)));
            found
        };
        assert_eq!(of(&[100..612, 612..1700]), of(&[100..101, 101..900, 900..900, 900..1700]));
    }
}
