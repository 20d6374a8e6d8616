"""The frames of /tf, or assumed while /tf lacks them; shapes are children of their frames."""

import math
from collections.abc import Container, Mapping

import numpy as np
from viser import FrameHandle, LabelHandle, SceneApi

from arm_description.kinematics.forward import forward_kinematics, resolve_mimics
from arm_description.transforms import quaternion_from_rpy, rpy_from_rotation
from arm_description.urdf.joint_type import JointType
from arm_description.urdf.robot import Joint, Robot
from arm_node.rigid_transform import RigidTransform
from arm_viewer.scene.poses import Poses
from arm_viewer.snapshot import Transform


def node_name(name: str) -> str:
    """Return a name for a single scene node; a slash would create nested nodes."""
    return name.replace("/", "\N{DIVISION SLASH}")


AXES_LENGTH, AXES_RADIUS = 0.06, 0.0018
NO_MOTION = 1e-6
"""A smaller change, in m or of a quaternion's component, is not sent."""


class Frames:
    """Draws every frame at its transform; use it in viser's event loop.

    The scene nodes of frames are siblings and not nested like the frames, so that a parent that
    arrives late or changes does not affect them. A frame without a transform is hidden.
    """

    def __init__(self, scene: SceneApi, poses: Poses) -> None:
        """Start without frames, which `poses` will move."""
        self._scene = scene
        self._moving = poses
        self._seen: Mapping[str, Transform] = {}
        self._poses: dict[str, RigidTransform] = {}
        self._handles: dict[str, FrameHandle] = {}
        self._names: dict[str, LabelHandle] = {}
        self._axes_shown = False
        self._names_shown = False

    @property
    def known(self) -> Mapping[str, RigidTransform]:
        """The frames that have a pose."""
        return self._poses

    def path(self, frame: str) -> str:
        """Return the scene path of a frame, below which shapes can be added."""
        if frame not in self._handles:
            self._handles[frame] = self._scene.add_frame(
                _path(frame),
                show_axes=self._axes_shown,
                axes_length=AXES_LENGTH,
                axes_radius=AXES_RADIUS,
                origin_radius=AXES_RADIUS * 1.5,
                visible=False,
            )
        return _path(frame)

    def update(self, transforms: Mapping[str, Transform]) -> None:
        """Move the frames to their transforms."""
        if transforms is self._seen:
            return
        self._seen = transforms
        poses = frame_poses(transforms)
        for frame, pose in poses.items():
            before = self._poses.get(frame)
            if before is None:
                self.path(frame)
                self._moving.move(self._handles[frame], pose)
                self._handles[frame].visible = True
                self._name(frame)
            elif _differ(before, pose):
                self._moving.move(self._handles[frame], pose)
            else:
                poses[frame] = before
        for frame in self._poses.keys() - poses.keys():
            self._handles[frame].visible = False
        self._poses = poses

    def show_axes(self, shown: bool) -> None:
        """Show or hide the axes of all frames."""
        if shown != self._axes_shown:
            self._axes_shown = shown
            for handle in self._handles.values():
                handle.show_axes = shown

    def show_names(self, shown: bool) -> None:
        """Show or hide the names of all frames."""
        if shown != self._names_shown:
            self._names_shown = shown
            for frame in self._poses:
                self._name(frame)

    def _name(self, frame: str) -> None:
        if frame in self._names:
            self._names[frame].visible = self._names_shown
        elif self._names_shown:
            self._names[frame] = self._scene.add_label(
                f"{self.path(frame)}/name", frame, font_screen_scale=0.7
            )


def _path(frame: str) -> str:
    return f"/frames/{node_name(frame)}"


def _differ(first: RigidTransform, second: RigidTransform) -> bool:
    return any(
        abs(a - b) > NO_MOTION
        for a, b in zip(
            (*first.position, *first.rotation), (*second.position, *second.rotation), strict=True
        )
    )


def frame_poses(transforms: Mapping[str, Transform]) -> dict[str, RigidTransform]:
    """Return the pose of every frame, including roots; frames in a loop have no pose."""
    poses: dict[str, RigidTransform] = {}
    for frame in transforms:
        chain: dict[str, Transform] = {}
        while frame not in poses and frame in transforms and frame not in chain:
            chain[frame] = transforms[frame]
            frame = transforms[frame].parent
        if frame in chain:
            continue
        pose = poses.setdefault(frame, RigidTransform())
        for child, step in reversed(chain.items()):
            pose = poses[child] = pose.then(step.pose)
    return poses


def assumed_transforms(
    robot: Robot,
    places: Mapping[str, str],
    initial: Mapping[str, float],
    known: Container[str],
) -> dict[str, Transform]:
    """Return the transforms that /tf lacks, by child frame, with joints at their initial positions.

    Other joints are at 0, or at the nearest limit if 0 is outside their limits.
    """
    missing = [joint for joint in robot.joints if places[joint.child] not in known]
    if not missing:
        return {}
    free = {j.name: _start(j, initial) for j in robot.joints if j.mimic is None}
    poses = forward_kinematics(robot, resolve_mimics(robot, free))
    transforms: dict[str, Transform] = {}
    for joint in missing:
        step = np.linalg.inv(poses[joint.parent]) @ poses[joint.child]
        x, y, z = step[:3, 3].tolist()
        qx, qy, qz, qw = quaternion_from_rpy(rpy_from_rotation(step[:3, :3])).tolist()
        parent = places[joint.parent]
        pose = RigidTransform((x, y, z), (qx, qy, qz, qw))
        transforms[places[joint.child]] = Transform(parent, pose)
    return transforms


def unknown_joints(robot: Robot, places: Mapping[str, str], known: Container[str]) -> list[str]:
    """Return the moving joints that /tf has no transform for."""
    return [
        joint.name
        for joint in robot.joints
        if joint.type is not JointType.FIXED and places[joint.child] not in known
    ]


def _start(joint: Joint, initial: Mapping[str, float]) -> float:
    position = initial.get(joint.name, 0.0)
    if joint.limit is not None and joint.type.needs_limit:
        position = min(max(position, joint.limit.lower), joint.limit.upper)
    return position if math.isfinite(position) else 0.0
