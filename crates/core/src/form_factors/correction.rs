//! Making form factors obey the laws that computed ones miss a little: reciprocity, and closure.
//!
//! Reciprocity: the exchange areas `A_i F_ij` and `A_j F_ji` are replaced by their mean. Closure of an enclosure: then all are
//! multiplied by `d_i d_j`, with the d for which every row sums to one (symmetric scaling; Sinkhorn & Knopp 1967). What is
//! zero stays zero, and what is symmetric stays so. Cost: a few passes over the matrix.

use super::FormFactors;

/// Which laws a matrix is made to obey.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Correction {
    #[default]
    None,
    Reciprocity,
    /// Reciprocity, and rows that sum to one: for closed scenes.
    Enclosure,
}

/// Passes of the scaling; it ends before when nothing changes any more.
const MOST_PASSES: usize = 1000;
/// Rows need not be nearer to one than this.
const NEAR_ENOUGH: f64 = 1e-13;

impl Correction {
    pub const ALL: [Correction; 3] = [Correction::None, Correction::Reciprocity, Correction::Enclosure];

    pub fn name(self) -> &'static str {
        match self {
            Correction::None => "none",
            Correction::Reciprocity => "reciprocity",
            Correction::Enclosure => "enclosure",
        }
    }

    /// The corrected matrix.
    pub fn apply(self, factors: FormFactors) -> FormFactors {
        match self {
            Correction::None => factors,
            Correction::Reciprocity => factors.joined(&factors.transposed(), 0.5),
            Correction::Enclosure => closed(Correction::Reciprocity.apply(factors)),
        }
    }
}

/// A reciprocal matrix with rows that sum to one. Rows without entries stay as they are.
fn closed(factors: FormFactors) -> FormFactors {
    let mut d = vec![1.0; factors.len()];
    for _ in 0..MOST_PASSES {
        let sums: Vec<f64> = (0..d.len()).map(|i| factors.row(i).map(|(j, f)| f * d[j]).sum::<f64>() * d[i]).collect();
        let open = |sum: &&f64| **sum > 0.0 && (**sum - 1.0).abs() > NEAR_ENOUGH;
        if sums.iter().find(open).is_none() {
            break;
        }
        // The square root keeps rows and columns from overshooting in turn.
        d.iter_mut().zip(&sums).filter(|(_, sum)| **sum > 0.0).for_each(|(d, sum)| *d /= sum.sqrt());
    }
    factors.scaled(|i, j| d[i] * d[j])
}

#[cfg(test)]
mod tests {
    use super::super::Row;
    use super::*;

    fn rough() -> FormFactors {
        let row = |element, entries: [f64; 4]| {
            let entries = (0..4).zip(entries).filter(|(_, f)| *f > 0.0).collect();
            Row { element, entries, ..Row::default() }
        };
        let rows = vec![
            row(0, [0.0, 0.30, 0.33, 0.35]),
            row(1, [0.16, 0.0, 0.41, 0.40]),
            row(2, [0.19, 0.40, 0.0, 0.42]),
            row(3, [0.17, 0.41, 0.44, 0.0]),
        ];
        FormFactors::from_rows(vec![1.0, 2.0, 2.0, 2.0], rows)
    }

    #[test]
    fn reciprocity_is_kept_and_changes_little() {
        let fixed = Correction::Reciprocity.apply(rough());
        assert!(fixed.reciprocity().largest < 1e-15 && rough().reciprocity().largest > 0.01);
        assert!((fixed.get(0, 1) - 0.5 * (0.30 + 2.0 * 0.16)).abs() < 1e-15);
    }

    #[test]
    fn an_enclosure_is_closed_and_reciprocal() {
        let fixed = Correction::Enclosure.apply(rough());
        assert!((0..4).all(|i| (fixed.row_sum(i) - 1.0).abs() < 1e-12));
        assert!(fixed.reciprocity().largest < 1e-12 && (fixed.get(0, 1) - 0.31).abs() < 0.02);
    }
}
