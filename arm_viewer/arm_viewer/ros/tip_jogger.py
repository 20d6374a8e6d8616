"""Lets a robot follow poses of its tip, by the servo_node beside its move_group."""

import math
import time
from collections.abc import Callable

from geometry_msgs.msg import PoseStamped
from moveit_msgs.msg import ServoStatus
from moveit_msgs.srv import ServoCommandType
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.time import Time

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.convert import pose_message
from arm_viewer.planning import JogView, default_group
from arm_viewer.requests import JogTip
from arm_viewer.ros.service_caller import ServiceCaller
from arm_viewer.ros.topic_reader import TopicReader
from arm_viewer.snapshot import SimulationTime

SERVO = "servo_node"
SWITCH = f"{SERVO}/switch_command_type"
GROUP = "moveit_servo.move_group_name"
STATUS_S = 2.0
"""A status that is older says nothing about the present; servo_node sends two a second at rest."""
_STOPPED = (
    ServoStatus.INVALID,
    ServoStatus.HALT_FOR_SINGULARITY,
    ServoStatus.HALT_FOR_COLLISION,
)
_QUEUE = QoSProfile(depth=10)


def is_served(node: Node, namespace: str) -> bool:
    """Return whether a servo_node runs in a namespace."""
    return bool(node.count_services(f"{namespace}/{SWITCH}"))


class TipJogger:
    """Use it in the executor's thread."""

    def __init__(
        self,
        node: Node,
        polled: PolledSubscriptions,
        namespace: str,
        model: PlanningModel,
        clock: Callable[[], SimulationTime | None],
    ) -> None:
        """Create the clients; without a simulation, `clock` returns None."""
        self._node, self._model, self._clock = node, model, clock
        self._group = ""
        self._drag = 0
        self._status, self._status_s = ServoStatus(), -math.inf
        self._problem = ""
        self._switch = ServiceCaller(node, ServoCommandType, f"{namespace}/{SWITCH}")
        name = f"{namespace}/{SERVO}/get_parameters"
        self._parameters = ServiceCaller(node, GetParameters, name)
        self._statuses: TopicReader[ServoStatus] = TopicReader(
            node, polled, ServoStatus, f"{namespace}/{SERVO}/status", _QUEUE
        )
        topic = f"{namespace}/{SERVO}/pose_target_cmds"
        self._targets = node.create_publisher(PoseStamped, topic, _QUEUE)

    @property
    def view(self) -> JogView | None:
        """What the page shows of it; None until its group is known."""
        if not self._group:
            return None
        if self._problem:
            return JogView(self._group, self._problem, is_stopped=True)
        return JogView(self._group, self._status.message, self._status.code in _STOPPED)

    def collect(self) -> None:
        """Take what has arrived, and ask for the group until it is known."""
        now_s = time.monotonic()
        status = self._statuses.take_newest()
        if status is not None:
            self._status, self._status_s = status, now_s
        elif now_s - self._status_s > STATUS_S:
            self._status = ServoStatus()
        if not self._group:
            self._parameters.ask(GetParameters.Request(names=[GROUP]), self._take_group)

    def jog(self, request: JogTip) -> None:
        """Send the tip to a pose; it stops when this is not repeated within servo_node's timeout.

        Until servo_node takes poses, none is sent.
        """
        if request.drag != self._drag:
            if self._switch.is_overdue():
                self._problem = f"{self._switch.service} does not answer"
            wanted = ServoCommandType.Request(command_type=ServoCommandType.Request.POSE)
            self._switch.ask(wanted, lambda answer: self._take_switch(request.drag, answer))
            return
        target = PoseStamped(pose=pose_message(request.pose))
        target.header.frame_id = self._model.robot.root
        clock = self._clock()
        now_s = time.time() if clock is None else clock.at(time.monotonic())
        target.header.stamp = Time(nanoseconds=round(1e9 * now_s)).to_msg()
        self._targets.publish(target)

    def close(self) -> None:
        """Destroy the clients."""
        self._switch.close()
        self._parameters.close()
        self._statuses.close()
        self._node.destroy_publisher(self._targets)

    def _take_group(self, answer: GetParameters.Response) -> None:
        named = [value.string_value for value in answer.values if value.string_value]
        self._group = named[0] if named else default_group(self._model)

    def _take_switch(self, drag: int, answer: ServoCommandType.Response) -> None:
        self._problem = "" if answer.success else "servo_node takes no poses"
        if answer.success:
            self._drag = drag
