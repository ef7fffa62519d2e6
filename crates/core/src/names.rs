//! Names people type: the known one nearest to a mistyped one.

use crate::Error;

/// The error for a `name` that is not among the `known` ones; it proposes the nearest of them.
pub fn unknown<'a>(kind: &'static str, name: &str, known: impl IntoIterator<Item = &'a str>) -> Error {
    let nearest = nearest(name, known).unwrap_or_default().to_owned();
    Error::UnknownName { kind, name: name.to_owned(), nearest }
}

/// The `known` name with the least edit distance to `name`, the first of them if several are as near.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    known.into_iter().min_by_key(|candidate| edit_distance(name, candidate))
}

/// Number of characters to insert, delete or replace to turn `a` into `b` (Levenshtein 1966).
fn edit_distance(a: &str, b: &str) -> usize {
    // row[j] is the distance of the part of `a` seen so far to the first j characters of `b`.
    let mut row: Vec<usize> = (0..=b.chars().count()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, to) in b.chars().enumerate() {
            let replaced = diagonal + usize::from(from != to);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[b.chars().count()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_of_the_textbook() {
        assert_eq!(edit_distance("kitten", "sitting"), 3);
        assert_eq!((edit_distance("", "abc"), edit_distance("abc", "")), (3, 3));
        assert_eq!(edit_distance("labyrinth", "labyrinth"), 0);
    }

    #[test]
    fn a_typing_error_finds_its_name() {
        assert_eq!(nearest("labirynth", ["box", "labyrinth", "office"]), Some("labyrinth"));
        assert_eq!(nearest("x", []), None);
    }
}
