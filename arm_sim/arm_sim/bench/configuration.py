"""Reads the arguments of a test's markers."""

import inspect
from collections.abc import Callable, Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from arm_sim.errors import CallError

if TYPE_CHECKING:
    import pytest

PATHS = ("robot", "world", "controllers")
"""Arguments that may name a file beside the test."""


def arguments_of(function: Callable[..., object]) -> list[str]:
    """Return the names of a function's keyword-only arguments."""
    parameters = inspect.signature(function).parameters.items()
    return [name for name, p in parameters if p.kind is inspect.Parameter.KEYWORD_ONLY]


def marked_arguments(item: "pytest.Item", marker: str, names: Sequence[str]) -> dict[str, Any]:
    """Return the arguments of a test's markers; those nearer to the test take precedence.

    A file in the test's folder may be given by its name alone.

    Raises:
        CallError: an argument is unknown.
    """
    arguments: dict[str, Any] = {}
    for mark in item.iter_markers(marker):
        if mark.args:
            raise CallError(f"@pytest.mark.{marker} takes arguments by name, such as robot='arm'")
        for name, value in mark.kwargs.items():
            if name not in names:
                raise CallError(
                    f"@pytest.mark.{marker} has no argument '{name}'; it has {', '.join(names)}"
                )
            arguments.setdefault(name, value)
    for name in PATHS:
        if name in arguments:
            arguments[name] = _beside(item.path.parent, arguments[name])
    return arguments


def configuration_key(arguments: Mapping[str, Any]) -> str:
    """Return a text that is the same for the same arguments."""
    return repr(sorted((name, _plain(value)) for name, value in arguments.items()))


def _beside(folder: Path, value: Any) -> Any:
    """Return the path of a file in a folder, or the value if there is none of that name."""
    if not isinstance(value, str | PathLike) or fspath(value).lstrip().startswith("<"):
        return value
    path = folder / fspath(value)
    return str(path) if path.is_file() else fspath(value)


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return sorted((str(key), _plain(inner)) for key, inner in value.items())
    if isinstance(value, PathLike):
        return fspath(value)
    return tuple(map(_plain, value)) if isinstance(value, list | tuple) else value
