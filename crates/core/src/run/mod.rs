//! Who drives a solver.
