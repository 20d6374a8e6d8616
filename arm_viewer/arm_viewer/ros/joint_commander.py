"""Moves joints by whatever controllers are active on them."""

from collections.abc import Callable

from rclpy.node import Node

from arm_viewer.joint_drive import DriveKind, JointDrive, joint_drives
from arm_viewer.joint_move import plan_moves
from arm_viewer.requests import MoveJoints
from arm_viewer.ros.command_topic import MESSAGES, CommandTopic
from arm_viewer.ros.gripper_goals import ACTIONS, GripperGoals
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.ros.topic_types import type_name, used_types
from arm_viewer.snapshot import Snapshot


class JointCommander:
    """Sends to the active controllers; used by the executor's thread alone.

    The ways there are made when a controller is seen to be active, before the first movement:
    what is sent in the moment of the match may be lost.
    """

    def __init__(self, node: Node, latest: Callable[[], Snapshot]) -> None:
        """Move what that snapshot shows."""
        self._node = node
        self._latest = latest
        self._ways: dict[tuple[str, DriveKind], CommandTopic | GripperGoals] = {}

    def discover(self, topics: TopicTypes) -> None:
        """Follow the controllers that are active."""
        snapshot = self._latest()
        # The order of a controller's joints may be heard of later: no reason to begin anew.
        drives = {
            (drive.name, drive.kind): drive
            for namespace in {d.namespace for d in snapshot.descriptions.values()}
            for drive in joint_drives(snapshot.controllers, namespace)
        }
        for key in self._ways.keys() - drives.keys():
            self._ways.pop(key).close()
        used = used_types(self._node)
        for key in drives.keys() - self._ways.keys():
            name, kind = key
            if kind in ACTIONS or used.get(name) in (None, type_name(MESSAGES[kind])):
                self._ways[key] = _way(self._node, drives[key])

    def collect(self, now_s: float) -> None:
        """Take nothing: this one only sends."""

    def move(self, request: MoveJoints) -> None:
        """Send the positions to the controllers of their joints."""
        for move in plan_moves(self._latest(), request):
            way = self._ways.get((move.drive.name, move.drive.kind))
            if way is not None:
                way.send(move)


def _way(node: Node, drive: JointDrive) -> CommandTopic | GripperGoals:
    return (GripperGoals if drive.kind in ACTIONS else CommandTopic)(node, drive)
