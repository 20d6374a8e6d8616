"""`arm param delete`: remove a parameter."""

import argparse
import sys

from arm_cli.param.target import add_node_argument, open_parameters


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_node_argument(parser)
    parser.add_argument("parameter_name", help="one that was declared without a type")


def run(options: argparse.Namespace) -> int:
    """Remove the parameter; the exit code is 1 where the node refuses.

    Raises:
        NotFoundError: there is no such node, or it has no such parameter.
        UnansweredError: the node does not answer.
    """
    with open_parameters(options.node_name) as parameters:
        from rcl_interfaces.msg import ParameterValue

        (result,) = parameters.set({options.parameter_name: ParameterValue()})
        if not result.successful:
            parameters.check_known(options.parameter_name)
    reason = f": {result.reason}" if result.reason else ""
    if result.successful:
        print(f"Deleted parameter successfully{reason}")
        return 0
    print(f"Deleting parameter failed{reason}", file=sys.stderr)
    return 1
