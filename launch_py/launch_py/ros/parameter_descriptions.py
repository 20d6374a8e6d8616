"""Parameter files, named as in ROS 2's `launch_ros.parameter_descriptions`, and their order.

A later file of a node wins, whatever the names of the sections in the files. rcl merges all
sections of one name, applies the sections in the order in which their names first appear, and keeps
one value for each type: 2.5 in a later file loses to 1 in an earlier one. So where files give a
node different values, they are replaced by one file in which each section holds all that applies to
it.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, cast

from launch_py.errors import LaunchError, NodeParameterError
from launch_py.near_names import describe_missing_file
from launch_py.plan.steps import GeneratedFile
from launch_py.ros.parameters import BARE, NODE_KEY, ParameterValue, Value, check_depth, dump_value
from launch_py.ros.substitution_parser import parse_substitutions
from launch_py.substitution import LaunchScope, Substitution, Text, perform_text

if TYPE_CHECKING:
    import yaml

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]

MAX_CHARACTERS = 20_000_000


class Parameter(dict[Any, Any]):
    """One parameter for a node's `parameters`: the dict of its name and its value.

    Args:
        name: its name.
        value: its value.
        value_type: see `ParameterValue`.
        description: accepted as in ROS, without effect.
    """

    def __init__(
        self, name: Text, value: Any, *, value_type: Any = None, description: Text = ""
    ) -> None:
        key = name if isinstance(name, str | Substitution) else tuple(cast("Iterable[Any]", name))
        typed = value if value_type is None else ParameterValue(value, value_type=value_type)
        super().__init__({key: typed})
        self.name = name
        self.value = value
        self.value_type = value_type


class ParameterFile:
    """A parameter file for a node's `parameters`.

    Args:
        param_file: its path.
        allow_substs: whether substitutions such as $(var name) are performed in its keys and
            values. A text with a substitution is then read as YAML, with or without quotes around
            it: `rate: "$(var rate)"` is a number if the argument is a number.
    """

    def __init__(self, param_file: Text, *, allow_substs: bool | Text = False) -> None:
        self.param_file = param_file
        self.allow_substs = allow_substs

    def evaluate(self, context: LaunchScope) -> str | GeneratedFile:
        """Return the path of the file, or a generated file with its substitutions performed.

        Raises:
            NodeParameterError: there is no such file, it is not YAML, or a substitution in it is
                malformed or has no value.
        """
        path = perform_text(context, self.param_file)
        if not os.path.isfile(path):
            folder = os.path.dirname(os.path.abspath(path))
            known = os.listdir(folder) if os.path.isdir(folder) else []
            holds = f"{folder} holds"
            raise NodeParameterError(describe_missing_file("parameter file", path, known, holds))
        if not ParameterValue(self.allow_substs, value_type=bool).evaluate(context):
            return path
        return GeneratedFile(".yaml", _performed(context, path))


def _performed(context: LaunchScope, path: str) -> str:
    """Return the text of a parameter file with its substitutions performed.

    It changes the nodes of the YAML document that hold substitutions; all others stay as written.
    """
    import yaml  # Imported late, because the import takes as long as starting a process.

    roots = compose_documents(read_file(path), yaml.SafeLoader, path)
    try:
        roots = [_node(context, root, {}) for root in roots]
    except LaunchError as error:
        raise NodeParameterError(f"parameter file {path}: {error}") from error
    return yaml.serialize_all(roots, Dumper=yaml.SafeDumper, width=float("inf"), allow_unicode=True)


def read_file(path: str) -> str:
    """Return the text of a parameter file.

    Raises:
        NodeParameterError: it cannot be read, or is too long.
    """
    try:
        with open(path, encoding="utf-8") as file:
            text = file.read(MAX_CHARACTERS + 1)
    except (OSError, UnicodeError) as error:
        raise NodeParameterError(f"parameter file {path} cannot be read: {error}") from error
    if len(text) > MAX_CHARACTERS:
        raise NodeParameterError(f"parameter file {path} has more than {MAX_CHARACTERS} characters")
    return text


def compose_documents(text: str, loader: Any, path: str) -> list[yaml.Node]:
    """Return the nodes of the documents in a parameter file.

    Raises:
        NodeParameterError: it is not YAML, or nested too deep.
    """
    import yaml

    try:
        check_depth(text)
        return list(yaml.compose_all(text, Loader=loader))
    except NodeParameterError as error:
        raise NodeParameterError(f"parameter file {path}: {error}") from None
    except yaml.YAMLError as error:
        reason = str(error).replace("\n", " ")
        raise NodeParameterError(f"parameter file {path} cannot be read: {reason}") from error


def _node(context: LaunchScope, node: yaml.Node, done: dict[int, yaml.Node]) -> yaml.Node:
    """Return a node of a YAML document with the substitutions in it performed.

    The node is modified; `done` has those visited before, by identity: aliases refer to one node
    many times.
    """
    import yaml

    if id(node) in done:
        return done[id(node)]
    done[id(node)] = node
    match node:
        case yaml.MappingNode():
            node.value = [
                (_node(context, key, done), _node(context, v, done)) for key, v in node.value
            ]
        case yaml.SequenceNode():
            node.value = [_node(context, item, done) for item in node.value]
        case yaml.ScalarNode() if "$(" in node.value:
            done[id(node)] = _read(perform_text(context, parse_substitutions(node.value)))
    return done[id(node)]


def _read(text: str) -> yaml.Node:
    """Return the YAML node of a text: a list, a dict, a text in quotes, else one value."""
    import yaml

    if text.strip()[:1] in ("[", "{", "'", '"'):
        try:
            return yaml.compose(text, Loader=yaml.SafeLoader)
        except yaml.YAMLError as error:
            reason = str(error).splitlines()[0]
            raise NodeParameterError(f"{text!r} is not YAML: {reason}") from error
    tag = yaml.SafeLoader("").resolve(yaml.ScalarNode, text, (True, False))
    return yaml.ScalarNode(tag, text)


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
    """Return the source of evaluated parameters by node, whose file has this text."""
    sections = tuple((_absolute(node), dict(_flat(values))) for node, values in by_node.items())
    return ParameterSource(GeneratedFile(".yaml", text), sections)


def files_in_order(sources: Sequence[ParameterSource], node: str) -> list[File]:
    """Return the files that let the node see the last value of each parameter.

    `node` is the full name; "" if unknown, or for a process with several nodes.

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
    return text if BARE.fullmatch(text) and not is_text else dump_value(text)
