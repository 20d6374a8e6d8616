"""Parameter files, named as in ROS 2's `launch_ros.parameter_descriptions`."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, cast

from launch_py.errors import LaunchError, NodeParameterError
from launch_py.near_names import describe_missing_file
from launch_py.plan.steps import GeneratedFile
from launch_py.ros.parameters import ParameterValue, check_depth
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

    Args:
        text: the file's text.
        loader: the YAML loader to read it with.
        path: the file, for messages.

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

    Args:
        context: the scope of the launch.
        node: the node, which is modified.
        done: the nodes visited before, by identity: aliases refer to one node many times.
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
