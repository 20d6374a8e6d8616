"""`arm param dump` and `load`: save and set a node's parameters as YAML."""

import argparse
from pathlib import Path
from typing import Any

from arm_cli.arguments import JSON, Argument, Flag, verb
from arm_cli.errors import CommandUsageError, MessageError, NoSuchNameError
from arm_cli.names import absolute_name
from arm_cli.output import complain, print_json, say, say_document
from arm_cli.param.access import NODE, open_parameters
from arm_cli.parameter_values import read_value
from arm_node.limited_yaml import YamlError
from arm_node.parameter_file import (
    PARAMETERS,
    flat_parameters,
    nested_parameters,
    parameters_text,
)
from arm_node.parameter_file import read_parameters as read_file_parameters
from arm_node.user_file import read_text


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
    """Print the parameters in the form that `arm param load` and launch files read.

    Raises:
        NoSuchNameError: there is no such node.
        UnansweredError: the node does not answer.
        CommandUsageError: the file cannot be written.
    """
    with open_parameters(options.node_name) as parameters:
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
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise CommandUsageError(f"cannot write {path}: {error.strerror}") from error
    say(f"Saving to:  {path}")


@verb(
    *NODE,
    Argument("parameter_file", help="file in the form of `arm param dump`"),
    Flag("--no-use-wildcard", help="ignore the file's section '/**'"),
)
def load(options: argparse.Namespace) -> int:
    """Set the parameters one by one; the exit code is 1 if the node refuses one.

    Raises:
        NoSuchNameError: there is no such node or file, or the file has no section for the node.
        MessageError: the file is not a parameter file.
        UnansweredError: the node does not answer.
    """
    node = absolute_name(options.node_name)
    sections = ([] if options.no_use_wildcard else ["/**"]) + [node]
    contents = read_parameters(Path(options.parameter_file), sections)
    with open_parameters(node) as parameters:
        from rcl_interfaces.msg import ParameterValue

        from arm_cli.parameter_values import set_value

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
