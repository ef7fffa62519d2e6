//! The table of what was measured: `result.csv`.

use crate::Error;
use isolux_io::files;
use std::path::Path;

/// One line.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub scene: String,
    pub series: String,
    pub at: f64,
    pub seed: u64,
    /// By the table's columns.
    pub values: Vec<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    pub columns: Vec<String>,
    pub rows: Vec<Row>,
}

/// The columns that name a row.
const KEYS: [&str; 4] = ["scene", "series", "at", "seed"];

impl Table {
    pub fn new(columns: &[&str]) -> Table {
        Table { columns: columns.iter().map(|&column| column.to_owned()).collect(), rows: Vec::new() }
    }

    /// Value of `column` in `row`; its place may be asked for as `at`.
    pub fn value(&self, row: &Row, column: &str) -> Option<f64> {
        if column == "at" {
            return Some(row.at);
        }
        let k = self.columns.iter().position(|name| name == column)?;
        row.values.get(k).copied()
    }

    /// Reads the table at `path`.
    ///
    /// # Errors
    /// [`Error::Io`]; [`Error::Table`] for a line that is no row, [`Error::OtherRun`] for other columns.
    pub fn read(path: &Path, columns: &[&str]) -> Result<Table, Error> {
        let mut table = Table::new(columns);
        let bytes = files::read(path)?;
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        let wrong = |error: csv::Error| {
            let line = error.position().map_or(1, csv::Position::line);
            Error::Table { path: path.to_owned(), line, what: error.to_string() }
        };
        if !reader.headers().map_err(wrong)?.iter().eq(KEYS.iter().chain(columns).copied()) {
            return Err(Error::OtherRun { path: path.to_owned(), what: "it has other columns".to_owned() });
        }
        for record in reader.records() {
            let record = record.map_err(wrong)?;
            let line = record.position().map_or(1, csv::Position::line);
            let number = |text: &str| {
                text.parse::<f64>().map_err(|_| {
                    let what = format!("'{text}' is not a number");
                    Error::Table { path: path.to_owned(), line, what }
                })
            };
            table.rows.push(Row {
                scene: record[0].to_owned(),
                series: record[1].to_owned(),
                at: number(&record[2])?,
                seed: number(&record[3])? as u64,
                values: record.iter().skip(KEYS.len()).map(number).collect::<Result<_, _>>()?,
            });
        }
        Ok(table)
    }

    /// The table as CSV.
    pub fn to_csv(&self) -> Vec<u8> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let header = KEYS.iter().copied().chain(self.columns.iter().map(String::as_str));
        let mut write = |fields: Vec<String>| writer.write_record(fields);
        let mut all = write(header.map(str::to_owned).collect());
        for row in &self.rows {
            let values = row.values.iter().map(|&value| short(value));
            let keys = [row.scene.clone(), row.series.clone(), short(row.at), row.seed.to_string()];
            all = all.and(write(keys.into_iter().chain(values).collect()));
        }
        // Writing to memory cannot fail.
        all.ok().and_then(|()| writer.into_inner().ok()).unwrap_or_default()
    }
}

/// A number with six digits at most.
pub fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    if value == value.trunc() && value.abs() < 1e15 {
        return format!("{value:.0}");
    }
    let digits = (5 - value.abs().log10().floor() as i32).clamp(0, 17) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_comes_back_as_it_was_written() {
        let mut table = Table::new(&["rays", "error"]);
        for (at, error) in [(1e4, 0.123456), (31623.0, 1.5e-7), (1e9, f64::NAN)] {
            let (scene, series) = ("labyrinth, \"rho\" = 0.1".to_owned(), "a".to_owned());
            table.rows.push(Row { scene, series, at, seed: 3, values: vec![at, error] });
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.csv");
        std::fs::write(&path, table.to_csv()).unwrap();
        let again = Table::read(&path, &["rays", "error"]).unwrap();
        assert_eq!(again.to_csv(), table.to_csv());
        assert_eq!(again.rows[..2], table.rows[..2]);
        assert!(matches!(Table::read(&path, &["rays"]), Err(Error::OtherRun { .. })));
        std::fs::write(&path, "scene,series,at,seed,rays\nx,y,1,2,lots\n").unwrap();
        let error = Table::read(&path, &["rays"]).unwrap_err().to_string();
        assert!(error.contains("line 2: 'lots' is not a number"), "{error}");
    }

    #[test]
    fn numbers_are_short() {
        let texts = [0.0, 1e7, 0.5, 12.3456789, 1234567.8, 1.23456789e-5].map(short);
        assert_eq!(texts, ["0", "10000000", "0.5", "12.3457", "1234568", "0.0000123457"]);
    }
}
