"""What can go wrong: one exception class for each kind of error.

All of them are `isolux.Error`, and what Python programs expect besides: a file that is not there is a `FileNotFoundError`, a wrong number
a `ValueError`. The message says what is wrong, where, and what to do; the attributes say it to programs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .solution import Solution


class Error(Exception):
    """The base class of all errors of isolux."""


class FileError(Error, OSError):
    """A file cannot be read or written.

    Attributes:
        path: the file.
        action: what was tried, such as "read" or "write".
        code: the number of the error of the operating system, if it has one.
    """

    def __init__(self, message: str, path: str, action: str, code: int | None = None) -> None:
        super().__init__(message)
        self.path, self.action, self.code = path, action, code
        self.filename = path
        if code is not None:
            self.errno = code

    def __str__(self) -> str:
        # An OSError would write its own message, from number and file.
        return str(self.args[0])


class MissingFile(FileError, FileNotFoundError):
    """A file, or its folder, is not there."""


class InvalidFile(Error, ValueError):
    """A file was read, but what it says is wrong.

    Attributes:
        file: the file.
        place: where in it, such as "meshes/3/primitives/0" or "line 7".
        what: what is wrong there.
    """

    def __init__(self, message: str, file: str, place: str, what: str) -> None:
        super().__init__(message)
        self.file, self.place, self.what = file, place, what


class UnknownFormat(Error, ValueError):
    """There is no reader or writer for the extension of a file.

    Attributes:
        path: the file.
    """

    def __init__(self, message: str, path: str) -> None:
        super().__init__(message)
        self.path = path


class InvalidScene(Error, ValueError):
    """A scene has an index that leads nowhere, or a number that is not finite.

    Attributes:
        place: where, such as "triangles/7".
        what: what is wrong there.
    """

    def __init__(self, message: str, place: str, what: str) -> None:
        super().__init__(message)
        self.place, self.what = place, what


class EmptyScene(Error, ValueError):
    """A scene has no surface, so there is nothing to light."""


class UnknownName(Error, KeyError):
    """A name that nothing has: of a scene, an object, a material, a method, a camera.

    Attributes:
        kind: what was looked for, such as "object".
        name: the name that was asked for.
        nearest: the known name that is most like it.
    """

    def __init__(self, message: str, kind: str, name: str, nearest: str) -> None:
        super().__init__(message)
        self.kind, self.name, self.nearest = kind, name, nearest

    def __str__(self) -> str:
        # A KeyError would put quotes round it.
        return str(self.args[0])


class ParameterError(Error, ValueError):
    """A parameter outside its meaning.

    Attributes:
        name: the parameter.
        value: what it was, as text.
        allowed: what it may be.
    """

    def __init__(self, message: str, name: str, value: str, allowed: str) -> None:
        super().__init__(message)
        self.name, self.value, self.allowed = name, value, allowed

    @classmethod
    def of(cls, name: str, value: object, allowed: str) -> ParameterError:
        """The error for a parameter called `name` that was `value`."""
        return cls(f"{name} = {value}: {allowed}", name, str(value), allowed)


class TooManyElements(Error, ValueError):
    """More elements than can be numbered.

    Attributes:
        asked, limit: how many were asked for, and how many there can be.
    """

    def __init__(self, message: str, asked: int, limit: int) -> None:
        super().__init__(message)
        self.asked, self.limit = asked, limit


class Meaningless(Error, ValueError):
    """A combination of axes of a method that has no meaning.

    Attributes:
        what: why not.
        nearest: the nearest combination that has one, as the command line writes it.
    """

    def __init__(self, message: str, what: str, nearest: str) -> None:
        super().__init__(message)
        self.what, self.nearest = what, nearest


class UnusedOption(Error, ValueError):
    """An option that the method would ignore.

    Attributes:
        method, option: which.
        why: why it has no use for it.
    """

    def __init__(self, message: str, method: str, option: str, why: str) -> None:
        super().__init__(message)
        self.method, self.option, self.why = method, option, why


class NotComparable(Error, ValueError):
    """Two solutions that have nothing in common.

    Attributes:
        what: why.
    """

    def __init__(self, message: str, what: str) -> None:
        super().__init__(message)
        self.what = what


class NotMergeable(Error, ValueError):
    """Solutions that cannot be made one.

    Attributes:
        what: why.
    """

    def __init__(self, message: str, what: str) -> None:
        super().__init__(message)
        self.what = what


class NotFinite(Error, ArithmeticError):
    """A number that is not finite reached a solver, or came out of one.

    Attributes:
        element: where.
        what: which quantity.
        value: what it was.
    """

    def __init__(self, message: str, element: int, what: str, value: float) -> None:
        super().__init__(message)
        self.element, self.what, self.value = element, what, value


class LightmapError(Error, ValueError):
    """A lightmap that cannot be made.

    Attributes:
        what: why, and what to ask for.
    """

    def __init__(self, message: str, what: str) -> None:
        super().__init__(message)
        self.what = what

    @classmethod
    def of(cls, what: str) -> LightmapError:
        """The error that says `what`."""
        return cls(f"there is no such lightmap: {what}", what)


class NoViewer(Error, RuntimeError):
    """A page (.html) cannot be written: isolux was built without the viewer, for npm was not installed."""


class InvalidStudy(Error, ValueError):
    """A `study.toml` says something wrong.

    Attributes:
        study: its name.
        what: what is wrong.
    """

    def __init__(self, message: str, study: str, what: str) -> None:
        super().__init__(message)
        self.study, self.what = study, what


class OtherRun(Error, ValueError):
    """The folder for a study holds something else than the first part of this study.

    Attributes:
        path, what: the file that says so, and what it says.
    """

    def __init__(self, message: str, path: str, what: str) -> None:
        super().__init__(message)
        self.path, self.what = path, what


class MissingPackage(Error, ImportError):
    """Something needs a Python package that is not installed.

    Attributes:
        package: which.
    """

    def __init__(self, message: str, package: str) -> None:
        super().__init__(message)
        self.package = package


class UnreadableObject(Error, TypeError):
    """An object from another package that is no mesh, as far as isolux can tell."""


class SolverFault(Error, AssertionError):
    """A solver does not do what every solver must: see `isolux.testing.check_solver`.

    Attributes:
        faults: one sentence for each test that it failed.
    """

    def __init__(self, message: str, faults: list[str]) -> None:
        super().__init__(message)
        self.faults = faults


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended a solve that was told to raise then. Not an `isolux.Error`: programs that handle errors should still end.

    Attributes:
        solution: the best result until then.
    """

    def __init__(self, solution: Solution) -> None:
        super().__init__("the solve was interrupted; its best result so far is in .solution")
        self.solution = solution


class InterruptedWarning(UserWarning):
    """Ctrl-C ended a solve, and the result is the best until then, less than was asked for."""


class AccuracyWarning(UserWarning):
    """A solve ended before it was as accurate as was asked for."""
