"""`arm param describe`: a parameter's type and limits."""

import argparse
from typing import Any

from arm_cli.param.target import add_node_argument, open_parameters
from arm_cli.parameter_values import TYPE_NAMES


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_node_argument(parser)
    parser.add_argument("parameter_names", nargs="+", help="such as desired_param")


def run(options: argparse.Namespace) -> None:
    """Print what the node says of the parameters.

    Raises:
        NotFoundError: there is no such node, or it has no such parameter.
        UnansweredError: the node does not answer.
    """
    with open_parameters(options.node_name) as parameters:
        parameters.check_known(*options.parameter_names)
        descriptors = parameters.descriptors(options.parameter_names)
    for descriptor in descriptors:
        _print(descriptor)


def _print(descriptor: Any) -> None:
    print(f"Parameter name: {descriptor.name}")
    print(f"  Type: {TYPE_NAMES[descriptor.type]}")
    if descriptor.description:
        print(f"  Description: {descriptor.description}")
    print("  Constraints:")
    if descriptor.read_only:
        print("    Read only: true")
    for limits in (*descriptor.floating_point_range, *descriptor.integer_range):
        print(f"    Min value: {limits.from_value}")
        print(f"    Max value: {limits.to_value}")
        if limits.step:
            print(f"    Step: {limits.step}")
    if descriptor.additional_constraints:
        print(f"    Additional constraints: {descriptor.additional_constraints}")
