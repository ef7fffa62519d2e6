"""Form factors: closed forms, sums, error bars, tables by name."""

import numpy as np
import pytest

import isolux
from conftest import box

pytest.importorskip("scipy")
pytest.importorskip("pandas")

OPPOSITE, ADJACENT = 0.199825, 0.200044
"""Form factors between faces of a cube (Howell's catalogue, C-11 and C-14)."""


def test_faces_of_a_cube_see_each_other_as_the_catalogue_says() -> None:
    factors = isolux.form_factors(box(), elements=200)
    table = factors.by_object()
    assert table.loc["floor", "ceiling"] == pytest.approx(OPPOSITE, abs=2e-6)
    assert table.loc["floor", "left"] == pytest.approx(ADJACENT, abs=2e-6)
    assert table.to_numpy().sum(axis=1) == pytest.approx(1) and factors.row_sums == pytest.approx(1)
    assert factors.reciprocity < 1e-6 and factors.std_error is None and factors.by_object_std_error() is None
    assert factors.matrix.shape == (len(factors.problem),) * 2 and factors.areas.sum() == pytest.approx(6)


def test_sampled_ones_have_error_bars_that_hold() -> None:
    problem = isolux.Problem(box(), elements=60)
    sampled = isolux.form_factors(problem, by="local-lines", rays=20_000)
    table, error = sampled.by_object(), sampled.by_object_std_error()
    assert error is not None
    for one, other, exact in [("floor", "ceiling", OPPOSITE), ("floor", "left", ADJACENT), ("left", "right", OPPOSITE)]:
        assert abs(table.loc[one, other] - exact) < 6.5 * error.loc[one, other] < 0.02
    assert (sampled.std_error.indices == sampled.matrix.indices).all() and sampled.std_error.max() < 0.01
    assert not sampled.matrix.data.flags.writeable, "a view on memory of the engine"
    closed = isolux.form_factors(problem, by="local-lines", rays=500, correct="enclosure")
    assert closed.row_sums == pytest.approx(1, abs=1e-9) and closed.reciprocity < 1e-9


def test_radiosity_by_hand_is_that_of_the_solver() -> None:
    """`B = Be + rho F B` with this matrix is what `direct` solves."""
    problem = isolux.Problem("box", elements=150)
    matrix = isolux.form_factors(problem, correct="reciprocity").matrix.toarray()
    rho, emission = problem.reflectivity[:, 1].astype(float), problem.emission[:, 1].astype(float)
    by_hand = np.linalg.solve(np.eye(len(problem)) - rho[:, None] * matrix, emission)
    assert isolux.solve(problem, method="direct").radiosity[:, 1] == pytest.approx(by_hand, rel=1e-4)


def test_wrong_ways_are_refused() -> None:
    with pytest.raises(isolux.UnknownName, match="did you mean 'hemicube'"):
        isolux.form_factors("box", by="hemicubes")  # type: ignore[arg-type]
    with pytest.raises(isolux.ParameterError):
        isolux.form_factors("box", by="hemicube", resolution=7)
    with pytest.raises(isolux.ParameterError, match="100 million"):
        isolux.form_factors("box", elements=1e6)
