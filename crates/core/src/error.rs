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

    /// A number that is not finite reached the solver.
    #[error("element {element} has {what} {value}, which is not a finite number")]
    NotFinite { element: u32, what: &'static str, value: f32 },
}
