"""Parses substitutions in parameter files: `$(var name)`, `$(find-pkg-share package)`."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from launch_py.errors import SubstitutionError
from launch_py.near_names import describe_known
from launch_py.ros.substitutions import (
    ExecutableInPackage,
    FindPackagePrefix,
    FindPackageShare,
    ParameterSubstitution,
)
from launch_py.substitution import Substitution, Text
from launch_py.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnonName,
    AnySubstitution,
    Command,
    EnvironmentVariable,
    EqualsSubstitution,
    FileContent,
    FindExecutable,
    IfElseSubstitution,
    LaunchConfiguration,
    LaunchLogDir,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    StringJoinSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)
from launch_py.substitutions.safe_expression import SafeExpression

NAME = re.compile(r"[A-Za-z][\w-]*", re.ASCII)
MANY = 1000


@dataclass(frozen=True, slots=True)
class _Kind:
    """A kind of substitution, and how many words it takes."""

    make: Callable[..., Substitution]
    least: int = 1
    most: int = 1


KINDS = {
    "all": _Kind(AllSubstitution, 1, MANY),
    "and": _Kind(AndSubstitution, 2, 2),
    "anon": _Kind(AnonName),
    "any": _Kind(AnySubstitution, 1, MANY),
    "command": _Kind(Command),
    "dirname": _Kind(ThisLaunchFileDir, 0, 0),
    "env": _Kind(lambda name, value=None: EnvironmentVariable(name, default_value=value), 1, 2),
    "equals": _Kind(EqualsSubstitution, 2, 2),
    "eval": _Kind(SafeExpression, 1, 2),
    "exec-in-pkg": _Kind(ExecutableInPackage, 2, 2),
    "file-content": _Kind(FileContent),
    "filename": _Kind(ThisLaunchFile, 0, 0),
    "find-exec": _Kind(lambda name: FindExecutable(name=name)),
    "find-pkg-prefix": _Kind(FindPackagePrefix),
    "find-pkg-share": _Kind(FindPackageShare),
    "if": _Kind(IfElseSubstitution, 2, 3),
    "launch_log_dir": _Kind(LaunchLogDir, 0, 0),
    "log_dir": _Kind(LaunchLogDir, 0, 0),
    "not": _Kind(NotSubstitution),
    "not-equals": _Kind(NotEqualsSubstitution, 2, 2),
    "or": _Kind(OrSubstitution, 2, 2),
    "param": _Kind(lambda name, value=None: ParameterSubstitution(name, default=value), 1, 2),
    "string-join": _Kind(lambda mark, *parts: StringJoinSubstitution(parts, mark), 2, MANY),
    "var": _Kind(lambda name, value=None: LaunchConfiguration(name, default=value), 1, 2),
}


def parse_substitutions(text: str) -> Text:
    r"""Return a text with its substitutions parsed.

    Spaces separate the words after a substitution's name; a quoted word may contain spaces and
    parentheses. Substitutions may be nested. `\$(` does not start a substitution.

    Raises:
        SubstitutionError: a substitution is not closed, is unknown, or has too many or too few
            words.
    """
    return _Parser(text).text()


class _Parser:
    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0

    def text(self) -> Text:
        parts: list[str | Substitution] = []
        while self._at < len(self._text):
            if self._take("\\$("):
                parts.append("$(")
            else:
                parts.append(self._part())
        return parts

    def _part(self) -> str | Substitution:
        """Return the substitution that begins here, or one character."""
        return self._substitution() if self._take("$(") else self._character()

    def _substitution(self) -> Substitution:
        match = NAME.match(self._text, self._at)
        name = match[0] if match else ""
        self._at += len(name)
        words: list[Text] = []
        while not self._take(")"):
            if not self._take(" "):
                raise self._malformed()
            if self._next() not in (" ", ")"):
                words.append(self._word())
        return _make(name, words)

    def _word(self) -> Text:
        quote = next((mark for mark in "'\"" if self._take(mark)), "")
        parts: list[str | Substitution] = []
        while not (self._take(quote) if quote else self._next() in (" ", ")")):
            if self._next() == "(" and not quote:
                raise self._malformed()
            parts.append(self._character() if self._take("\\") else self._part())
        plain = [part for part in parts if isinstance(part, str)]
        return "".join(plain) if len(plain) == len(parts) else parts

    def _character(self) -> str:
        if not self._next():
            raise self._malformed()
        self._at += 1
        return self._text[self._at - 1]

    def _next(self) -> str:
        return self._text[self._at : self._at + 1]

    def _malformed(self) -> SubstitutionError:
        return SubstitutionError(
            f"{self._text!r} is malformed at character {self._at + 1}: a substitution "
            "is $(name word 'word with spaces or parentheses')"
        )

    def _take(self, expected: str) -> bool:
        """Skip `expected` if it comes next; return whether it does."""
        found = self._text.startswith(expected, self._at)
        if found:
            self._at += len(expected)
        return found


def _make(name: str, words: Sequence[Text]) -> Substitution:
    kind = KINDS.get(name)
    if kind is None:
        raise SubstitutionError(f"no substitution $({name}); {describe_known(name, KINDS)}")
    if not kind.least <= len(words) <= kind.most:
        most = "" if kind.most == kind.least else f" to {kind.most}"
        takes = f"at least {kind.least}" if kind.most == MANY else f"{kind.least}{most}"
        raise SubstitutionError(f"$({name}) takes {takes} words after its name, not {len(words)}")
    return kind.make(*words)
