//! Test statistics and their p-values.

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

/// Probability that a standard normal variable is at least as far from zero as `z`. NaN counts as impossible: 0.
pub fn p_of_z(z: f64) -> f64 {
    if z.is_nan() { 0.0 } else { 2.0 * Normal::standard().sf(z.abs()) }
}

/// Probability that Student's t with `dof` degrees of freedom is at least as far from zero as `t`; 0 for NaN, or if there
/// are no degrees of freedom.
pub fn p_of_t(t: f64, dof: f64) -> f64 {
    match StudentsT::new(0.0, 1.0, dof) {
        Ok(student) if !t.is_nan() => 2.0 * student.sf(t.abs()),
        _ => 0.0,
    }
}

/// Probability that chi-square with `dof` degrees of freedom is at least `chi2`; 0 for NaN, or without degrees of freedom.
pub fn p_of_chi2(chi2: f64, dof: f64) -> f64 {
    match ChiSquared::new(dof) {
        Ok(distribution) if !chi2.is_nan() => distribution.sf(chi2),
        _ => 0.0,
    }
}

/// The distance from zero that a standard normal variable exceeds with probability `p`.
pub fn z_of_p(p: f64) -> f64 {
    -Normal::standard().inverse_cdf(0.5 * p)
}

/// Pearson's chi-square of `observed` counts against `expected` ones, and its degrees of freedom. Cells that expect fewer than
/// five are pooled into one. The totals are taken as equal.
pub fn chi_square(observed: &[u64], expected: &[f64]) -> (f64, f64) {
    assert_eq!(observed.len(), expected.len(), "as many expectations as observations");
    let (mut chi2, mut cells) = (0.0, 0);
    let mut pooled = (0.0, 0.0);
    let mut add = |(o, e): (f64, f64)| {
        chi2 += (o - e).powi(2) / e;
        cells += 1;
    };
    for (&o, &e) in observed.iter().zip(expected) {
        if e < 5.0 { pooled = (pooled.0 + o as f64, pooled.1 + e) } else { add((o as f64, e)) }
    }
    if pooled.1 > 0.0 {
        add(pooled);
    } else if pooled.0 > 0.0 {
        return (f64::INFINITY, 1.0);
    }
    (chi2, f64::from(cells - 1))
}

/// Deviation of a count of successes from `trials * probability`, in standard deviations of the binomial distribution.
pub fn z_of_count(successes: u64, trials: u64, probability: f64) -> f64 {
    let (n, p) = (trials as f64, probability);
    (successes as f64 - n * p) / (n * p * (1.0 - p)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tails_of_the_tables() {
        let near = |found: f64, table: f64| assert!((found / table - 1.0).abs() < 1e-4, "{found} {table}");
        near(p_of_z(1.959_964), 0.05);
        near(p_of_z(-6.0), 1.973_175e-9);
        near(z_of_p(1e-6), 4.891_638);
        near(p_of_t(2.262_157, 9.0), 0.05);
        near(p_of_t(-636.619_25, 1.0), 0.001);
        near(p_of_chi2(18.307_04, 10.0), 0.05);
        near(p_of_chi2(2.0 * 20.0, 2.0), (-20f64).exp());
        assert_eq!((p_of_z(f64::NAN), p_of_t(f64::INFINITY, 7.0), p_of_chi2(1.0, 0.0)), (0.0, 0.0, 0.0));
    }

    #[test]
    fn rare_cells_are_pooled_and_impossible_ones_refute() {
        let (chi2, dof) = chi_square(&[50, 48, 1, 1], &[49.0, 49.0, 1.0, 1.0]);
        assert_eq!(dof, 2.0);
        assert!((chi2 - 2.0 / 49.0).abs() < 1e-12);
        assert_eq!(chi_square(&[99, 1], &[100.0, 0.0]).0, f64::INFINITY);
    }
}
