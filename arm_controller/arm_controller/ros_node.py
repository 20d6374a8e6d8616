"""What a robust node adds to plain rclpy: parameters that refuse nonsense, and a clean end.

A first node needs none of it: `rclpy.init()` and `rclpy.spin(MyNode())` are enough.
"""

import os
import signal
import sys
import time
from collections.abc import Callable
from types import FrameType
from typing import Any, TypeVar

import rclpy
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.exceptions import NameValidationException, ParameterException
from rclpy.executors import ExternalShutdownException
from rclpy.logging import get_logger
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import ok, try_shutdown

from arm_controller.pose import ArmControllerError

TIMES_S = (0.001, 1e9)
"""Shortest and longest time of a parameter: thirty years fit into ROS's 64 bits of nanoseconds."""
ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
"""The signals that end a program."""
NodeT = TypeVar("NodeT", bound=Node)
ValueT = TypeVar("ValueT")


class NodeSettingError(ArmControllerError):
    """A parameter has an invalid value; the message names it and says what it must be."""


def run(make_node: Callable[[], NodeT], work: Callable[[NodeT], int | None] | None = None) -> int:
    """Run a node until its work is done, Ctrl-C or SIGTERM; return the process's exit code.

    Args:
        make_node: makes the node.
        work: what the main thread does instead of `rclpy.spin`; it returns the exit code. Ctrl-C,
            SIGTERM and a closed terminal raise KeyboardInterrupt in it while ROS still runs, so
            that it can stop the robot first.
    """
    # The ROS wheels from pip do not say where they are installed.
    prefixes = [p for p in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
    os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join(dict.fromkeys([*prefixes, sys.prefix]))
    node, has_ros = None, False
    interrupts: list[int] = []

    def interrupt(number: int, _frame: FrameType | None) -> None:
        interrupts.append(number)
        raise KeyboardInterrupt

    try:
        # With its own handlers, rclpy calls this one too, and ends `rclpy.spin` at SIGTERM.
        for number in (signal.SIGINT,) if work is None else ENDING:
            if signal.getsignal(number) != signal.SIG_IGN:  # As under nohup.
                signal.signal(number, interrupt)
        if work is None:
            rclpy.init()
        else:
            rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        has_ros = True
        node = make_node()
        return (work or rclpy.spin)(node) or 0
    except (KeyboardInterrupt, ExternalShutdownException):
        return 0
    except (ArmControllerError, ParameterException, NameValidationException) as error:
        get_logger(os.path.basename(sys.argv[0])).fatal(str(error))
        return 1
    except Exception as error:
        if interrupts or (has_ros and not ok()):
            # The signal came while the node was made, while rclpy was about to wait, or while it
            # converted a message, which turns KeyboardInterrupt into a RuntimeError.
            return 0
        if node is not None or not isinstance(error, RuntimeError):
            raise
        # rclpy refuses an argument, a file or a name.
        sys.exit(f"cannot start the node: {str(error).partition(', at ')[0]}")
    finally:
        if node is not None:
            node.destroy_node()
        try_shutdown()


def spin_for(node: Node, duration_s: float) -> None:
    """Serve a node's callbacks for a time, where a program without ROS would sleep."""
    end_s = time.monotonic() + duration_s
    while (left_s := end_s - time.monotonic()) > 0.0:
        rclpy.spin_once(node, timeout_sec=left_s)


def declare(
    node: Node,
    name: str,
    default: ValueT,
    about: str,
    bounds: tuple[float, float] | None = None,
    *,
    read_only: bool = True,
) -> ValueT:
    """Declare a parameter, and return its value. A number has bounds; `2` is as good as `2.0`.

    Raises:
        ParameterException: the given value has another type, or is out of bounds.
        NodeSettingError: it is an empty list.
    """
    descriptor = ParameterDescriptor(description=about, read_only=read_only)
    is_whole, value = False, default
    if bounds is not None:
        low, high = bounds
        descriptor.floating_point_range = [FloatingPointRange(from_value=low, to_value=high)]
        number = given(node, name, default)
        is_whole = type(number) is int
        value = float(number) if is_whole else default
    made: Any = node.declare_parameter(name, value, descriptor, ignore_override=is_whole)
    if made.value is None:  # rclpy takes [] for a parameter of any type.
        raise NodeSettingError(f"parameter {name}: must not be an empty list")
    return made.value


def given(node: Node, name: str, default: object) -> Any:
    """Return what the user gives for a parameter that is not declared yet, in any notation."""
    value = node.declare_parameter(name, default, ParameterDescriptor(dynamic_typing=True)).value
    node.undeclare_parameter(name)
    return value


def numbers_in(value: Any) -> list[float] | None:
    """Return a list of numbers that the user gives, None if it is something else.

    ROS's command line sends `[1, 0]` as integers, `[1, 0.5]` as a text, and `[]` without a type.
    """
    items = value.strip("[]").split(",") if isinstance(value, str) else value
    try:
        return [float(item) for item in ([] if items is None else items)]
    except (TypeError, ValueError, OverflowError):
        return None


def declare_joints(node: Node, default: tuple[str, ...] = ("j0", "j1", "j2", "j3")) -> list[str]:
    """Declare the parameter `joints`, and return it: the joints of a pose, in its order.

    Raises:
        NodeSettingError: a name is empty, or there twice.
    """
    about = "Joints of a pose, in its controller's order"
    names = declare(node, "joints", list(default), about)
    if not all(names) or len(set(names)) < len(names):
        raise NodeSettingError(f"parameter joints: must be different names, not {names}")
    return names


def declare_match_timeout_s(node: Node) -> float:
    """Declare the parameter `match_timeout`, and return it (s)."""
    about = "How long to wait for a subscriber to the commands (s)"
    return declare(node, "match_timeout", 10.0, about, TIMES_S)
