"""The console scripts: each runs one node of this package until its work or a signal ends it.

They import the nodes' modules, and so rclpy, only after `arm_node.process` has checked the
environment. A node of your own needs no more than `rclpy.init()` and `rclpy.spin(MyNode())`.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from arm_controller.pose import ArmControllerError
from arm_node.process import NodeProcess, run_process
from arm_node.workarounds.discovery import first_node


def arm_controller_node() -> int:
    """Publish the pose in a parameter and print joint states, until a signal."""
    return _run("arm_controller_node", "ArmController")


def publisher_terminal() -> int:
    """Publish the poses that the user types; return 1 if a valid line was not delivered."""
    return _run("publisher_terminal_node", "PublisherTerminal")


def publisher_defined() -> int:
    """Publish the poses in a file; return 1 if one of them was not reached."""
    return _run("publisher_defined_node", "PublisherDefined")


def arm_gripper_loop_controller() -> int:
    """Move the myCobot and its gripper back and forth, until a signal."""
    return _run("arm_gripper_loop_controller_node", "ArmGripperLoopController")


def mycobot_pick_and_place() -> int:
    """Pick an object up, hold it and put it back; return 1 if that failed."""
    return _run("pick_and_place_node", "PickAndPlaceNode")


def example_gripper() -> int:
    """Close and open the demo's gripper; return 1 if there is no subscriber."""
    return _run("command_sequence_node", "gripper_example")


def example_diff_drive() -> int:
    """Drive the demo's robot in circles until a signal; return 1 if there is no subscriber."""
    return _run("command_sequence_node", "diff_drive_example")


def _run(module: str, make: str) -> int:
    @contextmanager
    def application(process: NodeProcess) -> Iterator[None]:
        make_node: Callable[[NodeProcess], Any] = getattr(
            import_module(f"arm_controller.{module}"), make
        )
        node = first_node(lambda: make_node(process))
        process.executor.add_node(node)
        # Nodes that do more than answer callbacks.
        if not hasattr(node, "start"):
            yield
            return
        node.start()
        try:
            yield
        finally:
            node.stop()

    return run_process(application, user_errors=(ArmControllerError,))
