"""Lets a later parameter file of a node win, whatever the names of the sections in the files.

rcl merges all sections of one name, applies the sections in the order in which their names first
appear, and keeps one value for each type: 2.5 in a later file loses to 1 in an earlier one. So
where files give a node different values, they are replaced by one file in which each section holds
all that applies to it.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from launch_py.plan.steps import GeneratedFile
from launch_py.ros.parameter_descriptions import compose_documents, read_file
from launch_py.ros.parameters import NODE_KEY, Value, dump_value

if TYPE_CHECKING:
    import yaml

PLAIN = re.compile(r"[\w.+()-]+", re.ASCII)
"""Texts that rcl may read as something else than a text; others can be put into quotes."""
STRING_TAG = "tag:yaml.org,2002:str"

Section = tuple[str, dict[str, str]]
"""The pattern of the nodes' names, and their values as YAML by full name."""
File = str | GeneratedFile


@dataclass(frozen=True, slots=True)
class ParameterSource:
    """One entry of a node's parameters.

    Attributes:
        file: the file that passes it to the node.
        sections: what it holds, None for a file that must be read for it.
    """

    file: File
    sections: tuple[Section, ...] | None = None


def source_of_values(by_node: Mapping[str, Mapping[str, Value]], text: str) -> ParameterSource:
    """Return the source of evaluated parameters by node.

    Args:
        by_node: the parameters.
        text: their parameter file.
    """
    sections = tuple((_absolute(node), dict(_flat(values))) for node, values in by_node.items())
    return ParameterSource(GeneratedFile(".yaml", text), sections)


def files_in_order(sources: Sequence[ParameterSource], node: str) -> list[File]:
    """Return the files that let the node see the last value of each parameter.

    Args:
        sources: its parameters, in order.
        node: its full name; "" if unknown, or for a process with several nodes.

    Raises:
        NodeParameterError: a file is not YAML.
    """
    files = [source.file for source in sources]
    if len(sources) < 2:
        return files
    read = [_sections_of(source) for source in sources]
    known = [sections for sections in read if sections is not None]
    if len(known) < len(read):
        return files  # rcl refuses one of them, and says why.
    patterns = dict.fromkeys(pattern for sections in known for pattern, _ in reversed(sections))
    if node:
        patterns[node] = None
    if not any(_differ(known, pattern) for pattern in patterns):
        return files
    # A node takes the values of the last section that it matches, so the narrow ones come last.
    ordered = sorted(patterns, key=lambda p: sum(_covers(q, p) for q in patterns))
    every = [section for sections in known for section in sections]
    merged = [f"{json.dumps(p)}: {{{NODE_KEY}: {_text(_applying(every, p))}}}\n" for p in ordered]
    names = ", ".join(file if isinstance(file, str) else "the launch file" for file in files)
    return [GeneratedFile(".yaml", f"# {json.dumps(names)}\n{''.join(merged)}")]


def _differ(sources: Iterable[Iterable[Section]], pattern: str) -> bool:
    """Return whether two sources give the nodes of a pattern different values."""
    seen: dict[str, str] = {}
    for sections in sources:
        values = _applying(sections, pattern)
        if any(seen.get(name, value) != value for name, value in values.items()):
            return True
        seen |= values
    return False


def _applying(sections: Iterable[Section], pattern: str) -> dict[str, str]:
    """Return the values that apply to all nodes of a pattern; the last one of a name counts."""
    values: dict[str, str] = {}
    for own, more in sections:
        if _covers(own, pattern):
            values |= more
    return values


def _covers(wide: str, narrow: str) -> bool:
    """Return whether each node that matches `narrow` also matches `wide`."""
    return _covers_parts(tuple(wide.split("/")[1:]), tuple(narrow.split("/")[1:]))


@lru_cache(maxsize=10_000)  # Without it, many ** take exponential time.
def _covers_parts(wide: tuple[str, ...], narrow: tuple[str, ...]) -> bool:
    if not wide or not narrow:
        return not narrow and all(part == "**" for part in wide)
    if wide[0] == "**":
        return _covers_parts(wide[1:], narrow) or _covers_parts(wide, narrow[1:])
    same = wide[0] == narrow[0] or (wide[0] == "*" and narrow[0] != "**")
    return same and _covers_parts(wide[1:], narrow[1:])


def _absolute(name: str) -> str:
    return name if name.startswith("/") else f"/{name}"


def _text(values: Mapping[str, str]) -> str:
    return "{" + ", ".join(f"{json.dumps(name)}: {value}" for name, value in values.items()) + "}"


def _flat(values: Mapping[str, Value], prefix: str = "") -> Iterator[tuple[str, str]]:
    for name, value in values.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", dump_value(value)


def _sections_of(source: ParameterSource) -> Sequence[Section] | None:
    """Return the sections of a source, None if it does not have the form of a parameter file."""
    if source.sections is not None:
        return source.sections
    path, text = source.file, ""
    if isinstance(path, GeneratedFile):
        path, text = "of the launch file", path.text
    documents = compose_documents(text or read_file(path), _loader(), path)
    try:
        return [section for document in documents for section in _sections(document, "")]
    except _FormError:
        return None


def _loader() -> Any:
    """Return a YAML loader whose scalars have the tag "" if they are plain and have none."""
    import yaml  # Imported late, because the import takes as long as starting a process.

    base: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

    def resolve(self: Any, kind: Any, value: Any, implicit: Any) -> str:
        plain = kind is yaml.ScalarNode and implicit[0]
        return "" if plain else base.resolve(self, kind, value, implicit)

    return type("Loader", (base,), {"resolve": resolve})


class _FormError(Exception):
    """The document does not have the form of a parameter file."""


def _sections(node: yaml.Node, above: str) -> Iterator[Section]:
    for name, value in _pairs(node):
        if name == NODE_KEY:
            yield above, dict(_values(value, ""))
        else:
            yield from _sections(value, f"{above}{_absolute(name)}")


def _values(node: yaml.Node, prefix: str) -> Iterator[tuple[str, str]]:
    import yaml

    for name, value in _pairs(node):
        if isinstance(value, yaml.MappingNode):
            yield from _values(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", _leaf(value)


def _pairs(node: yaml.Node) -> Iterator[tuple[str, yaml.Node]]:
    import yaml

    if not isinstance(node, yaml.MappingNode):
        raise _FormError
    for key, value in node.value:
        if not isinstance(key, yaml.ScalarNode):
            raise _FormError
        yield str(key.value), value


def _leaf(node: yaml.Node) -> str:
    """Return a value as YAML in one line that rcl reads as it reads the value in its file."""
    import yaml

    if isinstance(node, yaml.SequenceNode):
        return "[" + ", ".join(map(_leaf, node.value)) + "]"
    if not isinstance(node, yaml.ScalarNode):
        raise _FormError
    text = str(node.value)
    is_text = node.tag == STRING_TAG and node.style not in ("|", ">")
    return text if PLAIN.fullmatch(text) and not is_text else dump_value(text)
