"""Publish joint states from the page's sliders, for a robot that is not running."""

from collections.abc import Callable

from rclpy.node import Node
from sensor_msgs.msg import JointState

from arm_description.publishers.joint_state_merge import JointStateMerge
from arm_description.publishers.settings import JointPublisherSettings
from arm_viewer.requests import MoveJoints
from arm_viewer.snapshot import Description, Snapshot

PERIOD_S = 0.1
_QUEUE = 10


class JointStateSource:
    """Replaces joint_state_publisher_gui in its node's namespace.

    It publishes ten times a second, and immediately when a slider moves. Use it only in the
    executor's thread.
    """

    def __init__(self, node: Node, latest: Callable[[], Snapshot]) -> None:
        """Publish for the snapshot's robot in the node's namespace."""
        self.namespace = node.get_namespace().rstrip("/")
        self._node = node
        self._latest = latest
        self._described: Description | None = None
        self._merge: JointStateMerge | None = None
        self._publisher = node.create_publisher(JointState, "joint_states", _QUEUE)
        node.create_timer(PERIOD_S, self._publish)

    def move(self, request: MoveJoints) -> None:
        """Take new positions, and publish them."""
        if self._merge is not None and request.namespace == self.namespace:
            self._merge.merge(list(request.positions), list(request.positions.values()), (), ())
            self._publish()

    def _publish(self) -> None:
        self._renew()
        if self._merge is None:
            return
        state = self._merge.state()
        if not state.names:
            return
        message = JointState(name=list(state.names), position=list(state.positions))
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)

    def _renew(self) -> None:
        described = self._latest().descriptions.get(f"{self.namespace}/robot_description")
        if described is self._described:
            return
        self._described = described
        self._merge = None
        if described is not None and described.robot is not None:
            self._merge = JointStateMerge(described.robot.joints, JointPublisherSettings())
