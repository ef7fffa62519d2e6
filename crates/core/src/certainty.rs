//! How sure sums over many elements are. Their errors do not follow from those of the elements, which the same rays light.
//!
//! Independent replicates tell them. The mean irradiance of an object differs from replicate to replicate: Student's t. The error of
//! the whole solution is `r² = Σ A (E - E*)² / Σ A`, a quadratic form of errors that are about normal: r² over its mean
//! is taken as chi-square over its ν degrees of freedom (Satterthwaite 1946), where ν is the number of ways in which a solution can
//! be wrong independently: one if all errors rise and fall together, thousands if every element has its own. The square distances
//! between replicates follow the same law, so their spread tells ν, and r² over its estimate is Fisher's F with ν and `ν d` degrees of freedom, d
//! those of the replicates.

use crate::math::Estimate;
use crate::math::estimate::fisher;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// ν is an estimate itself: it is taken as small as it may be with this probability.
const DOUBT: f64 = 0.1;
/// As many ways to be wrong as will ever be told from infinitely many.
const MANY: f64 = 1e4;

/// Of a solution. Irradiances are luminance [lux].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Certainty {
    /// Mean irradiance by area of all surfaces.
    pub scene: Estimate,
    /// Mean irradiance by area of the front and then of the back of each object of the scene ([`Problem::face`](crate::Problem::face)); zero
    /// where there are no elements.
    pub faces: Vec<Estimate>,
    /// The area-weighted mean square error [lux²] that is expected.
    pub mean_square: f64,
    pub freedom: f64,
    pub ways: Ways,
}

/// What square distances between replicates have told about ν.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Ways {
    /// Sum of the squares of their relative deviations from their mean, and its degrees of freedom: each is about 2 / ν.
    pub sum_sq: f64,
    pub freedom: f64,
}

impl Ways {
    /// Of `squares` that have the same law.
    pub fn of(squares: &[f64]) -> Ways {
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        if squares.len() < 2 || mean <= 0.0 {
            return Ways::default();
        }
        let sum_sq = squares.iter().map(|square| (square / mean - 1.0).powi(2)).sum();
        Ways { sum_sq, freedom: squares.len() as f64 - 1.0 }
    }

    /// Of both together.
    pub fn merged(self, other: Ways) -> Ways {
        Ways { sum_sq: self.sum_sq + other.sum_sq, freedom: self.freedom + other.freedom }
    }

    /// Of the sum of two independent errors, with these mean squares: `1/√ν = Σ m_k/√ν_k / Σ m_k`, as few as there can be. It is so
    /// if both err in the same places (Cauchy and Schwarz); degrees of freedom are those of Welch and Satterthwaite.
    fn summed(self, other: Ways, mean_squares: [f64; 2]) -> Ways {
        let all = mean_squares[0] + mean_squares[1];
        let part = |ways: Ways, mean_square: f64| match mean_square {
            0.0 => (0.0, 0.0),
            _ => {
                let part = mean_square / all * (ways.sum_sq / ways.freedom).sqrt();
                (part, part * part / ways.freedom)
            }
        };
        let [one, two] = [part(self, mean_squares[0]), part(other, mean_squares[1])];
        let relative = (one.0 + two.0).powi(2);
        let freedom = match relative {
            0.0 => self.freedom.min(other.freedom),
            _ => relative / (one.1 + two.1),
        };
        if freedom.is_finite() { Ways { sum_sq: relative * freedom, freedom } } else { Ways::default() }
    }

    /// ν, as few as there may be.
    pub fn at_least(&self) -> f64 {
        let doubt = ChiSquared::new(self.freedom).map_or(f64::NAN, |chi2| chi2.inverse_cdf(DOUBT));
        let ways = 2.0 * doubt / self.sum_sq;
        if ways.is_nan() { 1.0 } else { ways.clamp(1.0, MANY) }
    }
}

impl Certainty {
    /// Of the mean of two solutions that are independent, where the other one has this `weight` [1].
    pub fn merged(&self, other: &Certainty, weight: f64) -> Certainty {
        let square = |of: &Certainty| Estimate { mean: 0.0, variance: of.mean_square, freedom: of.freedom };
        let merged = square(self).merged(square(other), weight);
        let faces = self.faces.iter().zip(&other.faces);
        Certainty {
            scene: self.scene.merged(other.scene, weight),
            faces: faces.map(|(a, b)| a.merged(*b, weight)).collect(),
            mean_square: merged.variance,
            freedom: merged.freedom,
            ways: self.ways.merged(other.ways),
        }
    }

    /// Of the sum of two solutions that are independent: the light of two lamps.
    pub fn plus(&self, other: &Certainty) -> Certainty {
        let square = |of: &Certainty| Estimate { mean: 0.0, variance: of.mean_square, freedom: of.freedom };
        let sum = square(self).plus(square(other));
        Certainty {
            scene: self.scene.plus(other.scene),
            faces: self.faces.iter().zip(&other.faces).map(|(a, b)| a.plus(*b)).collect(),
            mean_square: sum.variance,
            freedom: sum.freedom,
            ways: self.ways.summed(other.ways, [self.mean_square, other.mean_square]),
        }
    }

    /// The area-weighted RMS error that is expected, relative to the mean irradiance. NaN in the dark.
    pub fn rms(&self) -> f64 {
        self.mean_square.sqrt() / self.scene.mean
    }

    /// The area-weighted RMS error is at most this with such `confidence`, relative to the mean irradiance.
    pub fn rms_bound(&self, confidence: f64) -> f64 {
        let ways = self.ways.at_least();
        self.rms() * fisher(confidence, ways, ways * self.freedom).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_squares_come_from_many_ways_to_be_wrong_and_scattered_ones_from_few() {
        assert_eq!(Ways::of(&[2.0; 8]).at_least(), MANY);
        let squares = [0.1, 3.0, 0.5, 0.02, 1.2, 0.4, 2.1];
        assert_eq!(Ways::of(&squares).at_least(), 1.0);
        assert_eq!(Ways::of(&[1.0]).at_least(), 1.0, "one of them tells nothing");
        // Relative variance 0.02: a hundred ways, and at least a third of that from seven of them.
        let spread = Ways { sum_sq: 6.0 * 0.02, freedom: 6.0 };
        assert!((30.0..45.0).contains(&spread.at_least()), "{spread:?}");
        let often = (0..20).fold(Ways::default(), |all, _| all.merged(spread));
        assert!((80.0..100.0).contains(&often.at_least()), "{often:?}");
    }

    #[test]
    fn the_errors_of_a_sum_may_all_be_in_the_same_places() {
        let spread = Ways { sum_sq: 6.0 * 0.02, freedom: 6.0 };
        let sum = spread.summed(spread, [3.0, 1.0]);
        assert!((sum.sum_sq / sum.freedom - 0.02).abs() < 1e-12, "a hundred ways each, a hundred together");
        assert!((sum.freedom - 6.0 / (0.75f64.powi(2) + 0.25f64.powi(2))).abs() < 1e-9);
        let exact = spread.summed(Ways::default(), [3.0, 0.0]);
        assert!((exact.sum_sq - spread.sum_sq).abs() < 1e-12 && (exact.freedom - 6.0).abs() < 1e-9);
        assert_eq!(spread.summed(Ways::default(), [3.0, 1.0]), Ways::default(), "one of them is not known");
    }

    #[test]
    fn the_bound_of_one_way_is_students() {
        let scene = Estimate { mean: 10.0, variance: 0.04, freedom: 7.0 };
        let one = Certainty { scene, faces: vec![], mean_square: 0.04, freedom: 7.0, ways: Ways::default() };
        assert!((one.rms() - 0.02).abs() < 1e-12);
        assert!((one.rms_bound(0.95) * 10.0 / scene.margin(0.95) - 1.0).abs() < 1e-3);
        let many = Certainty { ways: Ways { sum_sq: 0.0, freedom: 100.0 }, ..one.clone() };
        assert!(many.rms_bound(0.95) < 1.03 * many.rms());
        let sum = many.plus(&many);
        assert!((sum.mean_square - 0.08).abs() < 1e-12 && (sum.scene.mean, sum.freedom) == (20.0, 14.0));
        let both = many.merged(&many, 0.5);
        assert!((both.mean_square - 0.02).abs() < 1e-12 && both.freedom == 14.0);
    }
}
