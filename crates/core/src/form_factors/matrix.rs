//! The sparse matrix of form factors, row by row (CSR), and how well it keeps closure and reciprocity.

use super::Row;

/// Form factors `F_ij`, 12 bytes each and 4 more with a standard error.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct FormFactors {
    /// Area of each element [m²].
    areas: Vec<f64>,
    /// Where each row starts, and the end of the last.
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
    /// As many as values, or none.
    std_errors: Vec<f32>,
    back_face: Vec<f64>,
}

/// How far `A_i F_ij` is from `A_j F_ji`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reciprocity {
    /// Largest difference [m²].
    pub largest: f64,
    /// RMS difference over RMS exchange area, over all pairs with either.
    pub relative_rms: f64,
}

impl FormFactors {
    /// The matrix of `rows`, one for each of `areas` [m²], in order.
    pub fn from_rows(areas: Vec<f64>, rows: Vec<Row>) -> FormFactors {
        let count = rows.iter().map(|row| row.entries.len()).sum();
        let mut factors = FormFactors {
            areas,
            starts: vec![0],
            columns: Vec::with_capacity(count),
            values: Vec::with_capacity(count),
            ..FormFactors::default()
        };
        for row in rows {
            factors.columns.extend(row.entries.iter().map(|&(column, _)| column));
            factors.values.extend(row.entries.iter().map(|&(_, value)| value));
            factors.std_errors.extend(row.std_errors);
            factors.back_face.push(row.back_face);
            factors.starts.push(factors.values.len());
        }
        factors
    }

    /// Number of elements: rows and columns.
    pub fn len(&self) -> usize {
        self.areas.len()
    }

    pub fn is_empty(&self) -> bool {
        self.areas.is_empty()
    }

    /// Area of each element [m²].
    pub fn areas(&self) -> &[f64] {
        &self.areas
    }

    /// Where each row starts among [`columns`](FormFactors::columns) and [`values`](FormFactors::values), and the end.
    pub fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// Column of every entry, row by row.
    pub fn columns(&self) -> &[u32] {
        &self.columns
    }

    /// Form factor of every entry, row by row.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Standard error of every entry, or nothing if they have none.
    pub fn std_errors(&self) -> &[f32] {
        &self.std_errors
    }

    /// Share of the light of element `i` that falls on backs of one-sided surfaces, as far as it is known.
    pub fn back_face(&self, i: usize) -> f64 {
        self.back_face[i]
    }

    /// Columns and form factors of row `i`.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.range(i).map(|k| (self.columns[k] as usize, self.values[k]))
    }

    /// `F_ij`, zero if it is not stored.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let range = self.range(i);
        self.columns[range.clone()].binary_search(&(j as u32)).map_or(0.0, |k| self.values[range.start + k])
    }

    /// `Σ_j F_ij`: 1 in a closed scene.
    pub fn row_sum(&self, i: usize) -> f64 {
        self.row(i).fold(0.0, |sum, (_, f)| sum + f)
    }

    /// Standard error of [`FormFactors::row_sum`], entries taken as independent.
    pub fn row_sum_std_error(&self, i: usize) -> Option<f64> {
        let errors = self.std_errors.get(self.range(i))?;
        Some(errors.iter().map(|&error| f64::from(error).powi(2)).sum::<f64>().sqrt())
    }

    /// How far the matrix is from reciprocity.
    pub fn reciprocity(&self) -> Reciprocity {
        let other = self.transposed();
        let (mut largest, mut differences, mut exchanges) = (0.0f64, 0.0, 0.0);
        for i in 0..self.len() {
            union(&self.entries(i), &other.entries(i), |_, (there, _), (back, _)| {
                let difference = self.areas[i] * (there - back);
                largest = largest.max(difference.abs());
                differences += difference.powi(2);
                exchanges += (0.5 * self.areas[i] * (there + back)).powi(2);
            });
        }
        Reciprocity { largest, relative_rms: if exchanges > 0.0 { (differences / exchanges).sqrt() } else { 0.0 } }
    }

    /// What the columns say of the rows: `A_j F_ji / A_i`.
    pub fn transposed(&self) -> FormFactors {
        let mut rows: Vec<Row> = (0..self.len())
            .map(|i| Row { element: i as u32, back_face: self.back_face[i], ..Row::default() })
            .collect();
        for j in 0..self.len() {
            for k in self.range(j) {
                let i = self.columns[k] as usize;
                let scale = self.areas[j] / self.areas[i];
                rows[i].entries.push((j as u32, self.values[k] * scale));
                rows[i].std_errors.extend(self.std_errors.get(k).map(|&error| error * scale as f32));
            }
        }
        FormFactors::from_rows(self.areas.clone(), rows)
    }

    /// The whole matrix, of one that has only entries right of the diagonal.
    pub(super) fn mirrored(&self) -> FormFactors {
        self.joined(&self.transposed(), 1.0)
    }

    /// `scale` times the sum of two matrices, their errors taken as independent.
    pub(super) fn joined(&self, other: &FormFactors, scale: f64) -> FormFactors {
        let with_errors = self.std_errors.len() == self.values.len();
        let row = |i: usize| {
            let mut row = Row { element: i as u32, back_face: self.back_face[i], ..Row::default() };
            union(&self.entries(i), &other.entries(i), |column, (a, error_a), (b, error_b)| {
                row.entries.push((column, scale * (a + b)));
                if with_errors {
                    row.std_errors.push(scale as f32 * error_a.hypot(error_b));
                }
            });
            row
        };
        FormFactors::from_rows(self.areas.clone(), (0..self.len()).map(row).collect())
    }

    /// The same places with other values: `scale(i, j)` times each, errors included.
    pub(super) fn scaled(mut self, scale: impl Fn(usize, usize) -> f64) -> FormFactors {
        for i in 0..self.len() {
            for k in self.range(i) {
                let by = scale(i, self.columns[k] as usize);
                self.values[k] *= by;
                self.std_errors.iter_mut().skip(k).take(1).for_each(|error| *error *= by as f32);
            }
        }
        self
    }

    fn range(&self, i: usize) -> std::ops::Range<usize> {
        self.starts[i]..self.starts[i + 1]
    }

    /// Column, value and standard error (0 if unknown) of row `i`.
    fn entries(&self, i: usize) -> Vec<(u32, f64, f32)> {
        let error = |k: usize| self.std_errors.get(k).copied().unwrap_or(0.0);
        self.range(i).map(|k| (self.columns[k], self.values[k], error(k))).collect()
    }
}

/// Hands every column of either row to `each`, with value and error in both; zero where there is none.
fn union(first: &[(u32, f64, f32)], second: &[(u32, f64, f32)], mut each: impl FnMut(u32, (f64, f32), (f64, f32))) {
    let (mut a, mut b) = (first.iter().peekable(), second.iter().peekable());
    while let Some(column) = a.peek().into_iter().chain(b.peek()).map(|entry| entry.0).min() {
        let value = |entry: Option<&(u32, f64, f32)>| entry.map_or((0.0, 0.0), |&(_, value, error)| (value, error));
        each(column, value(a.next_if(|e| e.0 == column)), value(b.next_if(|e| e.0 == column)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(element: u32, entries: &[(u32, f64)]) -> Row {
        Row { element, entries: entries.to_vec(), ..Row::default() }
    }

    #[test]
    fn one_half_gives_the_other_by_reciprocity() {
        let upper = vec![row(0, &[(1, 0.5), (2, 0.5)]), row(1, &[(2, 0.25)]), row(2, &[])];
        let factors = FormFactors::from_rows(vec![1.0, 2.0, 4.0], upper).mirrored();
        assert_eq!((factors.get(1, 0), factors.get(2, 0), factors.get(2, 1)), (0.25, 0.125, 0.125));
        assert_eq!((factors.row_sum(1), factors.get(0, 0)), (0.5, 0.0));
        assert_eq!(factors.reciprocity(), Reciprocity::default());
    }

    #[test]
    fn a_broken_pair_is_found() {
        let rows = vec![row(0, &[(1, 0.5)]), row(1, &[(0, 0.75)])];
        let found = FormFactors::from_rows(vec![1.0, 1.0], rows).reciprocity();
        assert_eq!(found.largest, 0.25);
        assert!((found.relative_rms - 0.25 / 0.625).abs() < 1e-12);
    }
}
