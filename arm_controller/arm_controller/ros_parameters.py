"""Parameters that several nodes of this package share, and how they declare them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml
from ament_index_python.packages import get_package_share_directory
from rclpy.exceptions import ParameterException
from rclpy.node import Node

from arm_controller.pose import ArmControllerError
from arm_node.parameter_values import (
    NumberReader,
    ParameterValueError,
    Reader,
    Value,
    one_of,
    read_texts,
    refusal,
)
from arm_node.parameters import declare_from, given_parameters

COURSES = ("none", "S0", "S1", "S2", "S3")
MAX_NUMBER = 1e9
"""Largest allowed number: as a time it is thirty years, and ROS has 64 bits of nanoseconds."""

read_positive = NumberReader(f"a number above 0, at most {MAX_NUMBER:g}", 0.0, MAX_NUMBER, True)
read_zero_or_more = NumberReader(f"a number from 0 to {MAX_NUMBER:g}", 0.0, MAX_NUMBER)


def read_joint_names(value: object) -> tuple[str, ...]:
    """Return a list of unique names, at least one.

    Raises:
        ParameterValueError: the value is something else.
    """
    wanted = "a list of joint names"
    names = read_texts(value, wanted)
    if not names:
        raise refusal(wanted, value)
    if len(set(names)) != len(names):
        raise ParameterValueError(f"names a joint twice: {', '.join(names)}")
    return names


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

    It is `node.declare_parameter` that also takes `2` for a double.

    Raises:
        ParameterValueError: `read` refuses the given value; the message names the parameter.
    """
    given = given_parameters(node)
    try:
        return declare_from(given, node, name, default, read, description, read_only=read_only)
    except (ArmControllerError, ParameterValueError, ParameterException) as error:
        raise ParameterValueError(f"parameter {name}: {error}") from error


def declare_course(node: Node) -> Mapping[str, Any]:
    """Declare the parameter `course`; return what its file gives to this node as defaults."""
    course = declare(
        node,
        "course",
        "none",
        one_of(COURSES),
        "Whose tutorial the node follows; its file has the defaults of the other parameters",
    )
    if course == "none":
        return {}
    folder = Path(get_package_share_directory("arm_control"), "config", "courses")
    sections = yaml.safe_load((folder / f"{course}.yaml").read_text())
    own = [s for name, s in sections.items() if name.rpartition("/")[2] == node.get_name()]
    return own[0]["ros__parameters"] if own else {}


def declare_joints(node: Node) -> tuple[str, ...]:
    """Declare the parameter `joints` and return it: the joints of a pose, in its order."""
    return declare(
        node,
        "joints",
        ["j0", "j1", "j2", "j3"],
        read_joint_names,
        "Joints of a pose, in the position controller's order",
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
