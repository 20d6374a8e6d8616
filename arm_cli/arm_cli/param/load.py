"""`arm param load`: set a node's parameters from a YAML file."""

import argparse
import sys
from pathlib import Path
from typing import Any

from arm_cli.errors import MessageError, NotFoundError
from arm_cli.names import absolute_name
from arm_cli.param.target import add_node_argument, open_parameters

PARAMETERS = "ros__parameters"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_node_argument(parser)
    parser.add_argument("parameter_file", help="as `arm param dump` prints it")
    parser.add_argument(
        "--no-use-wildcard", action="store_true", help="leave out what the file says for '/**'"
    )


def run(options: argparse.Namespace) -> int:
    """Set the parameters one by one; the exit code is 1 where the node refuses one.

    Raises:
        NotFoundError: there is no such node or file, or the file has nothing for the node.
        MessageError: the file is no parameter file.
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
                raise MessageError(f"{name}: {content!r} is no value of a parameter")
        results = parameters.set(values)
    for name, result in zip(values, results, strict=True):
        outcome = "successful" if result.successful else "failed"
        reason = f": {result.reason}" if result.reason else ""
        stream = sys.stdout if result.successful else sys.stderr
        print(f"Set parameter {name} {outcome}{reason}", file=stream)
    return 0 if all(result.successful for result in results) else 1


def read_parameters(path: Path, sections: list[str]) -> dict[str, Any]:
    """Return the values that a parameter file gives in its sections, by dotted name.

    Raises:
        NotFoundError: no such file, or none of the sections.
        MessageError: it is no parameter file.
    """
    import yaml

    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise NotFoundError(f"no parameter file {path}: {error.strerror}") from error
    except (yaml.YAMLError, ValueError) as error:
        raise MessageError(f"{path} is no YAML: {error}") from error
    if not isinstance(content, dict):
        raise MessageError(f"{path} is no parameter file: no 'node: {PARAMETERS}:' in it")
    found = {absolute_name(str(key)): value for key, value in content.items()}
    chosen = [found[section] for section in sections if section in found]
    if not chosen:
        raise NotFoundError(f"{path} has nothing for {sections[-1]}, but for {', '.join(found)}")
    values: dict[str, Any] = {}
    for section in chosen:
        if not isinstance(section, dict) or not isinstance(section.get(PARAMETERS), dict):
            raise MessageError(f"{path}: no '{PARAMETERS}:' below the node's name")
        values |= _flatten(section[PARAMETERS], "")
    return values


def _flatten(values: dict[str, Any], prefix: str) -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, dict):
            flat |= _flatten(value, f"{prefix}{name}.")
        else:
            flat[f"{prefix}{name}"] = value
    return flat
