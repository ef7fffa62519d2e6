//! An estimate with its error bar, and what confidence makes of it.
//!
//! Quantiles are those of Student's t and of Fisher's F (Abramowitz, Stegun 1964, ch. 26.6 f.). Merged estimates have the degrees of
//! freedom of Welch (1947) and Satterthwaite (1946): `(Σ v_k)² / Σ (v_k² / d_k)`, where v_k is what each adds to the variance.

use statrs::distribution::{ContinuousCDF, FisherSnedecor, StudentsT};

/// More degrees of freedom than this are as good as infinitely many.
const MANY: f64 = 1e4;

/// A mean, the variance of that mean, and how many degrees of freedom that variance has.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Estimate {
    pub mean: f64,
    pub variance: f64,
    pub freedom: f64,
}

impl Estimate {
    /// Of a quantity about which nothing is known.
    pub const UNKNOWN: Estimate = Estimate { mean: f64::NAN, variance: f64::NAN, freedom: 0.0 };

    pub fn std_error(&self) -> f64 {
        self.variance.sqrt()
    }

    /// The mean is within so much of the true value with this `confidence`, by Student's t.
    pub fn margin(&self, confidence: f64) -> f64 {
        self.std_error() * student(confidence, self.freedom)
    }

    /// The mean of both, which are independent, where the other one has this `weight` [1].
    pub fn merged(self, other: Estimate, weight: f64) -> Estimate {
        let (of_self, of_other) = ((1.0 - weight).powi(2) * self.variance, weight.powi(2) * other.variance);
        let variance = of_self + of_other;
        let freedom = variance * variance / (of_self * of_self / self.freedom + of_other * of_other / other.freedom);
        Estimate {
            mean: (1.0 - weight) * self.mean + weight * other.mean,
            variance,
            // Neither has any variance.
            freedom: if freedom.is_nan() { self.freedom + other.freedom } else { freedom },
        }
    }

    /// The sum of both, which are independent.
    pub fn plus(self, other: Estimate) -> Estimate {
        self.merged(other, 0.5).times(2.0)
    }

    /// Of `k` times the quantity.
    pub fn times(self, k: f64) -> Estimate {
        Estimate { mean: self.mean * k, variance: self.variance * k * k, freedom: self.freedom }
    }
}

/// Student's t with so much `freedom` is within plus or minus this with probability `confidence`; NaN without freedom.
pub fn student(confidence: f64, freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom.min(MANY)).map_or(f64::NAN, |t| -t.inverse_cdf(0.5 - 0.5 * confidence))
}

/// Fisher's F is at most this with probability `confidence`; NaN without freedom.
pub fn fisher(confidence: f64, numerator: f64, denominator: f64) -> f64 {
    FisherSnedecor::new(numerator.min(MANY), denominator.min(MANY)).map_or(f64::NAN, |f| f.inverse_cdf(confidence))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn assert_near(found: f64, table: f64) {
        assert!((found / table - 1.0).abs() < 2e-4, "{found} instead of {table}");
    }

    #[test]
    fn quantiles_of_the_tables() {
        assert_near(student(0.95, 7.0), 2.3646);
        assert_near(student(0.95, 1e9), 1.9602);
        assert_near(student(0.999, 1.0), 636.619);
        // Far out in the tail, as for the worst of many elements: p = 2.5e-7 on either side.
        assert_near(student(1.0 - 5e-7, 30.0), 6.3686);
        assert_near(fisher(0.95, 1.0, 7.0), 5.5914);
        assert_near(fisher(0.95, 10.0, 70.0), 1.9689);
        assert_near(fisher(0.95, 1e6, 1e6), 1.0334);
        assert!(student(0.95, 0.0).is_nan() && fisher(0.95, 0.0, 1.0).is_nan());
    }

    #[test]
    fn t_squared_is_f() {
        for freedom in [3.0, 7.0, 40.0] {
            assert_near(student(0.9, freedom).powi(2), fisher(0.9, 1.0, freedom));
        }
    }

    #[test]
    fn equals_merge_to_half_the_variance_and_twice_the_freedom() {
        let one = Estimate { mean: 2.0, variance: 1.0, freedom: 7.0 };
        let two = one.merged(Estimate { mean: 4.0, ..one }, 0.5);
        assert_eq!(two, Estimate { mean: 3.0, variance: 0.5, freedom: 14.0 });
        let exact = Estimate { variance: 0.0, ..one };
        assert_eq!(exact.merged(exact, 0.25), Estimate { freedom: 14.0, ..exact });
        assert_eq!(one.plus(Estimate { mean: 4.0, ..one }), Estimate { mean: 6.0, variance: 2.0, freedom: 14.0 });
        assert_eq!(one.times(3.0), Estimate { mean: 6.0, variance: 9.0, freedom: 7.0 });
        // Whoever has no weight changes nothing.
        assert_eq!(one.merged(Estimate { mean: 9.0, variance: 5.0, freedom: 1.0 }, 0.0), one);
    }
}
