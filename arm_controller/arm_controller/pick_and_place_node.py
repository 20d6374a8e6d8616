"""The node mycobot_pick_and_place: picks an object up, holds it, puts it back, and ends."""

from typing import TYPE_CHECKING, Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
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
from arm_controller.ros_arm_actions import ArmActions
from arm_controller.ros_parameters import declare, read_positive
from arm_description.errors import DescriptionError
from arm_description.urdf.parser import parse_urdf
from arm_node.parameter_values import read_numbers, read_text, refusal

if TYPE_CHECKING:
    from arm_node.process import NodeProcess

TOPIC = "robot_description"
DEFAULT = PickTask()


class PickError(ArmControllerError):
    """A step of a pick failed; the message says which and why."""


class PickAndPlaceNode(Node):
    """Picks an object up through the robot's actions; parameters describe the object.

    Args:
        process: ends after the pick; with exit code 1 if it failed.

    Raises:
        ParameterValueError: a given parameter is invalid.
    """

    def __init__(self, process: "NodeProcess") -> None:
        super().__init__("mycobot_pick_and_place")
        self._process = process
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

    def start(self) -> None:
        """Begin the pick, in the executor's thread."""
        self._process.executor.create_task(self._pick)

    def stop(self) -> None:
        """Cancel the running movement; call it in any thread but the executor's."""
        self._actions.stop()

    async def _pick(self) -> None:
        try:
            await self._actions.connect()
            plan = plan_pick(parse_urdf(await self._description(), TOPIC), self._task, self._prefix)
            await PickAndPlace(self._actions, plan, self.get_logger()).run()
        except (ArmControllerError, DescriptionError) as error:
            # A pick that a signal interrupts has not failed.
            if not self._process.stopping:
                self.get_logger().fatal(str(error))
                self._process.stop(1)
        else:
            self._process.stop()

    async def _description(self) -> str:
        self.get_logger().info(f"Waiting for {self.resolve_topic_name(TOPIC)}...")
        described = Future(executor=self.executor)

        def take(message: String) -> None:
            if not described.done():
                described.set_result(message.data)

        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        subscription = self.create_subscription(String, TOPIC, take, qos)
        description: str = await described  # pyright: ignore[reportAssignmentType]
        self.destroy_subscription(subscription)
        return description


class PickAndPlace:
    """Executes a plan and logs each step.

    Fingers that close fully hold nothing; fingers that stop earlier hold the object.
    """

    def __init__(self, robot: ArmActions, plan: PickPlan, logger: Any) -> None:
        self._robot = robot
        self._plan = plan
        self._logger = logger

    async def run(self) -> None:
        """Pick up, hold and put back the object once, then move the arm home.

        Raises:
            PickError: a step failed and the robot stopped; the message says which and why.
        """
        plan, task = self._plan, self._plan.task
        await self._robot.connect()
        await self._open()
        await self._go("to the object", plan.to_object)
        await self._go("around the object", plan.approach)
        await self._close("Closing gripper")
        await self._go(f"up by {task.lift:g} m", plan.up)
        self._logger.info(f"Holding for {task.hold_s:g} s")
        await self._robot.pause(task.hold_s)
        await self._close("Checking whether the object is still held")
        await self._go("down again", plan.down)
        await self._open()
        await self._go("away", plan.away)
        await self._go("to home position", plan.home)
        self._logger.info("The object was picked up, held and put back")

    async def _go(self, where: str, path: JointPath) -> None:
        self._logger.info(f"Moving {where}")
        failure = await self._robot.follow(path)
        if failure is not None:
            raise PickError(f"the arm could not move {where}: {failure}")

    async def _open(self) -> None:
        self._logger.info("Opening gripper")
        result = await self._grip(WIDE_OPEN)
        if not result.reached_goal:
            raise PickError(f"the gripper did not open: it is at {result.position:.3f} rad")

    async def _close(self, doing: str) -> None:
        self._logger.info(doing)
        result = await self._grip(CLOSED)
        if result.reached_goal:
            raise PickError("there is nothing between the fingers: they closed all the way")
        if not result.stalled:
            raise PickError(
                f"the grip ended at {result.position:.3f} rad: another node moves the gripper"
            )
        self._logger.info(f"The object is held, at {result.position:.3f} rad")

    async def _grip(self, position: float) -> Any:
        result = await self._robot.grip(position, self._plan.task.max_effort)
        if isinstance(result, str):
            raise PickError(f"the gripper did not move: {result}")
        return result


def read_place(value: object) -> tuple[float, float]:
    """Return a position on the ground, x and y.

    Raises:
        ParameterValueError: the value is not a list of two finite numbers.
    """
    wanted = "a list of two numbers, x and y"
    numbers = read_numbers(value, wanted)
    if len(numbers) != 2:
        raise refusal(wanted, value)
    return numbers[0], numbers[1]
