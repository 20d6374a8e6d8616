"""`arm param get`: a parameter's value."""

import argparse

from arm_cli.output import add_json_argument, print_json
from arm_cli.param.target import add_node_argument, open_parameters
from arm_cli.parameter_values import LABELS, content_of, read_value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_node_argument(parser)
    parser.add_argument("parameter_name", help="such as desired_param")
    parser.add_argument("--hide-type", action="store_true", help="only the value")
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the value.

    Raises:
        NotFoundError: there is no such node, or it has no such parameter.
        UnansweredError: the node does not answer.
    """
    with open_parameters(options.node_name) as parameters:
        value = parameters.value(options.parameter_name)
    content = content_of(value)
    if options.json:
        print_json(read_value(value))
    elif options.hide_type:
        print(content)
    else:
        print(LABELS[value.type], *([] if content is None else [content]))
