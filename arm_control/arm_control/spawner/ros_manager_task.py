"""Runs spawner, unspawner or hardware_spawner as a process with a node."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, NoReturn

from arm_control.errors import ArmControlError, WaitInterruptedError
from arm_node.names import as_node_name
from arm_node.process import EXIT_OK, NodeProcess
from arm_node.task import Task, run_task
from arm_node.workarounds.exit_pause import end_process

if TYPE_CHECKING:
    from rclpy.node import Node


def run_manager_task(node_name: str, task: Task, argv: Sequence[str]) -> NoReturn:
    """Run a client of a controller manager and end this process, with 0 after a signal.

    Args:
        node_name: name of the client's node; characters that ROS does not allow become underscores.
        task: the work; an `ArmControlError` is reported to the user and gives exit code 1.
        argv: ROS arguments of the process, after the program's name.
    """

    def until_interrupted(node: "Node", process: NodeProcess) -> int:
        try:
            return task(node, process)
        except WaitInterruptedError:
            return EXIT_OK

    name = as_node_name(node_name)
    end_process(run_task(name, until_interrupted, argv, user_errors=(ArmControlError,)))
