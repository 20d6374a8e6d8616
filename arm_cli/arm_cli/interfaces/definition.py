"""The text of a type's definition, with the definitions of nested types indented below."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from arm_cli.interfaces.index import InterfaceIndex, InterfaceType

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
