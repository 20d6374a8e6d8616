"""A parameter file of a node, with or without substitutions in it."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from launch_py.errors import LaunchError, ParameterError
from launch_py.near_names import describe_known
from launch_py.parameters import ParameterValue
from launch_py.plan import GeneratedFile
from launch_py.ros.written_substitutions import parse_substitutions
from launch_py.substitution import Text, perform_text

if TYPE_CHECKING:
    import yaml

    from launch_py.launch_context import LaunchContext


class ParameterFile:
    """A parameter file for a node's `parameters`.

    Args:
        param_file: its path.
        allow_substs: whether substitutions such as $(var name) are performed in its keys and
            values. What has one is read as YAML afterwards, with or without quotes around it:
            `rate: "$(var rate)"` is a number where the argument is one.
    """

    def __init__(self, param_file: Text, *, allow_substs: bool | Text = False) -> None:
        self.param_file = param_file
        self.allow_substs = allow_substs

    def evaluate(self, context: LaunchContext) -> str | GeneratedFile:
        """Return the path of the file, or the file that it becomes.

        Raises:
            ParameterError: there is no such file, it is not YAML, or a substitution in it is
                malformed or has no value.
        """
        path = perform_text(context, self.param_file)
        if not os.path.isfile(path):
            folder, name = os.path.split(os.path.abspath(path))
            known = os.listdir(folder) if os.path.isdir(folder) else []
            raise ParameterError(
                f"no parameter file {path}; " + describe_known(name, known, f"{folder} holds")
            )
        if not ParameterValue(self.allow_substs, value_type=bool).evaluate(context):
            return path
        return GeneratedFile(".yaml", _performed(context, path))


def _performed(context: LaunchContext, path: str) -> str:
    """Return the text of a parameter file with its substitutions performed.

    Its nodes are changed, not its values: what has no substitution is written as it was.
    """
    import yaml  # Only here: importing it costs as much as starting a process.

    try:
        with open(path, encoding="utf-8") as file:
            root = yaml.compose(file, Loader=yaml.SafeLoader)
    except (OSError, UnicodeError, yaml.YAMLError) as error:
        reason = str(error).replace("\n", " ")
        raise ParameterError(f"parameter file {path} cannot be read: {reason}") from error
    if root is None:
        return ""
    try:
        root = _node(context, root)
    except LaunchError as error:
        raise ParameterError(f"parameter file {path}: {error}") from error
    return yaml.serialize(root, Dumper=yaml.SafeDumper, width=float("inf"), allow_unicode=True)


def _node(context: LaunchContext, node: yaml.Node) -> yaml.Node:
    """Return a node of a YAML document with the substitutions in it performed."""
    import yaml

    match node:
        case yaml.MappingNode():
            node.value = [(_node(context, key), _node(context, v)) for key, v in node.value]
        case yaml.SequenceNode():
            node.value = [_node(context, item) for item in node.value]
        case yaml.ScalarNode() if "$(" in node.value:
            return _read(perform_text(context, parse_substitutions(node.value)))
    return node


def _read(text: str) -> yaml.Node:
    """Return the node that a text means: a list or a dict in brackets, else one value."""
    import yaml

    if text.strip()[:1] in ("[", "{"):
        try:
            return yaml.compose(text, Loader=yaml.SafeLoader)
        except yaml.YAMLError as error:
            reason = str(error).splitlines()[0]
            raise ParameterError(f"{text!r} is not YAML: {reason}") from error
    tag = yaml.SafeLoader("").resolve(yaml.ScalarNode, text, (True, False))
    return yaml.ScalarNode(tag, text)
