"""The executable `hardware_spawner`: configures and activates hardware components."""

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, NoReturn

from arm_control.manager.node_arguments import split_ros_arguments
from arm_control.spawner.command_line import parse_hardware_spawner_options, run_manager_task

if TYPE_CHECKING:
    from rclpy.node import Node

    from arm_node.process import NodeProcess


def main(argv: Sequence[str] | None = None) -> NoReturn:
    """Run a hardware spawner and exit with 0, 1 without a manager, or 2 for bad arguments."""
    program, *arguments = sys.argv if argv is None else argv
    own, ros = split_ros_arguments(arguments)
    options = parse_hardware_spawner_options(own)

    def task(node: "Node", process: "NodeProcess") -> int:
        from arm_control.spawner.ros_spawner import spawn_hardware

        return spawn_hardware(node, process, options)

    run_manager_task("hardware_spawner", task, [program, *ros])


if __name__ == "__main__":
    main()
