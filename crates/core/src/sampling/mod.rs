//! Sample numbers: points of the unit hypercube, by index and stream, one sequence a file.
