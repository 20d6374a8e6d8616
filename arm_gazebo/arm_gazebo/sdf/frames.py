"""Where the frames of one SDF scope are: the models of a world, or the links of a model."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from arm_description.names import listing
from arm_description.robot import Pose
from arm_gazebo.sdf.element import SdfElement, SdfPose

ROOTS = ("", "world", "__model__")
"""What the scope's own frame is called."""


class SdfFrames:
    """Resolves `relative_to` by name.

    Args:
        elements: what has a pose, by name.
        offsets: of those whose pose places not their own frame but another one: their frame in
            that one, (4, 4).
    """

    def __init__(
        self,
        elements: Mapping[str, SdfElement],
        offsets: Mapping[SdfElement, NDArray[np.float64]] | None = None,
    ) -> None:
        self._elements = elements
        self._offsets = offsets or {}

    def matrix(self, element: SdfElement) -> NDArray[np.float64]:
        """Return the pose (4, 4) of an element in the scope's frame.

        Raises:
            WorldError: it is relative to nothing that is there, or in a circle.
        """
        return self._resolved(element, self._pose(element))

    def named(self, name: str, owner: SdfElement) -> NDArray[np.float64]:
        """Return the pose (4, 4) of the frame that the scope's owner calls so.

        Raises:
            WorldError: there is none.
        """
        if name in ROOTS:
            return np.eye(4)
        return self.matrix(self._element(name, owner, "is placed by"))

    def within(self, owner: SdfElement, part: SdfElement) -> NDArray[np.float64]:
        """Return the pose (4, 4) of a part of one of the elements in that element's frame."""
        pose = part.pose()
        if not pose.relative_to:
            return pose.matrix
        return np.linalg.inv(self.matrix(owner)) @ self._resolved(part, pose)

    def _resolved(self, element: SdfElement, pose: SdfPose) -> NDArray[np.float64]:
        """Follow a pose from frame to frame up to the scope's own."""
        matrix, passed = pose.matrix, set[str]()
        while (name := pose.relative_to or _usual_frame(element)) not in ROOTS:
            if name in passed:
                raise element.error(f"is relative to '{name}', and that in a circle to itself")
            passed.add(name)
            element = self._element(name, element, "is relative to")
            pose = self._pose(element)
            matrix = pose.matrix @ matrix
        return matrix

    def _pose(self, element: SdfElement) -> SdfPose:
        pose = element.pose()
        return replace(pose, matrix=pose.matrix @ self._offsets.get(element, np.eye(4)))

    def _element(self, name: str, asking: SdfElement, relation: str) -> SdfElement:
        if name not in self._elements:
            known = listing(sorted(self._elements))
            raise asking.error(f"{relation} '{name}', not one of {known}")
        return self._elements[name]


def _usual_frame(element: SdfElement) -> str:
    """Return what an element's pose is relative to where it does not say it itself."""
    return element.text("child") if element.tag == "joint" else element.attribute("attached_to")


def pose_of(matrix: NDArray[np.float64]) -> Pose:
    """Return a (4, 4) transform as translation and roll, pitch, yaw."""
    (x, y, z), r = matrix[:3, 3].tolist(), matrix[:3, :3]
    pitch = float(np.arctan2(-r[2, 0], np.hypot(r[0, 0], r[1, 0])))
    if np.hypot(r[0, 0], r[1, 0]) < 1e-9:
        # Roll and yaw turn about the same axis: all of it is called roll.
        return Pose((x, y, z), (float(np.arctan2(-r[1, 2], r[1, 1])), pitch, 0.0))
    roll, yaw = float(np.arctan2(r[2, 1], r[2, 2])), float(np.arctan2(r[1, 0], r[0, 0]))
    return Pose((x, y, z), (roll, pitch, yaw))
