"""Solves: exact answers, the bits of the command line, accuracies, interruptions."""

import itertools
import json
import os
import signal
import subprocess
import sys
import threading
import time
import warnings
from pathlib import Path

import numpy as np
import pytest

import isolux
from conftest import box
from isolux import _native


def test_every_wall_of_a_furnace_receives_what_it_emits() -> None:
    """`Be + rho = 1` gives E = 1: 36 means, each within 6.5 standard errors of 15 degrees of freedom, one false alarm in a million."""
    shares = {"floor": 0.2, "ceiling": 0.8, "back": 0.5, "front": 0.1, "left": 0.6, "right": 0.4}
    scene = box(reflectivity=shares, emission={name: 1 - share for name, share in shares.items()})
    solution = isolux.solve(scene, elements=600, rays=2e6, method="stochastic-jacobi", leaving="whole-element")
    for light in solution.objects.values():
        assert abs(light.mean.mean - 1) < 8 * light.mean.std_error + 1e-5, str(light)
        assert light.mean.std_error < 0.01
    assert solution.balance.residual == pytest.approx(0, abs=1e-5) and solution.balance.escaped == 0


def test_python_and_the_command_line_compute_the_same_bits(tmp_path: Path) -> None:
    file = tmp_path / "a.isolux"
    told = ["--elements", "700", "--rays", "300k", "--seed", "5", "--method", "random-walk", "--sequence", "halton"]
    assert _native.run(["isolux", "solve", "cubes", "--quiet", "-o", str(file), *told]) == 0
    for threads in (1, 3):
        own = isolux.solve("cubes", elements=700, rays=3e5, seed=5, method="random-walk", sequence="halton", threads=threads)
        theirs = isolux.open(file)
        assert (own.irradiance == theirs.irradiance).all() and (own.std_error == theirs.std_error).all()
        assert own.provenance == theirs.provenance and own.balance == theirs.balance
    assert isolux.compare(own, theirs).rms == 0


@pytest.mark.parametrize("contacts", ["cut", "ignore"])
def test_a_mesh_that_follows_the_light_is_that_of_the_command_line(tmp_path: Path, contacts: str) -> None:
    file = tmp_path / "a.isolux"
    told = ["--elements", "2000", "--rays", "300k", "--mesh", "adaptive", "--contacts", contacts]
    assert _native.run(["isolux", "solve", "cornell-box", "--quiet", "-o", str(file), *told]) == 0
    own = isolux.solve("cornell-box", elements=2000, rays=3e5, mesh="adaptive", contacts=contacts == "cut")
    assert len(own.areas) <= 2000 and own.areas.max() > 4 * np.median(own.areas)
    assert (own.irradiance == isolux.open(file).irradiance).all()
    with pytest.raises(isolux.ParameterError, match="mesh"):
        isolux.solve("cornell-box", max_edge=0.1, mesh="adaptive")
    with pytest.raises(isolux.UnknownName, match="adaptive"):
        isolux.solve("cornell-box", mesh="fine")  # type: ignore[arg-type]


def test_arrays_are_views_on_one_memory_that_nobody_can_change(cornell: isolux.Solution) -> None:
    n = len(cornell)
    for values, shape in [
        (lambda: cornell.irradiance, (n, 3)),
        (lambda: cornell.std_error, (n, 3)),
        (lambda: cornell.radiosity, (n, 3)),
        (lambda: cornell.areas, (n,)),
        (lambda: cornell.problem.normals, (n, 3)),
    ]:
        array = values()
        assert array.shape == shape and array.dtype == np.float32 and array.base is not None and array.flags.c_contiguous
        assert np.shares_memory(array, values()) and array.ctypes.data == values().ctypes.data
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.flags.writeable = True
    kept = isolux.solve("box", elements=100, rays=1e4).irradiance
    assert np.isfinite(kept).all(), "an array outlives its solution"


def test_radiosity_is_emission_and_what_is_reflected(cornell: isolux.Solution) -> None:
    problem = cornell.problem
    expected = problem.emission + problem.reflectivity * cornell.irradiance
    assert cornell.radiosity == pytest.approx(expected, rel=1e-6, abs=1e-7)


def test_an_accuracy_is_reached_or_warned_about() -> None:
    solution = isolux.solve("cornell-box", elements=500, error=0.04, error_of="object:floor")
    assert solution.error_bound(0.95, "object:floor") <= 0.04 and solution.ended == "complete"
    with pytest.warns(isolux.errors.AccuracyWarning, match="not 0.1 %"):
        isolux.solve("cornell-box", elements=500, error=0.001, rays=1e5)
    solution = isolux.solve("cornell-box", elements=2000, time=0.3)
    assert solution.ended == "time" and solution.provenance.parameters["stopped"] == "by the time limit"


def test_what_would_be_ignored_or_has_no_meaning_is_refused() -> None:
    for told, kind, reason in [
        ({"method": "direct", "rays": 1e5}, isolux.UnusedOption, "direct has no use for rays"),
        ({"method": "wdrs", "unshot": 0.1}, isolux.UnusedOption, "no use for unshot"),
        ({"walk": "continuous", "lines": "bundle"}, isolux.Meaningless, "nearest is"),
        ({"method": "jacobi-gathe"}, isolux.UnknownName, "did you mean 'jacobi-gather'"),
        ({"sequence": "halten"}, isolux.UnknownName, "did you mean 'halton'"),
        ({"error": 2}, isolux.ParameterError, "0.02 is two hundredths"),
        ({"error": 0.1, "error_of": "object:flor"}, isolux.UnknownName, "did you mean 'floor'"),
        ({"time": -1}, isolux.ParameterError, "seconds"),
        ({"threads": 0}, isolux.ParameterError, "1 to 1024"),
        ({"rays": 0.5}, isolux.ParameterError, "a whole number"),
        ({"elements": 1e12}, isolux.TooManyElements, "fewer"),
        ({"elements": 100, "max_edge": 0.1}, isolux.ParameterError, "not both"),
        ({"on_interrupt": "cry"}, isolux.ParameterError, "keep or raise"),
        ({"light_groups": {"a": "nothing"}}, isolux.UnknownName, "did you mean 'light'"),
        ({"colour": 1}, TypeError, "unexpected argument 'colour'"),
    ]:
        with pytest.raises(kind, match=reason):
            isolux.solve("cornell-box", **({"elements": 50} | told if "max_edge" not in told else told))  # type: ignore[arg-type]


def test_deterministic_methods_have_no_error_bars() -> None:
    exact = isolux.solve("box", method="direct", elements=200)
    assert np.isnan(exact.std_error).all() and np.isnan(exact.error) and exact.objects
    sampled = isolux.solve(isolux.Problem("box", elements=200), rays=2e6, leaving="whole-element", method="stochastic-jacobi")
    for name, light in exact.objects.items():
        other = sampled.objects[name].mean
        assert abs(light.mean.mean - other.mean) < 8 * other.std_error + 1e-4 * other.mean


def test_others_run_on_while_something_is_solved() -> None:
    """The interpreter is let go: another thread counts meanwhile."""
    counted, done = [0], threading.Event()

    def count() -> None:
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    other = threading.Thread(target=count)
    other.start()
    isolux.solve("cornell-box", elements=2000, time=0.5)
    done.set()
    other.join()
    assert counted[0] > 20


def test_somebody_who_watches_sees_progress_and_can_end_it() -> None:
    seen: list[isolux.SolveProgress] = []

    def watch(progress: isolux.SolveProgress) -> bool:
        seen.append(progress)
        return progress.rays > 100_000

    solution = isolux.solve("office", elements=20_000, rays=1e12, callback=watch)
    assert solution.ended == "stopped" and not solution.interrupted and 100_000 < solution.rays < 1e10
    assert all(a.rays <= b.rays for a, b in itertools.pairwise(seen)) and seen[-1].rays_in_all

    def fails(progress: isolux.SolveProgress) -> bool:
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        isolux.solve("office", elements=20_000, rays=1e12, callback=fails)


def interrupt_soon(process: int, after: float = 0.7) -> threading.Timer:
    timer = threading.Timer(after, os.kill, (process, signal.SIGINT))
    timer.start()
    return timer


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent as POSIX has them")
def test_ctrl_c_keeps_the_best_result_so_far() -> None:
    interrupt_soon(os.getpid())
    with pytest.warns(isolux.errors.InterruptedWarning, match="best result so far"):
        solution = isolux.solve("cornell-box", elements=500, rays=1e13)
    assert solution.interrupted and solution.irradiance.any() and solution.rays > 0
    interrupt_soon(os.getpid())
    with pytest.raises(isolux.Interrupted) as interrupted:
        isolux.solve("cornell-box", elements=500, rays=1e13, on_interrupt="raise")
    assert interrupted.value.solution.irradiance.any() and isinstance(interrupted.value, KeyboardInterrupt)
    assert not isinstance(interrupted.value, Exception)


def test_progress_is_shown_with_and_without_tqdm(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    solve = "import isolux; isolux.solve('box', elements=200, time=1, progress=True)"
    shown = subprocess.run([sys.executable, "-c", solve], capture_output=True, text=True, check=True)
    assert "solving" in shown.stderr and "rays" in shown.stderr and not shown.stdout
    monkeypatch.setattr(isolux.progress, "is_there", lambda package: False)
    isolux.solve("box", elements=200, time=1, progress=True)
    assert "solving:" in capsys.readouterr().err


def test_how_far_a_solve_is() -> None:
    def now(rays: int, in_all: int | None, excess: float | None) -> isolux.SolveProgress:
        return isolux.SolveProgress("shooting", rays, in_all, None if excess is None else 0.1, excess, seconds=2.0)

    assert now(50, 200, None).share() == 0.25
    assert now(50, 200, None).share(error=0.1) == 0 and now(50, 200, 2.0).share(error=0.1) == 0.25
    assert now(0, None, None).share(time=4) == 0.5 and now(0, None, 0.5).share(error=0.1) == 1
    assert str(now(1_500_000, None, 2.0)) == "1.5M rays, error 10 %" and str(now(2000, None, None)) == "2k rays"


def test_the_program_of_the_wheel_is_the_command_line() -> None:
    command = [sys.executable, "-m", "isolux.command_line"]
    listed = subprocess.run([*command, "list", "scenes"], capture_output=True, text=True, check=True)
    assert "cornell-box" in listed.stdout
    wrong = subprocess.run([*command, "solve", "nothing"], capture_output=True, text=True, check=False)
    assert wrong.returncode == 2 and "no built-in scene" in wrong.stderr
    summary = subprocess.run([*command, "solve", "box", "--elements", "100", "--json"], capture_output=True, text=True, check=True)
    assert json.loads(summary.stdout)["elements"] <= 100


def test_the_command_line_answers_ctrl_c() -> None:
    command = [sys.executable, "-m", "isolux.command_line", "solve", "box", "--rays", "1e12", "--quiet"]
    with subprocess.Popen(command, stderr=subprocess.PIPE) as running:
        time.sleep(2.5)
        running.send_signal(signal.SIGINT)
        assert running.wait(timeout=60) == 130


def test_solving_warns_of_nothing_when_all_is_well() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        isolux.solve("box", elements=100, error=0.2)
