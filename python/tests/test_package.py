"""The package itself: stubs, docstrings, examples, the tutorial, errors."""

import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest

import isolux
from conftest import ROOT
from isolux import errors

EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
PAGES = [ROOT / "docs" / "python.md", ROOT / "docs" / "lightmaps.md", ROOT / "README.md"]


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run(example: Path, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    command = [sys.executable, "-W", "error", str(example), str(tmp_path)]
    ran = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, check=False)
    assert ran.returncode == 0 and ran.stdout, ran.stderr


def blocks(text: str) -> list[str]:
    """The Python in a Markdown file."""
    return re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.stem)
def test_what_the_pages_show_runs_word_by_word(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib")
    pytest.importorskip("xatlas")
    monkeypatch.chdir(tmp_path)
    code = blocks(page.read_text(encoding="utf-8"))
    assert code
    known: dict[str, object] = {"__name__": "tutorial"}
    for block in code:
        exec(compile(block, page.name, "exec"), known)


def test_everything_public_says_what_it_is() -> None:
    for name in isolux.__all__:
        one = getattr(isolux, name)
        assert inspect.getdoc(one), name
        if inspect.isclass(one):
            for member, value in vars(one).items():
                is_public = not member.startswith("_") and (inspect.isfunction(value) or isinstance(value, property))
                assert not is_public or inspect.getdoc(getattr(one, member)), f"{name}.{member}"


def test_names_are_sorted_and_all_there() -> None:
    assert isolux.__all__ == sorted(isolux.__all__)
    assert all(hasattr(isolux, name) for name in isolux.__all__)
    assert isolux.names("methods")[0] == "auto" and "direct" in isolux.names("methods")
    with pytest.raises(isolux.UnknownName, match="did you mean 'scenes'"):
        isolux.names("scene")  # type: ignore[arg-type]


def test_every_kind_of_error_has_a_class_of_its_own() -> None:
    classes = [one for one in vars(errors).values() if inspect.isclass(one) and one.__module__ == errors.__name__]
    raised = re.findall(r'raise\(py, "(\w+)"|raise\("(\w+)"|"(MissingFile|FileError)"', (ROOT / "crates/python/src/fail.rs").read_text())
    names = {name for names in raised for name in names if name}
    assert names <= {one.__name__ for one in classes} and len(names) > 12
    for one in classes:
        is_error = issubclass(one, (isolux.Error, Warning, KeyboardInterrupt))
        assert is_error and inspect.getdoc(one) and (one.__name__ in isolux.__all__)


def test_stubs_say_what_the_engine_has() -> None:
    pytest.importorskip("mypy")
    command = [sys.executable, "-m", "mypy.stubtest", "isolux._native", "--ignore-disjoint-bases"]
    checked = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    assert checked.returncode == 0, checked.stdout


def test_types_fit() -> None:
    pytest.importorskip("mypy")
    checked = subprocess.run([sys.executable, "-m", "mypy"], capture_output=True, text=True, check=False, cwd=ROOT)
    assert checked.returncode == 0, checked.stdout


def test_a_package_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch, cornell: isolux.Solution) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(isolux.MissingPackage, match="pip install pandas") as missing:
        cornell.to_dataframe()
    assert missing.value.package == "pandas" and isinstance(missing.value, ImportError)
