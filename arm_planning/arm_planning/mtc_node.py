"""The executable mtc_node: picks up what the depth camera sees, and puts it down elsewhere."""

import sys
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from arm_description.errors import DescriptionError
from arm_node.environment import SEEING_PACKAGES
from arm_node.process import NodeProcess
from arm_node.task import run_task
from arm_planning.errors import PerceptionError, PlanningError
from arm_planning.mtc_demo_node import demonstrate, robot_of

if TYPE_CHECKING:
    from rclpy.node import Node

    from arm_planning.demos.pick_place import Picked
    from arm_planning.ros.task_robot import TaskRobot

NAME, SERVER = "mtc_node", "get_planning_scene_server"
DIMENSIONS = [0.35, 0.0125]
"""Of the red cylinder: height and radius, in m."""


def pick_what_is_seen(node: "Node", process: NodeProcess) -> int:
    """Ask what the camera sees, and plan with it.

    Raises:
        PlanningError: the object is not seen, or the task has no solution or failed.
        DescriptionError: the robot cannot be used.
    """
    from arm_planning.demos.all_demos import TaskDemo
    from arm_planning.demos.pick_place import pick_place

    shape = str(node.declare_parameter("object_type", "cylinder").value)
    dimensions: Any = node.declare_parameter("object_dimensions", DIMENSIONS).value
    robot = robot_of(node, process)
    picked = look(node, robot, shape, list(dimensions))
    return demonstrate(TaskDemo(lambda model: pick_place(model, picked)), robot, node, process)


def look(node: "Node", robot: "TaskRobot", shape: str, dimensions: Sequence[float]) -> "Picked":
    """Put what is seen into the scene; return the target, placed as high as it stands now.

    Raises:
        PlanningError: it is not seen, or move_group refuses an object.
    """
    from mycobot_interfaces.srv import GetPlanningScene

    from arm_planning.demos.pick_place import PLACE, Picked, heights_near_top

    asked = GetPlanningScene.Request(target_shape=shape, target_dimensions=dimensions)
    seen = robot.call(GetPlanningScene, "/get_planning_scene_mycobot", asked, SERVER)
    if not seen.success:
        raise PerceptionError(
            f"the camera does not see a {shape} of about {list(dimensions)} m; the log of {SERVER} "
            "says why"
        )
    target = seen.target_object_id
    node.get_logger().info(f"{target} is seen, on {seen.support_surface_id}")
    objects = seen.scene_world.collision_objects
    robot.add_messages(objects)
    thing = robot.planner.scene.objects[target]
    x, y, _ = PLACE.position
    place = replace(PLACE, position=(x, y, thing.pose.position[2]))
    solid = next(each for each in objects if each.id == target).primitives[0]
    height = solid.BOX_Z if solid.type == solid.BOX else solid.CYLINDER_HEIGHT
    heights_m = (0.0, *heights_near_top(solid.dimensions[height]))
    return Picked(target, place, seen.support_surface_id, heights_m)


def main(argv: Sequence[str] | None = None) -> int:
    """Run the task; return 1 if it failed."""
    errors = (PlanningError, DescriptionError)
    return run_task(NAME, pick_what_is_seen, argv, errors, SEEING_PACKAGES)


if __name__ == "__main__":
    sys.exit(main())
