"""Plans and executes motions by a running move_group, as MoveIt's MoveGroupInterface does."""

from typing import Any

import rclpy
from geometry_msgs.msg import PoseStamped
from moveit_msgs.action import ExecuteTrajectory, MoveGroup
from moveit_msgs.msg import (
    CollisionObject,
    Constraints,
    MoveItErrorCodes,
    OrientationConstraint,
    PlanningScene,
    PositionConstraint,
    RobotTrajectory,
)
from moveit_msgs.srv import ApplyPlanningScene
from rclpy.action.client import ActionClient
from rclpy.node import Node
from rclpy.task import Future
from shape_msgs.msg import SolidPrimitive

from arm_controller.pose import ArmControllerError
from arm_controller.ros_node import spin_for

POLL_S, REMINDER_S = 0.1, 10.0
POSITION_TOLERANCE_M, ORIENTATION_TOLERANCE = 1e-4, 1e-3


class MoveItError(ArmControllerError):
    """move_group could not do what it was asked to; the message says why."""


class MoveGroupInterface:
    """The clients of move_group for one group. Each method blocks, and serves the node.

    Attributes:
        pipeline_id: the planning pipeline.
        planner_id: its planner.
        planning_time_s: how long it may plan.
        link: the link that poses are for.
    """

    pipeline_id, planner_id, planning_time_s = "ompl", "RRTConnectkConfigDefault", 1.0

    def __init__(self, node: Node, group: str, link: str) -> None:
        self._node, self._group, self.link = node, group, link
        self._plan = ActionClient(node, MoveGroup, "move_action")
        self._execute = ActionClient(node, ExecuteTrajectory, "execute_trajectory")
        self._scene = node.create_client(ApplyPlanningScene, "apply_planning_scene")

    def connect(self) -> None:
        """Wait until move_group is there; remind the user from time to time."""
        waited_s = 0.0
        ready = (self._plan.server_is_ready, self._execute.server_is_ready)
        while not (all(is_ready() for is_ready in ready) and self._scene.service_is_ready()):
            spin_for(self._node, POLL_S)
            waited_s += POLL_S
            if waited_s >= REMINDER_S:
                waited_s = 0.0
                self._node.get_logger().warning("no move_group: does it run with planning:=true?")

    def plan(self, target: PoseStamped) -> RobotTrajectory:
        """Return a motion that brings the link to a pose.

        Raises:
            MoveItError: there is none.
        """
        goal = MoveGroup.Goal()
        request = goal.request
        request.group_name = self._group
        request.goal_constraints = [self._constraints(target)]
        request.pipeline_id, request.planner_id = self.pipeline_id, self.planner_id
        request.allowed_planning_time = self.planning_time_s
        request.num_planning_attempts = 1
        request.max_velocity_scaling_factor = request.max_acceleration_scaling_factor = 1.0
        request.start_state.is_diff = True
        options = goal.planning_options
        options.plan_only = True
        options.planning_scene_diff.is_diff = options.planning_scene_diff.robot_state.is_diff = True
        return self._result(self._plan, goal).planned_trajectory

    def execute(self, trajectory: RobotTrajectory) -> None:
        """Move the robot along a trajectory; Ctrl-C stops it.

        Raises:
            MoveItError: it did not get there.
        """
        self._result(self._execute, ExecuteTrajectory.Goal(trajectory=trajectory))

    def apply(self, *objects: CollisionObject) -> None:
        """Add objects to the planning scene.

        Raises:
            MoveItError: move_group refuses one.
        """
        scene = PlanningScene(is_diff=True)
        scene.robot_state.is_diff = True
        scene.world.collision_objects = list(objects)
        request = ApplyPlanningScene.Request(scene=scene)
        if not self._answer(self._scene.call_async(request)).success:
            raise MoveItError("move_group did not take the objects; its log says why")

    def _constraints(self, target: PoseStamped) -> Constraints:
        position = PositionConstraint(header=target.header, link_name=self.link, weight=1.0)
        sphere = SolidPrimitive(type=SolidPrimitive.SPHERE, dimensions=[POSITION_TOLERANCE_M])
        position.constraint_region.primitives = [sphere]
        position.constraint_region.primitive_poses = [target.pose]
        orientation = OrientationConstraint(
            header=target.header,
            link_name=self.link,
            orientation=target.pose.orientation,
            absolute_x_axis_tolerance=ORIENTATION_TOLERANCE,
            absolute_y_axis_tolerance=ORIENTATION_TOLERANCE,
            absolute_z_axis_tolerance=ORIENTATION_TOLERANCE,
            weight=1.0,
        )
        return Constraints(position_constraints=[position], orientation_constraints=[orientation])

    def _result(self, client: ActionClient, goal: Any) -> Any:
        handle = self._answer(client.send_goal_async(goal))
        if not handle.accepted:
            raise MoveItError("move_group did not take the goal")
        try:
            result = self._answer(handle.get_result_async()).result
        except KeyboardInterrupt:
            rclpy.spin_until_future_complete(self._node, handle.cancel_goal_async(), timeout_sec=2)
            raise
        if result.error_code.val != MoveItErrorCodes.SUCCESS:
            code = result.error_code
            raise MoveItError(code.message or f"move_group failed with code {code.val}")
        return result

    def _answer(self, future: Future) -> Any:
        while not future.done():
            if not self._plan.server_is_ready():
                raise MoveItError("move_group is gone")
            rclpy.spin_until_future_complete(self._node, future, timeout_sec=POLL_S)
        return future.result()
