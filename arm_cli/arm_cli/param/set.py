"""`arm param set`: set a parameter."""

import argparse
import sys

from arm_cli.param.target import add_node_argument, open_parameters


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_node_argument(parser)
    parser.add_argument("parameter_name", help="such as desired_param")
    parser.add_argument("value", help="as YAML, such as '[1.0, 0.5, 0.1, 0.5]'")


def run(options: argparse.Namespace) -> int:
    """Set the value; the exit code is 1 where the node refuses it.

    Raises:
        NotFoundError: there is no such node, or it has no such parameter.
        UnansweredError: the node does not answer.
    """
    with open_parameters(options.node_name) as parameters:
        from rcl_interfaces.msg import ParameterValue

        from arm_cli.parameter_values import write_value

        value = ParameterValue()
        write_value(value, options.value)
        (result,) = parameters.set({options.parameter_name: value})
        if not result.successful:
            parameters.check_known(options.parameter_name)
    reason = f": {result.reason}" if result.reason else ""
    if result.successful:
        print(f"Set parameter successful{reason}")
        return 0
    print(f"Setting parameter failed{reason}", file=sys.stderr)
    return 1
