"""Substitutions, which get their value when a launch file is expanded, and their scope."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from typing import Any, Self, cast

from launch_py.errors import LaunchFileError
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
        """Return a sentence for each undeclared argument that nothing read, with similar names."""
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


@dataclass(slots=True)
class LaunchScope:
    """What a launch file has set so far: arguments, environment, namespace, remappings.

    Groups and includes work on a copy (`scoped`), so what they set does not leak into the actions
    that follow.
    """

    launch_configurations: dict[str, str] = field(default_factory=dict)
    base_environment: Mapping[str, str] = field(default_factory=lambda: dict(os.environ))
    environment: dict[str, str | None] = field(default_factory=dict)
    """Variables that the launch file sets, None for those that it unsets."""
    namespace: str = ""
    parameters: list[dict[str, Any] | str] = field(default_factory=list)
    """Parameters of all nodes in this scope, before the nodes' own: dicts, and paths of files."""
    remappings: list[tuple[str, str]] = field(default_factory=list)
    event: object = None
    """The event that is being handled, if any; see `LocalSubstitution`."""
    launch_file: Path | None = None
    included_files: tuple[Path, ...] = ()
    """The launch files that include this scope, outermost first."""
    fixed_arguments: frozenset[str] = frozenset()
    """Arguments whose values an enclosing include sets."""
    configuration_stack: list[dict[str, str]] = field(default_factory=list)
    """What `PushLaunchConfigurations` keeps for `PopLaunchConfigurations`."""
    environment_stack: list[dict[str, str | None]] = field(default_factory=list)
    """What `PushEnvironment` keeps for `PopEnvironment`."""
    anonymous_names: dict[str, str] = field(default_factory=dict)
    """The names that `AnonName` has made up; all copies share this dict."""
    warnings: list[str] = field(default_factory=list)
    """Warnings for the user; all copies share this list."""

    def __post_init__(self) -> None:
        """Let the configurations know what is read of them."""
        if not isinstance(self.launch_configurations, LaunchConfigurations):
            self.launch_configurations = LaunchConfigurations(self.launch_configurations)

    def scoped(self) -> Self:
        """Return a copy; changes to it do not affect this scope."""
        return replace(
            self,
            launch_configurations=self._tracked().copy(),
            environment=dict(self.environment),
            parameters=list(self.parameters),
            remappings=list(self.remappings),
            configuration_stack=list(self.configuration_stack),
            environment_stack=list(self.environment_stack),
        )

    def surveyed(self) -> Self:
        """Return a copy for a survey; what it reads does not count as read."""
        return replace(self.scoped(), launch_configurations=self._tracked().untracked())

    def bare(self) -> Self:
        """Return a copy without any of the settings made so far."""
        return replace(
            self,
            launch_configurations={},
            environment={},
            namespace="",
            parameters=[],
            remappings=[],
        )

    def included(self, path: Path | None) -> Self:
        """Return the scope of a file that is included here."""
        inner = self.scoped()
        inner.launch_file = path
        if path is not None:
            inner.included_files = (*self.included_files, path)
        return inner

    def fix_arguments(self, arguments: Mapping[str, str]) -> list[GivenArgument]:
        """Set the arguments that an include passes; return them for `warn_of_unread`."""
        self.fixed_arguments |= arguments.keys()
        return self.give(arguments)

    def give(self, arguments: Mapping[str, str]) -> list[GivenArgument]:
        """Set arguments; return them for `warn_of_unread`."""
        return self._tracked().give(arguments)

    def warn_of_unread(
        self, given: Iterable[GivenArgument], declared: Iterable[str], where: str = ""
    ) -> None:
        """Warn of the undeclared arguments that nothing has read."""
        for sentence in self._tracked().unread(given, declared):
            self.warnings.append(f"{where}: {sentence}" if where else sentence)

    def _tracked(self) -> LaunchConfigurations:
        return cast("LaunchConfigurations", self.launch_configurations)

    def perform_substitution(self, value: Text) -> str:
        """Return the text that `value` stands for in this scope."""
        return perform_text(self, value)

    def environment_variable(self, name: str) -> str | None:
        """Return a variable as a process started here would see it."""
        if name in self.environment:
            return self.environment[name]
        return self.base_environment.get(name)

    def complete_environment(self) -> dict[str, str]:
        """Return all environment variables that are set in this scope."""
        merged = {**self.base_environment, **self.environment}
        return {name: value for name, value in merged.items() if value is not None}

    def set_environment_variable(self, name: str, value: str | None) -> None:
        """Set a variable for the processes that follow in this scope; None unsets it."""
        self.environment[name] = value

    def push_namespace(self, namespace: str) -> None:
        """Append a namespace to this scope's namespace; an absolute one replaces it."""
        self.namespace = join_names(self.namespace, namespace)


class Substitution(ABC):
    """A text whose value depends on the scope."""

    is_costly = False
    """Whether performing it takes time or has side effects; surveys skip costly substitutions."""

    @abstractmethod
    def perform(self, context: LaunchScope) -> str:
        """Return the text.

        Raises:
            SubstitutionError: the substitution has no value in this scope.
        """

    def describe(self) -> str:
        """Return the substitution as messages show it, about as a launch file writes it."""
        return f"{type(self).__name__}(...)"


Text = str | PathLike[str] | Substitution | Iterable["str | PathLike[str] | Substitution"]
"""What a launch file may pass as a text; the parts of an iterable are joined."""

Pairs = Mapping[str, Text] | Iterable[tuple[Text, Text]]
"""A dict, or pairs as its `items()` returns them."""


def perform_text(context: LaunchScope, value: Text) -> str:
    """Return the text that `value` stands for in this scope.

    Raises:
        LaunchFileError: a part of it is not a text, a path or a substitution.
        SubstitutionError: a substitution has no value.
    """
    if isinstance(value, str):
        return value
    if isinstance(value, Substitution):
        return value.perform(context)
    if isinstance(value, PathLike):
        return str(value.__fspath__())
    if isinstance(value, Iterable) and not isinstance(value, bytes):
        return "".join(perform_text(context, part) for part in value)
    raise LaunchFileError(
        f"a text or a substitution is needed, not {value!r} of type {type(value).__name__}"
    )


def describe_text(value: Text) -> str:
    """Return `value` as messages show it, without performing it."""
    if isinstance(value, str):
        return value
    if isinstance(value, Substitution):
        return value.describe()
    if isinstance(value, PathLike):
        return str(value.__fspath__())
    if isinstance(value, Iterable) and not isinstance(value, bytes):
        return "".join(describe_text(part) for part in value)
    return repr(value)  # The value has the wrong type; an error message is about to show it.


def is_costly(value: Text) -> bool:
    """Return whether a substitution in `value` is costly to perform."""
    if isinstance(value, Substitution):
        return value.is_costly
    if isinstance(value, str | PathLike) or not isinstance(value, Iterable):
        return False  # Performing a value of the wrong type says what is wrong.
    return any(is_costly(part) for part in value)


def keep_dict(values: Mapping[Any, Any] | None, of: str) -> dict[Any, Any]:
    """Return a copy of a dict, empty for None.

    Raises:
        LaunchFileError: it is not a dict.
    """
    if not isinstance(values, Mapping | None):
        raise LaunchFileError(f"{of} takes a dict, not {values!r} of type {type(values).__name__}")
    return dict(values or {})


def keep_list(values: Iterable[Any] | None, of: str) -> list[Any]:
    """Return what is iterated as a list, a single text as a list of it; see `keep_dict`."""
    if isinstance(values, str):
        return [values]
    if not isinstance(values, Iterable | None):
        raise LaunchFileError(f"{of} takes a list, not {values!r} of type {type(values).__name__}")
    return list(values or ())


def keep_pairs(pairs: Pairs | None) -> tuple[tuple[Text, Text], ...]:
    """Return the pairs as a tuple, because an iterator such as `zip` can be read only once."""
    items = pairs.items() if isinstance(pairs, Mapping) else pairs or ()
    if not isinstance(items, Iterable):
        raise LaunchFileError(f"a dict or pairs are needed, not {pairs!r}")
    return tuple(cast("Iterable[tuple[Text, Text]]", items))


def perform_pairs(context: LaunchScope, pairs: Pairs, of: str) -> tuple[tuple[str, str], ...]:
    """Return the pairs with both sides performed; see `perform_text`.

    Raises:
        LaunchFileError: an item is not a pair, or a side of it is not a text.
        SubstitutionError: a substitution has no value.
    """
    performed: list[tuple[str, str]] = []
    for pair in keep_pairs(pairs):
        if not isinstance(pair, Sequence) or isinstance(pair, str) or len(pair) != 2:
            raise LaunchFileError(f"{of} takes pairs of two texts, not {pair!r}")
        performed.append((perform_text(context, pair[0]), perform_text(context, pair[1])))
    return tuple(performed)


def join_names(namespace: str, name: str) -> str:
    """Return `name` resolved in `namespace`, with a leading slash; "" if both are empty."""
    if name.startswith("/"):
        return "/" + name.strip("/") if name.strip("/") else ""
    parts = [part for part in (namespace.strip("/"), name.strip("/")) if part]
    return "/" + "/".join(parts) if parts else ""
