//! How light gets from one element to another.
