"""The executable `spawner`: loads, configures and activates controllers."""

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, NoReturn

from arm_control.manager.node_arguments import parameter_files, split_ros_arguments
from arm_control.spawner.command_line import parse_spawner_options, run_manager_task

if TYPE_CHECKING:
    from rclpy.node import Node

    from arm_node.process import NodeProcess


def main(argv: Sequence[str] | None = None) -> NoReturn:
    """Run a spawner and exit with 0, 1 if a step failed, or 2 for an invalid command line."""
    program, *arguments = sys.argv if argv is None else argv
    own, ros = split_ros_arguments(arguments)
    options = parse_spawner_options(own, parameter_files(ros))

    def task(node: "Node", process: "NodeProcess") -> int:
        from arm_control.spawner.ros_spawner import spawn

        return spawn(node, process, options)

    run_manager_task(f"spawner_{options.controllers[0].name}", task, [program, *ros])


if __name__ == "__main__":
    main()
