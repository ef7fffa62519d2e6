//! What an estimate is worth beside others: how independent estimates of the same elements are weighted.
//!
//! ```text
//! E = Σ w_k E_k,    V = Σ w_k² V_k,    w_k ∝ 1 / Σ_i A_i min(V_ik / (E_ik + E_scene)², 1)
//! ```
//!
//! The weights are the inverse of the variances of all elements together, relative to each element's mean and the scene's, and at most 1
//! for an element that is hardly known. No element's own noise decides about them, and a method that gets better with more rays
//! is not held back by its first steps. Cost: two looks at each element.

/// With fewer elements one of them might decide about the weights.
const FEW_ELEMENTS: usize = 64;

/// What an estimate knows of an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Area [m²].
    pub area: f64,
    /// Luminance irradiance [lux].
    pub mean: f64,
    /// Variance of the mean [lux²].
    pub variance: f64,
}

/// One over the relative variance of all `elements` together [1/m²], infinite without any; `None` if there are too few elements to tell.
pub fn precision(elements: impl ExactSizeIterator<Item = Known> + Clone) -> Option<f64> {
    if elements.len() < FEW_ELEMENTS {
        return None;
    }
    let flux = elements.clone().map(|known| known.area * known.mean).sum::<f64>();
    let scene_mean = flux / elements.clone().map(|known| known.area).sum::<f64>();
    let variance = |Known { area, mean, variance }| {
        let scale = (mean + scene_mean).powi(2).max(f64::MIN_POSITIVE);
        area * (variance / scale).min(1.0)
    };
    Some(1.0 / elements.map(variance).sum::<f64>().max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(area: f64, mean: f64, variance: f64) -> Option<f64> {
        precision([Known { area, mean, variance }; 100].into_iter())
    }

    #[test]
    fn it_is_one_over_the_relative_variance() {
        // Relative to twice the mean.
        assert!((of(1.0, 10.0, 4.0).unwrap() - 1.0 / (100.0 * 4.0 / 400.0)).abs() < 1e-12);
        assert!((of(2.0, 10.0, 4.0).unwrap() - 0.5 / (100.0 * 4.0 / 400.0)).abs() < 1e-12);
    }

    #[test]
    fn an_element_that_is_hardly_known_counts_as_such_and_no_more() {
        assert!((of(1.0, 10.0, 1e9).unwrap() - 0.01).abs() < 1e-12);
    }

    #[test]
    fn without_noise_it_is_infinite_and_few_elements_do_not_tell() {
        assert_eq!(of(1.0, 10.0, 0.0), Some(f64::INFINITY));
        assert_eq!(of(1.0, 0.0, 0.0), Some(f64::INFINITY));
        assert_eq!(precision([Known { area: 1.0, mean: 1.0, variance: 1.0 }; 63].into_iter()), None);
    }
}
