"""Lists whose parts have names: materials, objects, lights and cameras of a scene."""

from __future__ import annotations

import difflib
import fnmatch
from collections.abc import Callable, Iterator, Sequence
from typing import Generic, TypeVar, overload

from .errors import ParameterError, UnknownName

Part = TypeVar("Part")


class NamedList(Sequence[Part], Generic[Part]):
    """The parts of a scene of one kind, by number or by name.

    `scene.materials[0]`, `scene.materials["Floor"]` and `for material in scene.materials` all work; `"Floor" in scene.materials` says
    whether there is one. What comes out is a handle: assigning to its attributes changes the scene.
    """

    def __init__(self, kind: str, names: Callable[[], list[str]], part: Callable[[int], Part]) -> None:
        self._kind, self._names, self._part = kind, names, part

    @property
    def names(self) -> list[str]:
        """The names, in the order of the numbers."""
        return self._names()

    def __len__(self) -> int:
        return len(self._names())

    @overload
    def __getitem__(self, key: int | str) -> Part: ...

    @overload
    def __getitem__(self, key: slice) -> list[Part]: ...

    def __getitem__(self, key: int | str | slice) -> Part | list[Part]:
        if isinstance(key, slice):
            return [self._part(k) for k in range(len(self))[key]]
        if isinstance(key, str):
            return self._part(self._number(key))
        try:
            return self._part(range(len(self))[key])
        except IndexError:
            raise IndexError(f"there is no {self._kind} number {key}; there are {len(self)}") from None

    def _number(self, name: str) -> int:
        names = self._names()
        if names.count(name) > 1:
            raise ParameterError.of(self._kind, name, "several have this name; take one of them by its number")
        try:
            return names.index(name)
        except ValueError:
            nearest = (difflib.get_close_matches(name, names, n=1, cutoff=0) or [""])[0]
            advice = f"did you mean '{nearest}'?" if names else "there is none at all"
            raise UnknownName(f"there is no {self._kind} called '{name}'; {advice}", self._kind, name, nearest) from None

    def matching(self, pattern: str) -> list[Part]:
        """All whose names match a pattern such as "Window*"."""
        return [self._part(k) for k, name in enumerate(self._names()) if fnmatch.fnmatchcase(name, pattern)]

    def __iter__(self) -> Iterator[Part]:
        return (self._part(k) for k in range(len(self)))

    def __contains__(self, name: object) -> bool:
        return name in self._names()

    def __repr__(self) -> str:
        names = self._names()
        shown = ", ".join(repr(name) for name in names[:6])
        return f"<{len(names)} {self._kind}{'' if len(names) == 1 else 's'}: {shown}{', ...' if len(names) > 6 else ''}>"
