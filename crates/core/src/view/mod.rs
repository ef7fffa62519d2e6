//! What a camera sees of a solution.
