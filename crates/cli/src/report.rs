//! Tables for people: text on the left, numbers on the right, in columns that line up.

use crate::numbers::decimals_for;
use crate::terminal::harmless;
use isolux_core::solution::Balance;
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// The longest name that is shown in full [columns].
const LONGEST_NAME: usize = 36;
const GAP: &str = "  ";

/// Rows of equal length, the first of them the heads.
#[derive(Clone, Debug, Default)]
pub struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    pub fn new(heads: &[&str]) -> Table {
        Table { rows: vec![heads.iter().map(|head| (*head).to_owned()).collect()] }
    }

    /// A row: a name, cut if it is too long, and cells.
    pub fn row(&mut self, name: &str, cells: impl IntoIterator<Item = String>) {
        self.rows.push(std::iter::once(short(&harmless(name))).chain(cells).collect());
    }

    /// Lines, indented by two; the first column to the left, all others to the right.
    pub fn lines(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let cells = |c: usize| self.rows.iter().filter_map(move |row| row.get(c));
        let widths: Vec<usize> = (0..columns).map(|c| cells(c).map(|cell| cell.width()).max().unwrap_or(0)).collect();
        let mut text = String::new();
        for row in self.rows.iter().filter(|row| row.iter().any(|cell| !cell.is_empty())) {
            let mut line = String::from(GAP);
            for (c, (cell, width)) in row.iter().zip(&widths).enumerate() {
                let space = " ".repeat(width - cell.width());
                line += &if c == 0 { format!("{cell}{space}") } else { format!("{GAP}{space}{cell}") };
            }
            text += line.trim_end();
            text.push('\n');
        }
        text
    }
}

/// Where the light went, with a blank line before.
pub fn balance(b: &Balance) -> String {
    let mut table = Table::new(&[]);
    let decimals = decimals_for(b.emitted, 5);
    let cell = |flux: f64| format!("{flux:.decimals$}");
    table.row("emitted", [cell(b.emitted), String::new()]);
    let parts = [
        ("absorbed by surfaces", b.absorbed),
        ("escaped from the scene", b.escaped),
        ("lost on backs of surfaces", b.back_face),
        ("not yet followed to its end", b.unshot),
    ];
    for (name, flux) in parts {
        let share = match 100.0 * flux / b.emitted {
            share if !share.is_finite() => String::new(),
            share if share > 0.0 && share < 0.005 => "< 0.01 %".to_owned(),
            share => format!("{share:.2} %"),
        };
        table.row(name, [cell(flux), share]);
    }
    format!("\nWhere the light went [lm]\n{}", table.lines())
}

/// `name`, its middle left out if it is too long: the end often tells more than the middle.
fn short(name: &str) -> String {
    if name.width() <= LONGEST_NAME {
        return name.to_owned();
    }
    let half = (LONGEST_NAME - 1) / 2;
    let take = |characters: &mut dyn Iterator<Item = char>| -> Vec<char> {
        let mut width = 0;
        characters
            .take_while(|c| {
                width += c.width().unwrap_or(0);
                width <= half
            })
            .collect()
    };
    let start: String = take(&mut name.chars()).into_iter().collect();
    let end: String = take(&mut name.chars().rev()).into_iter().rev().collect();
    format!("{start}…{end}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up_whatever_the_script() {
        let mut table = Table::new(&["object", "lux"]);
        table.row("größe", ["7.5".to_owned()]);
        table.row("壁", ["1234.5".to_owned()]);
        assert_eq!(table.lines(), "  object     lux\n  größe      7.5\n  壁      1234.5\n");
    }

    #[test]
    fn long_names_lose_their_middle() {
        let name = format!("{}-the-end", "a".repeat(50));
        assert!(short(&name).width() <= LONGEST_NAME && short(&name).ends_with("-the-end"));
        assert_eq!(short("wall"), "wall");
    }
}
