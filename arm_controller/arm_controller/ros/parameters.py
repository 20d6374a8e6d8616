"""Declares parameters whose type the user need not get right."""

from collections.abc import Callable
from typing import TypeVar

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.exceptions import ParameterException
from rclpy.node import Node

from arm_controller.errors import ArmControllerError, ParameterValueError
from arm_controller.parameter_values import read_joint_names, read_number, read_topic

Value = TypeVar("Value")

JOINT_MARK = "{joint}"
"""What stands for a joint's name in the name of a topic."""


def declare(
    node: Node,
    name: str,
    default: object,
    read: Callable[[object], Value],
    description: str,
    *,
    read_only: bool = True,
) -> Value:
    """Declare a parameter and return what `read` makes of its value.

    The declaration is dynamically typed: rclpy itself would refuse an integer for a double.

    Raises:
        ParameterValueError: `read` refused the value that the user gave.
    """
    descriptor = ParameterDescriptor(
        description=description, dynamic_typing=True, read_only=read_only
    )
    try:
        return read(node.declare_parameter(name, default, descriptor).value)
    except (ArmControllerError, ParameterException) as error:
        raise ParameterValueError(f"parameter {name}: {error}") from error


def declare_joints(node: Node) -> tuple[str, ...]:
    """Declare the parameter `joints` and return it: the joints of a pose, in its order."""
    return declare(
        node,
        "joints",
        ["j0", "j1", "j2", "j3"],
        read_joint_names,
        "Joints of a pose, in the position controller's order",
    )


def declare_command_topic(node: Node) -> str:
    """Declare the parameter `command_topic` and return it."""
    return declare(
        node,
        "command_topic",
        "position_controller/commands",
        read_topic,
        "Where poses go: one std_msgs/msg/Float64MultiArray or, where it holds {joint}, "
        "one std_msgs/msg/Float64 for each joint",
    )


def declare_match_timeout_s(node: Node) -> float:
    """Declare the parameter `match_timeout` and return it (s)."""
    return declare(
        node,
        "match_timeout",
        10.0,
        read_number,
        "How long to wait for somebody who listens to the commands (s)",
    )
