"""The executable mtc_demo: plans a demonstration of the task constructor, and executes it."""

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from arm_description.errors import DescriptionError
from arm_node.environment import PLANNING_PACKAGES
from arm_node.names import describe_known
from arm_node.process import EXIT_OK, EXIT_USAGE, NodeProcess
from arm_node.task import run_task
from arm_planning.errors import PlanningError

if TYPE_CHECKING:
    from rclpy.node import Node

    from arm_planning.demos.all_demos import TaskDemo
    from arm_planning.ros.task_robot import TaskRobot

CONFIGURATION = "package://mycobot_moveit_config/config/mycobot_280"
SHOWN = 5
"""Solutions whose costs are printed."""


def demonstrate(demo: "TaskDemo", robot: "TaskRobot", node: "Node", process: NodeProcess) -> int:
    """Plan the task of a demonstration, show it, and execute it if the parameter says so.

    Raises:
        PlanningError: there is no solution, or its execution failed.
    """
    log = node.get_logger()
    executes = node.declare_parameter("execute", False).value
    robot.add(demo.objects)
    task = demo.task(robot.planner.model)
    try:
        found = task.plan(
            robot.planner, max_solutions=demo.max_solutions, interrupted=lambda: process.stopping
        )
    except PlanningError:
        log.error("Task planning failed")
        for line in task.report().splitlines():
            log.info(line)
        raise
    log.info("Task planning succeeded")
    for number, solution in enumerate(found[:SHOWN], 1):
        steps = ", ".join(step.stage for step in solution.steps)
        log.info(f"Solution {number} of {len(found)}, cost {solution.cost:.2f}: {steps}")
    robot.show(found[0])
    log.info("Published solution for visualization")
    if executes:
        robot.execute(found[0])
        log.info("Task executed successfully")
    else:
        log.info("Execution skipped as per configuration")
    return EXIT_OK


def robot_of(node: "Node", process: NodeProcess) -> "TaskRobot":
    """Return the running robot, once move_group is there.

    Raises:
        PlanningError: its configuration cannot be used, or the process ends.
        DescriptionError: the robot cannot be used.
    """
    from arm_planning.ros.task_robot import TaskRobot

    configuration = str(node.declare_parameter("moveit_config", CONFIGURATION).value)
    return TaskRobot(node, process, configuration)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a demonstration; return 1 if it failed, and 2 if there is none of that name."""
    from arm_planning.demos.all_demos import DEMOS

    program, *words = sys.argv if argv is None else argv
    name, ros = (words[0], words[1:]) if words and not words[0].startswith("-") else ("", words)
    if name not in DEMOS:
        known = describe_known(name, DEMOS, "there are")
        sys.stderr.write(f"mtc_demo: no demonstration '{name}'; {known}\n")
        return EXIT_USAGE
    return run_task(
        name,
        lambda node, process: demonstrate(DEMOS[name], robot_of(node, process), node, process),
        [program, *ros],
        (PlanningError, DescriptionError),
        PLANNING_PACKAGES,
    )


if __name__ == "__main__":
    sys.exit(main())
