//! Everything that can go wrong inside the mathematics, each variant something a caller can act on.

/// An error of the core. File formats have their own error type in `isolux-io`.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum Error {
    /// The scene has no triangle left that could be lit.
    #[error("the scene has no surface: there is nothing to light")]
    NoSurface,

    /// More elements than the engine can number (2^32 - 2).
    #[error("{asked} elements are more than the {limit} that can be numbered; ask for fewer, or for a larger edge")]
    TooManyElements { asked: u64, limit: u64 },

    /// A parameter outside its meaning; the text says what is allowed.
    #[error("{name} = {value}: {allowed}")]
    Parameter { name: &'static str, value: String, allowed: &'static str },

    /// A name that is not in a table; `nearest` is the closest known one.
    #[error("there is no {kind} called '{name}'; did you mean '{nearest}'?")]
    UnknownName { kind: &'static str, name: String, nearest: String },

    /// A combination of axes without meaning; the texts say why, and what is nearest.
    #[error("this combination has no meaning: {what}; nearest is {nearest}")]
    Meaningless { what: &'static str, nearest: &'static str },

    /// Something that a method would ignore; the text says why, and what to do.
    #[error("{method} has no use for {option}: {why}")]
    Unused { method: &'static str, option: &'static str, why: &'static str },

    /// Two solutions that have nothing in common; the text says why.
    #[error("the two solutions cannot be compared: {what}")]
    NotComparable { what: &'static str },

    /// Solutions that cannot be made one; the text says why.
    #[error("the solutions cannot be merged: {what}")]
    NotMergeable { what: String },

    /// A lightmap that cannot be made; the text says why, and what to ask for.
    #[error("there is no such lightmap: {what}")]
    Lightmap { what: String },

    /// A number that is not finite reached the solver.
    #[error("element {element} has {what} {value}, which is not a finite number")]
    NotFinite { element: u32, what: &'static str, value: f32 },
}

impl Error {
    /// The error for a `name` that is not among the `known` ones; it proposes the nearest of them, the first if several are
    /// as near.
    pub fn unknown_name<'a>(kind: &'static str, name: &str, known: impl IntoIterator<Item = &'a str>) -> Error {
        let nearest = known.into_iter().min_by_key(|candidate| edit_distance(name, candidate)).unwrap_or_default();
        Error::UnknownName { kind, name: name.to_owned(), nearest: nearest.to_owned() }
    }
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
        let error = Error::unknown_name("scene", "labirynth", ["box", "labyrinth", "office"]);
        assert_eq!(error.to_string(), "there is no scene called 'labirynth'; did you mean 'labyrinth'?");
    }
}
