//! One false-alarm budget for the whole suite: all statistical tests together may fail by chance once in a million runs.
//!
//! Every statistical test has a line in [`REGISTER`] with its number of comparisons; each comparison of the m in the table
//! gets a significance level of `1e-6 / m` (Bonferroni). A test that is not in the table cannot be made.

use crate::ensemble::comparisons;
use crate::honesty;
use crate::statistics::{p_of_chi2, p_of_t, p_of_z};
use isolux_core::sampling::SEQUENCES;

/// Probability that one run of the whole suite raises a false alarm.
pub const FALSE_ALARM: f64 = 1e-6;

/// All statistical tests and how many comparisons each makes at most.
pub const REGISTER: &[(&str, u32)] = &[
    // So many methods with so many sequences, in a box of six faces and a sphere of eight octants.
    ("battery: box", 19 * 8 * comparisons(6)),
    ("battery: furnace", 19 * 8 * comparisons(6)),
    ("battery: sphere", 19 * 8 * comparisons(8)),
    ("regular power shooting", comparisons(8)),
    ("form factors of the sphere by local lines", 8),
    ("uniform points of a sphere's element", 1),
    ("form factors of rectangles by local lines", 3),
    ("crossings of global lines", 24),
    ("form factors of rectangles by global lines", 3),
    ("form factors of rectangles by bundles", 6),
    ("gathering by bundles in a box", 6),
    ("form factors of the sphere by global lines", 1),
    ("directions of global lines at an element", 2),
    ("form factor matrix by local lines", 4),
    ("form factor matrix by global lines", 3),
    ("projections of a fair coin", 12),
    ("furnace: box", 2 * comparisons(6)),
    ("furnace: cubes", 2 * comparisons(9)),
    ("furnace: labyrinth", 6 * comparisons(48)),
    ("furnace: cube with few lines", comparisons(6)),
    ("sphere", 2 * comparisons(8)),
    ("honest error bars", 4 * honesty::COMPARISONS),
    ("honest error bars of auto", 2 * honesty::COMPARISONS),
    ("honest error bars of objects", honesty::COMPARISONS_OF_OBJECTS),
    ("promises of the error of all elements", 1),
    ("promises of the error of means", 2),
    ("honest error bars with few lines", 1),
    ("honest error bars over rounds", 1),
    ("honest error bars of extended runs", 2),
    ("honest error bars of merged runs", 1),
    ("back face of a flipped wall", 1),
    ("point light in a black box", comparisons(6)),
    ("point light in a sphere", 2 * comparisons(8)),
    ("spot in a black box", comparisons(6)),
    ("sun on a floor", comparisons(1)),
    ("direct light: box", 3 * comparisons(6)),
    ("direct light: sphere", 3 * comparisons(8)),
    ("direct light: rectangles", 18),
    ("direct light: shooting", 18),
    ("direct light: point light", comparisons(6)),
    ("direct light: rounds", comparisons(6)),
    ("direct light: spread of rounds", 1),
    ("indirect light: box", 8 * comparisons(6)),
    ("indirect light: furnace", comparisons(9)),
    ("indirect light: point light", comparisons(8)),
    // The inside of a sphere by groups: their sum, each of five alone, a mixture.
    ("light groups: sum", comparisons(8)),
    ("light groups: each alone", 5 * comparisons(8)),
    ("light groups: mixture", comparisons(8)),
    ("light groups: error bars", 2),
    ("black room", comparisons(6)),
    ("bright sphere", comparisons(8)),
    ("clusters: box", 12 * comparisons(6)),
    ("clusters: furnace", 4 * comparisons(3)),
    ("box: 12 elements", comparisons(6)),
    ("box: 48 elements", comparisons(6)),
    ("integrals by sequences", 4 * SEQUENCES.len() as u32),
    ("streams of sequences", SEQUENCES.len() as u32),
    ("uniform numbers of sequences", 4 * SEQUENCES.len() as u32),
];

/// Significance level of a single comparison.
pub fn alpha() -> f64 {
    let comparisons: u32 = REGISTER.iter().map(|(_, comparisons)| comparisons).sum();
    FALSE_ALARM / f64::from(comparisons)
}

/// Holds a deviation in standard errors, known exactly, against the budget.
///
/// # Panics
/// If it is larger than chance allows, or if `test` is not in the register.
pub fn assert_z(test: &str, z: f64) {
    judge(test, &format!("z = {z:.3}"), p_of_z(z));
}

/// Holds a deviation in standard errors, estimated with `dof` degrees of freedom, against the budget.
///
/// # Panics
/// As [`assert_z`].
pub fn assert_t(test: &str, t: f64, dof: f64) {
    judge(test, &format!("t = {t:.3} with {dof} degrees of freedom"), p_of_t(t, dof));
}

/// [`assert_t`] for one of several quantities that a test compares.
///
/// # Panics
/// As [`assert_z`].
pub fn assert_t_of(test: &str, quantity: &str, t: f64, dof: f64) {
    judge(test, &format!("{quantity}: t = {t:.3} with {dof} degrees of freedom"), p_of_t(t, dof));
}

/// Holds a chi-square statistic against the budget.
///
/// # Panics
/// As [`assert_z`].
pub fn assert_chi2(test: &str, chi2: f64, dof: f64) {
    judge(test, &format!("chi² = {chi2:.2} with {dof} degrees of freedom"), p_of_chi2(chi2, dof));
}

/// Whether chance would be refuted by a p-value: how a test proves that it sees a planted fault.
pub fn refutes(p: f64) -> bool {
    p < alpha()
}

fn judge(test: &str, statistic: &str, p: f64) {
    assert!(REGISTER.iter().any(|(name, _)| *name == test), "statistical test '{test}' is not in budget::REGISTER");
    assert!(!refutes(p), "{test}: {statistic}, p = {p:.2e} is below the bound {:.2e}", alpha());
}

#[cfg(test)]
mod tests {
    use super::*;

    const COIN: &str = "projections of a fair coin";

    #[test]
    fn names_are_unique() {
        for (k, (name, comparisons)) in REGISTER.iter().enumerate() {
            assert!(*comparisons > 0 && REGISTER[..k].iter().all(|(other, _)| other != name), "{name}");
        }
    }

    #[test]
    fn what_chance_explains_passes() {
        assert_z(COIN, -4.5);
        assert_t(COIN, 6.0, 15.0);
        assert_chi2(COIN, 120.0, 100.0);
    }

    #[test]
    #[should_panic(expected = "z = 7.000, p = 2.56e-12 is below the bound")]
    fn what_chance_does_not_explain_fails() {
        assert_z(COIN, 7.0);
    }

    #[test]
    #[should_panic(expected = "is not in budget::REGISTER")]
    fn unregistered_tests_fail() {
        assert_z("something new", 0.0);
    }
}
