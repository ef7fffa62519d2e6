//! The `.isolux` file.
