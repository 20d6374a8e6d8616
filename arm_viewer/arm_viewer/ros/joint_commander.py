"""Move joints through their active controllers, or publish them if no robot is running."""

import uuid
from collections.abc import Callable
from typing import Any

from builtin_interfaces.msg import Duration
from control_msgs.action import GripperCommand, ParallelGripperCommand
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from unique_identifier_msgs.msg import UUID

from arm_description.publishers.joint_state_merge import JointStateMerge
from arm_description.publishers.settings import JointPublisherSettings
from arm_viewer.joint_move import DriveKind, JointDrive, JointMove, joint_drives, plan_moves
from arm_viewer.requests import MoveJoints
from arm_viewer.ros.observer import Observer, TopicTypes, keep_in_step, type_name, used_types
from arm_viewer.ros.service_caller import ServiceCaller
from arm_viewer.snapshot import Description, Snapshot

MESSAGES = {
    DriveKind.POSITIONS: Float64MultiArray,
    DriveKind.POSITION: Float64,
    DriveKind.TRAJECTORY: JointTrajectory,
}
ACTIONS = {
    DriveKind.GRIPPER: GripperCommand,
    DriveKind.PARALLEL_GRIPPER: ParallelGripperCommand,
}
_QUEUE = 10


class _PositionPublisher:
    """Publishes moves; use it only in the executor's thread."""

    def __init__(self, node: Node, drive: JointDrive) -> None:
        """Create the publisher."""
        self._node = node
        self._publisher = node.create_publisher(MESSAGES[drive.kind], drive.name, _QUEUE)

    def send(self, move: JointMove) -> None:
        """Publish a move."""
        self._publisher.publish(_message(move))

    def close(self) -> None:
        """Destroy the publisher."""
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


class _GripperGoals:
    """Sends moves as goals; use it only in the executor's thread.

    A slider sends more moves than the action can take, so only the latest move is kept while a goal
    is unanswered. A goal is a call to one of the action's services. Its result is not needed,
    because /joint_states shows the motion.
    """

    def __init__(self, node: Node, drive: JointDrive) -> None:
        """Create the client."""
        self._service_class: Any = ACTIONS[drive.kind].Impl.SendGoalService
        self._service = ServiceCaller(node, self._service_class, f"{drive.name}/_action/send_goal")
        self._waiting: JointMove | None = None

    def send(self, move: JointMove) -> None:
        """Send a move as soon as the previous one is answered."""
        self._waiting = move
        self._ask()

    def close(self) -> None:
        """Destroy the client."""
        self._service.close()

    def _ask(self) -> None:
        if self._waiting is None:
            return
        request = self._service_class.Request(
            goal_id=UUID(uuid=list(uuid.uuid4().bytes)), goal=_goal(self._waiting)
        )
        if self._service.ask(request, lambda _: self._ask()):
            self._waiting = None


def _goal(move: JointMove) -> Any:
    (joint,), (position,) = move.drive.joints, move.positions
    if move.drive.kind is DriveKind.PARALLEL_GRIPPER:
        command = JointState(name=[joint], position=[position])
        return ParallelGripperCommand.Goal(command=command)
    goal = GripperCommand.Goal()
    goal.command.position = position
    return goal


class JointCommander(Observer):
    """Sends moves to the active controllers; use it only in the executor's thread.

    Publishers and clients are created as soon as a controller is active, before the first move,
    because a message sent at the moment of discovery may be lost.
    """

    def __init__(self, node: Node, latest: Callable[[], Snapshot]) -> None:
        """Move the robots of the latest snapshot."""
        self._node = node
        self._latest = latest
        self._senders: dict[tuple[str, DriveKind], _PositionPublisher | _GripperGoals] = {}

    def discover(self, topics: TopicTypes) -> None:
        """Create and destroy senders as controllers become active and inactive."""
        snapshot = self._latest()
        # The order of a controller's joints may become known later; its sender stays.
        drives = {
            (drive.name, drive.kind): drive
            for namespace in {d.namespace for d in snapshot.descriptions.values()}
            for drive in joint_drives(snapshot.controllers, namespace)
        }
        used = used_types(self._node)
        usable = [
            (name, kind)
            for name, kind in drives
            if kind in ACTIONS or used.get(name) in (None, type_name(MESSAGES[kind]))
        ]
        keep_in_step(self._senders, usable, lambda key: _sender(self._node, drives[key]))

    def move(self, request: MoveJoints) -> None:
        """Send the positions to the controllers of their joints."""
        for move in plan_moves(self._latest(), request):
            sender = self._senders.get((move.drive.name, move.drive.kind))
            if sender is not None:
                sender.send(move)


def _sender(node: Node, drive: JointDrive) -> _PositionPublisher | _GripperGoals:
    return (_GripperGoals if drive.kind in ACTIONS else _PositionPublisher)(node, drive)


PERIOD_S = 0.1


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
