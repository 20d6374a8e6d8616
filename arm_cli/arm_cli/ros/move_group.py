"""Asks a running move_group: for its robot, and to move it."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from moveit_msgs.action import MoveGroup
from moveit_msgs.msg import MoveItErrorCodes
from rclpy.action.client import ActionClient
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from arm_cli.errors import MotionFailedError, StoppedError, UnansweredError
from arm_cli.names import absolute_name
from arm_cli.ros.graph import Graph
from arm_cli.ros.session import CommandSession
from arm_description.urdf.parser import parse_urdf
from arm_node.qos import LATCHED
from arm_planning.robot.build import planning_model
from arm_planning.robot.model import PlanningModel
from arm_planning.robot.srdf import parse_srdf

TIMEOUT_S = 5.0
URDF, SRDF = "robot_description", "robot_description_semantic"


class MoveGroupClient:
    """Asks the move_group in a namespace with the node of this command."""

    def __init__(self, session: CommandSession, namespace: str) -> None:
        self._session = session
        self._namespace = absolute_name(namespace).rstrip("/")

    def model(self) -> PlanningModel:
        """Return the running robot with its groups and named states.

        Raises:
            UnansweredError: nobody publishes its descriptions.
        """
        texts: dict[str, str] = {}
        for topic in (SRDF, URDF):
            take = partial(_keep, texts, topic)
            name = self._session.full_name(self._name(topic))
            self._session.node.create_subscription(String, name, take, LATCHED)
        if not self._session.wait_until(lambda: len(texts) == 2, timeout_s=TIMEOUT_S):
            missing = [self._name(topic) for topic in (SRDF, URDF) if topic not in texts]
            advice = "does robot_state_publisher run?" if SRDF in texts else self._advice()
            raise UnansweredError(f"nobody publishes {' and '.join(missing)}: {advice}")
        robot = parse_urdf(texts[URDF])
        # The limits do not matter here, so neither do remarks about them.
        return planning_model(robot, parse_srdf(texts[SRDF], robot), warn=lambda _: None)

    def _name(self, name: str) -> str:
        return f"{self._namespace}/{name}"

    def _advice(self) -> str:
        """Return where planning runs, or how to start it."""
        topics = Graph(self._session).topics()
        others = [
            topic.removesuffix(SRDF).rstrip("/") or "/"
            for topic in sorted(topics)
            if topic.endswith(f"/{SRDF}") and topic != self._name(SRDF)
        ]
        if others:
            return f"there is a robot with planning in -n {' or '.join(others)}"
        return "start the robot with planning:=true, as in `arm launch mycobot planning:=true`"

    def positions(self, joints: Sequence[str]) -> dict[str, float]:
        """Return where joints are now, rad or m.

        Raises:
            UnansweredError: nobody publishes the joint state of one.
        """
        known: dict[str, float] = {}

        def take(message: JointState) -> None:
            known.update(zip(message.name, message.position, strict=False))

        qos = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
        topic = self._name("joint_states")
        self._session.node.create_subscription(JointState, topic, take, qos)
        if not self._session.wait_until(lambda: known.keys() >= set(joints), timeout_s=TIMEOUT_S):
            if not known:
                raise UnansweredError(f"no message arrived on {topic}")
            missing = ", ".join(joint for joint in joints if joint not in known)
            raise UnansweredError(f"{topic} has no position of {missing}")
        return {joint: known[joint] for joint in joints}

    def move(self, goal: MoveGroup.Goal, timeout_s: float | None) -> MoveGroup.Result:
        """Send a goal and return its result, however late without a timeout; Ctrl-C cancels it.

        Raises:
            UnansweredError: no move_group runs, or it does not answer, or ends first.
            MotionFailedError: there is no plan, or the robot did not get there.
        """
        client = ActionClient(self._session.node, MoveGroup, self._name("move_action"))
        if not self._session.wait_until(client.server_is_ready, timeout_s=TIMEOUT_S):
            raise UnansweredError("no move_group runs: start the robot with planning:=true")
        handle = self._session.result(client.send_goal_async(goal), TIMEOUT_S)
        if handle is None or not handle.accepted:
            raise UnansweredError("move_group did not take the goal")
        answer = self._answer(handle, client.server_is_ready, timeout_s)
        code = answer.error_code
        if code.val != MoveItErrorCodes.SUCCESS:
            raise MotionFailedError(code.message or f"move_group failed with code {code.val}")
        return answer

    def _answer(
        self, handle: Any, is_there: Callable[[], bool], timeout_s: float | None
    ) -> MoveGroup.Result:
        future, action = handle.get_result_async(), self._name("move_action")
        try:
            answer = self._session.answer(future, action, is_there, timeout_s)
        except StoppedError:
            self._session.clear_stop()
            self._session.result(handle.cancel_goal_async(), TIMEOUT_S)
            raise
        except UnansweredError as error:
            raise UnansweredError(
                f"{error}; a motion that began goes on, `arm stop` ends it"
            ) from None
        if answer is None:
            raise UnansweredError(f"move_group has no result after {timeout_s:g} s")
        return answer.result


def _keep(texts: dict[str, str], topic: str, message: String) -> None:
    texts[topic] = message.data
