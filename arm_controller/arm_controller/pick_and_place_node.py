"""The node mycobot_pick_and_place: picks an object up, holds it, puts it back, and ends."""

from math import isfinite
from typing import Any

import rclpy
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import String

from arm_controller.pick_plan import (
    CLOSED,
    WIDE_OPEN,
    JointPath,
    PickPlan,
    PickTask,
    plan_pick,
    prefixed_joints,
)
from arm_controller.pose import ArmControllerError
from arm_controller.ros_arm import LATCHED
from arm_controller.ros_arm_actions import POLL_S, ArmActions
from arm_controller.ros_node import NodeSettingError, declare, given, numbers_in, run

TOPIC = "robot_description"
DEFAULT = PickTask()
LENGTHS_M, EFFORTS_N_M = (0.0, 10.0), (0.001, 1e3)


class PickError(ArmControllerError):
    """A step of a pick failed; the message says which and why."""


class PickAndPlaceNode(Node):
    """Picks an object up through the robot's actions; parameters describe the object."""

    def __init__(self) -> None:
        super().__init__("mycobot_pick_and_place")
        place = numbers_in(given(self, "position", [DEFAULT.x, DEFAULT.y]))
        if place is None or len(place) != 2 or not all(map(isfinite, place)):
            raise NodeSettingError("parameter position: must be a list of two numbers, x and y")
        x, y = place
        about = "Position of the object, x and y in the frame of the robot's base (m)"
        descriptor = ParameterDescriptor(description=about, read_only=True)
        self.declare_parameter("position", [x, y], descriptor, ignore_override=True)
        self._task = PickTask(
            x,
            y,
            declare(self, "height", DEFAULT.height, "Height of the grip (m)", LENGTHS_M),
            declare(self, "lift", DEFAULT.lift, "How far the object is lifted (m)", LENGTHS_M),
            declare(self, "hold_time", DEFAULT.hold_s, "How long it is held (s)", (0.0, 1e9)),
            declare(self, "max_effort", DEFAULT.max_effort, "Effort limit (N m)", EFFORTS_N_M),
        )
        self._prefix = declare(self, "prefix", "", "Prefix of the joint names")
        self._actions = ArmActions(self, prefixed_joints(self._prefix))

    def pick(self) -> None:
        """Pick the object up and put it back.

        Raises:
            ArmControllerError: a step failed, or the object cannot be gripped there.
        """
        self._actions.connect()
        plan = plan_pick(self._description(), self._task, self._prefix)
        PickAndPlace(self._actions, plan, self.get_logger()).run()

    def _description(self) -> str:
        self.get_logger().info(f"Waiting for {self.resolve_topic_name(TOPIC)}...")
        described = Future()

        def take(message: String) -> None:
            described.set_result(message.data)

        subscription = self.create_subscription(String, TOPIC, take, LATCHED)
        while not described.done():
            rclpy.spin_until_future_complete(self, described, timeout_sec=POLL_S)
        self.destroy_subscription(subscription)
        return str(described.result())


class PickAndPlace:
    """Executes a plan and logs each step.

    Fingers that close fully hold nothing; fingers that stop earlier hold the object.
    """

    def __init__(self, robot: ArmActions, plan: PickPlan, logger: Any) -> None:
        self._robot = robot
        self._plan = plan
        self._logger = logger

    def run(self) -> None:
        """Pick up, hold and put back the object once, then move the arm home.

        Raises:
            PickError: a step failed and the robot stopped; the message says which and why.
        """
        plan, task = self._plan, self._plan.task
        self._robot.connect()
        self._open()
        self._go("to the object", plan.to_object)
        self._go("around the object", plan.approach)
        self._close("Closing gripper")
        self._go(f"up by {task.lift:g} m", plan.up)
        self._logger.info(f"Holding for {task.hold_s:g} s")
        self._robot.pause(task.hold_s)
        self._close("Checking whether the object is still held")
        self._go("down again", plan.down)
        self._open()
        self._go("away", plan.away)
        self._go("to home position", plan.home)
        self._logger.info("The object was picked up, held and put back")

    def _go(self, where: str, path: JointPath) -> None:
        self._logger.info(f"Moving {where}")
        failure = self._robot.follow(path)
        if failure is not None:
            raise PickError(f"the arm could not move {where}: {failure}")

    def _open(self) -> None:
        self._logger.info("Opening gripper")
        result = self._grip(WIDE_OPEN)
        if not result.reached_goal:
            raise PickError(f"the gripper did not open: it is at {result.position:.3f} rad")

    def _close(self, doing: str) -> None:
        self._logger.info(doing)
        result = self._grip(CLOSED)
        if result.reached_goal:
            raise PickError("there is nothing between the fingers: they closed all the way")
        if not result.stalled:
            raise PickError(
                f"the grip ended at {result.position:.3f} rad: another node moves the gripper"
            )
        self._logger.info(f"The object is held, at {result.position:.3f} rad")

    def _grip(self, position: float) -> Any:
        result = self._robot.grip(position, self._plan.task.max_effort)
        if isinstance(result, str):
            raise PickError(f"the gripper did not move: {result}")
        return result


def main() -> int:
    """Pick an object up, hold it and put it back; return 1 if that failed."""
    return run(PickAndPlaceNode, PickAndPlaceNode.pick)
