"""The node mycobot_pick_and_place: picks an object up by the robot's actions."""

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from std_msgs.msg import String

from arm_controller.mycobot import JOINTS
from arm_controller.parameter_values import read_number, read_place, read_prefix
from arm_controller.pick_and_place import Grip
from arm_controller.pick_plan import PickPlan, PickTask, plan_pick
from arm_controller.ros.arm_actions import ArmActions
from arm_controller.ros.parameters import declare
from arm_controller.way import Way
from arm_description.urdf import parse_urdf

TOPIC = "robot_description"
DEFAULT = PickTask()


class PickAndPlaceNode(Node):
    """A `PickingRobot` by actions, and what is to be picked up by parameters.

    The coroutines run in the executor's thread, `stop` in any other.

    Raises:
        ParameterValueError: a parameter that was given makes no sense.
    """

    def __init__(self) -> None:
        super().__init__("mycobot_pick_and_place")
        x, y = declare(
            self,
            "position",
            [DEFAULT.x, DEFAULT.y],
            read_place,
            "Where the object stands, x and y in the frame of the robot's base (m)",
        )
        self._task = PickTask(
            x,
            y,
            declare(self, "height", DEFAULT.height, read_number, "Height of the grip there (m)"),
            declare(self, "lift", DEFAULT.lift, read_number, "How far the object is lifted (m)"),
            declare(self, "hold_time", DEFAULT.hold_s, read_number, "How long it is held (s)"),
            declare(self, "max_effort", DEFAULT.max_effort, read_number, "Of the grip (N m)"),
        )
        self._prefix = declare(self, "prefix", "", read_prefix, "Of the names of the joints")
        self._actions = ArmActions(self, [self._prefix + name for name in JOINTS])

    async def plan(self) -> PickPlan:
        """Return the plan for the robot that is described on /robot_description.

        Raises:
            PlanError: the object cannot be gripped there.
            DescriptionError: what is described is no myCobot with this prefix.
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
        """Return once both action servers are there; say so, and what is missing."""
        await self._actions.connect()

    async def follow(self, way: Way) -> str | None:
        """Move the arm; return why it did not get there."""
        return await self._actions.follow(way)

    async def grip(self, position: float, max_effort: float) -> Grip | str:
        """Move the gripper to a position in rad; a phrase says why there is no result."""
        result = await self._actions.grip(position, max_effort)
        if isinstance(result, str):
            return result
        return Grip(result.position, result.reached_goal, result.stalled)

    async def pause(self, seconds: float) -> None:
        """Return after some time of the node's clock."""
        await self._actions.wait(seconds, self.get_clock())

    def stop(self) -> None:
        """Stop what is under way; blocks until that is confirmed, for two seconds at most."""
        self._actions.stop()
