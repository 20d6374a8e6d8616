"""Reads ROS parameter files as rcl does, which reads them for a node that starts with one.

A file may name a node, or a parameter, more than once: all of it counts. Types follow rcl, whose
notation is not PyYAML's: 1e3 and 08 are doubles, 010 is 8, and y is true.
"""

import math
import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any

from arm_node.limited_yaml import YamlError, compose_yaml_documents

PARAMETERS = "ros__parameters"
"""The key between a node's name and its parameters."""

_TRUE = frozenset(["y", "Y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"])
_FALSE = frozenset(["n", "N", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"])
_INTEGER = re.compile(r"[+-]?(0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)", re.ASCII)
_INTEGERS = range(-(2**63), 2**63)
_DECIMAL = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_HEXADECIMAL = re.compile(r"[+-]?0x([\da-f]+\.?[\da-f]*|\.[\da-f]+)(p[+-]?\d+)?", re.ASCII | re.I)
_INFINITY = re.compile(r"([+-]?)(inf|infinity|\.inf)", re.IGNORECASE)
_NOT_A_NUMBER = re.compile(r"[+-]?nan(\(\w*\))?|\.nan", re.IGNORECASE | re.ASCII)
_SMALLEST = 2.0**-1022
"""The smallest double that is not subnormal; strtod reports an error for those."""
_STRING_TAG = "tag:yaml.org,2002:str"
_KINDS = (bool, int, float, str)


def read_parameters(text: str) -> dict[str, dict[str, Any]]:
    """Return the parameters in a file by node; see `parameters_by_node`.

    Raises:
        YamlError: the text is not YAML, or exceeds a limit of `arm_node.limited_yaml`.
    """
    sections = _Sections()
    for document in compose_yaml_documents(text, _loader()):
        content = _plain(document)
        sections.add_nodes(content if isinstance(content, _Mapping) else _Mapping(), "")
    return sections.by_node()


def parameters_by_node(content: Mapping[Any, Any]) -> dict[str, dict[str, Any]]:
    """Return the parameters in the content of a parameter file by node, with nested keys merged.

    A node in a namespace has its full name, any other one the name that the file gives it. Each has
    {"ros__parameters": ...}, a dict of nested dicts, or {} if the file gives it none.
    """
    sections = _Sections()
    sections.add_nodes(content, "")
    return sections.by_node()


def given_parameters(content: Mapping[str, Mapping[str, Any]], node: str) -> dict[str, Any]:
    """Return the parameters that apply to a node, by their names with dots.

    As in rcl, the sections that match the node's name are applied in the order of the file.
    """
    values: dict[str, Any] = {}
    for pattern, entry in content.items():
        if PARAMETERS in entry and applies(pattern, node):
            values |= dict(flat_parameters(entry[PARAMETERS]))
    return values


def applies(pattern: str, node: str) -> bool:
    """Return whether a name in a parameter file, with or without wildcards, means a node.

    A name without a leading slash is below the root.
    """
    return bool(_expression(pattern).fullmatch(node))


@lru_cache(maxsize=1000)
def _expression(pattern: str) -> re.Pattern[str]:
    wildcards = {"**": r"(/\w+)*", "*": r"/\w+"}
    parts = pattern.removeprefix("/").split("/")
    return re.compile("".join(wildcards.get(part, f"/{re.escape(part)}") for part in parts))


def flat_parameters(values: Mapping[Any, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the values of nested dicts by their names with dots."""
    for key, value in values.items():
        if isinstance(value, Mapping):
            yield from flat_parameters(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def nested_parameters(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values by names with dots as nested dicts.

    If `a` is itself a value, `a.b` keeps its dot; both forms mean the same.
    """
    nested: dict[str, Any] = {}
    for name, value in values.items():
        group, prefix, rest = nested, "", name
        while "." in rest:
            first, _, after = rest.partition(".")
            if f"{prefix}{first}" in values:
                break
            group = group.setdefault(first, {})
            prefix, rest = f"{prefix}{first}.", after
        group[rest] = value
    return nested


def parameters_text(content: Mapping[str, Any]) -> str:
    """Return the text of a parameter file, in which rcl finds the types of the values again.

    PyYAML alone leaves texts without quotes that rcl takes for numbers or booleans.
    """
    import yaml

    class Dumper(yaml.SafeDumper):
        def ignore_aliases(self, data: Any) -> bool:
            return True

    def represent_text(dumper: yaml.SafeDumper, text: str) -> yaml.ScalarNode:
        style = None if isinstance(typed_value(text), str) else "'"
        return dumper.represent_scalar(_STRING_TAG, text, style)

    Dumper.add_representer(str, represent_text)
    return yaml.dump(content, Dumper=Dumper, default_flow_style=False)


def typed_value(text: str) -> bool | int | float | str:
    """Return the value of a text without quotes, as rcl reads it."""
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    if _INTEGER.fullmatch(text):
        digits = text.lstrip("+-")
        is_octal = digits.startswith("0") and digits.isdigit()
        integer = int(digits, 8 if is_octal else 0) * (-1 if text[0] == "-" else 1)
        if integer in _INTEGERS:
            return integer
    if found := _INFINITY.fullmatch(text):
        return -math.inf if found[1] == "-" else math.inf
    if _NOT_A_NUMBER.fullmatch(text):
        return math.nan
    number = _number(text)
    return text if number is None else number


def _number(text: str) -> float | None:
    """Return the double of a text; None for another text, and for what a double cannot hold."""
    try:
        if found := _DECIMAL.fullmatch(text):
            number = float(text)
        elif found := _HEXADECIMAL.fullmatch(text):
            number = float.fromhex(text)
        else:
            return None
    except OverflowError:
        return None
    is_zero = not found[1].strip("0.")
    return number if is_zero or _SMALLEST <= abs(number) < math.inf else None


class _Mapping(list[tuple[str, Any]]):
    """The keys and values of a mapping in a file, in which a key may occur more than once."""

    def items(self) -> "_Mapping":
        """Return the pairs, as a dict does."""
        return self


class _Values:
    """The values of a section by their names with dots.

    rcl keeps a value of each type for a name, and takes that of the first type. A name in nested
    keys starts afresh; a name with dots, or without, adds to the first one of its name.
    """

    def __init__(self) -> None:
        self._first: dict[str, list[Any]] = {}
        self._last: dict[str, list[Any]] = {}

    def add(self, content: Any, prefix: str = "") -> None:
        """Add the values in a mapping below a prefix."""
        for key, value in content.items():
            name = f"{prefix}{key}"
            if isinstance(value, Mapping | _Mapping):
                self.add(value, f"{name}.")
            elif prefix or name not in self._first:
                self._last[name] = held = [value]
                self._first.setdefault(name, held)
            elif _rank(value) <= _rank(self._first[name][0]):
                self._first[name][0] = value

    def nested(self) -> dict[str, Any]:
        """Return the values as nested dicts."""
        return nested_parameters({name: held[0] for name, held in self._last.items()})


class _Sections:
    """Collects the values of each node, None for one without."""

    def __init__(self) -> None:
        self._values: dict[str, _Values | None] = {}

    def add_nodes(self, content: Any, above: str) -> bool:
        """Add the nodes in a mapping below a name; return whether any of them has parameters."""
        node = f"/{above}" if "/" in above and above[0] != "/" else above
        found = False
        for key, entry in content.items():
            if not isinstance(entry, Mapping | _Mapping):
                continue
            if key == PARAMETERS and node:
                self._values[node] = values = self._values.get(node) or _Values()
                values.add(entry)
                found = True
            else:
                found |= self.add_nodes(entry, f"{above}/{key}" if above else str(key))
        if node and not found:
            self._values.setdefault(node, None)
        return found

    def by_node(self) -> dict[str, dict[str, Any]]:
        """Return the parameters by node, {} for a node without."""
        return {
            node: {} if values is None else {PARAMETERS: values.nested()}
            for node, values in self._values.items()
        }


def _rank(value: Any) -> int:
    """Return the place of a value's type in rcl's order; lists come after single values."""
    of_list = isinstance(value, list | tuple)
    example = (value[0] if value else None) if of_list else value
    place = _KINDS.index(type(example)) if type(example) in _KINDS else len(_KINDS)
    return place + (len(_KINDS) if of_list else 0)


def _plain(node: Any) -> Any:
    """Return the value of a YAML node."""
    if node.id == "mapping":
        pairs = _Mapping()
        for key, value in node.value:
            if key.id != "scalar" or key.value == "<<":
                line = key.start_mark.line + 1
                raise YamlError(f"line {line}: a parameter file cannot have such a key")
            pairs.append((key.value, _plain(value)))
        return pairs
    if node.id == "sequence":
        return [_plain(item) for item in node.value]
    if node.tag == _STRING_TAG and node.style not in ("|", ">"):
        return node.value
    return typed_value(node.value) if node.value else None


def _loader() -> Any:
    """Return a YAML loader whose scalars have the tag "" if they are plain and have none."""
    import yaml  # Imported here, because most processes read no YAML.

    base: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

    def resolve(self: Any, kind: Any, value: Any, implicit: Any) -> str:
        plain = kind is yaml.ScalarNode and implicit[0]
        return "" if plain else base.resolve(self, kind, value, implicit)

    return type("Loader", (base,), {"resolve": resolve})
