"""The verbs of `arm param`: list, read, describe, set, delete, save and load parameters."""

import argparse
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from arm_cli.arguments import JSON, Argument, Flag, verb
from arm_cli.errors import MessageError, NoSuchNameError, UnansweredError
from arm_cli.names import absolute_name
from arm_cli.output import complain, print_json, say, say_document, write_text
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_node.limited_yaml import YamlError
from arm_node.parameter_file import (
    PARAMETERS,
    flat_parameters,
    nested_parameters,
    parameters_text,
)
from arm_node.parameter_file import read_parameters as read_file_parameters
from arm_node.user_file import read_text

if TYPE_CHECKING:
    from rcl_interfaces.msg import SetParametersResult

    from arm_cli.ros.parameters import NodeParameters

NODE = (
    Argument("node_name", completer=completers.nodes, help="such as /arm_controller_node"),
    # Accepted because command lines for ros2 use it. A named node may always be hidden here.
    Flag("--include-hidden-nodes", help=argparse.SUPPRESS),
)
"""The name of one node."""


PARAMETER = Argument(
    "parameter_name", completer=completers.parameters, help="such as desired_param"
)


@contextmanager
def open_parameters(node_name: str) -> Iterator["NodeParameters"]:
    """Yield the parameters of a node.

    Raises:
        NoSuchNameError: there is no such node.
    """
    with connect() as session:
        from arm_cli.ros.graph import Graph
        from arm_cli.ros.parameters import NodeParameters

        yield NodeParameters(session, Graph(session).find_node(node_name))


def _pattern(text: str) -> re.Pattern[str]:
    try:
        return re.compile(text)
    except re.error as error:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a regular expression: {error}"
        ) from error


@verb(
    Argument("node_name", nargs="?", help="default: every node", completer=completers.nodes),
    Flag("--include-hidden-nodes", dest="hidden", help="include hidden nodes"),
    Argument("--param-prefixes", nargs="+", default=[], help="only parameters with these prefixes"),
    Argument(
        "--filter",
        type=_pattern,
        default=".*",
        metavar="REGEX",
        help="only parameters whose names it matches at their start",
    ),
    Flag("--param-type", help="also print their types"),
    JSON,
)
def list_parameters(options: argparse.Namespace) -> None:
    """Print the names of the parameters."""
    found: dict[str, dict[str, str]] = {}
    with connect() as session:
        from arm_cli.ros.graph import Graph
        from arm_cli.ros.parameters import TYPE_NAMES, NodeParameters

        graph = Graph(session)
        if options.node_name:
            nodes = [graph.find_node(options.node_name)]
        else:
            graph.settle()
            serving = graph.services()
            nodes = [
                node
                for node in graph.nodes(options.hidden)
                if f"{node.full_name}/list_parameters" in serving
            ]
        for node in nodes:
            parameters = NodeParameters(session, node)
            try:
                names = list(filter(options.filter.match, parameters.names(options.param_prefixes)))
                types = [d.type for d in parameters.descriptors(names)] if names else []
            except UnansweredError as error:
                if options.node_name:
                    raise
                complain(f"arm param list: {error}")
                continue
            found[node.full_name] = {n: TYPE_NAMES[t] for n, t in zip(names, types, strict=True)}
    if options.json:
        print_json(found)
        return
    for full_name, parameter_types in found.items():
        if not options.node_name:
            say(f"{full_name}:")
        for name, type_ in parameter_types.items():
            say(f"  {name} (type: {type_})" if options.param_type else f"  {name}")


@verb(*NODE, PARAMETER, Flag("--hide-type", help="print only the value"), JSON)
def get(options: argparse.Namespace) -> None:
    """Print the value."""
    with open_parameters(options.node_name) as parameters:
        from arm_cli.ros.parameters import LABELS, NOT_SET, content_of, read_value

        value = parameters.value(options.parameter_name)
        unset = value.type == NOT_SET
        described = parameters.descriptors([options.parameter_name]) if unset else []
    content = content_of(value)
    if options.json:
        print_json(read_value(value))
    elif options.hide_type:
        say_document(str(content))
    else:
        words = [LABELS[value.type]] if content is None else [LABELS[value.type], content]
        say_document(" ".join(map(str, words)))
    for descriptor in described:
        about = f" ({descriptor.description})" if descriptor.description else ""
        complain(
            f"{options.parameter_name}{about} is declared, but has no value yet; give it one: "
            f"arm param set {options.node_name} {options.parameter_name} VALUE"
        )


@verb(
    *NODE,
    Argument(
        "parameter_names", nargs="+", help="such as desired_param", completer=completers.parameters
    ),
)
def describe(options: argparse.Namespace) -> None:
    """Print the descriptions of parameters."""
    with open_parameters(options.node_name) as parameters:
        parameters.check_known(*options.parameter_names)
        descriptors = parameters.descriptors(options.parameter_names)
    for descriptor in descriptors:
        _print(descriptor)


def _print(descriptor: Any) -> None:
    from arm_cli.ros.parameters import TYPE_NAMES

    say(f"Parameter name: {descriptor.name}")
    say(f"  Type: {TYPE_NAMES[descriptor.type]}")
    if descriptor.description:
        say(f"  Description: {descriptor.description}")
    say("  Constraints:")
    if descriptor.read_only:
        say("    Read only: true")
    for limits in (*descriptor.floating_point_range, *descriptor.integer_range):
        say(f"    Min value: {limits.from_value}")
        say(f"    Max value: {limits.to_value}")
        if limits.step:
            say(f"    Step: {limits.step}")
    if descriptor.additional_constraints:
        say(f"    Additional constraints: {descriptor.additional_constraints}")


@verb(
    *NODE,
    PARAMETER,
    Argument(
        "value",
        help="as YAML, such as '[1.0, 0.5, 0.1, 0.5]'",
        completer=completers.parameter_values,
    ),
)
def set_parameter(options: argparse.Namespace) -> int:
    """Set the value; the exit code is 1 if the node refuses it."""
    with open_parameters(options.node_name) as parameters:
        from rcl_interfaces.msg import ParameterValue

        from arm_cli.ros.parameters import write_value

        value = ParameterValue()
        write_value(value, options.value)
        result = _change(parameters, options.parameter_name, value)
    return _report(result, "Set parameter successful", "Setting parameter failed")


@verb(*NODE, PARAMETER)
def delete(options: argparse.Namespace) -> int:
    """Remove the parameter; the exit code is 1 if the node refuses."""
    with open_parameters(options.node_name) as parameters:
        from rcl_interfaces.msg import ParameterValue

        result = _change(parameters, options.parameter_name, ParameterValue())
    return _report(result, "Deleted parameter successfully", "Deleting parameter failed")


def _change(parameters: "NodeParameters", name: str, value: Any) -> "SetParametersResult":
    (result,) = parameters.set({name: value})
    if not result.successful:
        parameters.check_known(name)
    return result


def _report(result: "SetParametersResult", success: str, failure: str) -> int:
    """Print the node's answer; return the exit code."""
    reason = f": {result.reason}" if result.reason else ""
    if result.successful:
        say(f"{success}{reason}")
        return 0
    complain(f"{failure}{reason}")
    return 1


@verb(
    *NODE,
    # Accepted because command lines for older ROS use it.
    Flag("--print", help=argparse.SUPPRESS),
    Argument(
        "--output-dir",
        metavar="DIR",
        help="write them to a file in this folder, named after the node",
    ),
    JSON,
)
def dump(options: argparse.Namespace) -> None:
    """Print the parameters in the form that `arm param load` and launch files read."""
    with open_parameters(options.node_name) as parameters:
        from arm_cli.ros.parameters import read_value

        names = parameters.names()
        values = [read_value(value) for value in parameters.values(names)] if names else []
    content = {
        absolute_name(options.node_name): {
            PARAMETERS: nested_parameters(dict(sorted(zip(names, values, strict=True))))
        }
    }
    if options.json:
        print_json(content)
        return
    text = parameters_text(content)
    if options.output_dir is None:
        say_document(text)
    else:
        _save(text, Path(options.output_dir), absolute_name(options.node_name))


def _save(text: str, folder: Path, node: str) -> None:
    path = folder / f"{node.strip('/').replace('/', '__')}.yaml"
    write_text(path, text)
    say(f"Saving to:  {path}")


@verb(
    *NODE,
    Argument("parameter_file", help="file in the form of `arm param dump`"),
    Flag("--no-use-wildcard", help="ignore the file's section '/**'"),
)
def load(options: argparse.Namespace) -> int:
    """Set the parameters one by one; the exit code is 1 if the node refuses one."""
    node = absolute_name(options.node_name)
    sections = ([] if options.no_use_wildcard else ["/**"]) + [node]
    contents = read_parameters(Path(options.parameter_file), sections)
    with open_parameters(node) as parameters:
        from rcl_interfaces.msg import ParameterValue

        from arm_cli.ros.parameters import set_value

        values = {name: ParameterValue() for name in contents}
        for name, content in contents.items():
            if not set_value(values[name], content):
                raise MessageError(f"{name}: {content!r} cannot be the value of a parameter")
        results = parameters.set(values)
    for name, result in zip(values, results, strict=True):
        outcome = "successful" if result.successful else "failed"
        reason = f": {result.reason}" if result.reason else ""
        report = say if result.successful else complain
        report(f"Set parameter {name} {outcome}{reason}")
    return 0 if all(result.successful for result in results) else 1


def read_parameters(path: Path, sections: list[str]) -> dict[str, Any]:
    """Return the values in some sections of a parameter file, by dotted name.

    Raises:
        NoSuchNameError: there is no such file, or it has none of the sections.
        MessageError: the file is not a parameter file.
    """
    try:
        content = read_file_parameters(read_text(path))
    except OSError as error:
        raise NoSuchNameError(f"no parameter file {path}: {error.strerror}") from error
    except (YamlError, UnicodeDecodeError) as error:
        raise MessageError(f"{path} is not YAML: {error}") from error
    if not content:
        raise MessageError(f"{path} is not a parameter file: it has no 'node: {PARAMETERS}:'")
    found = [(absolute_name(key), entry) for key, entry in content.items()]
    chosen = [entry for section in sections for key, entry in found if key == section]
    if not chosen:
        known = ", ".join(key for key, _ in found)
        raise NoSuchNameError(f"{path} has no section for {sections[-1]}, only for {known}")
    values: dict[str, Any] = {}
    for entry in chosen:
        if PARAMETERS not in entry:
            raise MessageError(f"{path}: no '{PARAMETERS}:' below the node's name")
        values |= dict(flat_parameters(entry[PARAMETERS]))
    return values
