//! Sums over many elements in each replicate: what tells the [`Certainty`] of a solution.
//!
//! Replicates come in rounds, which are merged with the weights of [`Replicates`](super::replicates::Replicates). Cost: one look at each
//! element and replicate.

use crate::Problem;
use crate::certainty::{Certainty, Ways};
use crate::math::moments::Moments;
use crate::math::{Estimate, Rgb};

/// Running means over replicates and rounds; a few numbers for each face.
#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Totals {
    /// Mean irradiance of the scene, and then of each face, of the running round [lux].
    means: Vec<Moments>,
    /// Square distances of the running round's replicates from the mean of those before [lux²]: each is an independent estimate of
    /// the variance of a replicate.
    squares: Vec<f64>,
    earlier: Option<Certainty>,
}

impl Totals {
    /// Adds a replicate of this luminance `irradiance(e)` [lux]; `square` [lux²] is its distance from those before.
    pub fn push(&mut self, problem: &Problem, irradiance: impl Fn(u32) -> Rgb, square: Option<f64>) {
        let mesh = &problem.mesh;
        let mut sums = vec![(0.0, 0.0); 1 + problem.faces()];
        for e in mesh.elements() {
            let area = f64::from(mesh.area(e));
            let flux = area * irradiance(e).luminance_f64();
            for k in [0, 1 + problem.face(e) as usize] {
                sums[k].0 += flux;
                sums[k].1 += area;
            }
        }
        self.means.resize(sums.len(), Moments::default());
        let share = |(flux, area): (f64, f64)| if area > 0.0 { flux / area } else { 0.0 };
        self.means.iter_mut().zip(sums).for_each(|(mean, sum)| mean.push(share(sum)));
        self.squares.extend(square);
    }

    /// Closes the running round, which has this weight.
    pub fn close_round(&mut self, weight: f64) {
        self.earlier = self.certainty(weight);
        self.means.clear();
        self.squares.clear();
    }

    /// What is known, where the running round has this `weight`; `None` before there are two replicates.
    pub fn certainty(&self, weight: f64) -> Option<Certainty> {
        let count = self.squares.len() as f64 + 1.0;
        if self.squares.is_empty() {
            return self.earlier.clone();
        }
        let estimate = |of: &Moments| Estimate { mean: of.mean, variance: of.variance() / count, freedom: count - 1.0 };
        let mut means = self.means.iter().map(estimate);
        let now = Certainty {
            scene: means.next().unwrap_or(Estimate::UNKNOWN),
            faces: means.collect(),
            mean_square: self.squares.iter().sum::<f64>() / (count - 1.0) / count,
            freedom: count - 1.0,
            ways: Ways::of(&self.squares),
        };
        Some(match &self.earlier {
            Some(earlier) => earlier.merged(&now, weight),
            None => now,
        })
    }
}
