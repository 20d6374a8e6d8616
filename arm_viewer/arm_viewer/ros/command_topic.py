"""The topic on which a controller takes positions."""

from typing import Any

from builtin_interfaces.msg import Duration
from rclpy.node import Node
from std_msgs.msg import Float64, Float64MultiArray
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_viewer.joint_drive import DriveKind, JointDrive
from arm_viewer.joint_move import JointMove

MESSAGES = {
    DriveKind.POSITIONS: Float64MultiArray,
    DriveKind.POSITION: Float64,
    DriveKind.TRAJECTORY: JointTrajectory,
}
_QUEUE = 10


class CommandTopic:
    """Publishes moves; used by the executor's thread alone."""

    def __init__(self, node: Node, drive: JointDrive) -> None:
        """Make the publisher."""
        self._node = node
        self._publisher = node.create_publisher(MESSAGES[drive.kind], drive.name, _QUEUE)

    def send(self, move: JointMove) -> None:
        """Publish a move."""
        self._publisher.publish(_message(move))

    def close(self) -> None:
        """End the publisher."""
        self._node.destroy_publisher(self._publisher)


def _message(move: JointMove) -> Any:
    positions = list(move.positions)
    if move.drive.kind is DriveKind.POSITIONS:
        return Float64MultiArray(data=positions)
    if move.drive.kind is DriveKind.POSITION:
        return Float64(data=positions[0])
    seconds = int(move.duration_s)
    nanoseconds = int((move.duration_s - seconds) * 1e9)
    point = JointTrajectoryPoint(
        positions=positions, time_from_start=Duration(sec=seconds, nanosec=nanoseconds)
    )
    return JointTrajectory(joint_names=list(move.drive.joints), points=[point])
