"""Declares parameters of any type, which readers then convert; see `arm_node.parameter_values`."""

from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from arm_node.parameter_values import Reader, Value, read_parameter, wanted_by


def declare(
    node: Node,
    name: str,
    default: object,
    read: Reader[Value],
    description: str,
    *,
    read_only: bool = True,
) -> Value:
    """Declare a parameter and return its value, converted by `read`.

    Raises:
        ParameterValueError: `read` refuses the given value; the message names the parameter.
    """
    value = declare_untyped(node, name, default, description, wanted_by(read), read_only=read_only)
    return read_parameter(name, value, read)


def declare_untyped(
    node: Node,
    name: str,
    default: object,
    description: str,
    wanted: str = "",
    *,
    read_only: bool,
) -> Any:
    """Declare a parameter and return its value, of any type.

    The declaration is dynamically typed, because rclpy would refuse an integer for a double.

    Args:
        node: declares the parameter.
        name: of the parameter.
        default: its value if the user gives none; None for no value.
        description: one line for `arm param describe`.
        wanted: what the value must be, also for `arm param describe`.
        read_only: whether it is fixed once the node runs.
    """
    descriptor = ParameterDescriptor(
        description=description,
        additional_constraints=wanted,
        dynamic_typing=True,
        read_only=read_only,
    )
    return node.declare_parameter(name, default, descriptor).value
