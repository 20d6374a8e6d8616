"""The launch configurations of a scope, which know whether a given argument has been read."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Self

from launch_py.near_names import describe_known


@dataclass(slots=True)
class GivenArgument:
    """An argument from the command line or an include, and whether anything has read it."""

    name: str
    read: bool = False


class LaunchConfigurations(dict[str, str]):
    """Values by name, as launch files read them.

    Launch files read arguments that they do not declare, so a misspelt one is known only by nobody
    reading it.
    """

    def __init__(self, values: Mapping[str, str] | None = None) -> None:
        super().__init__(values or {})
        self._given: dict[str, GivenArgument] = {}
        self._asked: set[str] = set()

    def copy(self) -> Self:
        """Return a copy for an inner scope; reading there counts as reading here."""
        made = type(self)()
        dict.update(made, dict.items(self))
        made._given = dict(self._given)
        made._asked = self._asked
        return made

    def untracked(self) -> Self:
        """Return a copy for a survey; reading there does not count."""
        made = type(self)()
        dict.update(made, dict.items(self))
        return made

    def give(self, arguments: Mapping[str, str]) -> list[GivenArgument]:
        """Set arguments; return them, to see later which of them were read."""
        dict.update(self, arguments)
        given = [GivenArgument(name) for name in arguments]
        self._given.update({argument.name: argument for argument in given})
        return given

    def unread(self, given: Iterable[GivenArgument], declared: Iterable[str]) -> list[str]:
        """Return a sentence for each undeclared argument that nothing has read, with similar names.

        Args:
            given: the arguments.
            declared: the names of the arguments that the launch file declares.
        """
        declared = set(declared)
        known = declared | self._asked
        return [
            f"launch argument {argument.name!r} has no effect: nothing that starts reads it; "
            + describe_known(argument.name, known - {argument.name}, "the arguments are")
            for argument in given
            if not argument.read and argument.name not in declared
        ]

    def _note(self, name: object) -> None:
        if isinstance(name, str):
            self._asked.add(name)
            if name in self._given:
                self._given[name].read = True

    def _note_all(self) -> None:
        for argument in self._given.values():
            argument.read = True

    def __contains__(self, name: object) -> bool:
        self._note(name)
        return super().__contains__(name)

    def __getitem__(self, name: str) -> str:
        self._note(name)
        return super().__getitem__(name)

    def __setitem__(self, name: str, value: str) -> None:
        self._given.pop(name, None)
        super().__setitem__(name, value)

    def get(self, name: str, default: Any = None) -> Any:
        """Return a value, else the default."""
        self._note(name)
        return super().get(name, default)

    def pop(self, name: str, *default: Any) -> Any:
        """Remove a value and return it."""
        self._note(name)
        return super().pop(name, *default)

    def setdefault(self, name: str, default: str = "") -> str:
        """Return a value; set it to the default if there is none."""
        self._note(name)
        return super().setdefault(name, default)

    # Code that walks through all values may use any of them.

    def __iter__(self) -> Iterator[str]:
        self._note_all()
        return super().__iter__()

    def keys(self) -> Any:
        """Return all names."""
        self._note_all()
        return super().keys()

    def values(self) -> Any:
        """Return all values."""
        self._note_all()
        return super().values()

    def items(self) -> Any:
        """Return all names and values."""
        self._note_all()
        return super().items()
