"""The frames that are fixed to a camera's link, and the optical frame among them."""

import math
from collections import deque

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import UrdfError
from arm_description.transforms import rotation_from_rpy
from arm_description.urdf.description import RobotDescription
from arm_description.urdf.element import UrdfElement
from arm_description.urdf.robot import Pose

Matrix = NDArray[np.float64]

OPTICAL_RPY = (-math.pi / 2, 0.0, -math.pi / 2)
"""From a link that looks along x, z up, to the optical frame: z forward, y down (REP 103)."""
OPTICAL = rotation_from_rpy(OPTICAL_RPY)
ROTATION_TOLERANCE = 0.01


class CameraFrames:
    """A link of a URDF and every link that fixed joints attach to it.

    Args:
        description: the URDF.
        link: name of the link that carries the camera.
    """

    def __init__(self, description: RobotDescription, link: str) -> None:
        self._link = link
        self._poses: dict[str, Matrix] = {link: np.eye(4)}
        fixed = [joint for joint in description.joints if joint.get("type") == "fixed"]
        pending = deque([link])
        while pending:
            parent = pending.popleft()
            for joint in fixed:
                child = _child_of(joint, parent)
                origin = _origin(joint) if child and child not in self._poses else None
                if origin is not None:
                    self._poses[child] = self._poses[parent] @ origin.matrix()
                    pending.append(child)

    def optical(self) -> str:
        """Return the nearest frame with the optical orientation, or the link if there is none."""
        for name, pose in self._poses.items():
            if np.abs(pose[:3, :3] - OPTICAL).max() < ROTATION_TOLERANCE:
                return name
        return self._link

    def optics_in(self, frame: str, camera: Pose) -> Matrix | None:
        """Return the (4, 4) pose of a camera's optical axes in a frame.

        Args:
            frame: the link, or a frame that is fixed to it; for any other frame the result is None.
            camera: pose of the camera in its link.
        """
        pose = self._poses.get(frame)
        if pose is None:
            return None
        optics = camera.matrix()
        optics[:3, :3] = optics[:3, :3] @ OPTICAL
        return np.linalg.inv(pose) @ optics


def _child_of(joint: UrdfElement, parent: str) -> str:
    """Return the child link of a joint; empty if the joint has another parent link."""
    above, below = joint.first("parent"), joint.first("child")
    if above is None or below is None or above.get("link") != parent:
        return ""
    return below.get("link")


def _origin(joint: UrdfElement) -> Pose | None:
    """Return the pose of a joint in its parent link; None if the origin is invalid."""
    origin = joint.first("origin")
    try:
        return origin.pose() if origin else Pose()
    except UrdfError:
        return None
