"""Runs what spawner, unspawner and hardware_spawner do in a process of their own."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from arm_control.errors import ArmControlError, WaitInterruptedError
from arm_control.ros.node_name import as_node_name
from arm_node.process import EXIT_OK, NodeProcess
from arm_node.task import Task, run_task

if TYPE_CHECKING:
    from rclpy.node import Node


def run_manager_task(node_name: str, task: Task, argv: Sequence[str]) -> int:
    """Run a client of a controller manager; return its exit code, 0 where a signal ends it.

    Args:
        node_name: of the client; what ROS does not allow in it becomes an underscore.
        task: the work; an `ArmControlError` of it is for the user, and its exit code 1.
        argv: ROS arguments of the process, the program's name first.
    """

    def until_interrupted(node: "Node", process: NodeProcess) -> int:
        try:
            return task(node, process)
        except WaitInterruptedError:
            return EXIT_OK

    name = as_node_name(node_name)
    return run_task(name, until_interrupted, argv, user_errors=(ArmControlError,))
