"""The frames of one SDF scope: the models of a world, or the links of a model."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.sdf.element import SdfElement, SdfPose
from arm_node.names import listing

ROOTS = ("", "world", "__model__")
"""The names of the scope's own frame."""
SEPARATOR = "::"
"""Separates the name of a model from the name of a frame in it."""


class SdfFrames:
    """Resolves `relative_to` by name, also into the models of the scope: `table::top`.

    Args:
        elements: the elements that have a pose, by name.
        offsets: for elements with a placement frame, the pose (4, 4) of their own frame in it.
        models: frames of the models in the scope, by name; `elements` contains the models as well.
        merged: names of the models whose frames are known by their bare names as well.
    """

    def __init__(
        self,
        elements: Mapping[str, SdfElement],
        offsets: Mapping[SdfElement, NDArray[np.float64]] | None = None,
        models: "Mapping[str, SdfFrames] | None" = None,
        merged: Sequence[str] = (),
    ) -> None:
        self._elements = elements
        self._offsets = offsets or {}
        self._models = models or {}
        self._merged = tuple(merged)

    def matrix(self, element: SdfElement) -> NDArray[np.float64]:
        """Return the pose (4, 4) of an element in the scope's frame.

        Raises:
            WorldError: its reference frame does not exist, or the references form a circle.
        """
        return self._resolved(element, self._pose(element))

    def named(
        self, name: str, owner: SdfElement, relation: str = "is placed by"
    ) -> NDArray[np.float64]:
        """Return the pose (4, 4) of a frame by its name in the scope.

        Raises:
            WorldError: there is no such frame.
        """
        if name in ROOTS:
            return np.eye(4)
        inside, element = self._step(name, owner, relation)
        return self.matrix(element) @ inside

    def knows(self, name: str) -> bool:
        """Return whether the scope has a frame of this name."""
        model, _, rest = name.partition(SEPARATOR)
        return (
            name in self._elements
            or (model in self._models and self._models[model].knows(rest))
            or any(self._models[merged].knows(name) for merged in self._merged)
        )

    def within(self, owner: SdfElement, part: SdfElement) -> NDArray[np.float64]:
        """Return the pose (4, 4) of a part of an element in the frame of that element."""
        pose = part.pose()
        if not pose.relative_to:
            return pose.matrix
        return np.linalg.inv(self.matrix(owner)) @ self._resolved(part, pose)

    def _resolved(self, element: SdfElement, pose: SdfPose) -> NDArray[np.float64]:
        """Follow a pose from frame to frame up to the scope's own frame."""
        matrix, visited = pose.matrix, set[str]()
        while (name := pose.relative_to or _default_frame(element)) not in ROOTS:
            if name in visited:
                raise element.error(f"is relative to '{name}', which closes a circle of frames")
            visited.add(name)
            inside, element = self._step(name, element, "is relative to")
            pose = self._pose(element)
            matrix = pose.matrix @ inside @ matrix
        return matrix

    def _pose(self, element: SdfElement) -> SdfPose:
        pose = element.pose()
        return replace(pose, matrix=pose.matrix @ self._offsets.get(element, np.eye(4)))

    def _step(
        self, name: str, asking: SdfElement, relation: str
    ) -> tuple[NDArray[np.float64], SdfElement]:
        """Return the element of this scope that has a frame, and the frame's pose in it."""
        if name in self._elements:
            return np.eye(4), self._elements[name]
        model, separator, rest = name.partition(SEPARATOR)
        if separator and model in self._models:
            return self._models[model].named(rest, asking, relation), self._elements[model]
        for model in self._merged:
            if self._models[model].knows(name):
                return self._models[model].named(name, asking, relation), self._elements[model]
        known = listing(sorted(self._elements))
        raise asking.error(f"{relation} '{name}', not one of {known}")


def _default_frame(element: SdfElement) -> str:
    """Return the frame that an element's pose is relative to by default."""
    return element.text("child") if element.tag == "joint" else element.attribute("attached_to")
