"""Packages that isolux can do without."""

from __future__ import annotations

import importlib
import importlib.util
from types import ModuleType

from .errors import MissingPackage


def needed(package: str, what: str) -> ModuleType:
    """The module called `package`, which `what` needs.

    Raises:
        MissingPackage: if it is not installed.
    """
    try:
        return importlib.import_module(package)
    except ImportError as error:
        name = package.partition(".")[0]
        raise MissingPackage(f"{what} needs the package {name}: pip install {name}", name) from error


def is_there(package: str) -> bool:
    """Whether a package can be imported."""
    return importlib.util.find_spec(package) is not None
