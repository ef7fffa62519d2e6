"""Studies and convergence plots."""

from pathlib import Path

import numpy as np
import pytest

import isolux

pytest.importorskip("pandas")
pytest.importorskip("matplotlib")

TOML = """
title = "Does the error of random walks fall as N^-0.5?"
question = "It should."
measure = "convergence"
at = [3e3, 1e4, 3e4]
seeds = 3
reference-rays = 1e6

[quick]
scenes = ["labyrinth"]
at = [3e3, 1e4]
seeds = 2
reference-rays = 1e6

[[scenes]]
name = "labyrinth"
scene = "labyrinth:rho=0.5"
elements = 200
exact = 1.0

[[series]]
name = "random"
method = "random-walk"
sequence = "random"

[[plots]]
file = "error"
title = "walks"
x = "samples"
y = "error"
x-label = "samples"
y-label = "relative RMS error"
guides = [-0.5]

[[signs]]
claim = "N^-0.5"
plot = "error"
series = "random"
slope = [-0.8, -0.2]
robust = true
"""


def test_a_study_of_ones_own_is_run_kept_and_drawn(tmp_path: Path) -> None:
    file = tmp_path / "study.toml"
    file.write_text(TOML)
    found = isolux.study(file, folder=tmp_path / "results")
    assert [verdict.holds for verdict in found] == [True] and found.slopes[0].slope == pytest.approx(-0.5, abs=0.2)
    table = found.to_dataframe()
    assert len(table) == 9 and set(table["seed"]) == {1, 2, 3}
    axes = found.plot().axes[0]
    assert axes.get_xscale() == axes.get_yscale() == "log" and axes.get_xlabel() == "samples"
    drawn = axes.containers[0].lines[0].get_ydata()
    means = np.exp(np.log(table["error"]).groupby(table["at"]).mean())
    assert drawn == pytest.approx(means.to_numpy())
    assert (tmp_path / "results" / "result.csv").exists() and "N^-0.5" in str(found)
    assert len(isolux.study(file, quick=True).to_dataframe()) == 4
    with pytest.raises(isolux.OtherRun):
        isolux.study(file, quick=True, folder=tmp_path / "results")


def test_studies_that_are_not_there_or_wrong_say_so(tmp_path: Path) -> None:
    with pytest.raises(isolux.UnknownName, match="did you mean 'order'"):
        isolux.study("odrer")
    with pytest.raises(isolux.MissingFile):
        isolux.study(tmp_path / "none.toml")
    (tmp_path / "study.toml").write_text(TOML.replace("seeds = 3", "seeds = 'many'"))
    with pytest.raises(isolux.InvalidStudy, match="seeds"):
        isolux.study(tmp_path / "study.toml")


def test_errors_fall_with_the_rays_as_they_should() -> None:
    methods = {"walk": {"method": "random-walk", "sequence": "random"}}
    curves = isolux.convergence("labyrinth:rho=0.5", methods, rays=[5e3, 5e4], elements=200, seeds=4)
    slope, margin = curves.slope("walk")
    assert slope == pytest.approx(-0.5, abs=0.15) and margin < 0.3
    table = curves.to_dataframe()
    assert len(table) == 8 and curves.plot().axes[0].get_legend_handles_labels()[1] == ["walk"]
