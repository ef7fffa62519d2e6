//! Linear functionals of an error over all elements: a small bias everywhere hides in every element and shines in a sum.
//!
//! The functionals are the total, the total of each object, and a few sums with random signs, all weighted by area. Several
//! independent runs give each a mean and a standard error, and so a t.

use crate::random::Random;
use isolux_core::Problem;
use isolux_core::math::moments::Moments;

/// An area-weighted mean over elements, some with their sign turned.
#[derive(Clone, Debug)]
pub struct Projection {
    /// What it is the mean of.
    pub name: String,
    /// Weight of each element; their absolute values sum to one.
    weights: Vec<f64>,
}

/// The mean of a projection over independent runs, in its standard errors.
#[derive(Clone, Debug)]
pub struct Deviation {
    pub name: String,
    pub t: f64,
    pub dof: f64,
}

/// The total, one projection for each object, and `random` ones with signs that follow from `seed`.
pub fn projections(problem: &Problem, random: usize, seed: u64) -> Vec<Projection> {
    let mesh = &problem.mesh;
    let weighted = |name: String, mut sign: Box<dyn FnMut(u32) -> f64 + '_>| {
        let weights: Vec<f64> = mesh.elements().map(|e| f64::from(mesh.area(e)) * sign(e)).collect();
        let total: f64 = weights.iter().map(|w| w.abs()).sum();
        Projection { name, weights: weights.into_iter().map(|w| w / total).collect() }
    };
    let object_of = |e: u32| problem.object(e) as usize;
    let total = weighted("total".to_owned(), Box::new(|_| 1.0));
    let of_objects = problem.scene.objects.iter().enumerate().map(|(k, object)| {
        weighted(format!("object {}", object.name), Box::new(move |e| f64::from(u8::from(object_of(e) == k))))
    });
    let of_signs = (0..random).map(|k| {
        let mut draw = Random::new(seed.wrapping_add(k as u64));
        weighted(format!("signs {k}"), Box::new(move |_| draw.sign()))
    });
    std::iter::once(total).chain(of_objects).chain(of_signs).collect()
}

impl Projection {
    /// The projection of one value per element.
    pub fn of(&self, values: impl IntoIterator<Item = f64>) -> f64 {
        self.weights.iter().zip(values).map(|(weight, value)| weight * value).sum()
    }

    /// How far the mean over `runs` of independent results, one value per element, lies from `exact`. Deviations below
    /// 1e-6 of the mean of `exact` are rounding, as results are kept in single precision.
    pub fn deviation(&self, runs: &[Vec<f64>], exact: &[f64]) -> Deviation {
        let error = |run: &Vec<f64>| self.of(run.iter().zip(exact).map(|(value, exact)| value - exact));
        let moments: Moments = runs.iter().map(error).collect();
        let scale: f64 = self.weights.iter().zip(exact).map(|(w, b)| (w * b).abs()).sum();
        let std_error = moments.std_error().hypot(1e-6 * scale);
        let t = if moments.mean == 0.0 { 0.0 } else { moments.mean / std_error };
        Deviation { name: self.name.clone(), t, dof: runs.len() as f64 - 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::{assert_t, refutes};
    use crate::statistics::p_of_t;
    use isolux_core::mesh::Resolution;
    use isolux_core::scene::builtin::builtin;

    /// Thirty-two runs whose elements are all 1 with a noise of 10 %, and `bias`.
    fn runs(problem: &Problem, bias: f64) -> Vec<Vec<f64>> {
        let mut random = Random::new(11);
        let noisy = |_| 1.0 + bias + 0.1 * random.sign();
        let values: Vec<f64> = (0..32 * problem.mesh.len()).map(noisy).collect();
        values.chunks(problem.mesh.len()).map(<[f64]>::to_vec).collect()
    }

    #[test]
    fn noise_passes_and_a_bias_of_a_twentieth_of_it_is_found() {
        let problem = Problem::new(builtin("box").unwrap(), Resolution::Elements(2000)).unwrap();
        let exact = vec![1.0; problem.mesh.len()];
        let projections = projections(&problem, 5, 7);
        assert_eq!(projections.len(), 12);
        for projection in &projections {
            let Deviation { t, dof, .. } = projection.deviation(&runs(&problem, 0.0), &exact);
            assert_t("projections of a fair coin", t, dof);
        }
        let Deviation { t, dof, .. } = projections[0].deviation(&runs(&problem, 0.005), &exact);
        assert!(refutes(p_of_t(t, dof)), "t = {t}");
    }

    #[test]
    fn exact_results_deviate_by_nothing() {
        let problem = Problem::new(builtin("sphere").unwrap(), Resolution::Elements(8)).unwrap();
        let exact = vec![3.0; 8];
        let all = projections(&problem, 2, 1);
        assert!(all.iter().all(|p| p.deviation(&vec![exact.clone(); 4], &exact).t == 0.0));
    }
}
