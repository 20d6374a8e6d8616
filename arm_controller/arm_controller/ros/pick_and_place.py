"""The node mycobot_pick_and_place: picks up an object through the robot's actions."""

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from std_msgs.msg import String

from arm_controller.joint_path import JointPath
from arm_controller.mycobot import prefixed_joints
from arm_controller.parameter_values import read_place, read_positive
from arm_controller.pick_and_place import Grip
from arm_controller.pick_plan import PickPlan, PickTask, plan_pick
from arm_controller.ros.arm_actions import ArmActions
from arm_controller.ros.parameters import declare
from arm_description.urdf.parser import parse_urdf
from arm_node.parameter_values import read_text

TOPIC = "robot_description"
DEFAULT = PickTask()


class PickAndPlaceNode(Node):
    """A `PickingRobot` that uses actions; parameters describe the object.

    The coroutines run in the executor's thread, `stop` in any other.

    Raises:
        ParameterValueError: a given parameter is invalid.
    """

    def __init__(self) -> None:
        super().__init__("mycobot_pick_and_place")
        x, y = declare(
            self,
            "position",
            [DEFAULT.x, DEFAULT.y],
            read_place,
            "Position of the object, x and y in the frame of the robot's base (m)",
        )
        self._task = PickTask(
            x,
            y,
            declare(self, "height", DEFAULT.height, read_positive, "Height of the grip (m)"),
            declare(self, "lift", DEFAULT.lift, read_positive, "How far the object is lifted (m)"),
            declare(self, "hold_time", DEFAULT.hold_s, read_positive, "How long it is held (s)"),
            declare(self, "max_effort", DEFAULT.max_effort, read_positive, "Effort limit (N m)"),
        )
        self._prefix = declare(self, "prefix", "", read_text, "Prefix of the joint names")
        self._actions = ArmActions(self, prefixed_joints(self._prefix))

    async def plan(self) -> PickPlan:
        """Return the plan for the robot on /robot_description.

        Raises:
            PlanError: the object cannot be gripped there.
            DescriptionError: the robot is not a myCobot with this prefix.
        """
        self.get_logger().info(f"Waiting for {self.resolve_topic_name(TOPIC)}...")
        described = Future(executor=self.executor)

        def take(message: String) -> None:
            if not described.done():
                described.set_result(message.data)

        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        subscription = self.create_subscription(String, TOPIC, take, qos)
        description: str = await described  # pyright: ignore[reportAssignmentType]
        self.destroy_subscription(subscription)
        return plan_pick(parse_urdf(description, TOPIC), self._task, self._prefix)

    async def connect(self) -> None:
        """Wait for both action servers, and log which are missing."""
        await self._actions.connect()

    async def follow(self, path: JointPath) -> str | None:
        """Move the arm; return why it did not reach its goal, or None."""
        return await self._actions.follow(path)

    async def grip(self, position: float, max_effort: float) -> Grip | str:
        """Move the gripper to a position in rad; return a phrase if there is no result."""
        result = await self._actions.grip(position, max_effort)
        if isinstance(result, str):
            return result
        return Grip(result.position, result.reached_goal, result.stalled)

    async def pause(self, seconds: float) -> None:
        """Return after a time on the node's clock."""
        await self._actions.wait(seconds, self.get_clock())

    def stop(self) -> None:
        """Cancel the running movement; block until that is confirmed, for at most two seconds."""
        self._actions.stop()
