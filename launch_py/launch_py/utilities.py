"""What launch files import from `launch.utilities`, `launch.logging`, `launch_ros.utilities`."""

from __future__ import annotations

import logging
import sys
from collections.abc import Iterable
from inspect import isclass
from os import PathLike
from typing import Any

from launch_py.errors import LaunchFileError
from launch_py.events import LaunchDescriptionEntity
from launch_py.substitution import LaunchScope, Substitution, Text, join_names, perform_text
from launch_py.substitutions import TextSubstitution

ROOT = "launch"


class _ShownHandler(logging.Handler):
    """Writes to whatever stdout is at the time, as the launcher's own messages go there."""

    def emit(self, record: logging.LogRecord) -> None:
        """Write one message."""
        level = f"[{record.levelname}] " if record.levelno != logging.INFO else ""
        sys.stdout.write(f"[{record.name}] {level}{record.getMessage()}\n")
        sys.stdout.flush()


def get_logger(name: str | None = None) -> logging.Logger:
    """Return a logger below "launch"; it shows what is INFO or above."""
    root = logging.getLogger(ROOT)
    if not root.handlers:
        root.addHandler(_ShownHandler())
        root.setLevel(logging.INFO)
        root.propagate = False
    inner = (name or "").removeprefix(f"{ROOT}.")
    return root.getChild(inner) if inner and inner != ROOT else root


TEXT_TYPES = (str, PathLike, Substitution, Iterable)
ENTITY_TYPES = (LaunchDescriptionEntity, Iterable)


def perform_substitutions(context: LaunchScope, subs: Text) -> str:
    """Return the text that substitutions stand for."""
    return perform_text(context, subs)


def normalize_to_list_of_substitutions(subs: Text) -> list[Substitution]:
    """Return a text as a list of substitutions."""
    if isinstance(subs, Substitution):
        return [subs]
    if isinstance(subs, str) or not isinstance(subs, Iterable):
        return [TextSubstitution(text=str(subs))]
    return [part for item in subs for part in normalize_to_list_of_substitutions(item)]


def normalize_to_list_of_entities(entities: Any) -> list[LaunchDescriptionEntity]:
    """Return an entity, or nested lists of them, as one list."""
    if isinstance(entities, Iterable):
        return [entity for item in entities for entity in normalize_to_list_of_entities(item)]
    return [entities]


def ensure_argument_type(
    argument: object, types: type | Iterable[type], argument_name: str, caller: object = None
) -> None:
    """Raise a LaunchFileError if an argument has none of these types."""
    wanted = (types,) if isinstance(types, type) else tuple(types)
    if not isinstance(argument, wanted):
        names = " or ".join(kind.__name__ for kind in wanted)
        whose = f" of {caller}" if caller else ""
        raise LaunchFileError(f"{argument_name}{whose} must be {names}, not {argument!r}")


def isclassinstance(obj: object) -> bool:
    """Return whether an object is an instance of a class, as all are."""
    return hasattr(obj, "__class__")


def is_a(obj: object, entity_type: type) -> bool:
    """Return whether an object is an instance of a class."""
    return isinstance(obj, entity_type)


def is_a_subclass(obj: object, entity_type: type) -> bool:
    """Return whether an object is an instance of a class, or a class derived from it."""
    return isinstance(obj, entity_type) or (isclass(obj) and issubclass(obj, entity_type))


def is_namespace_absolute(ns: str) -> bool:
    """Return whether a namespace starts with a slash."""
    return ns.startswith("/")


def is_root_namespace(ns: str) -> bool:
    """Return whether a namespace is the root."""
    return ns == "/"


def make_namespace_absolute(ns: str | None) -> str | None:
    """Return a namespace with a leading slash; None stays None."""
    return ns if ns is None or is_namespace_absolute(ns) else f"/{ns}"


def prefix_namespace(base_ns: str | None, ns: str | None) -> str | None:
    """Return a namespace inside another one; an absolute one stays as it is."""
    if base_ns is None or ns is None:
        return ns if base_ns is None else base_ns
    joined = join_names(base_ns, ns)
    return joined if is_namespace_absolute(base_ns) or not joined else joined[1:]
