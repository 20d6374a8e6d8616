"""`arm param dump`: all parameters of a node as YAML."""

import argparse
from pathlib import Path
from typing import Any

from arm_cli.errors import UsageError
from arm_cli.names import absolute_name
from arm_cli.output import add_json_argument, print_json
from arm_cli.param.target import add_node_argument, open_parameters
from arm_cli.parameter_values import read_value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_node_argument(parser)
    # Lines for older ROS have it.
    parser.add_argument("--print", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument(
        "--output-dir", metavar="DIR", help="write them to a file there, named after the node"
    )
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the parameters, in the form that `arm param load` and launch files read.

    Raises:
        NotFoundError: there is no such node.
        UnansweredError: the node does not answer.
        UsageError: the file cannot be written.
    """
    with open_parameters(options.node_name) as parameters:
        names = parameters.names()
        values = [read_value(value) for value in parameters.values(names)] if names else []
    content = {
        absolute_name(options.node_name): {
            "ros__parameters": nest(dict(zip(names, values, strict=True)))
        }
    }
    if options.json:
        print_json(content)
        return
    import yaml

    text = yaml.safe_dump(content, default_flow_style=False)
    if options.output_dir is None:
        print(text)
    else:
        _save(text, Path(options.output_dir), absolute_name(options.node_name))


def _save(text: str, folder: Path, node: str) -> None:
    path = folder / f"{node.strip('/').replace('/', '__')}.yaml"
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror}") from error
    print(f"Saving to:  {path}")


def nest(values: dict[str, Any]) -> dict[str, Any]:
    """Return values of dotted names as dicts in dicts.

    Where `a` is a value itself, `a.b` keeps its dot: both forms mean the same.
    """
    nested: dict[str, Any] = {}
    # A name comes before those that begin with it.
    for name, value in sorted(values.items()):
        group, (first, dot, rest) = nested, name.partition(".")
        while dot and isinstance(group.setdefault(first, {}), dict):
            group, (first, dot, rest) = group[first], rest.partition(".")
        group[f"{first}{dot}{rest}"] = value
    return nested
