"""Moves joints by whatever controllers are active on them."""

from collections.abc import Callable
from typing import Any

from builtin_interfaces.msg import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import Float64, Float64MultiArray
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_viewer.joint_drive import DriveKind, joint_drives
from arm_viewer.joint_move import JointMove, plan_moves
from arm_viewer.requests import MoveJoints
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.snapshot import Snapshot

_MESSAGES = {
    DriveKind.POSITIONS: Float64MultiArray,
    DriveKind.POSITION: Float64,
    DriveKind.TRAJECTORY: JointTrajectory,
}
_QUEUE = 10


class JointCommander:
    """Publishes to the active controllers; used by the executor's thread alone.

    The publishers are made when a controller is seen to be active, before the first movement:
    what is sent in the moment of the match may be lost.
    """

    def __init__(self, node: Node, latest: Callable[[], Snapshot]) -> None:
        """Move what that snapshot shows."""
        self._node = node
        self._latest = latest
        self._publishers: dict[tuple[str, DriveKind], Publisher] = {}

    def discover(self, topics: TopicTypes) -> None:
        """Follow the controllers that are active."""
        snapshot = self._latest()
        drives = {
            (drive.topic, drive.kind)
            for namespace in {d.namespace for d in snapshot.descriptions.values()}
            for drive in joint_drives(snapshot.controllers, namespace)
        }
        for key in self._publishers.keys() - drives:
            self._node.destroy_publisher(self._publishers.pop(key))
        for topic, kind in drives - self._publishers.keys():
            publisher = self._node.create_publisher(_MESSAGES[kind], topic, _QUEUE)
            self._publishers[topic, kind] = publisher

    def collect(self, now_s: float) -> None:
        """Take nothing: this one only sends."""

    def move(self, request: MoveJoints) -> None:
        """Send the positions to the controllers of their joints."""
        for move in plan_moves(self._latest(), request):
            publisher = self._publishers.get((move.drive.topic, move.drive.kind))
            if publisher is not None:
                publisher.publish(_message(move))


def _message(move: JointMove) -> Any:
    positions = list(move.positions)
    match move.drive.kind:
        case DriveKind.POSITIONS:
            return Float64MultiArray(data=positions)
        case DriveKind.POSITION:
            return Float64(data=positions[0])
        case DriveKind.TRAJECTORY:
            seconds = int(move.duration_s)
            nanoseconds = int((move.duration_s - seconds) * 1e9)
            point = JointTrajectoryPoint(
                positions=positions, time_from_start=Duration(sec=seconds, nanosec=nanoseconds)
            )
            return JointTrajectory(joint_names=list(move.drive.joints), points=[point])
