"""Declares parameters, among them those that several nodes of this package share."""

from rclpy.exceptions import ParameterException
from rclpy.node import Node

from arm_control.course import COURSES, NO_COURSE, course_parameters
from arm_controller.errors import ArmControllerError
from arm_controller.parameter_values import read_joint_names, read_positive
from arm_node.parameter_values import (
    ParameterValueError,
    Reader,
    Value,
    one_of,
    read_nonempty_text,
)
from arm_node.parameters import declare_from, given_parameters

COURSE = "course"

JOINT_MARK = "{joint}"
"""Placeholder for a joint's name in the name of a topic."""


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
        ParameterValueError: `read` refuses the given value.
    """
    given = given_parameters(node)
    if node.has_parameter(COURSE):
        course = node.get_parameter(COURSE).value
        given = {**course_parameters(course, node.get_name()), **given}
    try:
        return declare_from(given, node, name, default, read, description, read_only=read_only)
    except (ArmControllerError, ParameterValueError, ParameterException) as error:
        raise ParameterValueError(f"parameter {name}: {error}") from error


def declare_course(node: Node) -> None:
    """Declare the parameter `course`, whose file has the defaults of those declared after it."""
    declare(
        node,
        COURSE,
        NO_COURSE,
        one_of((NO_COURSE, *COURSES)),
        "Whose tutorial the node follows; its file has the defaults of the other parameters",
    )


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
        _read_topic,
        "Topic of the poses: one std_msgs/msg/Float64MultiArray or, if it contains {joint}, "
        "one std_msgs/msg/Float64 per joint",
    )


def declare_match_timeout_s(node: Node) -> float:
    """Declare the parameter `match_timeout` and return it (s)."""
    return declare(
        node,
        "match_timeout",
        10.0,
        read_positive,
        "How long to wait for a subscriber to the commands (s)",
    )


def _read_topic(value: object) -> str:
    return read_nonempty_text(value, "the name of a topic")
