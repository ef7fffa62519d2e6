"""isolux: how much light every piece of every surface of a scene receives after all interreflections, with an error bar.

View-independent diffuse global illumination by Monte Carlo radiosity. Lengths are in metres, light in lumens, lux and candela.

    scene = isolux.load("room.glb")
    scene.materials["Floor"].reflectivity = 0.3
    solution = isolux.solve(scene, error=0.02, progress=True)
    print(solution.objects["Desk"].mean)

docs/python.md is a tutorial.
"""

from __future__ import annotations

from typing import Literal

from . import _native, errors, testing
from .check import Finding, Report
from .colors import luminance
from .comparing import Comparison, compare, merge
from .convergence import Convergence, convergence
from .driver import Solver, run
from .errors import (
    AccuracyWarning,
    EmptyScene,
    Error,
    FileError,
    Interrupted,
    InterruptedWarning,
    InvalidFile,
    InvalidScene,
    InvalidStudy,
    LightmapError,
    Meaningless,
    MissingFile,
    MissingPackage,
    NotComparable,
    NotFinite,
    NotMergeable,
    NoViewer,
    OtherRun,
    ParameterError,
    SolverFault,
    TooManyElements,
    UnknownFormat,
    UnknownName,
    UnreadableObject,
    UnusedOption,
)
from .estimate import Estimate
from .factors import FormFactors, form_factors
from .light import Balance, ObjectLight, Provenance
from .parts import Camera, Light, Material, Object
from .plot import plot_solution, to_pyvista
from .problem import Problem
from .progress import SolveProgress
from .scene import Scene, load
from .solution import Solution, open
from .solving import solve
from .studies import Slope, Study, Verdict, study
from .unwrap import Charts, unwrap

__version__ = _native.__version__


def names(
    table: Literal["scenes", "methods", "orders", "sequences", "ways", "studies", "readers", "writers"],
) -> list[str]:
    """What can be asked for by name: built-in scenes, methods, orders and sample sequences of methods, ways to form factors, studies, and
    the extensions of files that are read and written.

    Raises:
        UnknownName: there is no such table.
    """
    return _native.names(table)


__all__ = [
    "AccuracyWarning",
    "Balance",
    "Camera",
    "Charts",
    "Comparison",
    "Convergence",
    "EmptyScene",
    "Error",
    "Estimate",
    "FileError",
    "Finding",
    "FormFactors",
    "Interrupted",
    "InterruptedWarning",
    "InvalidFile",
    "InvalidScene",
    "InvalidStudy",
    "Light",
    "LightmapError",
    "Material",
    "Meaningless",
    "MissingFile",
    "MissingPackage",
    "NoViewer",
    "NotComparable",
    "NotFinite",
    "NotMergeable",
    "Object",
    "ObjectLight",
    "OtherRun",
    "ParameterError",
    "Problem",
    "Provenance",
    "Report",
    "Scene",
    "Slope",
    "Solution",
    "SolveProgress",
    "Solver",
    "SolverFault",
    "Study",
    "TooManyElements",
    "UnknownFormat",
    "UnknownName",
    "UnreadableObject",
    "UnusedOption",
    "Verdict",
    "compare",
    "convergence",
    "errors",
    "form_factors",
    "load",
    "luminance",
    "merge",
    "names",
    "open",
    "plot_solution",
    "run",
    "solve",
    "study",
    "testing",
    "to_pyvista",
    "unwrap",
]
