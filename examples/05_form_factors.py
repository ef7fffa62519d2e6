"""Form factors as a sparse matrix, and between named surfaces."""

import isolux

factors = isolux.form_factors("box", elements=600)
print(factors)
print(factors.by_object().round(4))

sampled = isolux.form_factors("box", elements=600, by="local-lines", rays=2000)
difference = abs(factors.matrix - sampled.matrix)
print(
    f"contour integrals and {sampled.by} differ by at most {difference.max():.4f}; "
    f"the largest standard error is {sampled.std_error.max():.4f}"
)
