"""The installed message, service and action types, found by their definition files."""

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from arm_cli.errors import NoSuchNameError
from arm_node.names import MIN_SIMILARITY, describe_known
from launch_py.system.packages import ament_prefixes

KINDS = ("msg", "srv", "action")
KIND_NAMES = {"msg": "message", "srv": "service", "action": "action"}


@dataclass(frozen=True, slots=True)
class InterfaceType:
    """One type, and the file that defines it."""

    package: str
    kind: str
    name: str
    path: Path

    @property
    def full_name(self) -> str:
        """The full name, such as std_msgs/msg/String."""
        return f"{self.package}/{self.kind}/{self.name}"


class InterfaceIndex:
    """Finds types in the share folders of the prefixes."""

    def __init__(self) -> None:
        """Search the prefixes of AMENT_PREFIX_PATH and of this Python."""
        self._shares = [Path(prefix, "share") for prefix in ament_prefixes(os.environ)]

    def packages(self, kinds: tuple[str, ...] = KINDS) -> list[str]:
        """Return the packages that define types of these kinds, sorted."""
        return sorted(
            {
                folder.parent.name
                for share in self._shares
                for kind in kinds
                for folder in share.glob(f"*/{kind}")
                if any(folder.glob(f"*.{kind}"))
            }
        )

    def types(self, kinds: tuple[str, ...] = KINDS, package: str = "*") -> list[InterfaceType]:
        """Return the types of these kinds, of one package or of all, sorted by name."""
        found: dict[str, InterfaceType] = {}
        for share in self._shares:
            for kind in kinds:
                for path in share.glob(f"{package}/{kind}/*.{kind}"):
                    type_ = InterfaceType(path.parent.parent.name, kind, path.stem, path)
                    found.setdefault(type_.full_name, type_)
        return sorted(found.values(), key=lambda type_: type_.full_name)

    def find(self, name: str, kinds: tuple[str, ...] = KINDS) -> InterfaceType:
        """Return the type with a name; `std_msgs/String` also means `std_msgs/msg/String`.

        Raises:
            NoSuchNameError: there is no such type; the message suggests similar names.
        """
        parts = name.split("/")
        if len(parts) == 3 and parts[1] in kinds:
            wanted = [name]
        elif len(parts) == 2:
            wanted = [f"{parts[0]}/{kind}/{parts[1]}" for kind in kinds]
        else:
            wanted = []
        for full_name in wanted:
            package, kind, stem = full_name.split("/")
            for share in self._shares:
                path = share / package / kind / f"{stem}.{kind}"
                if os.path.isfile(path):
                    return InterfaceType(package, kind, stem, path)
        raise self._unknown(name, kinds)

    def _unknown(self, name: str, kinds: tuple[str, ...]) -> NoSuchNameError:
        what = KIND_NAMES[kinds[0]] if len(kinds) == 1 else "interface"
        if "/" not in name:
            similar = self._similar_types(name, kinds)
            if similar:
                choices = " or ".join(map(repr, similar))
                return NoSuchNameError(f"no {what} type {name!r}; did you mean {choices}?")
        package = name.split("/")[0]
        installed = self.packages(kinds)
        if package not in installed:
            known = describe_known(package, installed)
            return NoSuchNameError(f"no {what} type {name!r}: no package {package!r}; {known}")
        known = [type_.full_name for type_ in self.types(kinds, package)]
        return NoSuchNameError(f"no {what} type {name!r}; {describe_known(name, known)}")

    def _similar_types(self, stem: str, kinds: tuple[str, ...]) -> list[str]:
        """Return up to three types with this name, or with similar names, in any package."""
        import difflib

        types = self.types(kinds)
        stems = {type_.name for type_ in types}
        near = (
            [stem]
            if stem in stems
            else difflib.get_close_matches(stem, sorted(stems), 3, MIN_SIMILARITY)
        )
        return [type_.full_name for name in near for type_ in types if type_.name == name][:3]


def load_class(type_: InterfaceType) -> Any:
    """Return the Python class of a type.

    Raises:
        NoSuchNameError: its package has no Python module, or the module lacks the type.
    """
    try:
        return getattr(import_module(f"{type_.package}.{type_.kind}"), type_.name)
    except (ImportError, AttributeError) as error:
        raise NoSuchNameError(
            f"{type_.full_name} is defined in {type_.path}, but cannot be used: {error}"
        ) from error


PRIMITIVES = frozenset(
    ["bool", "byte", "char", "string", "wstring", "float32", "float64"]
    + [f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)]
)
_FIELD = re.compile(r"^\s*([A-Za-z][\w/]*)(?:<=\d+)?(?:\[[^\]]*\])?\s+[A-Za-z]\w*\s*(.*)$")
_QUOTED = re.compile(r"'(?:\\.|[^'\\])*'|\"(?:\\.|[^\"\\])*\"")


@dataclass(frozen=True, slots=True)
class Comments:
    """Which comments and empty lines to show.

    Attributes:
        outer: whether to show those of the type itself.
        nested: whether to show those of the types of its fields.
    """

    outer: bool = True
    nested: bool = False


def describe_type(index: InterfaceIndex, type_: InterfaceType, comments: Comments) -> Iterator[str]:
    """Yield the lines of a type's definition, with one more tab for each level of nesting.

    Raises:
        NoSuchNameError: the type of a field is not installed.
    """
    yield from _lines(index, type_, comments.outer, comments.nested, "")


def nested_type(line: str, package: str) -> str | None:
    """Return the full name of the message type in a field's line, None if there is none."""
    match = _FIELD.match(line)
    if match is None or line.lstrip().startswith("#"):
        return None
    name, rest = match.groups()
    if name in PRIMITIVES or rest.startswith("="):
        return None
    outer, _, inner = name.rpartition("/")
    return f"{outer.removesuffix('/msg') or package}/msg/{inner}"


def without_comment(line: str) -> str:
    """Return a line without its comment; a # in quotes does not start a comment."""
    masked = _QUOTED.sub(lambda match: "_" * len(match.group()), line)
    return line[: masked.find("#")].strip() if "#" in masked else line


def _lines(
    index: InterfaceIndex, type_: InterfaceType, comments: bool, nested: bool, indent: str
) -> Iterator[str]:
    for raw in type_.path.read_text(encoding="utf-8").splitlines():
        line = raw.rstrip()
        shown = line if comments else without_comment(line)
        if shown or comments:
            yield f"{indent}{shown}" if shown else ""
        inner = nested_type(line, type_.package)
        if inner is not None:
            yield from _lines(index, index.find(inner, ("msg",)), nested, nested, f"{indent}\t")
